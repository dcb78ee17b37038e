# SPDX-License-Identifier: LGPL-2.1-or-later
"""What was found about a program: where in it, where on the part, how bad. Plain data for lists, marks and pins."""

from dataclasses import dataclass

# The worst first.
SEVERITIES = ("error", "warning", "note")

# Kinds of findings that are deviations from the design, as swarf.verify() names them, and the one that a move made;
# the others are seen best at the end, when nothing follows that could still take the material away.
DEVIATIONS, MADE_BY_MOVE = frozenset(("gouge", "excess", "not reached")), "gouge"


@dataclass(frozen=True)
class Finding:
    """place: where in the program to stand to see it, None where it is of no move. line: of the listing, -1 for none.
    point: mm, or None. amount: mm of a deviation or contact."""

    severity: str
    text: str
    kind: str = ""
    place: float = None
    line: int = -1
    operation: int = -1
    point: tuple = None
    amount: float = 0.0


def _order(finding):
    return SEVERITIES.index(finding.severity), -1.0 if finding.place is None else finding.place, finding.text


def _of_move(move, listing):
    return {"line": listing.line_of(move), "operation": listing.operation_at(move)} if move >= 0 else {}


def from_overview(found, listing):
    """Findings of (place, severity, text), as session.Overview has them."""
    return sorted((Finding(severity, text, "uncut", place, **_of_move(int(place), listing))
                   for place, severity, text in found), key=_order)


def from_verdicts(verdicts, listing):
    """Findings of swarf.verify()'s Verdicts: contacts where the tool stands at them, gouges when they are made, what
    is left at the end. What was accepted is a note, with its reason."""
    result = []
    for verdict in verdicts:
        place = None
        if verdict.kind in DEVIATIONS and verdict.kind != MADE_BY_MOVE:
            place = float(listing.begin[-1])
        elif verdict.move >= 0:
            place = verdict.move + (1.0 if verdict.kind == MADE_BY_MOVE else verdict.t)
        severity, text = verdict.severity, verdict.text
        if verdict.accepted is not None:
            severity, text = "note", "%s (%s)" % (text, verdict.accepted)
        result.append(Finding(severity, text, verdict.kind, place, point=verdict.place,
                              amount=verdict.amount or 0.0, **_of_move(verdict.move, listing)))
    return sorted(result, key=_order)


def marks(findings):
    """(place, severity, text) in the order of the program, the worst last where they coincide: it is drawn on top."""
    return sorted(((finding.place, finding.severity, finding.text) for finding in findings
                   if finding.place is not None),
                  key=lambda mark: (mark[0], -SEVERITIES.index(mark[1]), mark[2]))


def counts(findings):
    """severity -> number of them."""
    return {severity: sum(finding.severity == severity for finding in findings) for severity in SEVERITIES}


def worst_places(findings, limit):
    """The greatest deviations that have a place, the worst first."""
    found = [finding for finding in findings if finding.kind in DEVIATIONS and finding.point is not None]
    return sorted(found, key=lambda finding: -abs(finding.amount))[:limit]
