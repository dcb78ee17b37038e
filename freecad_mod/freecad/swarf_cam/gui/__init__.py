# SPDX-License-Identifier: LGPL-2.1-or-later
"""Widgets, commands and view providers: the only part that imports FreeCADGui and PySide."""
