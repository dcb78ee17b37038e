# SPDX-License-Identifier: LGPL-2.1-or-later
"""Task panel that adds the wires along which a plane cuts what is left of a stock."""

import FreeCAD

from ..app import model
from ..core.errors import JobError
from . import taskpanel
from .planepanel import PlanePanel

translate = FreeCAD.Qt.translate


class SectionPanel(PlanePanel):
    """Task panel for one simulation object. The plane that was agreed to is the one that is added, wherever it is moved
    until its curves are known."""

    def __init__(self, obj):
        self._wanted = None
        super().__init__("SwarfSectionPanel", translate("Swarf", "Section of the stock"), obj)
        self.add_progress(self.layout)

    @property
    def sought(self):
        """The plane that was agreed to; before, that of the widgets."""
        return self._wanted or self.plane

    def begin(self):
        """Add the wires, as soon as they are known."""
        self._wanted = self.plane
        if self.found is not None and self.found[0] == self._wanted:
            self.on_found(self.found[1])
        else:
            self.look()

    def on_found(self, curves):
        """Into the document where they are wanted; the panel stays where there are none."""
        if self._wanted is None:
            return
        try:
            made = model.add_section(self.obj, *self._wanted, curves)
        except (JobError, ReferenceError, ValueError, RuntimeError) as error:
            self.fail(error)
            return
        FreeCAD.Console.PrintMessage(translate("Swarf", "Swarf: in the document: {0}\n").format(made.Label))
        self.close()

    def fail(self, error):
        """Nothing is agreed to any more."""
        self._wanted = None
        super().fail(error)


def show_panel(obj):
    """Open the panel, None when another task is open or nothing is left."""
    return taskpanel.show(lambda: SectionPanel(obj))
