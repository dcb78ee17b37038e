# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run when FreeCAD's GUI starts: the workbench and its commands. Loads without the native module too."""

import os

import FreeCAD
import FreeCADGui as Gui

from freecad.swarf_cam import ICONS, TRANSLATIONS
from freecad.swarf_cam.gui import commands, preferences

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP


class SwarfWorkbench(Gui.Workbench):
    """Swarf's own workbench: its commands in a menu and a tool bar."""

    MenuText = "Swarf"
    ToolTip = QT_TRANSLATE_NOOP("Workbench", "Milling simulation")
    Icon = os.path.join(ICONS, "swarf.svg")

    def GetClassName(self):
        """FreeCAD's class for workbenches written in Python."""
        return "Gui::PythonWorkbench"

    def Initialize(self):
        """Once, at the first activation."""
        from freecad.swarf_cam.gui.commands import NAMES

        self.appendToolbar("Swarf", NAMES)
        self.appendMenu("&Swarf", NAMES)

    def Activated(self):
        """Say what is missing where the user will see it: the commands stay grey then."""
        from freecad.swarf_cam import native
        from freecad.swarf_cam.core.errors import JobError

        try:
            native.load()
        except JobError as error:
            FreeCAD.Console.PrintError("%s\n" % error)


Gui.addWorkbench(SwarfWorkbench())
Gui.addIconPath(ICONS)
Gui.addLanguagePath(TRANSLATIONS)
Gui.updateLocale()
Gui.addPreferencePage(preferences.Page, "Swarf")
commands.register()
