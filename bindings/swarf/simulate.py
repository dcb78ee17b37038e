# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a job to its result: stock, cutting, comparison, mesh, picture, files. Command line and add-on share it."""
from __future__ import annotations

import math
import os
import time
from dataclasses import dataclass, field
from typing import Any, Callable, Optional, Sequence

from ._native import Camera, Comparison, GeometryError, Mesh, Scene, Simulation, Stock, Surface, compare_volume
from .job import Job

#: Voxels along the longest edge of the stock where nobody says how fine: fast on any machine, and fine enough to see.
DEFAULT_RESOLUTION = 512

#: What an output file can be, by its suffix.
MESH_SUFFIXES = (".stl", ".ply", ".obj", ".3mf", ".glb")
STOCK_SUFFIXES = (".vdb",)

#: What a mesh may be off, in voxels, where nobody says: as much as the stock itself is at its edges.
MESH_ERROR_VOXELS = 0.1

#: Called with the stage ("stock", "cut", "compare", "mesh", "picture", "write") and the fraction of it that is done; a
#: true answer cancels, an exception cancels and comes out.
Progress = Callable[[str, float], Any]


@dataclass
class Result:
    """What a simulation came to."""

    job: Job
    stock: Stock
    simulation: Simulation
    comparison: Optional[Comparison] = None
    mesh: Optional[Mesh] = None
    seconds: dict[str, float] = field(default_factory=dict)

    @property
    def failed(self) -> bool:
        """Whether a finding is of class error."""
        return any(finding.severity == "error" for finding in self.simulation.findings)


def stock_box(description: dict[str, Any]) -> tuple[Sequence[float], Sequence[float]]:
    """Bounding box (lo, hi) of a stock as a Job describes it, before it is made; not for kind "vdb"."""
    kind = description["kind"]
    if kind == "box":
        return description["lo"], description["hi"]
    if kind == "mesh":
        box = description["mesh"].bounding_box
        if box is None:
            raise ValueError("the stock's mesh has no triangles")
        return box
    if kind == "cylinder":
        base, axis, radius = description["base"], description["axis"], description["radius"]
        length = math.hypot(*axis)
        if not length > 0:
            raise ValueError("the cylinder's axis has no length")
        # A disc's half extent along a coordinate is radius * sin(angle between that coordinate and the axis).
        reach = [radius * math.sqrt(max(0.0, 1 - (a / length) ** 2)) for a in axis]
        lo = [min(b, b + a) - r for b, a, r in zip(base, axis, reach)]
        hi = [max(b, b + a) + r for b, a, r in zip(base, axis, reach)]
        return lo, hi
    raise ValueError(f"stock of kind {kind!r} has no box")


def voxel_of(description: dict[str, Any], resolution: float) -> float:
    """Voxel size (mm) that divides the stock's longest edge by ``resolution``."""
    if not (math.isfinite(resolution) and resolution >= 1):
        raise ValueError(f"resolution {resolution:g}: not a number of voxels (1 or more)")
    lo, hi = stock_box(description)
    edge = max(h - l for l, h in zip(lo, hi))
    if not edge > 0:
        raise ValueError("the stock has no extent: its high corner must lie above its low corner")
    return edge / resolution


def make_stock(
    description: Optional[dict[str, Any]],
    *,
    voxel: Optional[float] = None,
    resolution: Optional[float] = None,
    progress: Optional[Callable[[float], Any]] = None,
) -> Stock:
    """The Stock that a Job describes, at a voxel size (mm) or a resolution (voxels along the longest edge)."""
    if description is None:
        raise ValueError("no stock: the job does not say what is being milled")
    if voxel is not None and resolution is not None:
        raise ValueError("give the voxel size or the resolution, not both")
    if voxel is not None and not (math.isfinite(voxel) and voxel > 0):
        raise ValueError(f"voxel {voxel:g}: not a positive length in mm")
    kind = description["kind"]
    if kind == "vdb":
        stock = Stock.read(description["path"], progress=progress)
        if resolution is not None or (voxel is not None and not math.isclose(voxel, stock.voxel, rel_tol=1e-6)):
            raise ValueError(
                f"{os.fspath(description['path'])} has voxels of {stock.voxel:g} mm: "
                "leave voxel size and resolution out"
            )
        return stock
    if voxel is None:
        voxel = voxel_of(description, DEFAULT_RESOLUTION if resolution is None else resolution)
    if kind == "box":
        return Stock.box(description["lo"], description["hi"], voxel)
    if kind == "cylinder":
        return Stock.cylinder(description["base"], description["axis"], description["radius"], voxel)
    if kind == "mesh":
        try:
            return Stock.from_mesh(description["mesh"], voxel, progress=progress)
        except GeometryError as error:  # which of the job's meshes, and of which file
            raise GeometryError(f"{description.get('path', 'stock')}: {error}") from None
    raise ValueError(f"stock of kind {kind!r} is not known: box, cylinder, mesh, vdb")


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
    progress: Optional[Progress] = None,
) -> Result:
    """Cut a job's stock with its program; compare, mesh, picture and write what is asked for.

    ``voxel`` in mm, or ``resolution`` voxels along the stock's longest edge (512 unless told); ``batch`` as in
    Stock.simulate(). The stock is compared with the design when the job has one. A mesh is made when ``mesh`` is true
    or an output needs it; ``outputs`` are .stl, .ply, .obj, .3mf, .glb and .vdb files, ``picture`` a .png file. Seconds
    of each stage are in the result. Raises what the stages raise; nothing is written before the cutting is done.
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
    stock = timed("stock", lambda report: make_stock(job.stock, voxel=voxel, resolution=resolution, progress=report))
    scene = None
    if picture is not None:  # before the cut: the exact surface begins with the stock as it was
        scene = Scene(stock)
        timed("stock", lambda report: scene.set_surface(stock, job.program, job.tools, progress=report))
    exact = None
    if mesh or any(output_suffix(path) in MESH_SUFFIXES for path in outputs):
        exact = timed("stock", lambda report: Surface(stock, job.program, job.tools, progress=report))
    simulation = timed("cut", lambda report: stock.simulate(job.program, job.tools, batch=batch, progress=report))
    result = Result(job, stock, simulation, seconds=seconds)
    if compare and job.design is not None:
        result.comparison = timed("compare", lambda report: compare_volume(stock, job.design, progress=report))
    if exact is not None:
        result.mesh = timed("mesh", lambda report: Mesh.from_stock(stock, MESH_ERROR_VOXELS * stock.voxel, surface=exact,
                                                                   progress=report))
    for path in outputs:
        written = result.mesh if output_suffix(path) in MESH_SUFFIXES else stock
        timed("write", lambda report: written.write(path, progress=report))
    if picture is not None:
        width, height = picture_size
        camera = Camera.view(view, stock.bounding_box(), width / height)
        timed("picture", lambda report: scene.render(camera, width, height, progress=report).write(picture))
    seconds["total"] = time.perf_counter() - started
    return result


def output_suffix(path: str) -> str:
    """Suffix of an output file in lower case; ValueError unless it is one that can be written."""
    suffix = os.path.splitext(os.fspath(path))[1].lower()
    if suffix not in MESH_SUFFIXES + STOCK_SUFFIXES:
        raise ValueError(f"{os.fspath(path)}: unknown suffix; an output is {', '.join(MESH_SUFFIXES + STOCK_SUFFIXES)}")
    return suffix
