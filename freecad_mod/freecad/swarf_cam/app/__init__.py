# SPDX-License-Identifier: LGPL-2.1-or-later
"""Document part of the add-on: needs FreeCAD, runs without its GUI."""
