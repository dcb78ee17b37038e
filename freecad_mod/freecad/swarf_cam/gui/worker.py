# SPDX-License-Identifier: LGPL-2.1-or-later
"""A long call in a thread of its own, its progress and its end told in the GUI's thread."""

import threading

from .qt import QtCore


class _Bridge(QtCore.QObject):
    """Lives in the GUI's thread: what the worker emits arrives there, in its event loop."""

    progress = QtCore.Signal(float)
    ended = QtCore.Signal(object, object)


class Worker:
    """Runs call(progress) in a thread; progress(fraction) answers whether it was cancelled.

    on_progress(fraction) and on_end(result, error) are called in the GUI's thread; one of result and error is None.
    The call must touch neither documents nor widgets. Keep the object until on_end was called.
    """

    def __init__(self, call, on_progress, on_end):
        self._call = call
        self._cancelled = threading.Event()
        self._bridge = _Bridge()
        self._bridge.progress.connect(on_progress, QtCore.Qt.QueuedConnection)
        self._bridge.ended.connect(on_end, QtCore.Qt.QueuedConnection)
        self._thread = threading.Thread(target=self._run, name="Swarf simulation", daemon=True)

    def start(self):
        """Begin; returns at once."""
        self._thread.start()

    def cancel(self):
        """Ask the call to stop; on_end follows with its error."""
        self._cancelled.set()

    def join(self, seconds):
        """Wait for the thread's end."""
        self._thread.join(seconds)

    @property
    def cancelled(self):
        """Whether cancel() was called."""
        return self._cancelled.is_set()

    def _progress(self, fraction):
        self._bridge.progress.emit(float(fraction))
        return self._cancelled.is_set()

    def _run(self):
        try:
            result, error = self._call(self._progress), None
        except BaseException as caught:  # a thread must not die silently; the GUI shows it
            result, error = None, caught
        self._bridge.ended.emit(result, error)
