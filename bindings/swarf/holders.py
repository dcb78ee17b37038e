# SPDX-License-Identifier: LGPL-2.1-or-later
"""Holders: stacks of cylinders and cones above a tool's nose, by name or of one's own.

A holder stands on the tool by its stickout: the distance from the tool's tip to the holder's lower face. What the
library knows are envelopes that a check may rely on, built from three tables: what clamps (collet chucks with their
nuts, shrink fits), the flange of the spindle's taper, and the projection, the length from the spindle's face to the
lower face. Where standards leave a dimension to the maker it is the usual one of catalogues: measure your own holder,
and give it as a profile, where a millimetre matters.

Names: ``ER16`` (a chuck of 50 mm, whatever carries it), ``SK40-ER32``, ``HSK-A63-SHRINK12``.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Optional, Sequence

from ._native import Cutter, Error
from .aliases import PartKind
from .records import rows

#: Collet chucks by size of ISO 15488 (DIN 6499), which sets collets, cones and threads: diameter and length of the
#: usual nuts with a hexagon or slots, greatest shank. M: the slim nuts with slots.
COLLETS = {
    "ER11": (19.0, 11.3, 7.0), "ER11M": (16.0, 12.0, 7.0), "ER16": (32.0, 17.5, 10.0), "ER16M": (22.0, 18.0, 10.0),
    "ER20": (35.0, 19.0, 13.0), "ER20M": (28.0, 19.0, 13.0), "ER25": (42.0, 20.0, 16.0), "ER25M": (35.0, 20.0, 16.0),
    "ER32": (50.0, 22.5, 20.0), "ER40": (63.0, 25.5, 26.0),
}

#: Shrink fits of the 4.5 degree form (DIN 69882-8) by bore: diameters of the nose and where its cone ends.
SHRINKS = {
    "SHRINK6": (21.0, 27.0, 6.0), "SHRINK8": (21.0, 27.0, 8.0), "SHRINK10": (24.0, 32.0, 10.0),
    "SHRINK12": (24.0, 32.0, 12.0), "SHRINK14": (27.0, 34.0, 14.0), "SHRINK16": (27.0, 34.0, 16.0),
    "SHRINK18": (33.0, 42.0, 18.0), "SHRINK20": (33.0, 42.0, 20.0), "SHRINK25": (44.0, 53.0, 25.0),
}
SHRINK_ANGLE_DEG = 4.5

#: Flanges: diameter, length from the spindle's face, usual projections of collet chucks and of shrink fits. SK: ISO
#: 7388-1 form A (DIN 69871), HSK: ISO 12164-1 form A (DIN 69893-1).
FLANGES = {
    "SK30": (50.0, 19.1, 50.0, 80.0), "SK40": (63.55, 19.1, 70.0, 80.0), "SK50": (97.5, 19.1, 70.0, 80.0),
    "HSK-A50": (50.0, 26.0, 80.0, 80.0), "HSK-A63": (63.0, 26.0, 80.0, 80.0), "HSK-A100": (100.0, 29.0, 100.0, 85.0),
}

#: Lengths of a collet chuck and a shrink fit that nobody says the carrier of, mm.
BARE_MM = (50.0, 60.0)


@dataclass(frozen=True)
class Holder:
    """Sections from the lower face up: (length, lower diameter, upper diameter), mm; the greatest shank that it takes,
    None: any."""

    name: str
    sections: tuple[tuple[float, float, float], ...]
    bore: Optional[float] = None

    def nodes(self, stickout: float) -> list[tuple[float, float, float]]:
        """Its meridian above a tool: r, z, bulge."""
        z = stickout
        made = [(0.0, z, 0.0)]
        for length, lower, upper in self.sections:
            made.append((lower / 2, z, 0.0))
            z += length
            made.append((upper / 2, z, 0.0))
        return made + [(0.0, z, 0.0)]


def names() -> list[str]:
    """All names of the library."""
    clamps = [*COLLETS, *SHRINKS]
    return clamps + [f"{flange}-{clamp}" for flange in FLANGES for clamp in clamps]


def find(name: str, projection: Optional[float] = None) -> Holder:
    """A holder of the library; ``projection`` in mm, None: the usual one. ValueError says which names there are, and
    what projection is possible."""
    word = name.strip().upper()
    clamp = word.rpartition("-")[2]
    carrier = word[:-len(clamp) - 1]
    if clamp not in COLLETS and clamp not in SHRINKS or (carrier and carrier not in FLANGES):
        raise ValueError(f"holder {name!r} is not known; known are {', '.join([*COLLETS, *SHRINKS])}, alone or after "
                         f"{', '.join(f'{flange}-' for flange in FLANGES)}, or form:r/z:r/z... for one's own")
    width, base, *usual = FLANGES.get(carrier, (0.0, 0.0, *BARE_MM))
    if clamp in COLLETS:
        nut, nose, bore = COLLETS[clamp]
        sections = [(nose, nut, nut)]
        body = nut
    else:
        lower, upper, bore = SHRINKS[clamp]
        nose = (upper - lower) / 2 / math.tan(math.radians(SHRINK_ANGLE_DEG))
        sections = [(nose, lower, upper)]
        body = upper
    # long cones need more than the usual: the next five millimetres
    length = projection if projection is not None else max(usual[clamp in SHRINKS], 5 * math.ceil((nose + base) / 5))
    if not (math.isfinite(length) and length >= nose + base):
        raise ValueError(f"holder {name!r}: a projection of {length:g} mm is impossible; nose and flange alone are "
                         f"{nose + base:.4g} mm long")
    if length > nose + base:
        sections.append((length - nose - base, body, body))
    if base:
        sections.append((base, width, width))
    return Holder(word, tuple(sections), bore)


def hold(cutter: Cutter, holder: Holder | str, stickout: Optional[float],
         what: str = "tool") -> tuple[Cutter, list[str]]:
    """A cutter in a holder (one of the library, or text as find() or Cutter() of a form takes it), instead of the one
    that it has -> the cutter and what is doubtful about it. Between tool and holder goes a shank as wide as the tool's
    upper end. ValueError, which begins with ``what``, for a holder without stickout, or one that is impossible."""
    if stickout is None:
        raise ValueError(f"{what}: a holder needs its stickout, the distance from the tool's tip to the holder in mm")
    if not (math.isfinite(stickout) and stickout > 0):
        raise ValueError(f"{what}: a stickout of {stickout:g} mm is impossible")
    try:
        if isinstance(holder, str) and holder.strip().lower().startswith("form:"):
            name, bore, profile = "own holder", None, _own(holder.strip(), stickout)
        else:
            found = find(holder) if isinstance(holder, str) else holder
            name, bore, profile = found.name, found.bore, found.nodes(stickout)
    except (ValueError, Error) as error:
        raise ValueError(f"{what}: {error}") from None
    parts: list[_Part] = [(kind, rows(table)) for kind, table in cutter.parts if kind != "holder"]
    top = max((nodes[-1][1] for _, nodes in parts), default=0.0)
    notes = []
    flutes = cutter.extent("flutes")[1]
    if stickout < flutes:
        notes.append(f"{what}: {name} holds it {stickout:g} mm above its tip, but its flutes are {flutes:g} mm long: "
                     "they would be clamped")
    shank = _width_at(parts, top)
    if stickout > top:
        parts.append(("shank", [(0.0, top, 0.0), (shank, top, 0.0), (shank, stickout, 0.0), (0.0, stickout, 0.0)]))
    if bore is not None and 2 * shank > bore + 1e-6:
        notes.append(f"{what}: {name} takes shanks of up to {bore:g} mm, but it has {2 * shank:.4g} mm")
    try:
        return Cutter.from_parts([*parts, ("holder", profile)]), notes
    except (ValueError, Error) as error:
        raise ValueError(f"{what}: holder: {error}") from None


def describe(name: str, stickout: Optional[float]) -> str:
    """A holder and its stickout, for people."""
    own = name.strip().lower().startswith("form:")
    return f"{'own holder' if own else name.strip().upper()}, stickout {stickout:g} mm" if stickout else name


def _own(text: str, stickout: float) -> list[tuple[float, float, float]]:
    """Nodes of a form, its lowest point moved to the stickout."""
    (_, table), = Cutter(text).parts
    nodes = rows(table)
    low = nodes[0][1]
    return [(r, z - low + stickout, bulge) for r, z, bulge in nodes]


#: Of a cutter: its kind and its nodes (r, z, bulge).
_Part = tuple[PartKind, Sequence[Sequence[float]]]


def _width_at(parts: Sequence[_Part], top: float) -> float:
    """Radius at the upper end of the parts."""
    return max((node[0] for _, nodes in parts for node in nodes if node[1] > top - 1e-6), default=0.0)


def parse(word: str) -> tuple[int, str, Optional[float], Optional[float]]:
    """Tool number, holder, stickout and projection of a word of the command line, e.g. ``1=SK40-ER16,stickout=35`` or
    ``2=form:0/0:20/0:20/50:0/50,stickout=40``. ValueError."""
    wanted = "wanted N=NAME,stickout=MM[,projection=MM], e.g. 1=SK40-ER16,stickout=35"
    number, equals, text = word.partition("=")
    name, *words = text.split(",")
    values: dict[str, float] = {}
    if not equals or not number.strip().isdecimal() or not name.strip():
        raise ValueError(f"holder {word!r}: {wanted}")
    for item in words:
        key, _, value = item.partition("=")
        key = key.strip()
        try:
            if key not in ("stickout", "projection") or key in values:
                raise ValueError
            values[key] = float(value)
        except ValueError:
            raise ValueError(f"holder {word!r}: {item.strip()!r}: {wanted}") from None
    if name.strip().lower().startswith("form:") and "projection" in values:
        raise ValueError(f"holder {word!r}: a form has its own length, no projection")
    return int(number), name.strip(), values.get("stickout"), values.get("projection")
