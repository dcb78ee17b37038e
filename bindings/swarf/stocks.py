# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a stock as a Job describes it to a Stock: shapes, files, and what another set-up leaves of its own."""
from __future__ import annotations

import math
import os
from dataclasses import dataclass, field
from typing import Any, Callable, Optional

from ._native import Cutter, GeometryError, Mesh, Program, Simulation, Stock, Surface
from .aliases import Box
from .files import naming
from .job import Job
from .placement import IDENTITY, Rows, box_of, direction, is_quarter, point, rows_of
from .progress import Report, share

#: Voxels along the longest edge of the stock where nobody says how fine: fast on any machine, and fine enough to see.
DEFAULT_RESOLUTION = 512

#: What edges may be off after other than quarter turns (Stock.placed()), in voxels: with the exact surface of what was
#: cut, and from voxels alone.
RESAMPLED_EXACT, RESAMPLED_FIELD = 0.02, 0.1

#: Set-ups in a row, so that a description that holds itself ends.
MOST_SET_UPS = 100

#: Plays the program of a set-up before on its stock, as far as verify() or others want more of it than its outcome.
Play = Callable[[Job, Stock, Report], Simulation]


@dataclass
class First:
    """A stock before its program is played, and what is known of it beyond its voxels."""

    stock: Stock
    before: Optional[Surface] = None  #: exact surface of the set-up before
    placement: Rows = IDENTITY  #: from that set-up to this
    played: list[tuple[Job, Simulation]] = field(default_factory=list)  #: set-ups before, as far as they were played
    kept: list[tuple[Job, str]] = field(default_factory=list)  #: those that were not, and the files of their outcome
    resampled_voxels: float = 0.0  #: how far its voxels may be off for being made again; 0: they are as they were

    def surface(self, program: Program, tools: dict[int, Cutter], progress: Report = None) -> Surface:
        """The exact surface that a program makes of it; to be asked for before the stock is cut."""
        if self.before is None:
            return Surface(self.stock, program, tools, progress=progress)
        return self.before.next(self.placement, program, tools, progress=progress)


#: What descriptions have to tell, by their kind.
NEEDS = {"box": ("lo", "hi"), "cylinder": ("base", "axis", "radius"), "mesh": ("mesh",), "vdb": ("path",),
         "result": ("job",)}


def _kind_of(description: dict[str, Any]) -> str:
    """The kind of a stock; ValueError where it is not known or does not tell what it has to."""
    kind: str = description.get("kind", "")
    if not isinstance(kind, str) or kind not in NEEDS:
        raise ValueError(f"stock of kind {kind!r} is not known: {', '.join(NEEDS)}")
    missing = [key for key in NEEDS[kind] if key not in description]
    if missing:
        raise ValueError(f"stock of kind {kind!r} without {missing[0]!r}; it needs {', '.join(NEEDS[kind])}")
    return kind


def _bare_box(description: dict[str, Any]) -> Box:
    kind = _kind_of(description)
    if kind == "box":
        return description["lo"], description["hi"]
    if kind == "mesh":
        box: Optional[Box] = description["mesh"].bounding_box
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
    if kind == "result":
        return stock_box(description["job"].stock)
    raise ValueError(f"stock of kind {kind!r} has no box")


def stock_box(description: Optional[dict[str, Any]]) -> Box:
    """Bounding box (lo, hi) of a stock as a Job describes it, before it is made; not for kind "vdb". Of what another
    job leaves, the box is that of its own stock."""
    if description is None:
        raise ValueError("no stock: the job does not say what is being milled")
    box = _bare_box(description)
    if "placement" not in description:
        return box
    return box_of(rows_of(description["placement"], lambda: box), box)


def voxel_of(description: dict[str, Any], resolution: float) -> float:
    """Voxel size (mm) that divides the stock's longest edge by ``resolution``."""
    if not (math.isfinite(resolution) and resolution >= 1):
        raise ValueError(f"resolution {resolution:g}: not a number of voxels (1 or more)")
    lo, hi = stock_box(description)
    edge = max(high - low for low, high in zip(lo, hi))
    if not edge > 0:
        raise ValueError("the stock has no extent: its high corner must lie above its low corner")
    return edge / resolution


def _box_mesh(box: Box) -> Mesh:
    """A block as triangles."""
    corners = [[box[i >> k & 1][k] for k in range(3)] for i in range(8)]
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    return Mesh(corners, [triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))])


def _make_shape(description: dict[str, Any], voxel: float, progress: Report) -> Stock:
    """Box, cylinder or mesh, placed: the shape is turned, not its voxels."""
    kind = description["kind"]
    rows = rows_of(description["placement"], lambda: _bare_box(description)) if "placement" in description else None
    if kind == "cylinder":
        base, axis = description["base"], description["axis"]
        if rows is not None:
            base, axis = point(rows, base), direction(rows, axis)
        return Stock.cylinder(base, axis, description["radius"], voxel)
    if kind == "box":
        box = description["lo"], description["hi"]
        if rows is None or is_quarter(rows):
            return Stock.box(*(box if rows is None else box_of(rows, box)), voxel)
        mesh = _box_mesh(box)
    else:
        mesh = description["mesh"]
    if rows is not None:
        mesh = mesh.placed(rows)
    with naming(description.get("path", "stock")):
        return Stock.from_mesh(mesh, voxel, progress=progress)


def _box_left(stock: Stock, surface: Optional[Surface], what: str, progress: Report) -> Box:
    """The box of what is left of a stock, as its mesh tells."""
    box = Mesh.from_stock(stock, surface=surface, progress=progress).bounding_box
    if box is None:
        raise GeometryError(f"{what}: nothing is left of the stock that could be set up again")
    return box


def _read_file(description: dict[str, Any], voxel: Optional[float], resolution: Optional[float],
               progress: Report) -> First:
    """Of a .vdb file, placed."""
    path = os.fspath(description["path"])
    stock = Stock.read(path, progress=share(progress, 0, 0.4))
    if resolution is not None or (voxel is not None and not math.isclose(voxel, stock.voxel, rel_tol=1e-6)):
        raise ValueError(f"{path} has voxels of {stock.voxel:g} mm: leave voxel size and resolution out")
    if "placement" not in description:
        return First(stock)
    rows = rows_of(description["placement"], lambda: _box_left(stock, None, path, share(progress, 0.4, 0.6)))
    return First(stock.placed(rows, progress=share(progress, 0.6, 1)),
                 resampled_voxels=0.0 if is_quarter(rows) else RESAMPLED_FIELD)


def _simulate(job: Job, stock: Stock, progress: Report) -> Simulation:
    return stock.simulate(job.program, job.tools, progress=progress)


def _play_before(description: dict[str, Any], voxel: Optional[float], depth: int, play: Play,
                 progress: Report) -> First:
    """What another job leaves: its program is played, unless a file holds the outcome; its exact surface stays."""
    job: Job = description["job"]
    if len(job.program) == 0:
        raise ValueError(f"{job.name}: the program has no moves: there is nothing to simulate")
    path = description.get("path")
    kept = None if path is None else Stock.read(path, progress=share(progress, 0, 0.3))
    first = _make(job.stock, kept.voxel if kept is not None else voxel, None, depth + 1, play,
                  share(progress, 0.3, 0.45))
    before = first.surface(job.program, job.tools, progress=share(progress, 0.45, 0.5))
    if kept is None:
        left = first.stock
        first.played.append((job, play(job, left, share(progress, 0.5, 0.8))))
    else:
        left = kept
        first.kept.append((job, os.fspath(description["path"])))
    rows = rows_of(description.get("placement", IDENTITY),
                   lambda: _box_left(left, before, job.name, share(progress, 0.8, 0.85)))
    try:
        stock = left.placed(rows, voxel=voxel, surface=before, progress=share(progress, 0.85, 1))
    except GeometryError as error:
        raise GeometryError(f"{job.name}: {error}") from None
    same = is_quarter(rows) and math.isclose(stock.voxel, left.voxel, rel_tol=1e-9)
    return First(stock, before, rows, first.played, first.kept,
                 max(first.resampled_voxels, 0.0 if same else RESAMPLED_EXACT))


def _make(description: Optional[dict[str, Any]], voxel: Optional[float], resolution: Optional[float], depth: int,
          play: Play, progress: Report) -> First:
    if description is None:
        raise ValueError("no stock: the job does not say what is being milled")
    if depth > MOST_SET_UPS:
        raise ValueError(f"the stock is what is left after more than {MOST_SET_UPS} set-ups, or after itself")
    kind = _kind_of(description)
    if kind == "vdb":
        return _read_file(description, voxel, resolution, progress)
    if kind == "result":
        if voxel is None and "path" not in description:
            voxel = voxel_of(description, DEFAULT_RESOLUTION if resolution is None else resolution)
        return _play_before(description, voxel, depth, play, progress)
    if voxel is None:
        voxel = voxel_of(description, DEFAULT_RESOLUTION if resolution is None else resolution)
    return First(_make_shape(description, voxel, progress))


def make_first(
    description: Optional[dict[str, Any]],
    *,
    voxel: Optional[float] = None,
    resolution: Optional[float] = None,
    play: Play = _simulate,
    progress: Report = None,
) -> First:
    """The stock that a Job describes, at a voxel size (mm) or a resolution (voxels along the longest edge), with what
    is known of it. Set-ups before it are played, by ``play``; a kept result has its voxel size, unless another is asked
    for."""
    if voxel is not None and resolution is not None:
        raise ValueError("give the voxel size or the resolution, not both")
    if voxel is not None and not (math.isfinite(voxel) and voxel > 0):
        raise ValueError(f"voxel {voxel:g}: not a positive length in mm")
    return _make(description, voxel, resolution, 0, play, progress)


def make_stock(
    description: Optional[dict[str, Any]],
    *,
    voxel: Optional[float] = None,
    resolution: Optional[float] = None,
    progress: Report = None,
) -> Stock:
    """The Stock of make_first() alone."""
    return make_first(description, voxel=voxel, resolution=resolution, progress=progress).stock
