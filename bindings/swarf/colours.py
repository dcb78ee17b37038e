# SPDX-License-Identifier: LGPL-2.1-or-later
"""Colours of a mesh's triangles: by operation, by deviation from the design, by wall thickness. Rows of (r, g, b)."""
from __future__ import annotations

import array
import math
from typing import Any, Optional, Sequence

from ._native import Mesh, Solid, Surface, deviation_colours
from .job import Job
from .progress import Report, share, told
from .records import MOVE, SECTION, rows, section_and_kind

KINDS = ("operation", "deviation", "thickness")

RGB = tuple[int, int, int]

#: Told apart by most colour-blind people when neighbours in this order (after Okabe and Ito), on light and dark.
OPERATIONS: Sequence[RGB] = ((61, 143, 209), (230, 159, 0), (42, 168, 118), (204, 111, 166), (213, 94, 0),
                             (123, 127, 212), (163, 161, 41), (80, 183, 201))

#: Of what no move made, and of what an earlier set-up made: bare and milled aluminium.
FIRST_SHAPE: RGB = (188, 193, 199)
EARLIER: RGB = (150, 158, 168)

#: Least to greatest of a scale: thin is red, thick is blue.
STOPS: Sequence[RGB] = ((184, 18, 31), (245, 133, 41), (252, 222, 102), (107, 204, 237), (41, 46, 158))

#: Points whose distance is asked for at once: enough for all cores, a moment for who cancels.
MIDDLES = 65536

#: What deviations are tinted on: about as light as a face towards the viewer.
LIT = (225, 225, 225, 255)


def _edges(triangle: Sequence[int]) -> list[tuple[int, int]]:
    a, b, c = triangle
    return [(min(edge), max(edge)) for edge in ((a, b), (b, c), (c, a))]


def _fill(mesh: Mesh, colours: list[Optional[RGB]], otherwise: RGB, progress: Report) -> list[RGB]:
    """Triangles without a colour (slivers, whose normals may be any) take that of a neighbour, as far as it reaches."""
    unknown = [index for index, colour in enumerate(colours) if colour is None]
    triangles = rows(mesh.triangles) if unknown else []
    beside: dict[tuple[int, int], list[int]] = {edge: [] for index in unknown for edge in _edges(triangles[index])}
    for index, triangle in told(enumerate(triangles), len(triangles), progress):
        for edge in _edges(triangle):
            if edge in beside:
                beside[edge].append(index)
    while unknown:
        known: dict[int, RGB] = {}
        for index in unknown:
            for edge in _edges(triangles[index]):
                near = [colours[other] for other in beside[edge] if colours[other] is not None]
                if near and near[0] is not None:
                    known[index] = near[0]
                    break
        if not known:
            break
        for index, colour in known.items():
            colours[index] = colour
        unknown = [index for index in unknown if index not in known]
    return [otherwise if colour is None else colour for colour in colours]


def by_operation(mesh: Mesh, surface: Surface, job: Job, moves: Optional[int] = None,
                 progress: Report = None) -> list[RGB]:
    """A colour for each operation of the job, one for all earlier set-ups, one for what no move made. Cancelled."""
    records, sections = job.program.moves, job.program.sections
    colours: list[Optional[RGB]] = []
    origins = rows(mesh.origins(surface, moves=moves, progress=share(progress, 0, 0.5)))
    for set_up, move, *_ in told(origins, len(origins), share(progress, 0.5, 0.75)):
        if move == -2:
            colours.append(None)
        elif move < 0 or set_up:
            colours.append(FIRST_SHAPE if move < 0 else EARLIER)
        else:
            *_, section_kind = MOVE.unpack_from(records, move * MOVE.size)
            operation = SECTION.unpack_from(sections, section_and_kind(section_kind)[0] * SECTION.size)[1]
            colours.append(OPERATIONS[operation % len(OPERATIONS)])
    return _fill(mesh, colours, FIRST_SHAPE, share(progress, 0.75, 1))


def by_deviation(mesh: Mesh, design: Mesh, tolerance: float, progress: Report = None, *,
                 allowance: float = 0.0) -> list[RGB]:
    """Green within the tolerance (mm) of the design and the allowance that is meant to be left on it, by yellow to red
    where more is left, by cyan to blue where less; of the middles of the triangles. Cancelled."""
    if not mesh.triangle_count:
        return []
    vertices, triangles = rows(mesh.vertices), rows(mesh.triangles)
    solid = Solid(design, progress=share(progress, 0, 0.2))
    values, middles = array.array("d"), []
    for a, b, c in told(triangles, len(triangles), share(progress, 0.2, 0.9)):
        middles.append([sum(corner) / 3 for corner in zip(vertices[a], vertices[b], vertices[c])])
        if len(middles) == MIDDLES:
            values.extend(solid.distance(middles))
            middles.clear()
    if middles:
        values.extend(solid.distance(middles))
    values = array.array("d", (value - allowance for value in values))
    table = memoryview(values).cast("B").cast("d", (len(values), 1))
    tinted = deviation_colours(table, bytes(LIT) * len(values), tolerance)
    return [(tinted[i], tinted[i + 1], tinted[i + 2]) for i in range(0, len(tinted), 4)]


def by_thickness(mesh: Mesh, most: Optional[float] = None, progress: Report = None) -> list[RGB]:
    """Red where the wall is thinnest to blue where it is ``most`` mm or more (None: half the greatest extent).
    Cancelled."""
    values = mesh.thickness(progress=share(progress, 0, 0.8))
    box = mesh.bounding_box
    if most is None:
        most = max(hi - lo for lo, hi in zip(*box)) / 2 if box else 1.0
    return [_scale(value / most) for value in told(values, len(values), share(progress, 0.8, 1))]


def _scale(part: float) -> RGB:
    place = min(max(part, 0.0), 1.0) * (len(STOPS) - 1) if not math.isinf(part) else len(STOPS) - 1.0
    low = min(int(place), len(STOPS) - 2)
    r, g, b = (round(a + (place - low) * (b - a)) for a, b in zip(STOPS[low], STOPS[low + 1]))
    return r, g, b


def check(kind: str, job: Any) -> None:
    """ValueError unless it is one of KINDS, and the job has the design that it may need."""
    if kind not in KINDS:
        raise ValueError(f"colours {kind!r}: wanted {', '.join(KINDS)}")
    if kind == "deviation" and job.design is None:
        raise ValueError(f"{job.name}: colours by deviation need a design, and the job has none")


def make(kind: str, mesh: Mesh, surface: Optional[Surface], job: Any, tolerance: float = 0.05,
         progress: Report = None, *, allowance: float = 0.0) -> list[RGB]:
    """Colours of one of KINDS of the mesh of a simulated job. ValueError where what it needs is missing; Cancelled."""
    check(kind, job)
    if kind == "operation":
        if surface is None:
            raise ValueError("colours by operation need the exact surface")
        return by_operation(mesh, surface, job, progress=progress)
    if kind == "deviation":
        return by_deviation(mesh, job.design, tolerance, progress, allowance=allowance)
    return by_thickness(mesh, progress=progress)
