# SPDX-License-Identifier: LGPL-2.1-or-later
"""A mesh in regions is opened, so that more regions meet where it had too few vertices: along a chain, or in a corner.

           a --- a --- a              the region on the left
      d   /|  /  |  /  |\\   e         new triangles; at each end one more of the region there, d and e
           b --- b --- b              that on the right"""
from __future__ import annotations

from typing import Sequence

from .chains import Chain
from .regions import Regions

#: Triangles about a vertex, each with the vertex at the far one of its edges.
Fan = list[tuple[int, int]]


def turn(regions: Regions, vertex: int, start: int, clockwise: bool = True) -> Fan:
    """All triangles about a vertex, from its edge to ``start`` on."""
    fan: Fan = []
    at = start
    while not fan or at != start:
        triangle = regions.across[(at, vertex) if clockwise else (vertex, at)]
        at = next(corner for corner in regions.triangles[triangle] if corner not in (vertex, at))
        fan.append((triangle, at))
    return fan


def along(regions: Regions, chain: Chain, strip: int, ends: Sequence[tuple[Fan, int, int]]) -> dict[int, int]:
    """Put a strip in along a chain. ``ends``, none where it is closed: for its first vertex the fan clockwise, for its
    last the other one, how many of its triangles go to the right side, and the region that the strip ends at there.
    The vertices on the right side by those on the left."""
    path = chain.vertices
    tips = [] if chain.closed else [path[0], path[-1]]
    right = {tip: [triangle for triangle, _ in fan[:count]] for tip, (fan, count, _) in zip(tips, ends)}
    ring = path[-2:-1] + path if chain.closed else path
    for before, vertex, after in zip(ring, ring[1:], ring[2:]):
        fan = turn(regions, vertex, after)
        stop = next(k for k, (_, at) in enumerate(fan) if at == before)
        right[vertex] = [triangle for triangle, _ in fan[:stop + 1]]
    other = {vertex: _double(regions, vertex, triangles) for vertex, triangles in right.items()}
    for a, b in zip(path, path[1:]):
        _put(regions, (b, a, other[a]), strip)
        _put(regions, (b, other[a], other[b]), strip)
    for number, (tip, (fan, count, region)) in enumerate(zip(tips, ends)):
        far = fan[count - 1][1]
        _put(regions, (tip, other[tip], far) if number else (other[tip], tip, far), region)
    return other


def corner(regions: Regions, vertex: int, fan: Fan, begin: int, end: int, beside: tuple[int, int]) -> int:
    """Give the triangles begin .. end - 1 of a fan (clockwise) a vertex of their own, which is returned, and put
    triangles of two regions in before and after them."""
    before, after = fan[begin - 1][1], fan[end - 1][1]
    other = _double(regions, vertex, [triangle for triangle, _ in fan[begin:end]])
    _put(regions, (vertex, other, before), beside[0])
    _put(regions, (other, vertex, after), beside[1])
    return other


def join(regions: Regions, several: Sequence[int]) -> None:
    """Make one region of several, with the number of the first."""
    gone = set(several[1:])
    for triangle, region in enumerate(regions.region_of):
        if region in gone:
            regions.region_of[triangle] = several[0]


def _double(regions: Regions, vertex: int, triangles: Sequence[int]) -> int:
    """A second vertex at the place of one, which these triangles have instead."""
    other = len(regions.vertices)
    regions.vertices.append(regions.vertices[vertex])
    for triangle in triangles:
        for half in _halves(regions.triangles[triangle]):
            if vertex in half:
                del regions.across[half]
    for triangle in triangles:
        regions.triangles[triangle] = [other if one == vertex else one for one in regions.triangles[triangle]]
        _enter(regions, triangle)
    return other


def _put(regions: Regions, corners: tuple[int, int, int], region: int) -> None:
    regions.triangles.append(list(corners))
    regions.region_of.append(region)
    _enter(regions, len(regions.triangles) - 1)


def _enter(regions: Regions, triangle: int) -> None:
    for half in _halves(regions.triangles[triangle]):
        regions.across[half] = triangle


def _halves(corners: Sequence[int]) -> list[tuple[int, int]]:
    a, b, c = corners
    return [(a, b), (b, c), (c, a)]
