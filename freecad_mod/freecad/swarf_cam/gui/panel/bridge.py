# SPDX-License-Identifier: LGPL-2.1-or-later
"""From the engine's thread to the GUI's: what the engine tells arrives here in the event loop."""

import threading

from ..qt import QtCore


class Bridge(QtCore.QObject):
    """Listener of a core.engine.Engine. Of frames and progress only the newest is told."""

    opened = QtCore.Signal(object)
    progressed = QtCore.Signal(float)
    failed = QtCore.Signal(object)
    finished = QtCore.Signal()
    frame_came = QtCore.Signal()
    _answered = QtCore.Signal(object, object, object)

    def __init__(self, parent=None):
        super().__init__(parent)
        self._lock = threading.Lock()
        self._frame = None
        self.listener = _Listener(self)
        self._answered.connect(self._tell, QtCore.Qt.QueuedConnection)

    def put_frame(self, frame):
        """The engine's thread: a newer picture."""
        with self._lock:
            told, self._frame = self._frame is not None, frame
        if not told:
            self.frame_came.emit()

    def take_frame(self):
        """The GUI's thread: the newest picture, or None when it was taken."""
        with self._lock:
            frame, self._frame = self._frame, None
        return frame

    def answer_to(self, function):
        """on_result for Engine.call(): function(result, error) in the GUI's thread."""
        return lambda result, error: self.listener.emit(self._answered, function, result, error)

    @staticmethod
    def _tell(function, result, error):
        function(result, error)


class _Listener:
    """What the engine calls. FreeCAD may be on its way out and Qt's objects gone: nobody is left to tell then."""

    def __init__(self, bridge):
        self._bridge = bridge

    @staticmethod
    def emit(signal, *values):
        """Emit unless the object is gone."""
        try:
            signal.emit(*values)
        except RuntimeError:
            pass

    def opened(self, session):
        """The job can be watched."""
        self.emit(self._bridge.opened, session)

    def progress(self, fraction):
        """Part of opening that is done."""
        self.emit(self._bridge.progressed, fraction)

    def failed(self, error):
        """Something did not work."""
        self.emit(self._bridge.failed, error)

    def finished(self):
        """The thread ends."""
        self.emit(self._bridge.finished)

    def frame(self, frame):
        """A picture."""
        try:
            self._bridge.put_frame(frame)
        except RuntimeError:
            pass
