# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the regions of a mesh meet: borders between two of them, cut where more meet."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Optional, Sequence

from ..vectors import Vector, add, distance, dot
from .regions import Regions
from .shapes import Equations, meet, on, tangency

#: mm; what shapes that should meet may miss each other by: the last digits of programs are twice that, and an edge is
#: told to be as inexact as it is.
SLOPPY = 2e-3

#: Cosine of the angle from which on faces cross and do not touch, as far as the mesh can tell.
CROSSING = 0.8

#: In voxels: how far from the mesh shapes that cross at a flat angle may do so, and how near it both have to be.
FLAT, ALMOST = 40.0, 0.05


@dataclass
class Chain:
    """Mesh vertices from corner to corner, the left region's half-edges going along. ``touching``: its faces have one
    plane there, ``blade``: and opposite sides of it."""

    left: int
    right: int
    vertices: list[int]
    closed: bool
    touching: bool = False
    blade: bool = False


def find(regions: Regions) -> tuple[list[Chain], dict[tuple[int, int], tuple[int, bool]]]:
    """Borders between regions, cut where more than two of them meet; and of each half-edge of a border its chain and
    whether it goes forwards there."""
    borders = regions.borders()
    ways: dict[int, list[tuple[int, int]]] = {}
    for u, v in borders:
        ways.setdefault(u, []).append((u, v))
    corners = {vertex for vertex, out in ways.items() if len(out) != 2}
    chains: list[Chain] = []
    chain_of: dict[tuple[int, int], tuple[int, bool]] = {}
    for begin in sorted(corners) + sorted(ways):
        for first in ways[begin]:
            if first in chain_of or borders[first][0] > borders[first][1]:
                continue
            vertices, half = [first[0]], first
            while True:
                chain_of[half] = len(chains), True
                chain_of[half[1], half[0]] = len(chains), False
                vertices.append(half[1])
                if half[1] in corners or half[1] == first[0]:
                    break
                half = [way for way in ways[half[1]] if way[1] != half[0]][0]
            closed = vertices[0] == vertices[-1] and vertices[0] not in corners
            chains.append(Chain(*borders[first], vertices, closed))
    return chains, chain_of


def touch(regions: Regions, a: int, b: int, blade: bool = False) -> Equations:
    """That two regions go on smoothly into each other at a place; or back, as the two sides of a blade."""
    return tangency(regions.shape[a], regions.shape[b], (regions.outwards[a] == regions.outwards[b]) != blade)


def contact(regions: Regions, a: int, b: int, place: Vector, near: float) -> Optional[Equations]:
    """touch() where two regions do so within ``near`` (mm) of a place, None where they cross."""
    (_, first), (_, second) = (regions.shape[region].see(place) for region in (a, b))
    along = dot(first, second) if regions.outwards[a] == regions.outwards[b] else -dot(first, second)
    if along < CROSSING:
        return None
    found = meet([on(regions.shape[a]), on(regions.shape[b]), touch(regions, a, b)], place)
    touches = found is not None and found[1] < SLOPPY and distance(found[0], place) < near
    return touch(regions, a, b) if touches else None


def reached(wanted: Sequence[Equations], start: Vector, place: Vector, near: float, voxel: float) -> bool:
    """Whether a place is within ``near`` voxels of where it was looked for; shapes that cross at a flat angle do so
    farther from there, where their equations almost held."""
    off = distance(start, place) / voxel
    if off <= near or off > FLAT:
        return off <= near
    return all(abs(value) <= ALMOST * voxel for equation in wanted for value, _ in equation(start))


def middle(regions: Regions, chain: Chain) -> Vector:
    """A place in the middle of a chain."""
    place = regions.vertices[chain.vertices[len(chain.vertices) // 2]]
    if len(chain.vertices) > 2:
        return place
    other = regions.vertices[chain.vertices[0]]
    return add(other, add(place, other, -1), 0.5)
