# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run when FreeCAD starts, with and without GUI. Nothing needs doing: documents import what they hold."""
