# SPDX-License-Identifier: LGPL-2.1-or-later
"""Endless faces, as rows of Mesh.faces() tell of them: how far a point is, where several of them meet."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Callable, Optional, Sequence

from ..vectors import Vector, add, cross, dot, unit

PLANE, CYLINDER, CONE, SPHERE, TORUS = range(1, 6)

#: Steps of a search for a point that lies on several faces; from within a voxel it takes about five.
STEPS = 40

#: mm; a step that is shorter is the last.
SETTLED = 1e-11

#: Damping, as a part of the system: what the faces leave open (the way along an edge) stays as it is.
DAMPING = 1e-9


@dataclass(frozen=True)
class Shape:
    """An endless face; see Mesh.faces()."""

    kind: int
    point: Vector
    axis: Vector
    radius: float
    second: float

    @classmethod
    def of_row(cls, row: Sequence[float]) -> Shape:
        """Of a row of Mesh.faces()."""
        kind, x, y, z, u, v, w, radius, second = row
        return cls(int(kind), (x, y, z), (u, v, w), radius, second)

    def see(self, place: Vector) -> tuple[float, Vector]:
        """Signed distance of a place and its gradient: along a plane's normal, away from an axis, a centre, a tube. On
        an axis, where the gradient is none, it is 0."""
        e = add(place, self.point, -1)
        if self.kind == SPHERE:
            return math.hypot(*e) - self.radius, unit(e)
        h = dot(e, self.axis)
        if self.kind == PLANE:
            return h, self.axis
        across = add(e, self.axis, -h)
        rho, away = math.hypot(*across), unit(across)
        if self.kind == CYLINDER:
            return rho - self.radius, away
        if self.kind == CONE:
            length = math.hypot(1, self.second)
            side = math.copysign(self.second, h)
            gradient = add((0.0, 0.0, 0.0), away, 1 / length)
            return (rho - side * h) / length, add(gradient, self.axis, -side / length)
        out = add(add((0.0, 0.0, 0.0), away, rho - self.radius), self.axis, h)
        return math.hypot(*out) - self.second, unit(out)

    def is_same(self, other: Shape, lengths: float, directions: float) -> bool:
        """Whether it is the other one within a tolerance of lengths (mm) and of directions."""
        if self.kind != other.kind or abs(self.radius - other.radius) > lengths:
            return False
        between = add(other.point, self.point, -1)
        if self.kind == SPHERE:
            return math.hypot(*between) <= lengths
        if math.hypot(*cross(self.axis, other.axis)) > directions:
            return False
        along = dot(between, self.axis)
        if self.kind == PLANE:
            return abs(along) <= lengths
        off = math.hypot(*add(between, self.axis, -along))
        if self.kind == CYLINDER:
            return off <= lengths
        tolerance = directions if self.kind == CONE else lengths
        return off <= lengths and abs(along) <= lengths and abs(self.second - other.second) <= tolerance


#: Equations: values and their gradients at a place, wanted to be 0.
Equations = Callable[[Vector], list[tuple[float, Vector]]]


def on(shape: Shape) -> Equations:
    """That a place is on a shape."""
    return lambda place: [shape.see(place)]


def tangency(a: Shape, b: Shape, same_way: bool) -> Equations:
    """That two faces have one normal (or opposite ones) at a place: they touch there, and do not cross."""
    sign = -1.0 if same_way else 1.0

    def difference(place: Vector) -> Vector:
        return add(a.see(place)[1], b.see(place)[1], sign)

    def see(place: Vector) -> list[tuple[float, Vector]]:
        here, step = difference(place), 1e-5
        slopes = []
        for way in ((step, 0.0, 0.0), (0.0, step, 0.0), (0.0, 0.0, step)):
            change = add(difference(add(place, way)), difference(add(place, way, -1)), -1)
            slopes.append((change[0] / (2 * step), change[1] / (2 * step), change[2] / (2 * step)))
        return [(here[k], (slopes[0][k], slopes[1][k], slopes[2][k])) for k in range(3)]

    return see


def meet(equations: Sequence[Equations], start: Vector) -> Optional[tuple[Vector, float]]:
    """The place near `start` where all equations hold best, and what is left of them; by Gauss and Newton, along what
    they leave open it stays. None where there is none in reach."""
    place = start
    for _ in range(STEPS):
        rows = [row for equation in equations for row in equation(place)]
        matrix = [[sum(g[i] * g[j] for _, g in rows) for j in range(3)] for i in range(3)]
        wanted = (-sum(g[0] * value for value, g in rows), -sum(g[1] * value for value, g in rows),
                  -sum(g[2] * value for value, g in rows))
        damping = DAMPING * (matrix[0][0] + matrix[1][1] + matrix[2][2])
        a, b, c = ((row[0] + damping * (i == 0), row[1] + damping * (i == 1), row[2] + damping * (i == 2))
                   for i, row in enumerate(matrix))
        whole = dot(a, cross(b, c))
        if whole == 0:
            return None
        step = (dot(wanted, cross(b, c)) / whole, dot(a, cross(wanted, c)) / whole, dot(a, cross(b, wanted)) / whole)
        place = add(place, step)
        if not all(map(math.isfinite, place)):
            return None
        if math.hypot(*step) < SETTLED:
            break
    return place, max(abs(value) for equation in equations for value, _ in equation(place))
