# SPDX-License-Identifier: LGPL-2.1-or-later
"""Loads of a program's moves: limits for them, what exceeds those, peaks by operation, and their course over time.

Limits are ``{tool: {kind: most}}``, tool None meaning all; kinds are the keys of KINDS. A file of limits is JSON::

    {"all": {"engagement": 120}, "tools": {"3": {"chip": 0.05}},
     "materials": {"steel": {"all": {"rate": 200}, "tools": {"3": {"chip": 0.03}}}}}

What is said of a tool goes before what is said of all, what is said of the material before the rest.
"""
from __future__ import annotations

import math
import numbers
from dataclasses import dataclass, field
from typing import Any, Iterable, Mapping, Optional, Sequence

from ._native import Program
from .files import read_json
from .records import MOVE, SECTION, section_and_kind
from .wording import Said

#: Words of limits: the load (a key of Check.loads), its unit, its name in texts.
KINDS = {
    "engagement": ("angle", "deg", "engagement"),
    "depth": ("depth", "mm", "axial depth"),
    "width": ("width", "mm", "radial width"),
    "chip": ("chip", "mm", "chip thickness"),
    "rate": ("peak_rate", "mm3/s", "removal rate"),
}

Limits = Mapping[Optional[int], Mapping[str, float]]

#: Above this many degrees a tool plunges: going sideways it has at most the half turn before it in material. Limits and
#: peaks of engagement are about the sides of tools, and leave plunges out.
MOST_SIDEWAYS = 180.5


def check_limits(limits: Limits, what: str = "limits") -> None:
    """ValueError for kinds that do not exist and numbers that are not above 0."""
    if not isinstance(limits, Mapping):
        raise ValueError(f"{what}: wanted {{tool: {{kind: number}}}}")
    for tool, entries in limits.items():
        if tool is not None and (isinstance(tool, bool) or not isinstance(tool, numbers.Integral)):
            raise ValueError(f"{what}: {tool!r} is no number of a tool, nor None for all")
        of = what if tool is None else f"{what} of tool {tool}"
        if not isinstance(entries, Mapping):
            raise ValueError(f"{of}: wanted {{kind: number}} with {', '.join(KINDS)}")
        for kind, most in entries.items():
            if kind not in KINDS:
                raise ValueError(f"{of}: {kind!r} is not known; {', '.join(KINDS)} are")
            if isinstance(most, bool) or not isinstance(most, (int, float)) or not 0 < most < 1e15:
                raise ValueError(f"{of}: {kind}: {most!r} is no number above 0")


def merge(*several: Limits) -> dict[Optional[int], dict[str, float]]:
    """Limits in one; later ones go before earlier ones, and what they say of all tools before what was said of one."""
    result: dict[Optional[int], dict[str, float]] = {}
    for limits in several:
        for kind, most in limits.get(None, {}).items():
            for merged in result.values():
                merged.pop(kind, None)
            result.setdefault(None, {})[kind] = most
        for tool, entries in limits.items():
            if tool is not None:
                result.setdefault(tool, {}).update(entries)
    return result


def limit(limits: Limits, tool: int, kind: str) -> Optional[float]:
    """The limit of a tool, None: there is none."""
    return limits.get(tool, {}).get(kind, limits.get(None, {}).get(kind))


def parse(word: str) -> Limits:
    """Limits of a word of the command line: ``engagement=90`` for all tools, ``3:chip=0.05`` for one. ValueError."""
    wanted = f"wanted [TOOL:]KIND=NUMBER, e.g. engagement=90 or 3:chip=0.05; kinds are {', '.join(KINDS)}"
    head, equals, number = word.partition("=")
    tool, colon, kind = head.rpartition(":")
    try:
        if not equals:
            raise ValueError
        made: Limits = {int(tool) if colon else None: {kind.strip(): float(number)}}
    except ValueError:
        raise ValueError(f"limit {word!r}: {wanted}") from None
    check_limits(made, f"limit {word!r}")
    return made


def read(path: str, material: Optional[str] = None) -> Limits:
    """Limits in a file, for a material. OSError; ValueError names the file and what is wrong."""
    document = read_json(path)

    def part(entry: Any, of: str, more: tuple[str, ...] = ()) -> Limits:
        if not isinstance(entry, dict) or not set(entry) <= {"all", "tools", *more}:
            raise ValueError(f"{path}: {of}wanted an object with {', '.join(('all', 'tools', *more))}")
        tools = entry.get("tools", {})
        if not isinstance(tools, dict) or not all(number.isdecimal() for number in tools):
            raise ValueError(f"{path}: {of}tools: wanted an object of tool numbers")
        made: Limits = {None: entry.get("all", {}), **{int(number): limits for number, limits in tools.items()}}
        check_limits(made, f"{path}: {of}limits")
        return made

    general = part(document, "", ("materials",))
    materials = document.get("materials", {})
    if not isinstance(materials, dict):
        raise ValueError(f"{path}: materials: wanted an object of names")
    parts = {name: part(entry, f"material {name!r}: ") for name, entry in materials.items()}
    if material is None:
        return merge(general)
    if material not in parts:
        raise ValueError(f"{path}: material {material!r} is not in it; {', '.join(parts) or 'none'} are")
    return merge(general, parts[material])


def unknown_chips(limits: Limits, used: Iterable[int], teeth: Mapping[int, int]) -> list[int]:
    """The tools, of those that are used, whose chips have a limit and are not known: nothing tells their teeth."""
    return [tool for tool in used if tool not in teeth and limit(limits, tool, "chip") is not None]


def value_of(kind: str, value: float) -> float:
    """What counts of a load: 0 for the engagement of a plunge."""
    return 0.0 if kind == "engagement" and value > MOST_SIDEWAYS else value


@dataclass
class Peak:
    """The greatest load of one kind in an operation."""

    value: float
    move: int


@dataclass
class Summary:
    """Loads of one operation: seconds of it in which material is cut, mm3, peaks by kind of KINDS, and the share of the
    volume that was cut in climb milling (None: nothing was cut). ``unseen``: mm3 of the volume that were layers too
    thin for their engagement to be seen; peaks leave them out."""

    seconds: float = 0.0
    cutting: float = 0.0
    volume: float = 0.0
    unseen: float = 0.0
    peaks: dict[str, Peak] = field(default_factory=dict)
    climb: Optional[float] = None


@dataclass
class Excess:
    """A load beyond its limit: the worst move of an operation, and how many are."""

    kind: str
    value: float
    most: float
    move: int
    count: int

    @property
    def text(self) -> Said:
        """What is wrong, for people."""
        _, unit, name = KINDS[self.kind]
        return Said("load" if self.count == 1 else "loads", load=Said(name), value=self.value, unit=Said(unit),
                    most=self.most, count=self.count)


def _moves(program: Program) -> Iterable[tuple[int, int]]:
    """Tool and operation of each move."""
    sections = [(row[0], row[1]) for row in SECTION.iter_unpack(bytes(program.sections))]
    return (sections[section_and_kind(row[-1])[0]] for row in MOVE.iter_unpack(program.moves))


def summaries(program: Program, loads: Mapping[str, memoryview], times: Sequence[float]) -> list[Summary]:
    """A Summary for each operation of the program; ``times``: seconds of each move."""
    result = [Summary() for _ in program.operations]
    climbed = [0.0] * len(result)
    columns = [(kind, loads[KINDS[kind][0]]) for kind in KINDS]
    volume, climb, angle = loads["volume"], loads["climb"], loads["angle"]
    for move, (_, operation) in enumerate(_moves(program)):
        summary = result[operation]
        summary.seconds += times[move]
        if not volume[move] > 0:
            continue
        summary.volume += volume[move]
        climbed[operation] += volume[move] * 0.5 * (1 + climb[move])
        if loads["peak_rate"][move] > 0:
            summary.cutting += times[move]
            summary.unseen += 0.0 if angle[move] > 0 else volume[move]
        for kind, column in columns:
            value = value_of(kind, column[move])
            if value > summary.peaks.get(kind, _NOTHING).value:
                summary.peaks[kind] = Peak(value, move)
    for summary, part in zip(result, climbed):
        summary.climb = part / summary.volume if summary.volume > 0 else None
    return result


_NOTHING = Peak(0.0, -1)


def exceeded(program: Program, loads: Mapping[str, memoryview], limits: Limits) -> list[Excess]:
    """What is beyond its limit, one for each operation, tool and kind, in the order of the worst moves."""
    found: dict[tuple[int, int, str], Excess] = {}
    kinds = {kind for entries in limits.values() for kind in entries}
    for kind in (kind for kind in KINDS if kind in kinds):
        column = loads[KINDS[kind][0]]
        for move, (tool, operation) in enumerate(_moves(program)):
            value = value_of(kind, column[move])
            most = limit(limits, tool, kind) if value > 0 else None
            if most is None or value <= most:
                continue
            excess = found.setdefault((operation, tool, kind), Excess(kind, 0.0, most, move, 0))
            excess.count += 1
            if value > excess.value:
                excess.value, excess.move = value, move
    return sorted(found.values(), key=lambda excess: (excess.move, excess.kind))


def course(
    program: Program, loads: Mapping[str, memoryview], times: Sequence[float], bins: int = 380
) -> dict[str, Any]:
    """Loads over the machine's time in even bins: ``seconds`` in all, and for each kind the greatest load of each bin;
    ``operations``: the second at which each operation begins."""
    total = math.fsum(times)
    made: dict[str, Any] = {"seconds": total, "operations": [], **{kind: [0.0] * bins for kind in KINDS}}
    begins: dict[int, float] = {}
    columns = [(kind, made[kind], loads[KINDS[kind][0]]) for kind in KINDS]
    clock = 0.0
    for move, (_, operation) in enumerate(_moves(program)):
        begins.setdefault(operation, clock)
        end = clock + times[move]
        if total > 0 and loads["angle"][move] > 0:
            first, last = int(clock / total * bins), int(math.ceil(end / total * bins))
            for kind, series, column in columns:
                value = value_of(kind, column[move])
                for index in range(min(first, bins - 1), min(max(last, first + 1), bins)):
                    if value > series[index]:
                        series[index] = value
        clock = end
    made["operations"] = [begins.get(index, None) for index in range(len(program.operations))]
    return made
