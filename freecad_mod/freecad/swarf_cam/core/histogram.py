# SPDX-License-Identifier: LGPL-2.1-or-later
"""How much of the surface deviates by how much: bars on the scale of the legend, and the numbers beside them."""

import math
from dataclasses import dataclass

from . import legend

BINS = 64


@dataclass(frozen=True)
class Histogram:
    """areas: mm2 of each of equal steps of the legend's scale from its lower end; the outer ones hold what is
    beyond."""

    areas: tuple
    tolerance_mm: float

    def bounds(self, index):
        """(least, greatest) deviation of a bar, mm; infinite at the outer ends."""
        count = len(self.areas)
        lower, upper = (legend.value_at(at / count, self.tolerance_mm) for at in (index, index + 1))
        return -math.inf if index == 0 else lower, math.inf if index == count - 1 else upper

    def middle(self, index):
        """The deviation in the middle of a bar, mm."""
        return legend.value_at((index + 0.5) / len(self.areas), self.tolerance_mm)

    def heights(self):
        """Heights of the bars, 0 .. 1: square roots of the areas, for one that is good would hide all that is not."""
        most = max(self.areas, default=0.0)
        return tuple(math.sqrt(area / most) if most > 0 else 0.0 for area in self.areas)


def of(deviation, tolerance_mm):
    """The Histogram of a swarf.Deviation."""
    reach = legend.TOLERANCES * tolerance_mm
    return Histogram(tuple(deviation.histogram(-reach, reach, BINS)), tolerance_mm)
