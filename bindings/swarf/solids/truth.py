# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far a solid is from the surface that it was made of. Its shapes are exact where they belong; what may be wrong is
which of them are where. So edges are held against both of their faces; the surface is asked for its shape beside each
edge, on both faces; and triangles inside a face that were given to it from another shape are held against that."""
from __future__ import annotations

from typing import Optional

from .._native import Surface
from ..progress import Report, share, told
from ..vectors import Vector, add, cross, distance, dot, middle, unit
from .probe import DEEP, ask
from .regions import Regions
from .shapes import PLANE, Shape
from .topology import Brep

#: In voxels: how far beside an edge the surface is asked.
BESIDE = 0.05

#: Pieces of an edge between which it is asked.
PIECES = 4


def measure(made: Brep, regions: Regions, surface: Surface, voxel: float, moves: Optional[int] = None,
            progress: Report = None) -> tuple[float, Vector]:
    """The greatest distance found (mm), and where. Cancelled."""
    places = beside_edges(made, voxel, share(progress, 0, 0.4))
    shapes = ask(surface, places, voxel, moves, share(progress, 0.4, 0.9)) if places else []
    found = [(_off(place, outside, shape, voxel), place) for (place, outside), shape in zip(places, shapes)]
    found += edges_off(made)
    borders = {vertex for half in regions.borders() for vertex in half}
    for triangle, shape in told(regions.mended, len(regions.mended), share(progress, 0.9, 1)):
        corners = regions.triangles[triangle]
        if borders.isdisjoint(corners):
            a, b, c = (regions.vertices[corner] for corner in corners)
            inside = middle(a, b, c)
            value, gradient = regions.shape[regions.region_of[triangle]].see(inside)
            place = add(inside, gradient, -value)
            found.append((abs(shape.see(place)[0]), place))
    return max(found, default=(0.0, (0.0, 0.0, 0.0)))


def _off(place: Vector, outside: Vector, shape: Optional[Shape], voxel: float) -> float:
    """How far a place is from the surface's shape there; as far as was looked where there is none, or where it is a
    plane turned the other way round."""
    if shape is None or (shape.kind == PLANE and dot(shape.axis, outside) < 0):
        return DEEP * voxel
    return abs(shape.see(place)[0])


def edges_off(made: Brep) -> list[tuple[float, Vector]]:
    """How far edges are from their faces and from the corners in which they end, and where."""
    found = []
    for face in made.faces:
        for number in (step for loop in face.loops for step, _ in loop):
            edge = made.edges[number]
            places = [place for place, _ in made.along(edge, PIECES)]
            found += [(abs(face.shape.see(place)[0]), place) for place in places]
            found.append((distance(places[-1], made.corners[edge.end]), places[-1]))
    return found


def beside_edges(made: Brep, voxel: float, progress: Report = None) -> list[tuple[Vector, Vector]]:
    """Places on faces close to their edges, and normals out of the material there."""
    found = []
    for face in told(made.faces, len(made.faces), progress):
        for number, forwards in (step for loop in face.loops for step in loop):
            for place, way in made.along(made.edges[number], PIECES)[1:-1]:
                normal = face.shape.see(place)[1]
                outside = normal if face.outwards else add((0.0, 0.0, 0.0), normal, -1)
                place = add(place, unit(cross(outside, way)), BESIDE * voxel if forwards else -BESIDE * voxel)
                value, normal = face.shape.see(place)
                found.append((add(place, normal, -value), outside))
    return found
