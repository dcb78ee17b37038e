# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids as faces, edges and corners."""
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Optional

from ..vectors import Vector, add, cross, dot, unit
from .shapes import Shape


@dataclass
class Edge:
    """From corner to corner: a line; a circle about ``centre``, counter-clockwise seen against ``axis``; or, where
    ``axis`` is None and there are points, a smooth curve through them with those directions."""

    start: int
    end: int
    centre: Optional[Vector] = None
    axis: Optional[Vector] = None
    radius: float = 0.0
    points: list[Vector] = field(default_factory=list)
    directions: list[Vector] = field(default_factory=list)


@dataclass
class Face:
    """Part of a shape; ``outwards``: its natural normal (a plane's own, away from an axis or a tube) leaves the
    material. Each loop has the face on its left seen from outside: numbers of edges and whether they go forwards."""

    shape: Shape
    outwards: bool
    loops: list[list[tuple[int, bool]]]


@dataclass
class Brep:
    """Solids as faces, edges and corners; ``shells``: faces that hang together; ``solids``: the outer shell of each and
    those of the hollows in it; ``inexact_mm``: by how much faces miss each other at edges, for the digits of the
    program."""

    corners: list[Vector]
    edges: list[Edge]
    faces: list[Face]
    shells: list[list[int]]
    solids: list[list[int]]
    inexact_mm: float

    #: How far the surface was found from it, at most, and where; mm.
    off_mm: float = 0.0
    off_at: Vector = (0.0, 0.0, 0.0)

    def along(self, edge: Edge, pieces: int) -> list[tuple[Vector, Vector]]:
        """Points of an edge from corner to corner, so many and one, or those that a curve has; and where it goes."""
        start, end = self.corners[edge.start], self.corners[edge.end]
        if edge.points:
            return list(zip(edge.points, edge.directions))
        if edge.axis is None or edge.centre is None:
            way = add(end, start, -1)
            return [(add(start, way, k / pieces), unit(way)) for k in range(pieces + 1)]
        u = add(start, edge.centre, -1)
        v, last = cross(edge.axis, u), add(end, edge.centre, -1)
        turn = 2 * math.pi if edge.start == edge.end else math.atan2(dot(last, v), dot(last, u)) % (2 * math.pi)
        outs = [add(add((0.0, 0.0, 0.0), u, math.cos(turn * k / pieces)), v, math.sin(turn * k / pieces))
                for k in range(pieces + 1)]
        return [(add(edge.centre, out), unit(cross(edge.axis, out))) for out in outs]
