# SPDX-License-Identifier: LGPL-2.1-or-later
"""``swarf verify``: is what a program leaves of its stock the design?"""
from __future__ import annotations

import argparse
import os
import time
from typing import Any, Sequence

from .. import accept, document, inputs, loads, pdf, report
from ..console import DONE, FINDINGS, check_outputs, one_line, say, tell
from ..files import write_text
from ..job import Job, number_of
from ..progress import Bar
from ..verify import CAD_SUFFIXES, DESIGN_SUFFIXES, Verdict, check_tolerance, read_design, verify

REPORT_SUFFIXES = (".html", ".json", ".pdf")


def add(subparsers: Any) -> None:
    """Add the parser of ``swarf verify``."""
    command = subparsers.add_parser(
        "verify",
        help="hold what a program leaves against the design",
        description="Simulate the program in INPUT and hold what is left of the stock against the design. Exit status: "
        "0 passed, 1 failed, 2 could not run. Lengths in mm.",
    )
    inputs.add_arguments(command)
    command.add_argument("--design", metavar="FILE",
                         help=f"{' '.join(DESIGN_SUFFIXES)}, with FreeCAD {' '.join(CAD_SUFFIXES)}; default: the model "
                              "of the job in a .FCStd file")
    command.add_argument("--tolerance", metavar="MM", type=float, default=0.05, help="both ways (default 0.05)")
    command.add_argument("--excess", metavar="MM", type=float, help="tolerance for material left")
    command.add_argument("--gouge", metavar="MM", type=float, help="tolerance for material missing")
    command.add_argument("--allowance", metavar="MM", type=float, default=0.0, help="material meant to be left")
    command.add_argument("--complete", action="store_true",
                         help="material left where no move went is an error, not a warning")
    command.add_argument("--fixture", metavar="FILE", action="append", default=[],
                         help="what nothing may touch: clamps, the vice; files as designs (repeatable)")
    command.add_argument("--clearance", metavar="MM", type=float, default=0.0,
                         help="warn where the holder comes nearer to the stock")
    command.add_argument("--limit", metavar="[N:]KIND=VALUE", action="append", default=[], type=_limit,
                         help="warn where a load exceeds this, of tool N or of all (repeatable): "
                              + ", ".join(f"{kind} ({unit})" for kind, (_, unit, _) in loads.KINDS.items()))
    command.add_argument("--limits", metavar="FILE.json", help="limits from a file, see the README")
    command.add_argument("--material", metavar="NAME", help="the stock's, among those in the file of limits")
    command.add_argument("--no-loads", action="store_true", help="do not measure loads: faster")
    command.add_argument("--accept", metavar="FILE.json", help="findings that are accepted, each with its reason")
    command.add_argument("--report", metavar="FILE", action="append", default=[],
                         help="write a report: .html .json, and .pdf where a converter is installed "
                              f"({', '.join(pdf.CONVERTERS)}) (repeatable)")


def _limit(word: str) -> loads.Limits:
    try:
        return loads.parse(word)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _check_tools(words: Sequence[loads.Limits], job: Job) -> None:
    """ValueError for a ``--limit`` of a tool that the job has not."""
    for tool in (tool for limits in words for tool in limits if tool is not None):
        if tool not in job.tools:
            raise ValueError(f"limit of tool {tool}: the set-up that is checked has no such tool; it has "
                             f"{', '.join(str(number) for number in sorted(job.tools) if number >= 0)}")


def finding_line(finding: Verdict) -> str:
    """A finding as one line: severity, line of the program, text, place."""
    where = f" line {finding.line}:" if finding.line else ""
    place = "" if finding.place is None else " at ({:.2f}, {:.2f}, {:.2f})".format(*finding.place)
    severity = finding.severity if finding.accepted is None else f"accepted {finding.severity}"
    reason = "" if finding.accepted is None else f" (accepted: {one_line(finding.accepted)})"
    return f"{severity}:{where} {one_line(finding.text)}{place}{reason}"


def run(arguments: argparse.Namespace) -> int:
    """Simulate, compare, write the reports, say what was found."""
    inputs.set_threads(arguments)
    for path in arguments.report:
        if os.path.splitext(path)[1].lower() not in REPORT_SUFFIXES:
            raise ValueError(f"{path}: unknown suffix; a report is {' or '.join(REPORT_SUFFIXES)}")
        if os.path.splitext(path)[1].lower() == ".pdf":
            try:
                pdf.find()
            except ValueError as error:
                raise ValueError(f"{path}: {error}") from None
    sources = inputs.files_read(arguments)
    check_outputs(arguments.report, (
        *sources, arguments.design, arguments.limits, arguments.accept, *arguments.fixture))
    if arguments.material is not None and arguments.limits is None:
        raise ValueError("--material chooses among the materials of a file of limits; give --limits FILE.json")
    limits = loads.merge({} if arguments.limits is None else loads.read(arguments.limits, arguments.material),
                         *arguments.limit)
    accepted = [] if arguments.accept is None else accept.read(arguments.accept)
    tightest = min(arguments.tolerance if side is None else side for side in (arguments.excess, arguments.gouge))
    check_tolerance(tightest)

    with Bar() as bar:
        started = time.perf_counter()
        fixtures = [read_design(path, tightest) for path in arguments.fixture]
        design = None if arguments.design is None else read_design(
            arguments.design, tightest, lambda fraction: bar("read", fraction))
        job = inputs.read_job(arguments, bar)
        check_outputs(arguments.report, (*sources, *inputs.files_of(job)))
        _check_tools(arguments.limit, job)
        if design is None and job.design is None:
            raise ValueError(f"{arguments.input}: it has no design to verify against; give --design FILE")
        seconds_read = time.perf_counter() - started
        done = verify(
            job, design, tolerance=arguments.tolerance, excess=arguments.excess, gouge=arguments.gouge,
            allowance=arguments.allowance, complete=arguments.complete, voxel=arguments.voxel,
            resolution=arguments.resolution, fixtures=fixtures, clearance=arguments.clearance,
            loads=not arguments.no_loads, limits=limits, accept=accepted, progress=bar)
        made = report.make_verification(done, arguments.input, seconds_read)
        text = ""  # of the document, made once
        for path in arguments.report:
            suffix = os.path.splitext(path)[1].lower()
            if suffix != ".json":
                text = text or document.make(done, made, lambda fraction: bar("pictures", fraction))
            if suffix == ".html":
                write_text(text, path)
            elif suffix == ".pdf":
                pdf.write(text, path)
            else:
                report.write(made, path)
    inputs.print_notes(job)
    used = [number_of(job, tool) for tool in job.program.tools]
    for tool in loads.unknown_chips(limits, used, job.teeth):
        tell(f"warning: the limit of chip thickness is not checked for tool {tool}: nothing tells its teeth, as "
             f"--tool {tool}=...,teeth=2 does")
    inputs.print_findings([finding_line(finding) for finding in done.findings])
    say([f"{arguments.input}: {'passed' if done.passed else 'FAILED'}, tolerance +{done.tolerance[0]:g} "
         f"-{done.tolerance[1]:g} mm, voxel {done.result.stock.voxel:g} mm"])
    return DONE if done.passed else FINDINGS
