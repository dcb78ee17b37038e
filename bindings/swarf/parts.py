# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meshes in parts: pieces that hang together, planes in words."""
from __future__ import annotations

import math
from typing import Any, Callable, Optional, Protocol, Sequence

from ._native import GeometryError, Mesh, Solid, Surface
from .progress import Report, check, share
from .records import rows
from .vectors import Vector, add, cross, middle

#: What a plane in words looks like.
PLANE_HELP = "x=MM, y=MM, z=MM, or X,Y,Z,NX,NY,NZ: a point and the normal"


class Closed(Protocol):
    """What closes a piece of space, as a Shell does."""

    @property
    def volume_mm3(self) -> float:
        """Below 0 where it is round a hollow."""
    @property
    def bounding_box(self) -> Optional[tuple[Vector, Vector]]:
        """Two corners."""


def _box_contains(outer: Closed, inner: Closed) -> bool:
    if outer.bounding_box is None or inner.bounding_box is None:
        return False
    (outer_lo, outer_hi), (inner_lo, inner_hi) = outer.bounding_box, inner.bounding_box
    return all(a <= b for a, b in zip(outer_lo, inner_lo)) and all(a >= b for a, b in zip(outer_hi, inner_hi))


def _place_on(mesh: Mesh) -> Vector:
    """The middle of a mesh's largest triangle: away from edges, along which it may touch others."""
    vertices: list[Vector] = [(x, y, z) for x, y, z in rows(mesh.vertices)]
    corners = ((vertices[a], vertices[b], vertices[c]) for a, b, c in rows(mesh.triangles))
    return middle(*max(corners, key=lambda one: math.hypot(*cross(add(one[1], one[0], -1), add(one[2], one[0], -1)))))


def pieces(shells: Sequence[Closed], mesh_of: Callable[[int], Mesh], progress: Report = None) -> list[list[int]]:
    """Places of the shells of each piece, the largest piece first; a hollow belongs to the innermost solid round it.
    ``mesh_of``: a shell by its place, asked of hollows and what may be round them. Cancelled."""
    solids = sorted((i for i, shell in enumerate(shells) if shell.volume_mm3 > 0), key=lambda i: -shells[i].volume_mm3)
    found = {i: [i] for i in solids}
    known: dict[int, Optional[Solid]] = {}

    def is_round(solid: int, place: Vector) -> bool:
        if solid not in known:
            try:
                known[solid] = Solid(mesh_of(solid))
            except GeometryError:  # open: its box has to do
                known[solid] = None
        told = known[solid]
        return told is None or told.distance([place])[0] < 0

    for i, shell in enumerate(shells):
        check(progress, i / len(shells))
        round_it = [s for s in solids if _box_contains(shells[s], shell)] if shell.volume_mm3 <= 0 else []
        if round_it:
            place = _place_on(mesh_of(i))
            innermost = next((s for s in reversed(round_it) if is_round(s, place)), None)
            if innermost is not None:
                found[innermost].append(i)
    return [found[i] for i in solids]


def pieces_of(mesh: Mesh, progress: Report = None) -> list[list[int]]:
    """Places in mesh.shells() of the shells of each piece, as pieces()."""
    shells = mesh.shells()
    made: list[Mesh] = []

    def mesh_of(shell: int) -> Mesh:
        if not made:  # all in one pass
            made.extend(mesh.split_shells([[place] for place in range(len(shells))]))
        return made[shell]

    return pieces(shells, mesh_of, progress)


def split_pieces(mesh: Mesh, progress: Report = None) -> tuple[Mesh, ...]:
    """A mesh per piece, as pieces_of() tells them. Cancelled."""
    return mesh.split_shells(pieces_of(mesh, share(progress, 0, 0.5)), progress=share(progress, 0.5, 1))


def largest(mesh: Mesh) -> Mesh:
    """The largest piece of a mesh alone; the mesh itself where it is one."""
    found = pieces_of(mesh)
    return mesh if len(found) < 2 else mesh.keep_shells(found[0])


def parse_plane(text: str) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Point and normal of a plane in words. ValueError."""
    axis, equals, value = text.partition("=")
    try:
        numbers = [float(word) for word in (value if equals else text).split(",")]
    except ValueError:
        numbers = []
    name = axis.strip().lower()
    if all(map(math.isfinite, numbers)):
        if equals and name in ("x", "y", "z") and len(numbers) == 1:
            point, normal = ([number if name == letter else 0.0 for letter in "xyz"] for number in (numbers[0], 1.0))
            return (point[0], point[1], point[2]), (normal[0], normal[1], normal[2])
        if not equals and len(numbers) == 6 and math.hypot(*numbers[3:]) > 0:
            return (numbers[0], numbers[1], numbers[2]), (numbers[3], numbers[4], numbers[5])
    raise ValueError(f"plane {text!r}: wanted {PLANE_HELP}")


def thinnest(mesh: Mesh, progress: Report = None) -> dict[str, Any]:
    """The least wall thickness of a mesh, mm, and the middle of the triangle where it is; plain types."""
    values = mesh.thickness(progress=progress)
    if not len(values):
        return {"least_mm": None, "place": None}
    least, where = min((value, index) for index, value in enumerate(values))
    if not math.isfinite(least):
        return {"least_mm": None, "place": None}
    (corners,) = rows(mesh.triangles[where:where + 1])
    a, b, c = ((x, y, z) for corner in corners for x, y, z in rows(mesh.vertices[corner:corner + 1]))
    return {"least_mm": least, "place": list(middle(a, b, c))}


#: Kinds of faces that CAD programs know, as in the last column of Mesh.origins(); the first is all else.
FACES = ("other", "plane", "cylinder", "cone", "sphere", "torus")


def faces(mesh: Mesh, surface: Surface, moves: Optional[int] = None) -> dict[str, float]:
    """Area of a mesh, mm2, by the kind of face that its triangles are on."""
    areas = dict.fromkeys(FACES, 0.0)
    vertices: list[Vector] = [(x, y, z) for x, y, z in rows(mesh.vertices)]
    for (*_, kind), (a, b, c) in zip(rows(mesh.origins(surface, moves=moves)), rows(mesh.triangles)):
        u, v = (add(vertices[end], vertices[a], -1) for end in (b, c))
        areas[FACES[kind]] += math.hypot(*cross(u, v)) / 2
    return areas
