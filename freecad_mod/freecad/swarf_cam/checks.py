# SPDX-License-Identifier: LGPL-2.1-or-later
"""Is the program right? A job is played once more with all checks, and what is left held against its design. Imports
no FreeCAD; any thread: it works on a stock of its own, so that the one that is watched can be played meanwhile."""

from dataclasses import dataclass, replace
from typing import Any

from . import native

# Where each stage begins and how much of the whole it is, about.
STAGES = {"design": (0.0, 0.04), "fixtures": (0.04, 0.01), "stock": (0.05, 0.15), "cut": (0.2, 0.55),
          "compare": (0.75, 0.2), "loose": (0.95, 0.05)}


@dataclass
class Outcome:
    """What the checks of a job came to. verdicts: swarf Verdicts. verification: swarf.verify.Verification, None without
    a design that encloses something. stopped: at the first error, the rest was not looked at."""

    verdicts: list
    verification: Any = None
    stopped: bool = False

    @property
    def deviation(self):
        """The swarf.Deviation, or None."""
        return self.verification.deviation if self.verification is not None else None


def run(job, voxel_mm, tolerance_mm, progress, stop=False, clearance_mm=0.0, allowance_mm=0.0):
    """Outcome of a swarf.Job; what its document accepts is accepted. stop: at the first error, unless that is accepted:
    the rest is then looked at as without it. allowance_mm: meant to be left on the design.

    progress as in native.simulate(). MemoryError, swarf.Error.
    """
    if stop:
        outcome, ended = _check(job, voxel_mm, [], _stages(progress, 0.0, 0.5), True, clearance_mm)
        if outcome.stopped or (job.design is None and ended):
            return outcome
    swarf, report, doubts = native.load(), _stages(progress, 0.5 if stop else 0.0, 1.0), []
    if job.design is not None:
        try:
            made = swarf.verify(job, tolerance=tolerance_mm, allowance=allowance_mm, voxel=voxel_mm, loads=False,
                                clearance=clearance_mm, progress=report)
            return Outcome(made.findings, made)
        except swarf.GeometryError as error:
            doubts.append(_doubt(str(error)))
    return _check(job, voxel_mm, doubts, report, False, clearance_mm)[0]


def _stages(progress, first, last):
    """What is told of stages as one fraction, from first to last."""
    def report(stage, fraction):
        begin, share = STAGES[stage]
        return progress(first + (last - first) * (begin + share * fraction))
    return report


def _doubt(text):
    from swarf.verify import Verdict  # of the package, once it is known to be there

    return Verdict("warning", text, "design")


def _check(job, voxel_mm, doubts, report, stop, clearance_mm):
    """Outcome without a design, and whether the program was played to its end."""
    native.load()
    from swarf.stocks import make_first
    from swarf.verify import SetUps, findings_of, fixture_findings, loose_findings, settle, solids_of

    clamps = solids_of(job.fixtures, lambda done: report("fixtures", done))
    earlier = SetUps(clearance_mm)
    made = make_first(job.stock, voxel=voxel_mm, play=earlier.play, progress=lambda done: report("stock", done))
    stock = made.stock
    first = stock.copy() if not stop or job.design is None else None  # else swarf.verify() follows, and looks itself
    doubts += earlier.findings(made) + fixture_findings(stock, clamps)
    checked = stock.check(job.program, job.tools, fixtures=clamps, clearance=clearance_mm, teeth=job.teeth, stop=stop,
                          progress=lambda done: report("cut", done))
    ended = not (stop and any(item.severity == "error" for item in checked.findings))
    found = findings_of(job, checked, voxel_mm, clearance_mm)
    if ended and first is not None:
        found += loose_findings(job, stock, first, lambda done: report("loose", done))
    verdicts = settle(doubts + found, job.accepted)
    serious = any(verdict.severity == "error" and verdict.accepted is None for verdict in verdicts)
    return Outcome(verdicts, stopped=not ended and serious), ended


def judge(outcome, tolerance_mm, progress, allowance_mm=0.0):
    """The Outcome by another tolerance and allowance, without cutting or measuring again."""
    if outcome.verification is None:
        return outcome
    made = replace(outcome.verification, allowance=allowance_mm).judge(tolerance_mm, progress=progress)
    return Outcome(made.findings, made)


def accept(outcome, acceptances):
    """The Outcome by what is accepted now: a list of swarf Acceptances."""
    from swarf.verify import settle

    found = settle(outcome.verdicts, acceptances)
    made = outcome.verification
    return replace(outcome, verdicts=found, verification=None if made is None else replace(made, findings=found))
