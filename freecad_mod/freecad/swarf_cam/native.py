# SPDX-License-Identifier: LGPL-2.1-or-later
"""The native module at work: JobData -> swarf objects, and the simulation of a job. Imports no FreeCAD, touches no
document: runs in any thread."""

import functools
import importlib
import os
import sys
from dataclasses import dataclass, field
from typing import Optional

from . import FOLDER
from .core.errors import JobError

HELP = ("Swarf's native module is missing or cannot be loaded (%s). Install it with the Debian package of Swarf, or "
        "build it in place (see README.md), then start FreeCAD again.")

# Where a build in place puts the Python package, seen from the add-on's own folder.
BUILD_IN_PLACE = os.path.join("..", "build", "python")


@functools.lru_cache(maxsize=1)
def _find():
    """(module, None) or (None, why not), looked for once: commands ask whenever the GUI is idle."""
    built = os.path.normpath(os.path.join(os.path.dirname(os.path.dirname(os.path.realpath(FOLDER))), BUILD_IN_PLACE))
    try:
        return importlib.import_module("swarf"), None
    except ImportError as error:
        if built in sys.path or not os.path.isdir(os.path.join(built, "swarf")):
            return None, str(error)
    sys.path.append(built)
    importlib.invalidate_caches()
    try:
        return importlib.import_module("swarf"), None
    except ImportError as error:
        return None, str(error)


def load():
    """The module swarf. JobError says how to get it."""
    module, error = _find()
    if module is None:
        raise JobError(HELP % error)
    return module


def is_available():
    """Whether the native module can be loaded."""
    return _find()[0] is not None


def _table(values, columns):
    return memoryview(values).cast("B").cast(values.typecode, (len(values) // columns, columns))


def to_mesh(mesh):
    """swarf.Mesh of a pair (points, triangles)."""
    points, triangles = mesh
    return load().Mesh(_table(points, 3), _table(triangles, 3))


def to_cutters(tools):
    """number -> swarf.Cutter of JobData.tools. JobError names the tool that is impossible."""
    swarf = load()
    result = {}
    for number, (name, parts) in tools.items():
        try:
            result[number] = swarf.Cutter.from_parts(parts)
        except (ValueError, swarf.Error) as error:
            raise JobError("the tool '%s' (T%d): %s" % (name, number, error)) from error
    return result


def _package(name):
    """A module of swarf, by its name there."""
    return importlib.import_module("%s.%s" % (load().__name__, name))


def holder_names():
    """Names of the library of holders."""
    return _package("holders").names()


def hold_one(cutter, name, stickout, what):
    """(cutter in a holder, what is doubtful about it). JobError, which begins with `what`, for a holder that is
    impossible or has no stickout."""
    try:
        return _package("holders").hold(cutter, name, stickout, what)
    except ValueError as error:
        raise JobError(str(error)) from error


def hold(cutters, data):
    """Put the cutters of a JobData into their holders, in place -> (number -> text, notes). JobError names the tool
    whose holder is impossible or has no stickout."""
    texts, notes = {}, []
    for number, (name, stickout) in data.holders.items():
        if number not in cutters:
            continue
        cutters[number], doubts = hold_one(cutters[number], name, stickout,
                                           "the tool '%s' (T%d)" % (data.tools[number][0], number))
        texts[number] = _package("holders").describe(name, stickout)
        notes += doubts
    return texts, notes


def to_accepted(name, entries):
    """swarf.accept.Acceptances of the entries in a job of this name; JobError for an entry that is none."""
    accept = _package("accept")
    try:
        return [accept.make(entry, "the job '%s', acceptance %d" % (name, number))
                for number, entry in enumerate(entries, 1)]
    except ValueError as error:
        raise JobError(str(error)) from error


def to_fixtures(data, progress=None):
    """swarf.Meshes of a JobData's fixtures; JobError names the one that encloses nothing. swarf.Cancelled."""
    swarf, result = load(), []
    share = functools.partial(_package("progress").share, progress)
    for number, (name, mesh) in enumerate(data.fixtures):
        result.append(to_mesh(mesh))
        try:
            swarf.Solid(result[-1], progress=share(number / len(data.fixtures), (number + 1) / len(data.fixtures)))
        except swarf.Cancelled:
            raise
        except (ValueError, swarf.Error) as error:
            raise JobError("the fixture '%s': %s" % (name, error)) from error
    return result


def pieces(shells, triangles_of):
    """Places of the shells (with volume_mm3 and bounding_box) of each solid piece, its cavities behind it;
    triangles_of(place): vertices and triangles of a shell."""
    mesh = load().Mesh
    return _package("parts").pieces(shells, lambda place: mesh(*triangles_of(place)))


def share(progress, begin, end):
    """The progress of a part of the work, from begin to end of the whole."""
    return _package("progress").share(progress, begin, end)


def check(progress, fraction):
    """Tell how much is done; swarf.Cancelled."""
    _package("progress").check(progress, fraction)


def pieces_of(mesh, progress=None):
    """Places in mesh.shells() of the shells of each piece, its cavities behind it. swarf.Cancelled."""
    return _package("parts").pieces_of(mesh, progress)


def thinnest(mesh, progress=None):
    """The least wall thickness of a mesh and where, as swarf.parts.thinnest() tells them. swarf.Cancelled."""
    return _package("parts").thinnest(mesh, progress)


def to_program(table):
    """swarf.Program of a MoveTable."""
    return table.play(load().Program())


def to_job(data, progress=None):
    """swarf.Job, the command line's view of a job. progress: of looking at the fixtures, called with the fraction done;
    a true answer cancels (swarf.Cancelled)."""
    share = functools.partial(_package("progress").share, progress)
    stock, begin = dict(data.stock), 0.0
    if stock["kind"] == "mesh":
        stock["mesh"] = to_mesh(stock["mesh"])
    elif stock["kind"] == "result":
        begin = 0.5
        stock["job"] = to_job(stock["job"], share(0.0, begin))
    cutters = to_cutters(data.tools)
    holders, doubts = hold(cutters, data)
    return load().Job(name=data.name, program=to_program(data.moves), tools=cutters,
                      tool_names={number: name for number, (name, _) in data.tools.items()}, stock=stock,
                      design=to_mesh(data.design) if data.design else None, notes=list(data.notes) + doubts,
                      teeth=dict(data.teeth), holders=holders, accepted=to_accepted(data.name, data.accepted),
                      fixtures=to_fixtures(data, share(begin, 1.0)))


@dataclass
class Result:
    """What a simulation came to; volumes in mm3. stock_file and mesh_file lie in the folder that was given.
    excess and gouge are None without a design; findings: arguments of app.wording.line(); colours: (r, g, b), 0 .. 1,
    of each triangle of the mesh, by operation."""

    stock_file: str
    mesh_file: str
    moves: int
    operations: list
    removed: list
    volume_initial: float
    volume_final: float
    excess: Optional[float] = None
    gouge: Optional[float] = None
    findings: list = field(default_factory=list)
    errors: int = 0
    seconds: float = 0.0
    colours: list = field(default_factory=list)


def default_voxel(lo, hi):
    """A voxel size that shows a part of this size at once: its longest edge in 400, rounded to one digit, mm."""
    edge = max(b - a for a, b in zip(lo, hi)) / 400
    return float("%.0e" % edge)


def estimate(lo, hi, voxel_mm):
    """Bytes that simulating a stock of this size may take. ValueError for an impossible voxel size."""
    return load().Stock.estimate(lo, hi, voxel_mm)


# Where each stage of simulate() begins and how much of the whole it is, about.
STAGES = {"fixtures": (0.0, 0.02), "stock": (0.02, 0.08), "cut": (0.1, 0.4), "loose": (0.5, 0.05),
          "mesh": (0.55, 0.1), "compare": (0.65, 0.2), "write": (0.85, 0.05), "colours": (0.9, 0.1)}


def text_of(item, job):
    """What a swarf.Finding of a swarf.Job says, in words that can be translated."""
    return _package("verify").uncut_text(item, job)


def _findings(job, found):
    """Findings of the swarf.Simulation of a swarf.Job: (severity, operation, line, text)."""
    names = job.program.operations
    return [(item.severity, names[item.operation] if 0 <= item.operation < len(names) else None, item.line,
             text_of(item, job)) for item in found]


def simulate(data, voxel_mm, folder, progress=None):
    """Cut the stock of a JobData and write stock.vdb and stock.stl into a folder -> Result.

    progress: called with the fraction done, any thread; a true answer cancels (swarf.Cancelled). Raises JobError for
    a tool that is impossible, MemoryError before any work, ValueError, swarf.Error.
    """
    swarf = load()
    mesh_file, stock_file = os.path.join(folder, "stock.stl"), os.path.join(folder, "stock.vdb")

    def report(stage, fraction):
        begin, share = STAGES[stage]
        return progress(begin + share * fraction)

    job = to_job(data, (lambda fraction: report("fixtures", fraction)) if progress else None)
    done = swarf.simulate(job, voxel=voxel_mm, outputs=[mesh_file, stock_file], progress=report if progress else None)
    outcome, comparison = done.simulation, done.comparison
    names = data.moves.operations
    # a set-up before that was kept says nothing here: its own simulation has said it
    findings = [(*line, job.name) for job, played in done.before for line in _findings(job, played.findings)]
    findings += [(*line, None) for line in _findings(done.job, outcome.findings)]
    findings += [("warning", piece.operation, piece.line, piece.text, None) for piece in done.loose.pieces]
    tints = _package("colours").make(
        "operation", done.mesh, done.surface, done.job,
        progress=(lambda fraction: report("colours", fraction)) if progress else None)
    parts = {tint: tuple(part / 255 for part in tint) for tint in set(tints)}
    return Result(
        stock_file, mesh_file, len(data.moves), list(names), list(outcome.removed_by_operation),
        outcome.volume_initial, outcome.volume_final, comparison.excess_mm3 if comparison else None,
        comparison.gouge_mm3 if comparison else None, findings,
        sum(item.severity == "error" for played in (*(played for _, played in done.before), outcome)
            for item in played.findings), done.seconds["total"], [parts[tint] for tint in tints])


def said(key, **values):
    """A sentence of swarf.wording."""
    return _package("wording").Said(key, **values)


# Error of a mesh where nobody says, in voxels: swarf.simulate's own.
MESH_ERROR_VOXELS = 0.1


def _exact(data, stock_file, progress=None):
    """(swarf.Job, what is left of its stock, the exact surface of that)."""
    swarf = load()
    share = functools.partial(_package("progress").share, progress)
    job = to_job(data, share(0, 0.02))
    left = swarf.Stock.read(stock_file, progress=share(0.02, 0.25))
    first = _package("stocks").make_first(job.stock, voxel=left.voxel, progress=share(0.25, 0.75))
    return job, left, first.surface(job.program, job.tools, progress=share(0.75, 1))


@dataclass
class Analytic:
    """A STEP file with faces as they were cut. share: part of the area on planes, cylinders, cones, spheres and tori,
    None where it was not measured; reason: why there is no file, None when there is; volume_mm3 and area_mm2 of the
    mesh it was made of, which is within error_mm; faces: their number; note: what is told of them."""

    share: Optional[float]
    reason: Optional[str] = None
    volume_mm3: float = 0.0
    area_mm2: float = 0.0
    error_mm: float = 0.0
    faces: int = 0
    note: Optional[str] = None


def export_analytic(data, stock_file, path, largest=False, progress=None):
    """Write what is left of a JobData's stock as a STEP file of analytic faces -> Analytic, without a file where the
    stock is not bounded by such faces alone. Raises and the rest as export()."""
    solids = _package("solids")
    share = functools.partial(_package("progress").share, progress)
    _, left, surface = _exact(data, stock_file, share(0, 0.4))
    cut = solids.as_cut(left, surface, only_largest=largest, progress=share(0.4, 0.9))
    if not cut.mesh.triangle_count:
        raise JobError("nothing is left of the stock")
    if cut.made is None:
        return Analytic(cut.share, cut.reason)
    written = solids.write_cut(cut.made, path, share(0.9, 1))
    return Analytic(cut.share, None, cut.mesh.volume, cut.mesh.area, cut.error_mm, written.faces, written.missing)


def export(data, stock_file, path, error_mm=None, budget=0, colour=None, tolerance_mm=0.05, allowance_mm=0.0,
           largest=False, fine=False, keep_volume=False, progress=None):
    """Write the mesh of what is left of a JobData's stock, a .vdb file, on the exact surface -> number of triangles.

    error_mm: vertices are left out up to this (None: 0.1 voxels); budget: no more triangles, if the error allows;
    colour: "operation", "deviation" (green within tolerance_mm of the design with allowance_mm left on it) or
    "thickness"; largest: the largest piece alone; fine: edges closer to each other than a voxel are followed;
    keep_volume: vertices are shifted until the volume is that of the surface that the mesh stands for; what is thinner
    than a voxel is in no mesh.
    progress as simulate(). Any thread. JobError where nothing is left, or no mesh is that small; swarf.Error, OSError.
    """
    swarf = load()
    colours, parts, shares = map(_package, ("colours", "parts", "progress"))
    share = functools.partial(shares.share, progress)
    job, left, surface = _exact(data, stock_file, share(0, 0.4))
    mesh = swarf.Mesh.from_stock(left, MESH_ERROR_VOXELS * left.voxel if error_mm is None else error_mm, budget=budget,
                                 surface=surface, fine=fine, keep_volume=keep_volume, progress=share(0.4, 0.8))
    if not mesh.triangle_count:
        raise JobError("nothing is left of the stock")
    if not mesh.contour.budget_met:
        raise JobError("%d triangles are the fewest within this error; allow more of them, or a greater error"
                       % mesh.triangle_count)
    if largest:
        mesh = parts.largest(mesh)
    tints = colours.make(colour, mesh, surface, job, tolerance_mm, progress=share(0.8, 0.95),
                         allowance=allowance_mm) if colour else None
    mesh.write(path, colours=tints, progress=share(0.95, 1))
    return mesh.triangle_count
