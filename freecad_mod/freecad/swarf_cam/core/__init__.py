# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pure Python part of the add-on: imports neither FreeCAD nor the native module."""
