# SPDX-License-Identifier: LGPL-2.1-or-later
"""Volume within a solid of analytic faces, by the theorem of Gauss: that of a third of the place through each face; and
that by the theorem of Stokes of what its flow is from a height or an angle of the face on, along its edges."""
from __future__ import annotations

import math
from typing import Callable, Iterator

from ..vectors import Vector, add, cross, dot, unit
from .shapes import CONE, CYLINDER, PLANE, SPHERE
from .topology import Brep, Edge, Face

#: Gauss' places and weights in 0 .. 1.
NODES = tuple((0.5 + side * at / 2, weight / 2) for at, weight in (
    (0.1834346424956498, 0.3626837833783620), (0.5255324099163290, 0.3137066458778873),
    (0.7966664774136267, 0.2223810344533745), (0.9602898564975363, 0.1012285362903763)) for side in (-1, 1))

#: Parts of a line or an arc; of circles about an axis the integral is exact but for digits, of others within 1e-8.
PARTS = 8

Step = tuple[Vector, Vector]  #: a place on an edge; and where it goes, as long as the part of the edge it stands for


def of(made: Brep) -> float:
    """Volume, mm3; a face that is left out, inside out, or ends elsewhere than its neighbours, changes it."""
    origin = made.corners[0]
    return sum(_flow(made, face, origin) for face in made.faces) / 3


def steps(made: Brep, edge: Edge) -> Iterator[Step]:
    """Places along an edge with their weights."""
    if edge.points:
        ends = zip(edge.points, edge.points[1:], edge.directions, edge.directions[1:])
        for a, b, first, last in ends:
            length = math.dist(a, b)
            yield from _cubic(a, b, add((0.0, 0.0, 0.0), first, length), add((0.0, 0.0, 0.0), last, length))
        return
    places = made.along(edge, PARTS)
    if edge.axis is None or edge.centre is None:
        for (a, _), (b, _) in zip(places, places[1:]):
            way = add(b, a, -1)
            yield from ((add(a, way, t), add((0.0, 0.0, 0.0), way, weight)) for t, weight in NODES)
        return
    u = add(places[0][0], edge.centre, -1)
    v, last = cross(edge.axis, u), add(places[-1][0], edge.centre, -1)
    turn = 2 * math.pi if edge.start == edge.end else math.atan2(dot(last, v), dot(last, u)) % (2 * math.pi)
    for part in range(PARTS):
        for t, weight in NODES:
            angle = turn * (part + t) / PARTS
            out = add(add((0.0, 0.0, 0.0), u, math.cos(angle)), v, math.sin(angle))
            yield add(edge.centre, out), add((0.0, 0.0, 0.0), cross(edge.axis, out), turn * weight / PARTS)


def _cubic(a: Vector, b: Vector, first: Vector, last: Vector) -> Iterator[Step]:
    """A piece of a curve, with its derivatives at both ends."""
    way = add(b, a, -1)
    for t, weight in NODES:
        place = add(add(add(a, way, t * t * (3 - 2 * t)), first, t * (1 - t) ** 2), last, -t * t * (1 - t))
        slope = add(add((0.0, 0.0, 0.0), way, 6 * t * (1 - t)), first, (1 - t) * (1 - 3 * t))
        yield place, add((0.0, 0.0, 0.0), add(slope, last, t * (3 * t - 2)), weight)


def _loops(made: Brep, face: Face) -> Iterator[Step]:
    for number, forwards in (one for loop in face.loops for one in loop):
        for place, way in steps(made, made.edges[number]):
            yield place, way if forwards else add((0.0, 0.0, 0.0), way, -1)


def _flow(made: Brep, face: Face, origin: Vector) -> float:
    """Of the place, seen from an origin, out of a face."""
    shape, sign = face.shape, 1 if face.outwards else -1
    if shape.kind == PLANE:
        twice = sum(dot(cross(add(place, shape.point, -1), way), shape.axis) for place, way in _loops(made, face))
        return dot(add(shape.point, origin, -1), shape.axis) * math.copysign(twice / 2, sign)
    axis = _axis(made, face) if shape.kind == SPHERE else shape.axis
    centre = add(shape.point, origin, -1)
    inner, turns, flow, area = _inner(made, face), 0.0, 0.0, 0.0
    for place, way in _loops(made, face):
        out = add(place, shape.point, -1)
        height = dot(out, axis)
        across = add(out, axis, -height)
        rho = math.hypot(*across)
        if rho < 1e-9:  # an edge through an apex: it goes straight on
            continue
        away = unit(across)
        turn = dot(cross(axis, away), way) / rho
        turns += turn
        up, covered = inner(height, rho, dot(centre, away), dot(centre, axis))
        flow -= up * turn
        area -= covered * turn
    if shape.kind != SPHERE:
        return flow if sign * area > 0 else -flow
    poles = {1: (1,), -1: (-1,), 0: () if sign * area > 0 else (1, -1)}.get(round(sign * turns / (2 * math.pi)), ())
    for pole in poles:  # those in the face, about which the angle turns
        up, _ = inner(pole * shape.radius, 0.0, 0.0, dot(centre, axis))
        flow += sign * pole * 2 * math.pi * up
    return flow


def _axis(made: Brep, face: Face) -> Vector:
    """Of a sphere: poles far from its edges."""
    ways = [unit(add(place, face.shape.point, -1)) for loop in face.loops for number, _ in loop
            for place, _ in made.along(made.edges[number], PARTS)]
    turned = (unit((math.cos(3.7 * k), math.sin(3.7 * k), 2 * (k + 0.5) / 60 - 1)) for k in range(60))
    return min(turned, key=lambda axis: max(abs(dot(axis, way)) for way in ways))


def _inner(made: Brep, face: Face) -> Callable[[float, float, float, float], tuple[float, float]]:
    """By height, distance from the axis, and the centre along the way out and along the axis: what flows through the
    face and what is covered of it below there, for each radian."""
    shape = face.shape
    r, k = shape.radius, shape.second
    if shape.kind == CYLINDER:
        return lambda h, rho, out, along: (r * (out + r) * h, r * h)
    if shape.kind == CONE:
        def cone(h: float, rho: float, out: float, along: float) -> tuple[float, float]:
            square = k * h * abs(h) / 2
            return (out - math.copysign(k, h) * along) * square, math.hypot(1, k) * square
        return cone
    if shape.kind == SPHERE:
        def sphere(h: float, rho: float, out: float, along: float) -> tuple[float, float]:
            tilt = (h * rho / r + r * math.atan2(h, rho)) / 2
            return r * (along * h * h / (2 * r) + out * tilt + r * h), r * h
        return sphere
    cut = _cut(made, face)

    def torus(h: float, rho: float, out: float, along: float) -> tuple[float, float]:
        phi = (math.atan2(h, rho - r) - cut) % (2 * math.pi) + cut
        s, c, a = math.sin(phi), math.cos(phi), out + r
        flow = r * (a * s - along * c + k * phi) + k * (a * (phi + s * c) / 2 + along * s * s / 2 + k * s)
        return k * flow, k * (r * phi + k * s)
    return torus


def _cut(made: Brep, face: Face) -> float:
    """An angle about a torus' tube in the middle of where there are no edges."""
    shape, found = face.shape, []
    for place, _ in _loops(made, face):
        out = add(place, shape.point, -1)
        height = dot(out, shape.axis)
        rho = math.hypot(*add(out, shape.axis, -height))
        found.append(math.atan2(height, rho - shape.radius))
    found.sort()
    gaps = [(b - a, a) for a, b in zip(found, [*found[1:], found[0] + 2 * math.pi])]
    gap, begin = max(gaps)
    return begin + gap / 2
