# SPDX-License-Identifier: LGPL-2.1-or-later
"""The scale of the colours of deviations, as swarf.deviation_colours() has them: up to four tolerances either way."""

TOLERANCES = 4

# Tolerances that are marked: where the colours begin and what they come to.
MARKS = (4, 2, 1, -1, -2, -4)


def value_at(share, tolerance_mm):
    """Deviation (mm) at a share of the scale, 0 at its lower end, where material is missing."""
    return (2 * share - 1) * TOLERANCES * tolerance_mm


def share_of(value, tolerance_mm):
    """Where on the scale a deviation is; what is beyond it stands at its end."""
    return min(max((value / (TOLERANCES * tolerance_mm) + 1) / 2, 0.0), 1.0)


def ticks(tolerance_mm):
    """(share, value) of the marks, from the top."""
    return [(share_of(mark * tolerance_mm, tolerance_mm), mark * tolerance_mm) for mark in MARKS]
