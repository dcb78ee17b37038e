# SPDX-License-Identifier: LGPL-2.1-or-later
"""Work that must be done in the GUI's thread, because it reads a document, and must not stop it: some of it between the
events."""

from ..core import steps
from .qt import QtCore

# Seconds of work between two looks at what the user does: no one notices them.
SLICE_SECONDS = 0.012


class Slices(QtCore.QObject):
    """Takes the steps of a generator while the event loop is idle; on_end(result, error) is called at the end, one of
    them None. What may be gone in the meantime is the generator's to notice, by an error."""

    def __init__(self, work, on_end, parent=None):
        super().__init__(parent)
        self._work, self._on_end = work, on_end
        self._timer = QtCore.QTimer(self)
        self._timer.timeout.connect(self._go_on)
        self._timer.start(0)

    @property
    def running(self):
        """Whether the end is still to come."""
        return self._work is not None

    def cancel(self):
        """Take no more steps; on_end is not called."""
        self._timer.stop()
        if self._work is not None:
            self._work.close()
        self._work = None
        self.deleteLater()

    def _go_on(self):
        if self._work is None:
            return
        try:
            through, result = steps.run_for(self._work, SLICE_SECONDS)
        except Exception as error:  # the caller shows it
            self._end(None, error)
        else:
            if through:
                self._end(result, None)

    def _end(self, result, error):
        self._timer.stop()
        self._work = None
        self.deleteLater()
        self._on_end(result, error)
