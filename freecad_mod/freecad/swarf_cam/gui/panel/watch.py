# SPDX-License-Identifier: LGPL-2.1-or-later
"""Notices when the job that is watched changes, or goes."""

import FreeCAD

from ...app.state import job_signature
from ..qt import QtCore

# Milliseconds of quiet after a change before the job's signature is compared: recomputes change many objects.
QUIET_MS = 400


class JobWatch(QtCore.QObject):
    """Document observer of one job. Signals: changed (it differs from what was read, or again not), deleted, closed
    (its document)."""

    changed = QtCore.Signal(bool)
    deleted = QtCore.Signal()
    closed = QtCore.Signal()

    def __init__(self, job, parent=None):
        super().__init__(parent)
        self._job, self._document = job, job.Document
        self._name, self._document_name = job.Name, job.Document.Name
        self._signature = job_signature(job, 1.0)
        self._timer = QtCore.QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(QUIET_MS)
        self._timer.timeout.connect(self._compare)
        self._observer = _Observer(self)
        FreeCAD.addDocumentObserver(self._observer)

    def stop(self):
        """Watch no more."""
        if self._observer is not None:
            FreeCAD.removeDocumentObserver(self._observer)
            self._observer = None
        self._timer.stop()

    @property
    def job(self):
        """The job, None once it is gone."""
        return self._job

    def _compare(self):
        if self._job is None:
            return
        try:
            same = job_signature(self._job, 1.0) == self._signature
        except (ReferenceError, RuntimeError, AttributeError, ValueError):
            same = False  # half way through an edit
        self.changed.emit(not same)

    def on_changed(self, obj):
        """Something in some document."""
        if self._job is not None and obj.Document.Name == self._document_name:
            self._timer.start()

    def on_deleted(self, obj):
        """An object goes."""
        if self._job is None or obj.Document.Name != self._document_name:
            return
        if obj.Name == self._name:
            self._job = None
            self._timer.stop()
            self.deleted.emit()
        else:
            self._timer.start()

    def on_closed(self, document):
        """A document goes."""
        if document.Name == self._document_name:
            self._job = None
            self._timer.stop()
            self.closed.emit()


class _Observer:
    """FreeCAD calls these; nothing may come out of them."""

    def __init__(self, watch):
        self._watch = watch

    def _call(self, function, argument):
        try:
            function(argument)
        except (ReferenceError, RuntimeError, AttributeError):
            pass

    def slotChangedObject(self, obj, _):
        self._call(self._watch.on_changed, obj)

    def slotDeletedObject(self, obj):
        self._call(self._watch.on_deleted, obj)

    def slotDeletedDocument(self, document):
        self._call(self._watch.on_closed, document)
