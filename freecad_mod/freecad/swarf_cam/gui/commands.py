# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands, thin: they find the job and open the panel."""

import os

import FreeCAD
import FreeCADGui as Gui

from .. import ICONS, native
from ..app import job as jobs
from ..app import simulation

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

NAMES = ["Swarf_Live", "Swarf_Simulate", "Swarf_Update", "Swarf_Export", "Swarf_Section", "Swarf_Split",
         "Swarf_Measure"]


def chosen_job():
    """The job that is selected, or to which the selection belongs, or the document's only one; else None."""
    document = FreeCAD.ActiveDocument
    if document is None:
        return None
    for obj in Gui.Selection.getSelection():
        if jobs.is_job(obj):
            return obj
        if simulation.is_simulation(obj) and obj.Job is not None:
            return obj.Job  # other jobs may cut its result
        for parent in getattr(obj, "InListRecursive", ()):
            if jobs.is_job(parent):
                return parent
    found = jobs.find_jobs(document)
    return found[0] if len(found) == 1 else None


def chosen_simulation():
    """The simulation that is selected, or the document's only one; else None."""
    document = FreeCAD.ActiveDocument
    if document is None:
        return None
    for obj in Gui.Selection.getSelection():
        if simulation.is_simulation(obj):
            return obj
    found = [obj for obj in document.Objects if simulation.is_simulation(obj)]
    return found[0] if len(found) == 1 else None


def result_is_chosen():
    """Whether a simulation with a result is chosen and no task is open."""
    try:
        chosen = chosen_simulation()
        return (native.is_available() and not Gui.Control.activeDialog() and chosen is not None
                and bool(chosen.Stock))
    except (AttributeError, ReferenceError, RuntimeError):
        return False


class Live:
    """Watch a job being cut."""

    def GetResources(self):
        """Texts and icon."""
        return {"Pixmap": os.path.join(ICONS, "swarf-live.svg"),
                "MenuText": QT_TRANSLATE_NOOP("Swarf_Live", "Watch milling"),
                "ToolTip": QT_TRANSLATE_NOOP(
                    "Swarf_Live", "Watch the stock of the job being cut, step by step, forward and back")}

    def IsActive(self):
        """Whenever there is a job to watch and something to do it with."""
        try:
            return native.is_available() and chosen_job() is not None
        except (AttributeError, ReferenceError, RuntimeError):
            return False

    def Activated(self):
        """Open the dock."""
        from .panel import dock

        dock.show(chosen_job())


class Simulate:
    """Simulate a job."""

    def GetResources(self):
        """Texts and icon."""
        return {"Pixmap": os.path.join(ICONS, "swarf.svg"),
                "MenuText": QT_TRANSLATE_NOOP("Swarf_Simulate", "Simulate milling"),
                "ToolTip": QT_TRANSLATE_NOOP("Swarf_Simulate", "Cut the stock of the job with its tools and compare it "
                                                               "with the model")}

    def IsActive(self):
        """Whenever there is a job to simulate and something to do it with."""
        try:
            return native.is_available() and not Gui.Control.activeDialog() and chosen_job() is not None
        except (AttributeError, ReferenceError, RuntimeError):
            return False

    def Activated(self):
        """Open the panel."""
        from .task import show_panel

        show_panel(chosen_job())


class Update:
    """Simulate again."""

    def GetResources(self):
        """Texts and icon."""
        return {"Pixmap": os.path.join(ICONS, "swarf-update.svg"),
                "MenuText": QT_TRANSLATE_NOOP("Swarf_Update", "Update simulation"),
                "ToolTip": QT_TRANSLATE_NOOP("Swarf_Update", "Simulate the job of the chosen simulation again")}

    def IsActive(self):
        """Whenever a simulation is chosen."""
        try:
            return native.is_available() and not Gui.Control.activeDialog() and chosen_simulation() is not None
        except (AttributeError, ReferenceError, RuntimeError):
            return False

    def Activated(self):
        """Open the panel on it and start."""
        from .task import show_panel

        obj = chosen_simulation()
        show_panel(obj.Job, obj, start=True)


class Export:
    """Write what is left into a file."""

    def GetResources(self):
        """Texts and icon."""
        return {"Pixmap": os.path.join(ICONS, "swarf-export.svg"),
                "MenuText": QT_TRANSLATE_NOOP("Swarf_Export", "Export stock"),
                "ToolTip": QT_TRANSLATE_NOOP(
                    "Swarf_Export",
                    "Write what is left of the stock as a mesh with sharp edges, a shape or a level set")}

    def IsActive(self):
        """Whenever a simulation with a result is chosen."""
        return result_is_chosen()

    def Activated(self):
        """Open the panel."""
        from .exporting import show_panel

        show_panel(chosen_simulation())


class Section:
    """Put the outline of what is left, cut by a plane, into the document."""

    def GetResources(self):
        """Texts and icon."""
        return {"Pixmap": os.path.join(ICONS, "swarf-section.svg"),
                "MenuText": QT_TRANSLATE_NOOP("Swarf_Section", "Section of the stock"),
                "ToolTip": QT_TRANSLATE_NOOP(
                    "Swarf_Section",
                    "Add the wires along which a plane cuts what is left of the stock: to measure, to export as DXF or "
                    "SVG")}

    def IsActive(self):
        """Whenever a simulation with a result is chosen."""
        return result_is_chosen()

    def Activated(self):
        """Open the panel."""
        from .sectioning import show_panel

        show_panel(chosen_simulation())


class Split:
    """Put what is left, cut by a plane, into the document as meshes."""

    def GetResources(self):
        """Texts and icon."""
        return {"Pixmap": os.path.join(ICONS, "swarf-split.svg"),
                "MenuText": QT_TRANSLATE_NOOP("Swarf_Split", "Split the stock"),
                "ToolTip": QT_TRANSLATE_NOOP(
                    "Swarf_Split", "Split what is left of the stock by a plane into closed meshes")}

    def IsActive(self):
        """Whenever a simulation with a result is chosen."""
        return result_is_chosen()

    def Activated(self):
        """Open the panel."""
        from .splitting import show_panel

        show_panel(chosen_simulation())


class Measure:
    """Tell the measures of what is left."""

    def GetResources(self):
        """Texts and icon."""
        return {"Pixmap": os.path.join(ICONS, "swarf-measure.svg"),
                "MenuText": QT_TRANSLATE_NOOP("Swarf_Measure", "Measures of the stock"),
                "ToolTip": QT_TRANSLATE_NOOP(
                    "Swarf_Measure",
                    "Volume, area, size, centre of mass, inertia, holes and thinnest wall of what is left of the "
                    "stock, of the whole and of each shell")}

    def IsActive(self):
        """Whenever a simulation with a result is chosen."""
        return result_is_chosen()

    def Activated(self):
        """Open the panel."""
        from .measuring import show_panel

        show_panel(chosen_simulation())


class CamEntries:
    """Puts the commands beside FreeCAD's own simulators in the CAM workbench; from FreeCAD 0.21 on."""

    SIMULATORS = ("Path_Simulator", "CAM_Simulator")  # 0.21, 1.0

    def modifyMenuBar(self):
        """After the simulators in the menu."""
        return [{"insert": name, "menuItem": simulator, "after": ""}
                for simulator in self.SIMULATORS for name in reversed(NAMES)]

    def modifyToolBars(self):
        """After the simulators in the tool bar."""
        return [{"insert": NAMES[0], "toolItem": simulator, "after": ""} for simulator in self.SIMULATORS]


class PathEntries:
    """The same in FreeCAD 0.20, where a workbench can only be added to once it is there."""

    def __init__(self):
        self.done = False

    def on_activated(self, name):
        """The Path workbench has just been activated for the first time."""
        if name == "PathWorkbench" and not self.done:
            self.done = True
            workbench = Gui.getWorkbench(name)
            workbench.appendMenu(["&Path"], NAMES)
            workbench.appendToolbar("Swarf", NAMES)
            workbench.reloadActive()


_path_entries = PathEntries()  # Qt keeps no reference to the object of a method it calls


def register():
    """Make the commands known, in the CAM workbench too."""
    Gui.addCommand("Swarf_Live", Live())
    Gui.addCommand("Swarf_Simulate", Simulate())
    Gui.addCommand("Swarf_Update", Update())
    Gui.addCommand("Swarf_Export", Export())
    Gui.addCommand("Swarf_Section", Section())
    Gui.addCommand("Swarf_Split", Split())
    Gui.addCommand("Swarf_Measure", Measure())
    if hasattr(Gui, "addWorkbenchManipulator"):
        Gui.addWorkbenchManipulator(CamEntries())
    else:
        Gui.getMainWindow().workbenchActivated.connect(_path_entries.on_activated)
