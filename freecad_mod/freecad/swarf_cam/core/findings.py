# SPDX-License-Identifier: LGPL-2.1-or-later
"""What was found about a program: where in it, where on the part, how bad. Plain data for lists, marks and pins."""

import math
from dataclasses import dataclass, field
from typing import Any, Optional

# The worst first.
SEVERITIES = ("error", "warning", "note")

# Where an accepted finding may be found again, at least.
WITHIN_MM, WITHIN_VOXELS = 1.0, 4.0

# Kinds of findings that are deviations from the design, as swarf.verify() names them, and the one that a move made;
# the others are seen best at the end, when nothing follows that could still take the material away.
DEVIATIONS, MADE_BY_MOVE = frozenset(("gouge", "excess", "not reached")), "gouge"


@dataclass(frozen=True)
class Finding:
    """place: where in the program to stand to see it, None where it is of no move. line: of the listing, -1 for none.
    point: mm, or None. amount: mm of a deviation or contact. accepted: the reason why it does not count, None: it does.
    verdict: the swarf Verdict that it was made from."""

    severity: str
    text: str
    kind: str = ""
    place: Optional[float] = None
    line: int = -1
    operation: int = -1
    point: Optional[tuple] = None
    amount: float = 0.0
    accepted: Optional[str] = None
    verdict: Any = field(default=None, compare=False, repr=False)


def _order(finding):
    place = -1.0 if finding.place is None else finding.place
    return finding.accepted is not None, SEVERITIES.index(finding.severity), place, finding.text


def _of_move(move, listing):
    return {"line": listing.line_of(move), "operation": listing.operation_at(move)} if move >= 0 else {}


def from_overview(found, listing, say=str):
    """Findings of (place, severity, text), as session.Overview has them. say: a text as people are to read it."""
    return sorted((Finding(severity, say(text), "uncut", place, **_of_move(int(place), listing))
                   for place, severity, text in found), key=_order)


def from_verdicts(verdicts, listing, say=str):
    """Findings of swarf.verify()'s Verdicts: contacts where the tool stands at them, gouges when they are made, what
    is left at the end. What is accepted is a note. say: a text as people are to read it."""
    result = []
    for verdict in verdicts:
        place = None
        if verdict.kind in DEVIATIONS and verdict.kind != MADE_BY_MOVE:
            place = float(listing.begin[-1])
        elif verdict.move >= 0:
            place = verdict.move + (1.0 if verdict.kind == MADE_BY_MOVE else verdict.t)
        severity = "note" if verdict.accepted is not None else verdict.severity
        result.append(Finding(severity, say(verdict.text), verdict.kind, place, point=verdict.place,
                              amount=verdict.amount or 0.0, accepted=verdict.accepted, verdict=verdict,
                              **_of_move(verdict.move, listing)))
    return sorted(result, key=_order)


def acceptance(verdict, reason, voxel_mm):
    """The entry of swarf.accept that knows this swarf Verdict, and no worse one: what lies within some voxels of it and
    is at most a tenth greater; of a deviation, over the same allowance and beyond no tighter tolerance."""
    entry = {"reason": reason, "kind": verdict.kind}
    if verdict.operation is not None:
        entry["operation"] = verdict.operation
    if verdict.line:
        entry["line"] = verdict.line
    if verdict.place is not None:
        entry["place"] = [round(value, 4) for value in verdict.place]
        entry["within"] = round(max(WITHIN_MM, WITHIN_VOXELS * voxel_mm), 4)
    if verdict.amount is not None and not verdict.at_least:
        entry["most"] = math.ceil(1.1e4 * abs(verdict.amount)) / 1e4
    entry.update((name, getattr(verdict, name)) for name in ("tolerance", "allowance")
                 if getattr(verdict, name) is not None)
    if not set(entry) & {"operation", "line", "place"}:
        entry["text"] = str(verdict.text)
    return entry


def kinds(findings):
    """Kinds that there are, in the order of the list."""
    return list(dict.fromkeys(finding.kind for finding in findings))


def marks(findings):
    """(place, severity, text) in the order of the program, the worst last where they coincide: it is drawn on top."""
    return sorted(((finding.place, finding.severity, finding.text) for finding in findings
                   if finding.place is not None and finding.accepted is None),
                  key=lambda mark: (mark[0], -SEVERITIES.index(mark[1]), mark[2]))


def counts(findings):
    """severity -> number of them."""
    return {severity: sum(finding.severity == severity for finding in findings) for severity in SEVERITIES}


def worst_places(findings, limit):
    """The greatest deviations that have a place, the worst first."""
    found = [finding for finding in findings
             if finding.kind in DEVIATIONS and finding.point is not None and finding.accepted is None]
    return sorted(found, key=lambda finding: -abs(finding.amount))[:limit]
