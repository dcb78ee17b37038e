# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces narrower than the voxels, which the mesh bridges or has in parts: the surface is asked along lines across each
chain, and where it has a third face between the two the regions are opened there. Corners that four or more regions
have together but the surface has not become two. Which edges and corners there are is all that is made here; where
they lie is solved on the shapes."""
from __future__ import annotations

from typing import Optional, Sequence

from .._native import Surface
from ..progress import Report, check, share, told
from ..vectors import Vector, add, cross, distance, dot, unit
from . import chains, opening
from .chains import SLOPPY, Chain
from .opening import Fan
from .probe import ask
from .regions import Regions
from .shapes import Equations, Shape, meet, on

#: In voxels: how far to both sides the surface is asked, and how closely.
REACH, STEP = 1.5, 0.06

#: In voxels: how far a vertex of the mesh may be from what is solved for it.
OFF = 2.5

#: How often it is looked for more: of several strips beside each other one is found at a time.
ROUNDS = 20

#: Edges of a chain across which the surface is asked.
ASKED = 3


class _Mender:
    """Regions in which strips are looked for."""

    def __init__(self, regions: Regions, surface: Surface, voxel: float, moves: Optional[int]) -> None:
        self.regions, self.surface, self.voxel, self.moves = regions, surface, voxel, moves
        self.kept: set[tuple[int, ...]] = set()  # corners that were looked at: the vertex and the regions about it

    def place(self, beside: Sequence[int], vertex: int) -> Optional[Vector]:
        """Where regions meet near a vertex, and touch where they touch there."""
        start = self.regions.vertices[vertex]
        wanted: list[Equations] = [on(self.regions.shape[region]) for region in beside]
        for number, a in enumerate(beside):
            touching = (chains.contact(self.regions, a, b, start, OFF * self.voxel) for b in beside[:number])
            wanted += [touch for touch in touching if touch is not None]
        found = meet(wanted, start)
        if found is None or found[1] > SLOPPY or not chains.reached(wanted, start, found[0], OFF, self.voxel):
            return None
        return found[0]

    # ---- strips ----

    def line(self, chain: Chain, first: int) -> list[tuple[Vector, Vector]]:
        """Places and normals across the middle of a chain's edge, from the left to the right."""
        a, b = (self.regions.vertices[chain.vertices[k]] for k in (first, first + 1))
        place, way = add(a, add(b, a, -1), 0.5), unit(add(b, a, -1))
        count = round(REACH / STEP)
        found = []
        for step in range(-count, count + 1):
            normal = self.regions.outside(chain.left if step < 0 else chain.right, place)
            found.append((add(place, unit(cross(normal, way)), -step * STEP * self.voxel), normal))
        return found

    def between(self, chain: Chain, shapes: Sequence[Optional[Shape]]) -> Optional[Shape]:
        """The first other shape between the two of a chain along a line across it."""
        left, right = self.regions.shape[chain.left], self.regions.shape[chain.right]
        is_left = [self.regions.same(shape, left) for shape in shapes]
        begin = max((k for k in range(len(shapes) // 2 + 1) if is_left[k]), default=None)
        if begin is None:
            return None
        while begin + 1 < len(shapes) and is_left[begin + 1]:
            begin += 1
        end = next((k for k in range(begin + 1, len(shapes)) if self.regions.same(shapes[k], right)), begin + 1)
        return None if end == begin + 1 else shapes[begin + 1]

    def missing(self, found: Sequence[Chain], progress: Report) -> list[tuple[Chain, Shape]]:
        """Chains along most of which there is a strip, and its shape."""
        edges = [(chain, k) for chain in found for k in _some(len(chain.vertices) - 1)]
        lines = [self.line(chain, k) for chain, k in told(edges, len(edges), share(progress, 0, 0.3))]
        shapes = ask(self.surface, [place for line in lines for place in line], self.voxel, self.moves,
                     share(progress, 0.3, 1)) if lines else []
        seen: dict[int, list[tuple[float, Optional[Shape]]]] = {}
        for number, ((chain, k), line) in enumerate(zip(edges, lines)):
            a, b = (self.regions.vertices[chain.vertices[j]] for j in (k, k + 1))
            shape = self.between(chain, shapes[number * len(line):(number + 1) * len(line)])
            seen.setdefault(id(chain), []).append((distance(a, b), shape))
        result = []
        for chain in found:
            _, shape = max(seen[id(chain)], key=lambda one: (one[1] is not None, one[0]))
            along = sum(length for length, other in seen[id(chain)] if self.regions.same(other, shape))
            if shape is not None and 2 * along > sum(length for length, _ in seen[id(chain)]):
                result.append((chain, shape))
        return result

    def number(self, chain: Chain, shape: Shape, fans: Sequence[Fan]) -> int:
        """Region of a strip: that which it goes on from at its ends, else a new one."""
        regions = self.regions
        known = sorted({region for fan in fans for region in (regions.region_of[triangle] for triangle, _ in fan)
                        if regions.same(regions.shape[region], shape)})
        if known:
            opening.join(regions, known)
            return known[0]
        place = chains.middle(regions, chain)
        normal = add(regions.outside(chain.left, place), regions.outside(chain.right, place))
        regions.shape.append(shape)
        regions.outwards.append(dot(shape.see(place)[1], normal) > 0)
        regions.shell.append(regions.shell[chain.left])
        return len(regions.shape) - 1

    def end(self, chain: Chain, vertex: int, strip: int, fan: Fan) -> Optional[tuple[Fan, int, int]]:
        """At an end of a chain: its fan, how many triangles of that go to the right side, and the region that the
        strip ends at; None where there is no other region."""
        best: Optional[tuple[float, tuple[Fan, int, int]]] = None
        for begin, region in _runs(self.regions, fan)[1:]:
            if region == strip:
                return fan, begin, region
            if region in (chain.left, chain.right):
                continue
            places = [self.place((side, strip, region), vertex) for side in (chain.left, chain.right)]
            off = sum(OFF * self.voxel if place is None else distance(place, self.regions.vertices[vertex])
                      for place in places)
            if best is None or off < best[0]:
                best = off, (fan, begin, region)
        return None if best is None else best[1]

    def is_wide(self, chain: Chain, strip: int) -> bool:
        """Whether the edges of a strip are apart in the middle of its chain."""
        vertex = chain.vertices[len(chain.vertices) // 2]
        a, b = (self.place((side, strip), vertex) for side in (chain.left, chain.right))
        return a is None or b is None or distance(a, b) > 2 * SLOPPY

    def open(self, chain: Chain, shape: Shape) -> bool:
        """Put a strip in along a chain; whether there is one."""
        path, vertices = chain.vertices, self.regions.vertices
        tips = [] if chain.closed else [path[0], path[-1]]
        fans = [opening.turn(self.regions, path[0], path[1]),
                opening.turn(self.regions, path[-1], path[-2], clockwise=False)] if tips else []
        strip = self.number(chain, shape, fans)
        if strip in (chain.left, chain.right) or not self.is_wide(chain, strip):
            return False
        ends = [end for tip, fan in zip(tips, fans) if (end := self.end(chain, tip, strip, fan)) is not None]
        if len(ends) < len(tips):
            return False
        beyond = {tip: (region,) for tip, (_, _, region) in zip(tips, ends) if region != strip}
        for vertex, other in opening.along(self.regions, chain, strip, ends).items():
            for side, moved in ((chain.left, vertex), (chain.right, other)):
                place = self.place((side, strip, *beyond.get(vertex, ())), moved)
                vertices[moved] = vertices[moved] if place is None else place
        return True

    # ---- corners ----

    def split(self, vertex: int, start: int) -> bool:
        """Make two corners of one in which four or more regions meet that have no point together: two of those, not
        beside each other there, get an edge, or are one. Whether it was done."""
        regions = self.regions
        fan = opening.turn(regions, vertex, start)
        runs = _runs(regions, fan)
        around = [region for _, region in runs]
        if len(runs) < 4 or (vertex, *around) in self.kept:
            return False
        self.kept.add((vertex, *around))
        if self.place(list(dict.fromkeys(around)), vertex) is not None:
            return False
        best: Optional[tuple[tuple[bool, float], tuple[int, int], tuple[Vector, Vector]]] = None
        for i in range(len(runs)):
            for j in range(i + 2, min(len(runs), i + len(runs) - 1)):
                joined = regions.same(regions.shape[around[i]], regions.shape[around[j]])
                ends = (around[i],) if joined else (around[i], around[j])
                outer = self.place((*ends, *around[j + 1:], *around[:i]), vertex)
                inner = self.place((*ends, *around[i + 1:j]), vertex)
                if outer is None or inner is None:
                    continue
                off = distance(outer, regions.vertices[vertex]) + distance(inner, regions.vertices[vertex])
                if best is None or (not joined, off) < best[0]:
                    best = (not joined, off), (i, j), (outer, inner)
        if best is None:
            return False
        _, (i, j), (outer, inner) = best
        end = runs[j + 1][0] if j + 1 < len(runs) else len(fan)
        other = opening.corner(regions, vertex, fan, runs[i + 1][0], end, (around[i], around[j]))
        regions.vertices[vertex], regions.vertices[other] = outer, inner
        if regions.same(regions.shape[around[i]], regions.shape[around[j]]):
            opening.join(regions, (around[i], around[j]))
        return True

    def drop_point(self, found: Sequence[Chain]) -> bool:
        """Give a region all of whose corners are one point to what it has the longest border with: triangles that cut
        off a corner have the shape of what is beyond it. Whether there was one."""
        beside: dict[int, list[Chain]] = {}
        meeting: dict[int, set[int]] = {}
        for chain in found:
            for region in (chain.left, chain.right):
                beside.setdefault(region, []).append(chain)
            for vertex in () if chain.closed else _tips(chain):
                meeting.setdefault(vertex, set()).update((chain.left, chain.right))
        for region, around in sorted(beside.items()):
            if not any(chain.closed for chain in around) and self.is_point(around, meeting):
                lengths: dict[int, float] = {}
                for chain in around:
                    other = chain.left if chain.right == region else chain.right
                    lengths[other] = lengths.get(other, 0.0) + self.length(chain)
                opening.join(self.regions, (max(sorted(lengths), key=lambda other: lengths[other]), region))
                return True
        return False

    def is_point(self, around: Sequence[Chain], meeting: dict[int, set[int]]) -> bool:
        """Whether the corners between chains, which are near each other, are one."""
        first, *others = (self.regions.vertices[vertex] for chain in around for vertex in chain.vertices)
        if any(distance(first, other) > OFF * self.voxel for other in others):
            return False
        places = [self.place(sorted(meeting[vertex]), vertex) for chain in around for vertex in _tips(chain)]
        return all(a is not None and b is not None and distance(a, b) <= SLOPPY for a, b in zip(places, places[1:]))

    def length(self, chain: Chain) -> float:
        """Of a chain in the mesh."""
        places = [self.regions.vertices[vertex] for vertex in chain.vertices]
        return sum(distance(a, b) for a, b in zip(places, places[1:]))


def _some(count: int) -> list[int]:
    """A few of the numbers below one, evenly."""
    return sorted({count * (2 * k + 1) // (2 * ASKED) for k in range(ASKED)})


def _tips(chain: Chain) -> tuple[int, int]:
    return chain.vertices[0], chain.vertices[-1]


def _runs(regions: Regions, fan: Fan) -> list[tuple[int, int]]:
    """Regions about a vertex, each with where its triangles begin in a fan that begins at a border."""
    order = [regions.region_of[triangle] for triangle, _ in fan]
    return [(k, region) for k, region in enumerate(order) if k == 0 or order[k - 1] != region]


def mend(regions: Regions, surface: Surface, voxel: float, moves: Optional[int] = None,
         progress: Report = None) -> None:
    """Open regions where the surface has faces that the mesh has not. Cancelled."""
    mender = _Mender(regions, surface, voxel, moves)
    asked: set[tuple[int, ...]] = set()
    for number in range(ROUNDS):
        report = share(progress, number / ROUNDS, (number + 1) / ROUNDS)
        check(report, 0.0)
        found = [chain for chain in chains.find(regions)[0] if tuple(chain.vertices) not in asked]
        asked.update(tuple(chain.vertices) for chain in found)
        changed: set[int] = set()
        missing = mender.missing(found, share(report, 0, 0.6))
        for chain, shape in told(missing, len(missing), share(report, 0.6, 0.8)):
            if not changed.isdisjoint(chain.vertices):
                asked.remove(tuple(chain.vertices))
            elif mender.open(chain, shape):
                changed.update(chain.vertices)
        found = chains.find(regions)[0]
        for chain in told(found, len(found), share(report, 0.8, 1)):
            for vertex, start in () if chain.closed else (chain.vertices[:2], chain.vertices[:-3:-1]):
                if changed.isdisjoint((vertex, start)) and mender.split(vertex, start):
                    changed.update((vertex, start))
        if not changed and not mender.drop_point(found):
            break
    regions.compact()
