# SPDX-License-Identifier: LGPL-2.1-or-later
"""A stock that can stand at any place of its program, gone to in slices of time. One thread."""

import time


class Playback:
    """history: swarf.History. Places are moves that are done, and the part of the next one."""

    def __init__(self, history):
        self._history = history

    @property
    def stock(self):
        """The stock as it stands; only to be read."""
        return self._history.stock

    @property
    def moves(self):
        """Moves that are done."""
        return self._history.move

    @property
    def fraction(self):
        """The part of the next one that is."""
        return self._history.fraction

    @property
    def at(self):
        """Where it stands."""
        return self._history.move + self._history.fraction

    def step(self, place, seconds, progress=None):
        """Go towards a place for about so many seconds, at least one batch of moves; where it stands then."""
        end = time.monotonic() + seconds
        move = int(place)
        while not self._history.approach(move, place - move, progress=progress) and time.monotonic() < end:
            pass
        return self.at
