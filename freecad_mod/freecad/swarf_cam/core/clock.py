# SPDX-License-Identifier: LGPL-2.1-or-later
"""When the machine does what: places in a program <-> seconds, at the programmed feeds and without acceleration.

A place is a number of moves that are done, with the part of the next one that is done as its fraction: 0.0 is the
start, len(clock) the end. Columns of doubles, one value per move, made once; then read only, any thread.
"""

import array
import bisect
import math

from . import moves

# What a machine does in a rapid where nobody says, mm/min; Program.seconds() takes the same.
RAPID_MM_MIN = 5000.0


def _arc(start, end, centre, plane, turns):
    """(radius, begin, sweep in radians, rise) of an arc's or helix' track."""
    first, second, normal = moves.PLANE_AXES[plane]
    u, v = start[first] - centre[first], start[second] - centre[second]
    begin = math.atan2(v, u)
    sweep = math.atan2(end[second] - centre[second], end[first] - centre[first]) - begin
    full = 2 * math.pi
    # An end on the start is a whole turn; what rounding leaves of one is a whole turn too.
    share = (sweep if turns > 0 else -sweep) % full
    if share < 1e-9 or full - share < 1e-9:
        share = full
    share += full * (abs(turns) - 1)
    return math.hypot(u, v), begin, math.copysign(share, turns), end[normal] - start[normal]


class Clock:
    """Times and tool tips along a MoveTable."""

    def __init__(self, table, rapid_mm_min=RAPID_MM_MIN):
        self._table = table
        self._starts = array.array("d", [0.0])
        self._tips = array.array("d")  # before each move; NaN: unknown
        tip, total = (math.nan,) * 3, 0.0
        for index in range(len(table)):
            self._tips.extend(tip)
            kind, code, _, _, feed, *rest = table.row(index)
            if kind == moves.EVENT:
                total += feed if code == moves.DWELL else 0.0
            else:
                end = tuple(rest[:3])
                speed = rapid_mm_min if kind == moves.LINE and code == moves.RAPID else feed
                if speed > 0.0 and not math.isnan(tip[0]):
                    total += 60.0 * self._length(tip, kind, code, end, rest[3:6], rest[6]) / speed
                tip = end
            self._starts.append(total)
        self._tips.extend(tip)

    @staticmethod
    def _length(start, kind, code, end, centre, turns):
        if kind == moves.LINE:
            return math.dist(start, end)
        radius, _, sweep, rise = _arc(start, end, centre, int(code), turns)
        return math.hypot(radius * sweep, rise)

    def __len__(self):
        return len(self._starts) - 1

    @property
    def seconds(self):
        """Length of the whole program."""
        return self._starts[-1]

    def time_of(self, place):
        """Seconds from the start at a place."""
        place = min(max(place, 0.0), float(len(self)))
        index = min(int(place), len(self))
        if index == len(self):
            return self._starts[-1]
        begin, end = self._starts[index], self._starts[index + 1]
        return begin + (end - begin) * (place - index)

    def place_at(self, seconds):
        """The place reached after so many seconds; of moves that take no time, behind them all."""
        index = bisect.bisect_right(self._starts, seconds) - 1
        if index < 0:
            return 0.0
        if index >= len(self):
            return float(len(self))
        begin, end = self._starts[index], self._starts[index + 1]
        return index + (seconds - begin) / (end - begin)

    def tip_at(self, place):
        """The tool's tip (x, y, z) at a place, mm; None while it is not known."""
        place = min(max(place, 0.0), float(len(self)))
        index = int(place)
        share = place - index
        start = tuple(self._tips[3 * index:3 * index + 3])
        if share == 0.0:
            return None if math.isnan(start[0]) else start
        kind, code, _, _, _, ex, ey, ez, cx, cy, cz, turns = self._table.row(index)
        if kind == moves.EVENT:
            return None if math.isnan(start[0]) else start
        end = (ex, ey, ez)
        if math.isnan(start[0]):
            return end
        if kind == moves.LINE:
            return tuple(a + (b - a) * share for a, b in zip(start, end))
        first, second, normal = moves.PLANE_AXES[int(code)]
        centre = (cx, cy, cz)
        radius, begin, sweep, rise = _arc(start, end, centre, int(code), turns)
        angle = begin + sweep * share
        point = [0.0] * 3
        point[first] = centre[first] + radius * math.cos(angle)
        point[second] = centre[second] + radius * math.sin(angle)
        point[normal] = start[normal] + rise * share
        return tuple(point)


def text_of(seconds):
    """1:02:03 or 2:03, for clocks that are read at a glance."""
    whole = int(max(seconds, 0.0) + 0.5)
    hours, minutes = whole // 3600, whole // 60 % 60
    return "%d:%02d:%02d" % (hours, minutes, whole % 60) if hours else "%d:%02d" % (minutes, whole % 60)
