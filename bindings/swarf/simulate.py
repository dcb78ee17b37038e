# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a job to its result: stock, cutting, comparison, mesh, picture, files. Command line and add-on share it."""
from __future__ import annotations

import os
import time
from dataclasses import dataclass, field
from typing import Any, Callable, Optional, Sequence

from . import colours, loose, solids
from ._native import Camera, Comparison, Contour, Mesh, Scene, Simulation, Stock, Surface, compare_volume
from .job import Job
from .parts import largest
from .stocks import DEFAULT_RESOLUTION, make_first, make_stock, stock_box, voxel_of

__all__ = [
    "DEFAULT_RESOLUTION", "MESH_ERROR_VOXELS", "MESH_SUFFIXES", "Progress", "Result", "STOCK_SUFFIXES", "make_stock",
    "OUTPUT_SUFFIXES", "output_suffix", "simulate", "stock_box", "voxel_of",
]

#: What an output file can be, by its suffix.
MESH_SUFFIXES = (".stl", ".ply", ".obj", ".3mf", ".glb")
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
    solids: list[solids.Written] = field(default_factory=list)  #: .step files, and why they are of facets where they are
    loose: loose.LoosePieces = field(default_factory=loose.LoosePieces)  #: what hangs on nothing any more
    dropped_mm3: float = 0.0  #: of it, where it was left out
    resampled_voxels: float = 0.0  #: how far the first stock's voxels may be off for being turned; 0: they are as they were

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
    view: str = "isometric",
    colour: Optional[str] = None,
    tolerance: float = 0.05,
    allowance: float = 0.0,
    drop_loose: bool = False,
    progress: Optional[Progress] = None,
) -> Result:
    """Cut a job's stock with its program; compare, mesh, picture and write what is asked for.

    Where the stock is what another job leaves, that is played first. ``voxel`` in mm, or ``resolution`` voxels along the
    stock's longest edge (512 unless told); ``batch`` as in Stock.simulate(). The stock is compared with the design when
    the job has one. A mesh is made when ``mesh`` is true or an output needs it; where exactly one .stl file does, with
    no ``colour`` and nothing dropped, it is streamed there (Mesh.stream()): then the result has its ``contour``, but no
    mesh. ``outputs`` are .stl, .ply, .obj, .3mf, .glb, .vdb and .step (.stp) files, ``picture`` a .png file; a .step file
    has faces as they were cut where that is possible, else facets, and ``solids`` of the result tells why. ``colour`` (operation,
    deviation, thickness) is what the mesh files are coloured by, deviations green within ``tolerance`` of the design and
    ``allowance``, which is meant to be left on it (mm). Pieces that come loose are in the result, with the moves that
    free them; ``drop_loose`` leaves them out of all that follows. Seconds of each stage are in the result. Raises what
    the stages raise; nothing is written before the cutting is done.
    """
    if len(job.program) == 0:
        raise ValueError(f"{job.name}: the program has no moves: there is nothing to simulate")
    for path in outputs:
        output_suffix(path)

    seconds: dict[str, float] = {}

    def timed(stage: str, work: Callable[[Optional[Callable[[float], Any]]], Any]) -> Any:
        started = time.perf_counter()
        report = None if progress is None else lambda fraction: progress(stage, fraction)
        try:
            return work(report)
        finally:
            seconds[stage] = seconds.get(stage, 0.0) + time.perf_counter() - started

    started = time.perf_counter()
    first = timed("stock", lambda report: make_first(job.stock, voxel=voxel, resolution=resolution, progress=report))
    stock = first.stock
    meshed, exact = mesh or any(output_suffix(path) in MESH_SUFFIXES for path in outputs), None
    solid = any(output_suffix(path) in solids.SUFFIXES for path in outputs)
    if meshed or solid or picture is not None:  # before the cut: the exact surface begins with the stock as it was
        exact = timed("stock", lambda report: first.surface(job.program, job.tools, progress=report))
    simulation = timed("cut", lambda report: stock.simulate(job.program, job.tools, batch=batch, progress=report))
    result = Result(job, stock, simulation, seconds=seconds, before=first.played, surface=exact,
                    resampled_voxels=first.resampled_voxels)
    result.loose = timed("loose", lambda report: loose.find(
        job, stock, lambda part: make_stock(job.stock, voxel=stock.voxel, progress=part), report))
    streamed = meshed and not (mesh or drop_loose or colour) and streams(
        [path for path in outputs if output_suffix(path) in MESH_SUFFIXES])
    if meshed and not streamed:
        result.mesh = timed("mesh", lambda report: Mesh.from_stock(stock, MESH_ERROR_VOXELS * stock.voxel, surface=exact,
                                                                   progress=report))
        result.contour = result.mesh.contour
    cut = stock
    if drop_loose and (result.loose.pieces or result.loose.crumbs):
        whole = timed("mesh", lambda report: Mesh.from_stock(stock, progress=report)) if result.mesh is None else result.mesh
        result.stock = stock = timed("mesh", lambda report: Stock.from_mesh(largest(whole), stock.voxel, progress=report))
        result.mesh = None if result.mesh is None else largest(whole)
        result.dropped_mm3 = simulation.volume_final - stock.volume()
    if compare and job.design is not None:
        result.comparison = timed("compare", lambda report: compare_volume(stock, job.design, progress=report))
    tints = None
    if colour is not None and result.mesh is not None:
        tints = timed("mesh", lambda report: colours.make(
            colour, result.mesh, exact, job, tolerance, progress=report, allowance=allowance))
    for path in outputs:
        if output_suffix(path) in MESH_SUFFIXES and streamed:
            result.contour = timed("mesh", lambda report: Mesh.stream(
                stock, path, MESH_ERROR_VOXELS * stock.voxel, surface=exact, progress=report))
        elif output_suffix(path) in MESH_SUFFIXES:
            timed("write", lambda report: result.mesh.write(path, colors=tints, progress=report))
        elif output_suffix(path) in STOCK_SUFFIXES:
            timed("write", lambda report: stock.write(path, progress=report))
    if picture is not None:
        width, height = picture_size
        camera, scene = Camera.view(view, stock.bounding_box(), width / height), Scene(stock)
        scene.show_surface(exact)
        timed("picture", lambda report: scene.render(camera, width, height, progress=report).write(picture))
    for path in outputs:  # these last: they may be refused
        if output_suffix(path) in solids.SUFFIXES:
            result.solids.append(timed("write", lambda report: solids.write(
                cut, exact, path, error=MESH_ERROR_VOXELS * cut.voxel, only_largest=drop_loose, progress=report)))
    seconds["total"] = time.perf_counter() - started
    return result


def streams(paths: Sequence[str]) -> bool:
    """Whether a mesh for these files alone can be written without being in memory as a whole."""
    return len(paths) == 1 and os.path.splitext(os.fspath(paths[0]))[1].lower() == ".stl"


def output_suffix(path: str) -> str:
    """Suffix of an output file in lower case; ValueError unless it is one that can be written."""
    suffix = os.path.splitext(os.fspath(path))[1].lower()
    if suffix not in OUTPUT_SUFFIXES:
        raise ValueError(f"{os.fspath(path)}: unknown suffix; an output is {', '.join(OUTPUT_SUFFIXES)}")
    return suffix
