# SPDX-License-Identifier: LGPL-2.1-or-later
"""Task panel that adds the wires along which a plane cuts what is left of a stock."""

import FreeCAD

from ..app import model
from ..core.errors import JobError
from . import taskpanel
from .planepanel import PlanePanel

translate = FreeCAD.Qt.translate


class SectionPanel(PlanePanel):
    """Task panel for one simulation object."""

    def __init__(self, obj):
        super().__init__("SwarfSectionPanel", translate("Swarf", "Section of the stock"), obj)
        self._wanted = False
        self.add_progress(self.layout)

    def begin(self):
        """Add the wires, as soon as they are known."""
        self._wanted = True
        if self.found is not None and self.found[0] == self.plane:
            self.on_found(self.found[1])
        else:
            self.look()

    def on_found(self, curves):
        """Into the document where they are wanted; the panel stays where there are none."""
        if not self._wanted:
            return
        self._wanted = False
        try:
            made = model.add_section(self.obj, *self.plane, curves)
        except (JobError, ReferenceError, ValueError, RuntimeError) as error:
            self.fail(error)
            return
        FreeCAD.Console.PrintMessage(translate("Swarf", "Swarf: in the document: {0}\n").format(made.Label))
        self.close()


def show_panel(obj):
    """Open the panel, None when another task is open or nothing is left."""
    return taskpanel.show(lambda: SectionPanel(obj))
