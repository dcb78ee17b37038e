# SPDX-License-Identifier: LGPL-2.1-or-later
"""Canned drilling cycles as the moves they stand for, after RS274/NGC as LinuxCNC reads it.

Each generator yields steps (action, value): "rapid" or "feed" with a height, "dwell" with seconds. The hole's
place has been reached before them and the retreat after them is the caller's: it depends on G98 and G99.
"""

# How far a peck stays clear of (G83) or draws back from (G73) the bottom reached before; LinuxCNC: 0.010 inch.
PECK_CLEARANCE_MM = 0.254

# A peck that would leave less than this for the next one goes to the bottom: rounding, not a cut.
PECK_REST_MM = 1e-6

CYCLES = ("G73", "G74", "G81", "G82", "G83", "G84", "G85", "G86", "G89")
PECKING = ("G73", "G83")


def _drill(z, dwell):
    yield "feed", z
    if dwell:
        yield "dwell", dwell


def _bore(z, retract, dwell):
    yield from _drill(z, dwell)
    yield "feed", retract


def _peck(z, retract, peck, dwell, full_retract):
    depth = retract
    while True:
        depth = depth - peck
        if depth - z <= PECK_REST_MM:
            depth = z
        yield "feed", depth
        if dwell:
            yield "dwell", dwell
        if depth == z:
            return
        if full_retract:
            yield "rapid", retract
            yield "rapid", min(depth + PECK_CLEARANCE_MM, retract)
        else:
            yield "rapid", min(depth + PECK_CLEARANCE_MM, retract)


def expand(name, z, retract, peck=None, dwell=0.0):
    """Steps from the retract height into the hole: bottom `z`, `retract` (the R word) and `peck` (Q) in mm.

    ValueError when the bottom lies above the retract height, or a pecking cycle has no depth per peck.
    """
    if z > retract:
        raise ValueError("the bottom Z %g lies above the retract height R %g" % (z, retract))
    if name in PECKING:
        if not peck or peck <= 0:
            raise ValueError("needs a depth per peck Q greater than 0")
        return _peck(z, retract, peck, dwell, name == "G83")
    if name in ("G85", "G89"):
        return _bore(z, retract, dwell if name == "G89" else 0.0)
    if name in ("G74", "G84"):  # tapping: out at the feed it went in with, the spindle reversed
        return _bore(z, retract, dwell)
    if name in ("G81", "G82", "G86"):
        return _drill(z, dwell if name != "G81" else 0.0)
    raise ValueError("is not a drilling cycle")
