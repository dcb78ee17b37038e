# SPDX-License-Identifier: LGPL-2.1-or-later
"""``swarf mesh``: a stock as a mesh with its edges, measured, in pieces."""
from __future__ import annotations

import argparse
import json
import os
from typing import Any, Optional

from .. import _native, colours, drawing, meshing, solids
from ..console import DONE, FINDINGS, check_outputs, say, tell
from ..files import naming
from ..parts import PLANE_HELP, parse_plane, split_pieces, thinnest
from ..progress import Bar
from ..simulate import MESH_SUFFIXES, check_coloured, check_mesh, mesh_error, streams


def add(subparsers: Any) -> None:
    """Add the parser of ``swarf mesh``."""
    command = subparsers.add_parser(
        "mesh",
        help="make a mesh of a stock, measure it, take it apart",
        description="Make a mesh of the stock in INPUT, or take the mesh in it. Exit status: 0 done, 1 done but the "
        "budget is not met, 2 could not run. Lengths in mm.",
    )
    command.add_argument("input", metavar="INPUT", help="a .vdb file, or a mesh: .stl .ply .obj")
    meshing.add_options(command)
    command.add_argument("--output", metavar="FILE", action="append", default=[],
                         help=f"write the mesh: {' '.join(MESH_SUFFIXES)}, or .step, of facets (repeatable); one that "
                         "does not fit into memory only to .stl; or its sections: .svg .dxf")
    command.add_argument("--split", action="store_true",
                         help="write every piece that hangs together to a file of its own: FILE-1, FILE-2 ...")
    command.add_argument("--split-at", metavar="PLANE", type=_plane, action="append", default=[],
                         help=f"cut it by a plane, each side closed by caps (repeatable); {PLANE_HELP}. Each side goes "
                         "to a file of its own, or each piece of each side with --split")
    command.add_argument("--section", metavar="PLANE", type=_plane, action="append", default=[],
                         help="write the curves along which a plane cuts it, to the .svg and .dxf files (repeatable, "
                         "then FILE-1, FILE-2 ...), in mm: across x, y or z with the other two coordinates, else seen "
                         "against the normal from the point")
    command.add_argument("--thickness", action="store_true",
                         help="colour the files by wall thickness, and tell the least with --measure")
    command.add_argument("--measure", action="store_true", help="print measures of the whole and its shells as JSON")
    command.add_argument("--threads", metavar="T", type=int, default=0, help="threads to use (default: all cores)")


def describe(shell: Any) -> dict[str, Any]:
    """A Shell for JSON."""
    return dict(zip(shell.__match_args__, shell))


def _plane(text: str) -> Any:
    try:
        return parse_plane(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def measures(mesh: _native.Mesh, thickness: bool) -> dict[str, Any]:
    """All that ``--measure`` prints."""
    shells = mesh.shells()
    made: Optional[Any] = mesh.contour
    found = {
        "whole": describe(mesh.measure()),
        "shells": [describe(shell) for shell in shells],
        "pieces": sum(shell.volume_mm3 > 0 for shell in shells),
        "contour": None if made is None else describe(made),
    }
    return {**found, "thickness": thinnest(mesh)} if thickness else found


def parts_of(mesh: _native.Mesh, arguments: argparse.Namespace) -> list[_native.Mesh]:
    """What goes to files of its own."""
    parts = [mesh]
    for point, normal in arguments.split_at:
        parts = [side for part in parts for side in part.split(point, normal) if side.triangle_count]
    if arguments.split:
        parts = [piece for part in parts for piece in split_pieces(part)]
    return parts


def read(arguments: argparse.Namespace, bar: Bar) -> tuple[Any, float]:
    """The mesh in the input, or the stock in it and what its mesh may be off."""
    if os.path.splitext(arguments.input)[1].lower() != ".vdb":
        if arguments.error or arguments.budget or arguments.keep_volume:
            raise ValueError(f"{arguments.input}: --error, --budget and --keep-volume are for stocks (.vdb); a mesh is "
                             "taken as it is")
        return _native.Mesh.read(arguments.input), 0.0
    stock = _native.Stock.read(arguments.input, progress=lambda fraction: bar("read", fraction))
    return stock, mesh_error(arguments.error, stock.voxel)


def is_streamed(arguments: argparse.Namespace) -> bool:
    """Whether a stock can go to its files without a mesh of the whole in memory."""
    return streams(arguments.output) and not (arguments.split or arguments.split_at or arguments.thickness
                                              or arguments.measure or arguments.budget)


def is_drawing(path: str) -> bool:
    """Whether a file is one of section curves, by its suffix."""
    return os.path.splitext(path)[1].lower() in drawing.SUFFIXES


def draw(mesh: _native.Mesh, arguments: argparse.Namespace) -> list[tuple[str, list[list[drawing.Point]]]]:
    """Files of sections, each with its curves. ValueError where there are none."""
    outputs = [path for path in arguments.output if is_drawing(path)]
    if outputs and not mesh.closed:
        raise ValueError(f"{arguments.input}: sections are of closed meshes; {mesh.boundary_edges} edges are open")
    drawn = []
    for number, (point, normal) in enumerate(arguments.section, 1):
        curves = drawing.flat(mesh.section(point, normal), point, normal)
        if not curves:
            which = f"section {number}" if len(arguments.section) > 1 else "the section"
            raise ValueError(f"{arguments.input}: {which} does not cut it")
        drawn += [(numbered(path, number) if len(arguments.section) > 1 else path, curves) for path in outputs]
    return drawn


def is_solid(path: str) -> bool:
    """Whether a file is one of solids, by its suffix."""
    return os.path.splitext(path)[1].lower() in solids.SUFFIXES


def write_parts(mesh: _native.Mesh, arguments: argparse.Namespace, bar: Bar) -> list[str]:
    """The mesh, or its parts, to all files; returns those of solids, of many parts the first and the last."""
    several = arguments.split or bool(arguments.split_at)
    meshes = [path for path in arguments.output if not is_drawing(path)]
    outputs = sorted(meshes, key=is_solid)  # solids last: they may be refused
    parts = parts_of(mesh, arguments)
    if several:
        if not parts:
            why = "none of its pieces is closed" if mesh.triangle_count else "nothing is left of it"
            raise ValueError(f"{arguments.input}: {why}, so there is no piece to write")
        check_outputs([numbered(path, number) for path in outputs for number in range(1, len(parts) + 1)],
                      [arguments.input])
    for number, part in enumerate(parts, 1):
        tints = colours.by_thickness(part) if arguments.thickness and part.triangle_count else None
        for path in outputs:
            if is_solid(path):
                solids.write_facets(part, numbered(path, number) if several else path, NO_PROGRAM,
                                    lambda fraction: bar("write", fraction))
                continue
            part.write(numbered(path, number) if several else path, colours=tints,
                       progress=lambda fraction: bar("write", fraction))
    written = [path for path in outputs if is_solid(path)]
    return [in_a_row(path, len(parts)) for path in written] if several else written


#: Why ``swarf mesh`` writes no faces as they were cut.
NO_PROGRAM = "the program that cut them is not known here, but swarf simulate --output knows it"


def numbered(path: str, number: int) -> str:
    """``part.3mf`` -> ``part-1.3mf``."""
    stem, suffix = os.path.splitext(path)
    return f"{stem}-{number}{suffix}"


def in_a_row(path: str, count: int) -> str:
    """The files of so many parts: ``part-1.step`` or ``part-1.step to part-3.step``."""
    return numbered(path, 1) if count == 1 else f"{numbered(path, 1)} to {numbered(path, count)}"


def check(arguments: argparse.Namespace) -> None:
    """ValueError, OSError where what is asked for cannot be, as far as that is known before the work."""
    if abs(arguments.threads) >= 1 << 31:
        raise ValueError(f"threads: {arguments.threads} is not in 0 .. 1024 (0: one per core)")
    check_mesh(arguments.error, arguments.budget)
    if not (arguments.output or arguments.measure):
        raise ValueError("nothing to do: give --output FILE, --measure or both")
    known = MESH_SUFFIXES + solids.SUFFIXES + drawing.SUFFIXES
    for path in arguments.output:
        if os.path.splitext(path)[1].lower() not in known:
            raise ValueError(f"{path}: unknown suffix; an output is {', '.join(known)}")
    drawings = [path for path in arguments.output if is_drawing(path)]
    if (arguments.split or arguments.split_at) and len(drawings) == len(arguments.output):
        raise ValueError("--split and --split-at write meshes: give --output FILE")
    if bool(arguments.section) != bool(drawings):
        raise ValueError(f"{drawings[0]}: a drawing is of a section: give --section PLANE" if drawings else
                         f"--section: no --output is a drawing, which is {', '.join(drawing.SUFFIXES)}")
    if arguments.thickness and not arguments.measure:
        check_coloured(arguments.output, "--thickness")
    check_outputs(arguments.output, [arguments.input])
    if len(arguments.section) > 1:
        numbers = range(1, len(arguments.section) + 1)
        check_outputs([numbered(path, number) for path in drawings for number in numbers], [arguments.input])


def run(arguments: argparse.Namespace) -> int:
    """Mesh, write, measure."""
    check(arguments)
    _native.set_threads(arguments.threads)
    with naming(arguments.input):
        return make(arguments)


def make(arguments: argparse.Namespace) -> int:
    """The work itself, and what is said of it."""
    of_facets: list[str] = []
    with Bar() as bar:
        mesh, error = read(arguments, bar)
        if isinstance(mesh, _native.Stock) and is_streamed(arguments):
            for path in arguments.output:
                made = _native.Mesh.stream(mesh, path, error, keep_volume=arguments.keep_volume,
                                           progress=lambda fraction: bar("mesh", fraction))
        else:
            if isinstance(mesh, _native.Stock):
                mesh = _native.Mesh.from_stock(mesh, error, budget=arguments.budget,
                                               keep_volume=arguments.keep_volume,
                                               progress=lambda fraction: bar("mesh", fraction))
            drawn = draw(mesh, arguments)  # before anything is written: there may be none
            of_facets = write_parts(mesh, arguments, bar)
            for path, curves in drawn:
                drawing.write(curves, path)
            made = mesh.contour
    if arguments.measure:
        say([json.dumps(measures(mesh, arguments.thickness), indent=2, allow_nan=False)])
    for files in of_facets:
        tell(f"note: {files}: facets, no faces as they were cut: {NO_PROGRAM}")
    if made is None:
        return DONE
    kept = None
    if arguments.keep_volume:
        kept = meshing.volume_of(None if isinstance(mesh, _native.Stock) else mesh, arguments.output)
    for line in meshing.notes(made, arguments.output, arguments.budget, error, kept):
        tell(line)
    return DONE if made.budget_met else FINDINGS
