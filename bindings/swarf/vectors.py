# SPDX-License-Identifier: LGPL-2.1-or-later
"""Places and directions in space."""
from __future__ import annotations

import math

Vector = tuple[float, float, float]


def add(a: Vector, b: Vector, times: float = 1.0) -> Vector:
    """a + times * b."""
    return a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2]


def dot(a: Vector, b: Vector) -> float:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """Vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def middle(a: Vector, b: Vector, c: Vector) -> Vector:
    """Of a triangle."""
    return (a[0] + b[0] + c[0]) / 3, (a[1] + b[1] + c[1]) / 3, (a[2] + b[2] + c[2]) / 3


def distance(a: Vector, b: Vector) -> float:
    """Of two points."""
    return math.dist(a, b)


def unit(a: Vector) -> Vector:
    """Of length 1; of no length it stays."""
    length = math.hypot(*a)
    return (a[0] / length, a[1] / length, a[2] / length) if length > 0 else a
