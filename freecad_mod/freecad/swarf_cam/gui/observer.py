# SPDX-License-Identifier: LGPL-2.1-or-later
"""What FreeCAD tells of its documents."""

import FreeCAD


class Observer:
    """Calls a watcher's on_changed(object, property), on_undone(document), on_deleted(object) and on_closed(document)
    until stop(). Nothing may come out of them: they may be told of what is half gone."""

    def __init__(self, watcher):
        self._watcher = watcher
        FreeCAD.addDocumentObserver(self)

    def stop(self):
        """Tell no more; may be called twice."""
        if self._watcher is not None:
            FreeCAD.removeDocumentObserver(self)
            self._watcher = None

    def _call(self, name, *arguments):
        try:
            getattr(self._watcher, name)(*arguments)
        except (ReferenceError, RuntimeError, AttributeError):
            pass

    def slotChangedObject(self, obj, name):
        self._call("on_changed", obj, name)

    def slotUndoDocument(self, document):
        self._call("on_undone", document)

    def slotRedoDocument(self, document):
        self._call("on_undone", document)

    def slotDeletedObject(self, obj):
        self._call("on_deleted", obj)

    def slotDeletedDocument(self, document):
        self._call("on_closed", document)
