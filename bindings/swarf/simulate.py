# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a job to its result: stock, cutting, comparison, mesh, picture, files. Command line and add-on share it."""
from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import Any, Callable, Optional, Sequence

from . import colours, loose, solids
from ._native import Camera, Comparison, Contour, Mesh, Scene, Simulation, Stock, Surface, compare_volume
from .aliases import View
from .files import check_suffix
from .job import Job
from .parts import largest
from .progress import Stages
from .stocks import DEFAULT_RESOLUTION, make_first, make_stock, stock_box, voxel_of

__all__ = [
    "COLOURED_SUFFIXES", "DEFAULT_RESOLUTION", "MESH_ERROR_VOXELS", "MESH_SOURCES", "MESH_SUFFIXES", "OUTPUT_SUFFIXES",
    "Progress", "Result", "STOCK_SUFFIXES", "check_coloured", "check_mesh", "make_stock", "mesh_error",
    "output_suffix", "simulate", "stock_box", "voxel_of",
]

#: What meshes are read from.
MESH_SOURCES = (".stl", ".ply", ".obj")

#: What an output file can be, by its suffix.
COLOURED_SUFFIXES = (".ply", ".obj", ".3mf", ".glb")
MESH_SUFFIXES = (".stl", *COLOURED_SUFFIXES)
STOCK_SUFFIXES = (".vdb",)
OUTPUT_SUFFIXES = MESH_SUFFIXES + STOCK_SUFFIXES + solids.SUFFIXES

#: What a mesh may be off, in voxels, where nobody says: as much as the stock itself is at its edges.
MESH_ERROR_VOXELS = 0.1

#: Called with the stage ("stock", "cut", "loose", "mesh", "compare", "picture", "write") and the fraction of it that is
#: done; a true answer cancels, an exception cancels and comes out.
Progress = Callable[[str, float], Any]


@dataclass
class Result:
    """What a simulation came to."""

    job: Job
    stock: Stock
    simulation: Simulation
    comparison: Optional[Comparison] = None
    mesh: Optional[Mesh] = None  #: none where it was streamed to its file
    contour: Optional[Contour] = None  #: what making the mesh came to, or streaming it; of all pieces
    seconds: dict[str, float] = field(default_factory=dict)
    before: list[tuple[Job, Simulation]] = field(default_factory=list)  #: of the set-ups before, the first one first
    surface: Optional[Surface] = None  #: exact, where a mesh or a picture was made
    solids: list[solids.Written] = field(default_factory=list)  #: .step files; why they are of facets where they are
    loose: loose.LoosePieces = field(default_factory=loose.LoosePieces)  #: what hangs on nothing any more
    dropped_mm3: float = 0.0  #: of it, where it was left out
    resampled_voxels: float = 0.0  #: how far the first stock's voxels may be off for being turned; 0: as they were

    @property
    def failed(self) -> bool:
        """Whether a finding is of class error, in any set-up."""
        return any(finding.severity == "error"
                   for simulation in (*(played for _, played in self.before), self.simulation)
                   for finding in simulation.findings)


def simulate(
    job: Job,
    *,
    voxel: Optional[float] = None,
    resolution: Optional[float] = None,
    batch: int = 0,
    compare: bool = True,
    mesh: bool = True,
    outputs: Sequence[str] = (),
    picture: Optional[str] = None,
    picture_size: tuple[int, int] = (1600, 1200),
    view: View = "isometric",
    colour: Optional[str] = None,
    tolerance: float = 0.05,
    allowance: float = 0.0,
    drop_loose: bool = False,
    error: Optional[float] = None,
    budget: int = 0,
    fine: bool = False,
    keep_volume: bool = False,
    progress: Optional[Progress] = None,
) -> Result:
    """Cut a job's stock with its program; compare, mesh, picture and write what is asked for.

    Where the stock is what another job leaves, that is played first. ``voxel`` in mm, or ``resolution`` voxels along
    the stock's longest edge (512 unless told); ``batch`` as in Stock.simulate(). The stock is compared with the design
    when the job has one. A mesh is made when ``mesh`` is true or an output needs it; where exactly one .stl file does,
    with no ``colour``, no ``budget`` and nothing dropped, it is streamed there (Mesh.stream()): then the result has its
    ``contour``, but no mesh. ``outputs`` are .stl, .ply, .obj, .3mf, .glb, .vdb and .step (.stp) files, ``picture`` a
    .png file; a .step file has faces as they were cut where that is possible, else facets, and ``solids`` of the result
    tells why. ``colour`` (operation, deviation, thickness) is what the mesh files are coloured by, deviations green
    within ``tolerance`` of the design and ``allowance``, which is meant to be left on it (mm). Pieces that come loose
    are in the result, with the moves that free them; ``drop_loose`` leaves them out of all that follows. ``error`` (mm;
    None: 0.1 voxels), ``budget``, ``fine``, ``keep_volume``: as in Mesh.from_stock(), of mesh files and the result's
    mesh, the error of facets in .step files too; whether a budget was met is in the result's ``contour``. Seconds of
    each stage are in the result. Raises what the stages raise; nothing is written before the cutting is done.
    """
    if len(job.program) == 0:
        raise ValueError(f"{job.name}: the program has no moves: there is nothing to simulate")
    suffixes = {output_suffix(path) for path in outputs}
    check_suffix(picture, "picture", ".png")
    if picture is not None:
        if not all(isinstance(pixels, int) and pixels >= 1 for pixels in picture_size):
            raise ValueError(f"picture of {picture_size[0]} x {picture_size[1]} pixels: 1 or more each way are wanted")
        Camera.view(view, None, picture_size[0] / picture_size[1])  # ValueError, before the long work
    if colour is not None:
        colours.check(colour, job)
    check_mesh(error, budget)
    meshed = mesh or not suffixes.isdisjoint(MESH_SUFFIXES)
    stages = Stages(progress)
    first = stages.run("stock", lambda report: make_first(
        job.stock, voxel=voxel, resolution=resolution, progress=report))
    exact: Optional[Surface] = None
    if meshed or picture is not None or not suffixes.isdisjoint(solids.SUFFIXES):
        # before the cut: the exact surface begins with the stock as it was
        exact = stages.run("stock", lambda report: first.surface(job.program, job.tools, progress=report))
    stock = first.stock
    simulation = stages.run("cut", lambda report: stock.simulate(job.program, job.tools, batch=batch, progress=report))
    result = Result(job, stock, simulation, seconds=stages.seconds, before=first.played, surface=exact,
                    resampled_voxels=first.resampled_voxels)
    result.loose = stages.run("loose", lambda report: loose.find(
        job, stock, lambda part: make_stock(job.stock, voxel=stock.voxel, progress=part), report))
    most = mesh_error(error, stock.voxel)
    how: dict[str, Any] = {"surface": exact, "fine": fine, "keep_volume": keep_volume}
    if meshed and (mesh or drop_loose or colour or budget or not streams(
            [path for path in outputs if output_suffix(path) in MESH_SUFFIXES])):
        whole = stages.run("mesh", lambda report: Mesh.from_stock(stock, most, budget=budget, progress=report, **how))
        result.mesh, result.contour = whole, whole.contour
    if drop_loose and (result.loose.pieces or result.loose.crumbs):
        _drop_loose(result, stages)
    if compare and job.design is not None:
        result.comparison = _compare(result.stock, job.design, stages)
    tints = None
    if colour is not None and result.mesh is not None:
        tints = _tints(colour, result.mesh, result, tolerance, allowance, stages)
    for path in outputs:
        if output_suffix(path) in MESH_SUFFIXES:
            if result.mesh is None:
                result.contour = stages.run("mesh", lambda report: Mesh.stream(
                    result.stock, path, most, progress=report, **how))
            else:
                _write_mesh(path, result.mesh, tints, stages)
        elif output_suffix(path) in STOCK_SUFFIXES:
            stages.run("write", lambda report: result.stock.write(path, progress=report))
    if exact is not None:
        if picture is not None:
            _draw(picture, result.stock, exact, view, picture_size, stages)
        for path in outputs:  # these last: they may be refused
            if output_suffix(path) in solids.SUFFIXES:
                result.solids.append(_write_solid(path, stock, exact, most, drop_loose, stages))
    stages.end()
    return result


def _drop_loose(result: Result, stages: Stages) -> None:
    """Leave the largest piece of a result alone. Voxels do not come from a mesh with a greater error than usual."""
    stock, made, whole = result.stock, result.contour, result.mesh
    result.mesh = None if whole is None else largest(whole)
    near = made is not None and made.error_mm <= MESH_ERROR_VOXELS * stock.voxel * (1 + 1e-6)
    kept = result.mesh if result.mesh is not None and near else largest(
        stages.run("mesh", lambda report: Mesh.from_stock(stock, progress=report)))
    result.stock = stages.run("mesh", lambda report: Stock.from_mesh(kept, stock.voxel, progress=report))
    result.dropped_mm3 = result.simulation.volume_final - result.stock.volume()


def _compare(stock: Stock, design: Mesh, stages: Stages) -> Comparison:
    return stages.run("compare", lambda report: compare_volume(stock, design, progress=report))


def _tints(colour: str, mesh: Mesh, result: Result, tolerance: float, allowance: float,
           stages: Stages) -> list[colours.RGB]:
    return stages.run("mesh", lambda report: colours.make(
        colour, mesh, result.surface, result.job, tolerance, progress=report, allowance=allowance))


def _write_mesh(path: str, mesh: Mesh, tints: Optional[list[colours.RGB]], stages: Stages) -> None:
    stages.run("write", lambda report: mesh.write(path, colours=tints, progress=report))


def _draw(path: str, stock: Stock, surface: Surface, view: View, size: tuple[int, int], stages: Stages) -> None:
    """A picture of what is left to a file."""
    camera, scene = Camera.view(view, stock.bounding_box(), size[0] / size[1]), Scene(stock)
    scene.show_surface(surface)
    stages.run("picture", lambda report: scene.render(camera, *size, progress=report).write(path))


def _write_solid(path: str, cut: Stock, surface: Surface, error: float, only_largest: bool,
                 stages: Stages) -> solids.Written:
    return stages.run("write", lambda report: solids.write(
        cut, surface, path, error=error, only_largest=only_largest, progress=report))


def streams(paths: Sequence[str]) -> bool:
    """Whether a mesh for these files alone can be written without being in memory as a whole."""
    return len(paths) == 1 and os.path.splitext(os.fspath(paths[0]))[1].lower() == ".stl"


def mesh_error(asked: Optional[float], voxel: float) -> float:
    """What a mesh may be off, mm, where this is asked for (None: nothing)."""
    return MESH_ERROR_VOXELS * voxel if asked is None else asked


def check_mesh(error: Optional[float], budget: int) -> None:
    """ValueError unless a mesh can be asked for with this error (mm; None: not given) and budget of triangles."""
    if error is not None and not 0 <= error <= 1e6:
        raise ValueError(f"error {error:g}: not a length in mm (0 to 1e6)")
    if not 0 <= budget < 1 << 32:
        raise ValueError(f"budget {budget}: not a number of triangles")
    if budget and error == 0:
        raise ValueError(f"a budget of {budget} triangles needs an error (mm) that may be spent on it")


def check_coloured(paths: Sequence[str], option: str) -> None:
    """ValueError unless a file has a place for the colours that an option asks for."""
    if not any(os.path.splitext(path)[1].lower() in COLOURED_SUFFIXES for path in paths):
        raise ValueError(f"{option}: no --output has colours; {', '.join(COLOURED_SUFFIXES)} files do")


def output_suffix(path: str) -> str:
    """Suffix of an output file in lower case; ValueError unless it is one that can be written."""
    suffix = os.path.splitext(os.fspath(path))[1].lower()
    if suffix not in OUTPUT_SUFFIXES:
        raise ValueError(f"{os.fspath(path)}: unknown suffix; an output is {', '.join(OUTPUT_SUFFIXES)}")
    return suffix
