# SPDX-License-Identifier: LGPL-2.1-or-later
"""Swarf's FreeCAD add-on: core (pure Python), app (document objects, headless), gui (widgets).

Imports nothing itself, and inside the package all imports are relative: it works as `freecad.swarf_cam` in FreeCAD
and as `swarf_cam` in a plain Python, where the command line finds its reader of .FCStd files.
"""

import os

FOLDER = os.path.dirname(os.path.abspath(__file__))
ICONS = os.path.join(FOLDER, "icons")
TRANSLATIONS = os.path.join(FOLDER, "translations")
