# SPDX-License-Identifier: LGPL-2.1-or-later
"""What task panels share that work on what is left of a stock: they follow the document, in which it may change or go
while they are open."""

import FreeCAD

from ..app import pieces
from ..core.errors import JobError
from .observer import Observer
from .qt import QtCore
from .taskpanel import TaskPanel

translate = FreeCAD.Qt.translate

# Properties of any object that may move others.
MOVING = ("Placement", "Group")


class BodyPanel(TaskPanel):
    """Task panel for one simulation object, closed when that goes. body: the Body of its mesh, box: where that lies in
    the document, made again when it changes."""

    def __init__(self, name, title, obj):
        self._observer = None
        super().__init__(name, title)
        self.obj = obj
        self._names = obj.Document.Name, obj.Name
        self._changed = self._lost = self._woken = False
        self._take()
        self._observer = Observer(self)

    def _take(self):
        self._placement = self.obj.getGlobalPlacement()
        self.body, self.box = pieces.body_of(self.obj), pieces.box_of(self.obj)

    def renew(self):
        """The body is another one."""

    def accept(self):
        """As the document is now."""
        self.follow()
        return not self.closed and super().accept()

    def follow(self):
        """Learn what became of the simulation."""
        self._woken = False
        if self.closed:
            return
        if self._lost:
            FreeCAD.Console.PrintWarning(translate("Swarf", "Swarf: the simulation was deleted; its panel is closed\n"))
            self.close()
        elif self._changed or self._placement != self.obj.getGlobalPlacement():
            self._changed = False
            try:
                self._take()
            except JobError as error:
                self.fail(error)
                self.close()
            else:
                self.renew()

    def _wake(self):
        """Follow once the event loop is idle: nothing may be read while it changes."""
        if not self._woken:
            self._woken = True
            QtCore.QTimer.singleShot(0, self.follow)

    def on_changed(self, obj, name):
        """A property of some object."""
        mine = (obj.Document.Name, obj.Name) == self._names and name == "Mesh"
        self._changed |= mine
        if mine or name in MOVING:
            self._wake()

    def on_undone(self, document):
        """Properties that come and go so are told as changes."""

    def on_deleted(self, obj):
        """An object goes."""
        if (obj.Document.Name, obj.Name) == self._names:
            self._lost = True
            self._wake()

    def on_closed(self, document):
        """A document goes."""
        if document.Name == self._names[0]:
            self._lost = True
            self._wake()

    def release(self):
        """Follow the document no more."""
        super().release()
        if self._observer is not None:
            self._observer.stop()
