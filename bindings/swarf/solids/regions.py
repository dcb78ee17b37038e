# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts of a mesh that lie on one shape: what each triangle is on, what hangs together, and how small mistakes about
edges and smooth joints are mended."""
from __future__ import annotations

import bisect
import math
from dataclasses import dataclass
from typing import Optional

from .._native import Mesh, Surface
from ..progress import TURNS, Report, check, share
from ..records import rows as rows_of
from ..vectors import Vector, add, cross, dot, middle
from ..wording import Said
from .shapes import Shape

#: mm; shapes that differ by less are one: what the digits of a program leave open.
SAME = 1e-4

#: In voxels: what lies within the first of a neighbour's shape and is narrower than the second was told wrongly; it is
#: the neighbour's.
NEAR, NARROW = 0.1, 1.0

#: How often what is left is looked at again.
ROUNDS = 20

#: Unknown regions that are wider than this, in voxels, are no mistakes about edges: mending would not help.
WIDE = 4.0

#: Shapes that a solid is made of in some seconds, and that CAD is glad to have.
SHAPES_MAX = 1000


class NotAnalytic(ValueError):
    """A stock that is not bounded by these faces alone, or whose edges are not found. ``share``: part of the area that
    lies on such faces."""

    def __init__(self, text: Said, share: float) -> None:
        super().__init__(text)
        self.said, self.share = text, share


class Ticks:
    """Progress of loops whose turns take microseconds: asked every some turns; Cancelled."""

    def __init__(self, progress: Report) -> None:
        self.progress, self.fraction, self.turns = progress, 0.0, 0

    def tick(self) -> None:
        """One turn."""
        self.turns += 1
        if self.turns % TURNS == 0:
            check(self.progress, self.fraction)


@dataclass
class Regions:
    """A mesh in parts; lists by region but for the first three."""

    vertices: list[Vector]
    triangles: list[list[int]]
    region_of: list[int]  #: of a triangle
    across: dict[tuple[int, int], int]  #: half-edge -> its triangle
    shape: list[Shape]
    outwards: list[bool]  #: whether its shape's gradient leaves the material
    shell: list[int]  #: pieces of surface that hang together
    known_share: float  #: of the area, on planes, cylinders, cones, spheres and tori
    unknown: list[Vector]  #: places where none of them is
    directions: float  #: by how much directions of one shape may differ
    mended: list[tuple[int, Shape]]  #: triangles that were given to a neighbour, and the shape that the surface has

    def same(self, one: Optional[Shape], other: Optional[Shape]) -> bool:
        """Whether two shapes are one, but for the digits of the program."""
        return one is not None and other is not None and one.is_same(other, SAME, self.directions)

    def outside(self, region: int, place: Vector) -> Vector:
        """Normal of a region out of the material, at a place on its shape."""
        gradient = self.shape[region].see(place)[1]
        return gradient if self.outwards[region] else add((0.0, 0.0, 0.0), gradient, -1)

    def compact(self) -> None:
        """Leave out regions without triangles."""
        kept = sorted(set(self.region_of))
        number = {region: k for k, region in enumerate(kept)}
        self.region_of[:] = [number[region] for region in self.region_of]
        self.shape[:] = [self.shape[region] for region in kept]
        self.outwards[:] = [self.outwards[region] for region in kept]
        self.shell[:] = [self.shell[region] for region in kept]

    def shell_mesh(self, shell: int) -> Mesh:
        """A piece of surface alone."""
        used = [triangle for triangle, region in zip(self.triangles, self.region_of) if self.shell[region] == shell]
        number = {vertex: k for k, vertex in enumerate(sorted({corner for triangle in used for corner in triangle}))}
        return Mesh([self.vertices[vertex] for vertex in number], [[number[v] for v in triangle] for triangle in used])

    def borders(self) -> dict[tuple[int, int], tuple[int, int]]:
        """Half-edges between regions: (the region on the left, that on the right)."""
        found = {}
        for (u, v), triangle in self.across.items():
            left, right = self.region_of[triangle], self.region_of[self.across[v, u]]
            if left != right:
                found[u, v] = left, right
        return found

    def loops(self) -> list[list[list[tuple[int, int]]]]:
        """Half-edges round each region, loop by loop."""
        borders = self.borders()
        found: list[list[list[tuple[int, int]]]] = [[] for _ in self.shape]
        left = dict.fromkeys(sorted(borders))
        while left:
            first = half = next(iter(left))
            loop = []
            while half in left:
                del left[half]
                loop.append(half)
                half = self._next(half)
            if half != first:
                raise NotAnalytic(Said("loops open"), self.known_share)
            found[borders[first][0]].append(loop)
        return found

    def _next(self, half: tuple[int, int]) -> tuple[int, int]:
        """The half-edge of a region's border that follows, turning about its end inside the region."""
        region = self.region_of[self.across[half]]
        u, v = half
        while True:
            a, b, c = self.triangles[self.across[u, v]]
            w = c if v == b else a if v == c else b
            if self.region_of[self.across[w, v]] != region:
                return v, w
            u = w


def _area(vertices: list[Vector], triangle: list[int]) -> Vector:
    """Twice the area of a triangle, along its normal."""
    a, b, c = (vertices[corner] for corner in triangle)
    return cross(add(b, a, -1), add(c, a, -1))


class _Parts:
    """Shapes of triangles, gathered and mended."""

    def __init__(self, mesh: Mesh, rows: list[list[float]], voxel: float, ticks: Ticks) -> None:
        self.voxel, self.ticks = voxel, ticks
        self.vertices: list[Vector] = [(x, y, z) for x, y, z in rows_of(mesh.vertices)]
        self.triangles: list[list[int]] = rows_of(mesh.triangles)
        self.across: dict[tuple[int, int], int] = {}
        for number, (a, b, c) in enumerate(self.triangles):
            self.across[a, b] = self.across[b, c] = self.across[c, a] = number
            ticks.tick()
        self.area = [math.hypot(*_area(self.vertices, triangle)) / 2 for triangle in self.triangles]
        lo, hi = mesh.bounding_box or ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        self.directions = SAME / max(math.dist(lo, hi), SAME)
        self.probe = add(lo, (0.37 * (hi[0] - lo[0]), 0.41 * (hi[1] - lo[1]), 0.43 * (hi[2] - lo[2])))
        self.by_distance: list[tuple[float, int]] = []  # of the probe from each shape; and the shape
        self.shapes: list[Optional[Shape]] = [None]  # the first is what is not known
        numbers: dict[tuple[float, ...], int] = {}
        self.shape_of = []
        for row in rows:
            key = tuple(row)
            if key not in numbers:
                numbers[key] = self._number(Shape.of_row(row)) if row[0] else 0
                if len(self.shapes) > SHAPES_MAX + 1:
                    known = sum(area for area, row in zip(self.area, rows) if row[0])
                    raise NotAnalytic(Said("too many shapes", most=SHAPES_MAX), known / sum(self.area))
            self.shape_of.append(numbers[key])
            ticks.tick()

    def _number(self, shape: Shape) -> int:
        """Its number; the same as that of a shape that it hardly differs from: those are as far from the probe."""
        away = abs(shape.see(self.probe)[0])
        begin = bisect.bisect_left(self.by_distance, (away - 8 * SAME, 0))
        end = bisect.bisect_left(self.by_distance, (away + 8 * SAME, 0))
        for number in sorted(number for _, number in self.by_distance[begin:end]):
            known = self.shapes[number]
            if known is not None and known.is_same(shape, SAME, self.directions):
                return number
            self.ticks.tick()
        self.shapes.append(shape)
        bisect.insort(self.by_distance, (away, len(self.shapes) - 1))
        return len(self.shapes) - 1

    def components(self) -> tuple[list[int], list[list[int]]]:
        """Region of each triangle, triangles of each region."""
        region_of = [-1] * len(self.triangles)
        members: list[list[int]] = []
        for first in range(len(self.triangles)):
            if region_of[first] >= 0:
                continue
            region_of[first] = len(members)
            found, at = [first], 0
            while at < len(found):
                self.ticks.tick()
                a, b, c = self.triangles[found[at]]
                for edge in ((b, a), (c, b), (a, c)):
                    other = self.across[edge]
                    if region_of[other] < 0 and self.shape_of[other] == self.shape_of[first]:
                        region_of[other] = len(members)
                        found.append(other)
                at += 1
            members.append(found)
        return region_of, members

    def fits(self, triangles: list[int], number: int) -> bool:
        """Whether triangles lie near a shape."""
        shape = self.shapes[number]
        corners = {corner for triangle in triangles for corner in self.triangles[triangle]}
        return shape is not None and all(abs(shape.see(self.vertices[corner])[0]) <= NEAR * self.voxel
                                         for corner in corners)

    def give(self, triangles: list[int], numbers: dict[int, float]) -> bool:
        """Give triangles to the shape beside them that fits, the one with the longest border first."""
        for number in sorted(numbers, key=lambda other: (-numbers[other], other)):
            if self.fits(triangles, number):
                for triangle in triangles:
                    self.shape_of[triangle] = number
                return True
        return False

    def given(self, own: list[int]) -> list[tuple[int, Shape]]:
        """Triangles that have another shape than their own, which is known."""
        shapes = ((triangle, self.shapes[number]) for triangle, number in enumerate(own)
                  if number != self.shape_of[triangle])
        return [(triangle, shape) for triangle, shape in shapes if shape is not None]

    def border(self, region: int, region_of: list[int], triangles: list[int]) -> dict[int, float]:
        """Length of a region's border by the shape beyond it."""
        border: dict[int, float] = {}
        own = self.shape_of[triangles[0]]
        for triangle in triangles:
            self.ticks.tick()
            a, b, c = self.triangles[triangle]
            for u, v in ((a, b), (b, c), (c, a)):
                other = self.shape_of[self.across[v, u]]
                if region_of[self.across[v, u]] != region and other != own:
                    border[other] = border.get(other, 0.0) + math.dist(self.vertices[u], self.vertices[v])
        return border

    def hopeless(self) -> bool:
        """Whether there is an unknown region that is too wide for mend()."""
        region_of, members = self.components()
        return any(
            2 * sum(self.area[triangle] for triangle in triangles)
            >= WIDE * self.voxel * sum(self.border(region, region_of, triangles).values())
            for region, triangles in enumerate(members) if self.shape_of[triangles[0]] == 0)

    def mend(self) -> bool:
        """Narrow regions that a neighbour's shape fits as well become its; whether there was any."""
        region_of, members = self.components()
        changed = False
        for region in sorted(range(len(members)), key=lambda one: sum(self.area[t] for t in members[one])):
            border = self.border(region, region_of, members[region])
            area = sum(self.area[triangle] for triangle in members[region])
            if border and 2 * area < NARROW * self.voxel * sum(border.values()):
                changed |= self.give(members[region], border)
        return changed

    def unpinch(self) -> bool:
        """Where two regions meet twice at a vertex, the smaller triangles there go over; whether there was any."""
        ways: dict[int, list[tuple[int, int]]] = {}
        for (u, v), triangle in self.across.items():
            self.ticks.tick()
            if self.shape_of[triangle] != self.shape_of[self.across[v, u]]:
                ways.setdefault(u, []).append((u, v))
        changed = False
        for vertex in sorted(ways):
            self.ticks.tick()
            fans = self._fans(vertex, ways[vertex])
            if len(fans) < 4 or len({self.shape_of[fan[0]] for fan in fans}) == len(fans):
                continue
            for fan in sorted(fans, key=lambda one: sum(self.area[t] for t in one)):
                beside = {self.shape_of[t]: 1.0 for other in fans for t in other[:1]
                          if self.shape_of[t] != self.shape_of[fan[0]]}
                twice = sum(self.shape_of[other[0]] == self.shape_of[fan[0]] for other in fans) > 1
                if twice and self.give(fan, beside):
                    changed = True
                    break
        return changed

    def _fans(self, vertex: int, ways: list[tuple[int, int]]) -> list[list[int]]:
        """Triangles about a vertex between borders."""
        fans = []
        for _, v in ways:
            fan, at = [], v
            while True:
                triangle = self.across[vertex, at]
                fan.append(triangle)
                a, b, c = self.triangles[triangle]
                at = c if vertex == a else a if vertex == b else b
                if (vertex, at) in ways:
                    break
            fans.append(fan)
        return fans


def _shells(region_of: list[int], across: dict[tuple[int, int], int], count: int) -> list[int]:
    """Number of the piece of surface of each region."""
    root = list(range(count))

    def top(one: int) -> int:
        while root[one] != one:
            root[one] = root[root[one]]
            one = root[one]
        return one

    for (u, v), triangle in across.items():
        a, b = top(region_of[triangle]), top(region_of[across[v, u]])
        root[max(a, b)] = min(a, b)
    return [top(one) for one in range(count)]


def find(mesh: Mesh, surface: Surface, voxel: float, moves: Optional[int] = None, progress: Report = None) -> Regions:
    """The regions of a closed mesh on a Surface. NotAnalytic where they are of too many shapes."""
    rows = rows_of(mesh.faces(surface, moves=moves, progress=share(progress, 0, 0.5)))
    ticks = Ticks(progress)
    ticks.fraction = 0.5
    parts = _Parts(mesh, rows, voxel, ticks)
    whole = sum(parts.area)
    own = list(parts.shape_of)
    for number in range(0 if parts.hopeless() else ROUNDS):
        ticks.fraction = 0.5 + 0.5 * number / ROUNDS
        check(progress, ticks.fraction)
        if not (parts.mend() | parts.unpinch()):
            break
    region_of, members = parts.components()
    shapes, outwards, unknown, lost = [], [], [], 0.0
    for triangles in members:
        shape = parts.shapes[parts.shape_of[triangles[0]]]
        area = sum(parts.area[triangle] for triangle in triangles)
        if shape is None:
            lost += area
            at = max(triangles, key=lambda triangle: parts.area[triangle])
            a, b, c = (parts.vertices[corner] for corner in parts.triangles[at])
            unknown.append(middle(a, b, c))
            continue
        way = 0.0
        for triangle in triangles:
            ticks.tick()
            a, b, c = (parts.vertices[corner] for corner in parts.triangles[triangle])
            way += dot(shape.see(middle(a, b, c))[1], _area(parts.vertices, parts.triangles[triangle]))
        shapes.append(shape)
        outwards.append(way > 0)
    if unknown:
        shapes, outwards = [], []
    return Regions(parts.vertices, parts.triangles, region_of, parts.across, shapes, outwards,
                   _shells(region_of, parts.across, len(members)), 1 - lost / whole if whole > 0 else 0.0, unknown,
                   parts.directions, parts.given(own))
