# SPDX-License-Identifier: LGPL-2.1-or-later
"""STEP files of what is left of a stock: with faces as they were cut where all of it is known, else of facets."""
from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import Optional

from .._native import Mesh, Stock, Surface
from ..parts import largest, pieces_of
from ..progress import Report, check, share
from ..records import rows
from ..vectors import add, cross, unit
from ..wording import Said
from . import brep, step
from .chains import SLOPPY
from .shapes import PLANE, Shape

__all__ = ["SUFFIXES", "Cut", "Written", "as_cut", "facets", "write", "write_cut", "write_facets"]

SUFFIXES = (".step", ".stp")

#: Triangles whose faces are told in a minute or so.
TRIANGLES_MAX = 500000

#: Of facets: a file of some 90 MB, more than CAD programs read.
FACETS_MAX = 100000


@dataclass
class Written:
    """A file that was written. ``reason``: why it is of facets, None where its faces are as they were cut; then they
    are off by ``off_mm`` at most (None of facets), and ``missing`` tells where that is more than the program's
    digits."""

    path: str
    faces: int
    reason: Optional[str] = None
    off_mm: Optional[float] = None
    missing: Optional[Said] = None

    @property
    def note(self) -> Optional[str]:
        """What is not as it was cut, in words."""
        if self.reason:
            return f"{self.faces} facets, no faces as they were cut: {self.reason}"
        return self.missing


@dataclass
class Cut:
    """Faces of what is left of a stock as they were cut, ``made`` of a mesh that is within ``error_mm``; or the
    ``reason`` why there are none, as that nothing is left. ``share``: the part of the area that such faces take, None
    where it was not measured."""

    mesh: Mesh
    error_mm: float
    made: Optional[brep.Brep] = None
    reason: str = ""
    share: Optional[float] = None


def facets(mesh: Mesh, progress: Report = None) -> brep.Brep:
    """Each triangle of a closed mesh a plane. ValueError: open, empty, a hollow in no solid, too many triangles, one
    without area."""
    if not mesh.triangle_count or not mesh.closed:
        raise ValueError("a solid is made of a closed mesh")
    if mesh.triangle_count > FACETS_MAX:
        raise ValueError(f"{mesh.triangle_count} triangles are too many for facets, of which {FACETS_MAX} are written "
                         "at most")
    made = brep.Brep([], [], [], [], [], 0.0)
    solids = pieces_of(mesh)
    order = [shell for solid in solids for shell in solid]
    if len(order) != len(mesh.shells()):
        raise ValueError(Said("hollow"))
    shells = mesh.split_shells([[shell] for shell in order]) if len(order) > 1 else (mesh,)
    for solid in solids:
        made.solids.append(list(range(len(made.shells), len(made.shells) + len(solid))))
        for _ in solid:
            _add(made, shells[len(made.shells)])
            check(progress, len(made.faces) / mesh.triangle_count)
    return made


def _add(made: brep.Brep, mesh: Mesh) -> None:
    """One shell more."""
    corner, first = len(made.corners), len(made.faces)
    made.corners.extend((x, y, z) for x, y, z in rows(mesh.vertices))
    edges: defaultdict[tuple[int, int], list[int]] = defaultdict(list)  #: with one triangle so far
    for triangle in rows(mesh.triangles):
        a, b, c = (made.corners[corner + vertex] for vertex in triangle)
        loop = []
        for start, end in zip(triangle, (*triangle[1:], triangle[0])):
            if edges[end, start]:
                loop.append((edges[end, start].pop(), False))
                continue
            edges[start, end].append(len(made.edges))
            loop.append((len(made.edges), True))
            made.edges.append(brep.Edge(corner + start, corner + end))
        normal = unit(cross(add(b, a, -1), add(c, a, -1)))
        if not any(normal):
            raise ValueError(f"a triangle at ({a[0]:g}, {a[1]:g}, {a[2]:g}) has no area")
        made.faces.append(brep.Face(Shape(PLANE, a, normal, 0.0, 0.0), True, [loop]))
    made.shells.append(list(range(first, len(made.faces))))


def _why(problem: ValueError) -> str:
    """What such an error says, a wording.Said where it is one of faces that are not possible."""
    said = problem.args[0] if problem.args else ""
    return said if isinstance(said, Said) else str(problem)


def _missing(made: brep.Brep) -> Optional[Said]:
    """Where a solid of faces as they were cut lacks a narrow one; None where it has all of them."""
    if made.off_mm <= SLOPPY:
        return None
    x, y, z = made.off_at
    return Said("narrow missing", off=made.off_mm, x=x, y=y, z=z)


def _written(made: brep.Brep, path: str, reason: Optional[str], progress: Report) -> Written:
    step.write(made, path, progress=progress)
    if progress is not None:
        progress(1.0)  # it is there: too late to cancel
    return Written(path, len(made.faces), reason, None if reason else made.off_mm, _missing(made))


def write_facets(mesh: Mesh, path: str, reason: str, progress: Report = None) -> Written:
    """A STEP file of facets. ValueError as facets(), with the reason why it is none of faces; OSError."""
    try:
        made = facets(mesh, share(progress, 0, 0.7))
    except ValueError as problem:
        raise ValueError(f"{path}: cannot be written: {problem}; faces as they were cut are not possible: "
                         f"{reason}") from None
    return _written(made, path, reason, share(progress, 0.7, 1))


def as_cut(stock: Stock, surface: Surface, *, only_largest: bool = False, progress: Report = None) -> Cut:
    """What is left of a stock after all moves of its Surface, bounded by planes, cylinders, cones, spheres and tori, if
    it is by them alone."""
    error = brep.MESH_ERROR * stock.voxel
    mesh = Mesh.from_stock(stock, error, surface=surface, progress=share(progress, 0, 0.5))
    if not mesh.triangle_count:
        return Cut(mesh, error, reason=Said("place empty"))
    mesh = largest(mesh) if only_largest else mesh
    if mesh.triangle_count > TRIANGLES_MAX:
        return Cut(mesh, error, reason=Said("too many triangles", triangles=mesh.triangle_count, most=TRIANGLES_MAX))
    try:
        return Cut(mesh, error, brep.make(mesh, surface, stock.voxel, progress=share(progress, 0.5, 1)), share=1.0)
    except brep.NotAnalytic as problem:
        return Cut(mesh, error, reason=problem.said, share=problem.share)
    except ValueError as problem:  # a piece that is no closed mesh: facets show what there is
        return Cut(mesh, error, reason=_why(problem))


def write_cut(made: brep.Brep, path: str, progress: Report = None) -> Written:
    """A STEP file of faces as they were cut. OSError."""
    return _written(made, path, None, progress)


def write(stock: Stock, surface: Surface, path: str, *, error: float, only_largest: bool = False,
          progress: Report = None) -> Written:
    """A STEP file of what is left of a stock after all moves of its Surface: as_cut(), where it is that, else of facets
    with this error (mm). ValueError where it is too much even for facets, or nothing is left; OSError."""
    cut = as_cut(stock, surface, only_largest=only_largest, progress=share(progress, 0, 0.8))
    if not cut.mesh.triangle_count:
        raise ValueError(f"{path}: cannot be written: {cut.reason}")
    if cut.made is not None:
        return write_cut(cut.made, path, share(progress, 0.8, 1))
    coarse = Mesh.from_stock(stock, error, surface=surface, progress=share(progress, 0.8, 0.9))
    return write_facets(largest(coarse) if only_largest else coarse, path, cut.reason, share(progress, 0.9, 1))
