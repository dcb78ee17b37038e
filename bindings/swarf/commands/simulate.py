# SPDX-License-Identifier: LGPL-2.1-or-later
"""``swarf simulate``: cut a stock with a program."""
from __future__ import annotations

import argparse
import math
import sys
import time
from typing import Any

from .. import colours, inputs, meshing, report, solids, timing
from .._native import Contour
from ..console import DONE, FINDINGS, check_outputs, one_line, say, tell
from ..files import check_suffix
from ..progress import Bar
from ..simulate import MESH_SUFFIXES, Result, check_coloured, check_mesh, mesh_error, output_suffix, simulate
from ..stocks import RESAMPLED_FIELD
from ..verify import check_tolerance, uncut_text


def add(subparsers: Any) -> None:
    """Add the parser of ``swarf simulate``."""
    command = subparsers.add_parser(
        "simulate",
        help="cut a stock with a program",
        description="Cut a stock with the program in INPUT, and what is left of it in the set-ups of --then. Exit "
        "status: 0 done, 1 findings of class error or the budget is not met, 2 could not run. Lengths in mm.",
    )
    inputs.add_arguments(command)
    command.add_argument("--output", metavar="FILE", action="append", default=[],
                         help="write the result: .stl .ply .obj .3mf .glb .vdb .step (repeatable)")
    command.add_argument("--colours", choices=colours.KINDS, help="what mesh files are coloured by (not .stl)")
    command.add_argument("--tolerance", metavar="MM", type=float, default=0.05,
                         help="deviations up to this are coloured green (default 0.05)")
    command.add_argument("--allowance", metavar="MM", type=float, default=0.0,
                         help="material meant to be left on the design: deviations are coloured by what is left beyond "
                         "it")
    command.add_argument("--loose", choices=("keep", "drop"), default="keep",
                         help="pieces that have come loose: keep them, or leave them out (default: keep)")
    meshing.add_options(command, "mesh files: ")
    command.add_argument("--fine", action="store_true",
                         help="mesh files: follow edges that are closer to each other than a voxel, as those of "
                         "threads; takes longer")
    command.add_argument("--picture", metavar="FILE.png", help="write a picture")
    command.add_argument("--report", metavar="FILE.json",
                         help="write a report; it tells of the mesh, which is made in memory for it even where it "
                         "would be written to one .stl file without that")
    command.add_argument("--machine", metavar="FILE.json", help="speeds and accelerations of the machine, for its time")


def run(arguments: argparse.Namespace) -> int:
    """Cut, write what is asked for, say what was found."""
    inputs.set_threads(arguments)
    check_suffix(arguments.picture, "picture", ".png")
    check_suffix(arguments.report, "report", ".json")
    if arguments.colours is not None:
        check_coloured(arguments.output, "--colours")
    outputs, sources = (*arguments.output, arguments.picture, arguments.report), inputs.files_read(arguments)
    check_outputs(outputs, (*sources, arguments.machine))
    check_tolerance(arguments.tolerance)
    check_mesh(arguments.error, arguments.budget)
    suffixes = {output_suffix(path) for path in arguments.output}
    meshing.check_meant(arguments, made=arguments.report is not None or not suffixes.isdisjoint(MESH_SUFFIXES),
                        of_error=not suffixes.isdisjoint(solids.SUFFIXES))
    if not math.isfinite(arguments.allowance):
        raise ValueError(f"allowance {arguments.allowance:g}: wanted a number")
    machine = None if arguments.machine is None else timing.read_machine(arguments.machine)
    with Bar() as bar:
        started = time.perf_counter()
        job = inputs.read_job(arguments, bar)
        check_outputs(outputs, (*sources, *inputs.files_of(job)))
        seconds_read = time.perf_counter() - started

        result = simulate(
            job,
            voxel=arguments.voxel,
            resolution=arguments.resolution,
            mesh=arguments.report is not None,
            outputs=arguments.output,
            picture=arguments.picture,
            colour=arguments.colours,
            tolerance=arguments.tolerance,
            allowance=arguments.allowance,
            drop_loose=arguments.loose == "drop",
            error=arguments.error,
            budget=arguments.budget,
            fine=arguments.fine,
            keep_volume=arguments.keep_volume,
            progress=bar,
        )
    made = report.make(result, arguments.input, seconds_read, machine)
    if arguments.report is not None:
        report.write(made, arguments.report)
    inputs.print_notes(job)
    told = [f"warning: line {piece.line}: {piece.text}" for piece in result.loose.pieces]
    if result.loose.crumbs:
        told.append(f"note: {result.loose.crumbs} crumbs of a few voxels are loose")
    told += [f"note: {solid.path}: {solid.note}" for solid in result.solids if solid.note]
    if result.resampled_voxels:
        corners = ", at corners by up to 0.3" if result.resampled_voxels == RESAMPLED_FIELD else ""
        told.append(f"note: the stock was turned into new voxels, which are off by {result.resampled_voxels:g} voxels "
                    f"at most at its edges{corners}; quarter turns keep them as they are")
    found = []
    for played, simulation in (*result.before, (job, result.simulation)):
        of = f"{played.name}: " if result.before else ""
        found += [f"{finding.severity}: {of}line {finding.line}: {one_line(uncut_text(finding, played))}"
                  for finding in simulation.findings]
    inputs.print_findings(found + told)
    if result.contour is not None:
        tell_of_mesh(result, result.contour, arguments)
    if sys.stdout.isatty():
        say([report.summary(made)])
    return FINDINGS if result.failed or not getattr(result.contour, "budget_met", True) else DONE


def tell_of_mesh(result: Result, made: Contour, arguments: argparse.Namespace) -> None:
    """What there is to say of the mesh, on stderr."""
    files = [path for path in arguments.output if output_suffix(path) in MESH_SUFFIXES]
    is_kept = arguments.keep_volume and not result.dropped_mm3
    for line in meshing.notes(made, files, arguments.budget, mesh_error(arguments.error, result.stock.voxel),
                              meshing.volume_of(result.mesh, files) if is_kept else None):
        tell(line)
