# SPDX-License-Identifier: LGPL-2.1-or-later
"""The surface's answer to what shape it has somewhere."""
from __future__ import annotations

import math
from typing import Optional, Sequence

from .._native import Mesh, Surface
from ..progress import Report
from ..records import rows
from ..vectors import Vector, add, cross, unit
from .shapes import Shape

#: In voxels: how far the surface may lie above or below a place.
DEEP = 0.5

#: In voxels: from the middle to the corners of the triangles that ask.
SMALL = 0.01


def ask(surface: Surface, places: Sequence[tuple[Vector, Vector]], voxel: float, moves: Optional[int],
        progress: Report = None) -> list[Optional[Shape]]:
    """The shape that the surface has at each place, looked for along a normal; None where none is near."""
    vertices: list[Vector] = []
    for place, normal in places:
        u = unit(cross(normal, (1.0, 0.0, 0.0) if abs(normal[0]) < 0.6 else (0.0, 1.0, 0.0)))
        v = cross(normal, u)
        for angle in (0.0, 2 * math.pi / 3, 4 * math.pi / 3):
            corner = add(add(place, u, SMALL * voxel * math.cos(angle)), v, SMALL * voxel * math.sin(angle))
            vertices.append(corner)
    mesh = Mesh(vertices, [(k, k + 1, k + 2) for k in range(0, len(vertices), 3)])
    found = mesh.faces(surface, moves=moves, reach=DEEP * voxel, progress=progress)
    return [Shape.of_row(row) if row[0] else None for row in rows(found)]
