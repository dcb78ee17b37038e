# SPDX-License-Identifier: LGPL-2.1-or-later
"""Canned drilling cycles as the moves they stand for, after RS274/NGC as LinuxCNC reads it.

The steps are (action, value): "rapid" or "feed" with a height, "dwell" with seconds. They begin at the retract height
above the hole.
"""

# How far a peck stays clear of (G83) or draws back from (G73) the bottom reached before; LinuxCNC: 0.010 inch.
PECK_CLEARANCE_MM = 0.254

# A peck that would leave less than this for the next one goes to the bottom: rounding, not a cut.
PECK_REST_MM = 1e-6

CYCLES = ("G73", "G74", "G81", "G82", "G83", "G84", "G85", "G86", "G89")
PECKING = ("G73", "G83")
DWELLING = ("G74", "G82", "G84", "G86", "G89")

# Boring and tapping come out at the feed, the tap's spindle reversed; G85 does so up to the retract height only.
FED_OUT = ("G74", "G84", "G89")


# A depth per peck that makes more pecks than this is a mistake, and would fill the memory.
PECKS_MAX = 100000


def _drill(z, dwell):
    yield "feed", z
    if dwell:
        yield "dwell", dwell


def _peck(z, retract, peck, dwell, full_retract):
    number = 1
    while True:
        depth = retract - number * peck
        if depth - z <= PECK_REST_MM:
            break
        yield "feed", depth
        if dwell:
            yield "dwell", dwell
        if full_retract:
            yield "rapid", retract
        yield "rapid", min(depth + PECK_CLEARANCE_MM, retract)
        number += 1
    yield from _drill(z, dwell)


def expand(name, z, retract, clear, peck=None, dwell=0.0):
    """Steps from the retract height into the hole and out again: bottom `z`, `retract` (the R word), `clear` (where
    to end: R, or what G98 returns to) and `peck` (Q) in mm, dwell in seconds.

    ValueError when the bottom lies above the retract height, or a pecking cycle has no sensible depth per peck.
    """
    if z > retract:
        raise ValueError("the bottom Z %g lies above the retract height R %g" % (z, retract))
    if name in PECKING:
        if not peck or peck <= 0:
            raise ValueError("needs a depth per peck Q greater than 0")
        if (retract - z) / peck > PECKS_MAX:
            raise ValueError("makes more than %d pecks of Q %g mm" % (PECKS_MAX, peck))
        steps = _peck(z, retract, peck, dwell, name == "G83")
    elif name in CYCLES:
        steps = _drill(z, dwell if name in DWELLING else 0.0)
    else:
        raise ValueError("is not a drilling cycle")
    yield from steps
    if name == "G85":
        yield "feed", retract
        if clear == retract:
            return
    yield "feed" if name in FED_OUT else "rapid", clear
