# SPDX-License-Identifier: LGPL-2.1-or-later
"""Findings that someone has looked at and accepts, with a reason: they stay in the report and do not fail it.

An acceptance names a reason and at least one thing by which it knows its findings; all that it names must agree::

    [{"reason": "the clamp is moved after roughing", "kind": "fixture", "operation": "Profile", "line": 120},
     {"reason": "scallops are sanded", "kind": "excess", "place": [10.5, 3, -2], "within": 5, "most": 0.2}]

kind: as in the report; operation, line, text (a part of it); place in mm, where the finding lies no farther than
``within`` (default 1 mm); most: only while what was measured (mm of a deviation, depth of a contact, value of a load)
is no greater than this. Where it is only known to be at least so much, "most" accepts nothing.

What a deviation measures depends on how it was looked at: with ``allowance`` (mm) only deviations over this very
allowance are known, with ``tolerance`` (mm) only those beyond this tolerance or a coarser one: a tighter one is asked
of the part anew, and brings places along that nobody has looked at.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Optional, Sequence

from .files import is_number, read_json

KEYS = ("reason", "kind", "operation", "line", "text", "place", "within", "most", "tolerance", "allowance")

#: mm; lengths that people set are the same within this.
SAME = 1e-9


@dataclass(frozen=True)
class Acceptance:
    """See the head of the module."""

    reason: str
    kind: Optional[str] = None
    operation: Optional[str] = None
    line: Optional[int] = None
    text: Optional[str] = None
    place: Optional[tuple[float, float, float]] = None
    within: float = 1.0
    most: Optional[float] = None
    tolerance: Optional[float] = None
    allowance: Optional[float] = None

    def knows(self, finding: Any) -> bool:
        """Whether this is about a verify.Verdict."""
        return ((self.kind is None or self.kind == finding.kind)
                and (self.operation is None or self.operation == finding.operation)
                and (self.line is None or self.line == finding.line)
                and (self.text is None or self.text in finding.text)
                and (self.place is None
                     or (finding.place is not None and math.dist(self.place, finding.place) <= self.within))
                and (self.most is None or (finding.amount is not None and not finding.at_least
                                           and abs(finding.amount) <= self.most))
                and (self.tolerance is None
                     or (finding.tolerance is not None and finding.tolerance >= self.tolerance - SAME))
                and (self.allowance is None
                     or (finding.allowance is not None and abs(finding.allowance - self.allowance) <= SAME)))


def make(entry: Any, where: str) -> Acceptance:
    """An Acceptance of an entry of a file. ValueError begins with ``where``."""
    if not isinstance(entry, dict) or not set(entry) <= set(KEYS):
        raise ValueError(f"{where}: wanted an object with {', '.join(KEYS)}")
    if not isinstance(entry.get("reason"), str) or not entry["reason"].strip():
        raise ValueError(f"{where}: a reason is wanted: why it may stay so")
    if not set(entry) & {"kind", "operation", "line", "text", "place"}:
        raise ValueError(f"{where}: it would accept everything; name kind, operation, line, text or place")
    for key in ("kind", "operation", "text"):
        if key in entry and not (isinstance(entry[key], str) and entry[key].strip()):
            raise ValueError(f"{where}: {key}: a text is wanted")
    if type(entry.get("line", 0)) is not int:
        raise ValueError(f"{where}: line: a whole number is wanted")
    place = entry.get("place")
    if "place" in entry and not (isinstance(place, (list, tuple)) and len(place) == 3 and all(map(is_number, place))):
        raise ValueError(f"{where}: place: three numbers in mm are wanted")
    for key in ("within", "most"):
        if key in entry and not (is_number(entry[key]) and entry[key] >= 0):
            raise ValueError(f"{where}: {key}: a number of 0 or more is wanted")
    if "tolerance" in entry and not (is_number(entry["tolerance"]) and entry["tolerance"] > 0):
        raise ValueError(f"{where}: tolerance: a number above 0 is wanted")
    if "allowance" in entry and not is_number(entry["allowance"]):
        raise ValueError(f"{where}: allowance: a number is wanted")
    words: dict[str, Any] = {**entry, "place": None if place is None else tuple(place)}
    return Acceptance(**words)


def read(path: str) -> list[Acceptance]:
    """The acceptances of a JSON file. OSError; ValueError names the file, the entry and what is wrong."""
    document = read_json(path)
    if not isinstance(document, list):
        raise ValueError(f"{path}: a list of acceptances is wanted")
    return [make(entry, f"{path}: acceptance {number}") for number, entry in enumerate(document, 1)]


def apply(acceptances: Sequence[Acceptance], findings: Sequence[Any]) -> list[Acceptance]:
    """Set ``accepted`` of the verify.Verdicts that are known to the reason; the acceptances that know none."""
    idle = []
    for acceptance in acceptances:
        known = [finding for finding in findings if acceptance.knows(finding)]
        for finding in known:
            if finding.accepted is None:
                finding.accepted = acceptance.reason
        if not known:
            idle.append(acceptance)
    return idle
