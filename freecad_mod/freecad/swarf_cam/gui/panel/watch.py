# SPDX-License-Identifier: LGPL-2.1-or-later
"""Notices when the job that is watched changes, or goes."""

from ...app import fixtures
from ...app.accepted import ACCEPTED
from ...app.setups import signature_steps
from ..observer import Observer
from ..qt import QtCore
from ..slices import Slices

# Milliseconds of quiet after a change before the job's signature is compared: recomputes change many objects.
QUIET_MS = 400


class JobWatch(QtCore.QObject):
    """Document observer of one job. Signals: changed (it differs from what was read, or again not), deleted, closed
    (its document), accepted (what it accepts may be another). differs: what changed told last. known: hashes of the
    paths that have not changed since."""

    changed = QtCore.Signal(bool)
    deleted = QtCore.Signal()
    closed = QtCore.Signal()
    accepted = QtCore.Signal()

    def __init__(self, job, parent=None):
        super().__init__(parent)
        self._job = job
        self._name, self._document_name = job.Name, job.Document.Name
        self._signature = self._slices = None
        self.differs, self.known = False, {}
        self._timer = QtCore.QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(QUIET_MS)
        self._timer.timeout.connect(self._compare)
        self._observer = Observer(self)

    def stop(self):
        """Watch no more."""
        self._observer.stop()
        self._stop_comparing()

    @property
    def job(self):
        """The job, None once it is gone."""
        return self._job

    @property
    def comparing(self):
        """Whether something changed of which is not known yet whether the job differs by it."""
        return self._timer.isActive() or self._slices is not None

    def remember_steps(self):
        """Steps after which changes are told from how the job is now."""
        self._signature = yield from self._signature_steps()

    def _signature_steps(self):
        """Steps -> what the panel depends on: the checks want fixtures, of which the stock knows nothing."""
        return (yield from signature_steps(self._job, 1.0, self.known)), fixtures.measures_of(self._job)

    def _stop_comparing(self):
        self._timer.stop()
        if self._slices is not None:
            self._slices.cancel()
            self._slices = None

    def _compare(self):
        self._slices = Slices(self._signature_steps(), self._compared, self)

    def _compared(self, signature, error):
        """An error: half way through an edit."""
        self._slices = None
        self.differs = error is not None or signature != self._signature
        self.changed.emit(self.differs)

    def on_changed(self, obj, name=None):
        """Something in some document; name: the property."""
        if self._job is not None and obj.Document.Name == self._document_name:
            if obj.Name == self._name and name == ACCEPTED:
                self.accepted.emit()
                return
            self.known.pop(obj.Name, None)
            self._stop_comparing()
            self._timer.start()

    def on_undone(self, document):
        """Something was undone or done again: properties that come and go so are not told as changes."""
        if self._job is not None and document.Name == self._document_name:
            self.accepted.emit()
            self._stop_comparing()
            self._timer.start()

    def on_deleted(self, obj):
        """An object goes."""
        if self._job is None or obj.Document.Name != self._document_name:
            return
        if obj.Name == self._name:
            self._lose_job()
            self.deleted.emit()
        else:
            self.on_changed(obj)

    def on_closed(self, document):
        """A document goes."""
        if document.Name == self._document_name:
            self._lose_job()
            self.closed.emit()

    def _lose_job(self):
        self._job = None
        self._stop_comparing()
