# SPDX-License-Identifier: LGPL-2.1-or-later
"""A stock that can stand after any move: forward by cutting, back from copies that were kept on the way.

One thread. The stock object changes when it goes back: whoever shows it looks at `stock` again after every step.
"""

import bisect
import time

# Copies that are kept at most, and the share of the stock's memory that all of them together may take: copies of a
# narrow band are as large as the stock itself.
COPIES_MAX = 12

# Moves cut in the first slice of a step; the following ones are sized by what it took.
FIRST_SLICE = 16


class Playback:
    """start: swarf.Stock as it was before the first move. runs: (first move, tool number) of each run of moves with
    one tool, in order, the first at 0. memory_limit: bytes for the kept copies."""

    def __init__(self, start, program, tools, runs, memory_limit):
        self._program, self._tools = program, tools
        self._cutting = {number for number, cutter in tools.items() if cutter.radius("flutes") > 0}
        self._begins, self._numbers = [first for first, _ in runs], [number for _, number in runs]
        self._copies = {0: start.copy()}
        self._limit = memory_limit
        self._rate = None
        self.stock = start
        self.at = 0

    @property
    def first(self):
        """The stock before the first move; only to be read."""
        return self._copies[0]

    def keep(self):
        """Keep a copy of the stock as it stands, when memory allows."""
        held = self.stock.size()[1]
        if self.at not in self._copies and len(self._copies) < COPIES_MAX and \
                held * (len(self._copies) + 1) <= self._limit:
            self._copies[self.at] = self.stock.copy()

    def _rewind(self, move):
        """Stand at the last copy before a move, unless going on from here is nearer."""
        nearest = max(at for at in self._copies if at <= move)
        if move < self.at or nearest > self.at:
            self.stock = self._copies[nearest].copy()
            self.at = nearest

    def play_to(self, move, progress=None):
        """Cut all moves up to one at once: the swarf.Simulation of these."""
        done = self.stock.simulate(self._program, self._tools, first=self.at, count=move - self.at, progress=progress)
        self.at = move
        return done

    def _cut(self, count, progress):
        """Cut some moves, at most up to where the tool changes; how many."""
        run = bisect.bisect_right(self._begins, self.at) - 1
        if run + 1 < len(self._begins):
            count = min(count, self._begins[run + 1] - self.at)
        if self._numbers[run] in self._cutting:
            self.stock.cut(self._tools[self._numbers[run]], self._program, self.at, count=count, progress=progress)
        self.at += count
        return count

    def step(self, move, seconds, progress=None):
        """Go towards a move for about so many seconds, at least one slice; where it stands then."""
        self._rewind(move)
        started = time.monotonic()
        end = started + seconds
        while self.at < move:
            left = end - started
            wanted = FIRST_SLICE if self._rate is None else max(int(self._rate * left), 1)
            count = self._cut(min(wanted, move - self.at), progress)
            now = time.monotonic()
            rate = count / max(now - started, 1e-6)
            # Up by doubling only: a slice in the air says little about the next one in the material.
            self._rate = rate if self._rate is None else min(rate, 2 * max(self._rate, 1.0))
            if now >= end:
                break
            started = now
        return self.at
