# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a mesh on the exact surface to the solid that it is of: planes, cylinders, cones, spheres and tori, with the
edges in which they meet.

    triangles of one shape that hang together   a region, later a face
    mesh edges between the same two regions     a chain, later an edge
    mesh vertices where more chains end         corners

The mesh tells only what is beside what, and of what it is too coarse for (see strips) the surface does; where corners
and edges lie is solved on the shapes. Faces that go on smoothly into each other have no edge in the mesh: there the
chain wanders by about a voxel, and their line of contact is solved. What comes out is held against the surface."""
from __future__ import annotations

import math
from itertools import product
from typing import Iterator, Optional, Sequence

from .._native import Mesh, Surface
from ..parts import pieces
from ..progress import Report, check, share
from ..vectors import Vector, add, cross, distance, dot, unit
from ..wording import Said
from . import chains, strips, truth, volume
from .chains import SLOPPY, Chain
from .regions import NEAR, NotAnalytic, Regions, find
from .shapes import CONE, CYLINDER, PLANE, SPHERE, TORUS, Equations, Shape, meet, on
from .topology import Brep, Edge, Face

__all__ = ["Brep", "Edge", "Face", "NotAnalytic", "make"]

#: mm; what an edge that is told to be a line, a circle or a curve may be off.
CLOSE = 1e-6

#: mm; what curves between others than these may be off.
CURVE = 1e-5

#: mm; what corners in which faces touch may be off.
UNSETTLED = 1e-3

#: Points of an edge that are looked at, about.
MOST_SAMPLES = 32

#: Points of a curve; it becomes no smoother by more.
MOST_POINTS = 200

#: Halves of a piece of a curve are shorter than it, by this at least; else it turns back.
HALF = 0.75

#: In voxels: points of a curve are farther apart than this.
SHORT = 1e-3

#: Cosine of the angle between a curve and the chord of one of its pieces, at least; else it is folded.
FOLD = 0.5

#: In voxels: what the mesh of a solid may be off. Few triangles where it is flat, and edges that wander little: facets
#: of a cylinder of 12 voxels' radius are a voxel wide then; wider ones bridge the narrow faces in which a path of many
#: short lines bends.
MESH_ERROR = 0.01

#: Sine of the angle between faces below which their normals do not tell where their edge goes.
TANGENT = 1e-4


class _Maker:
    """One solid in the making."""

    def __init__(self, regions: Regions, voxel: float) -> None:
        self.regions, self.voxel = regions, voxel
        self.progress: Report = None
        self.done = 0.0
        self.left = 0.0  # what equations are off, mm
        self.chains, self.chain_of = chains.find(regions)
        self.corner_of: dict[int, int] = {}

    def fail(self, key: str, **values: float) -> NotAnalytic:
        return NotAnalytic(Said(key, **values), self.regions.known_share)

    # ---- where it lies ----

    def shape(self, region: int) -> Shape:
        return self.regions.shape[region]

    def equations(self, regions: Sequence[int]) -> list[Equations]:
        return [on(self.shape(region)) for region in regions]

    def contact(self, chain: Chain) -> list[Equations]:
        """What holds along a chain."""
        found = self.equations((chain.left, chain.right))
        if chain.touching:
            found.append(self.touch(chain))
        return found

    def touch(self, chain: Chain) -> Equations:
        return chains.touch(self.regions, chain.left, chain.right, chain.blade)

    def tell_touching(self, chain: Chain) -> None:
        """Whether the faces beside a chain go on smoothly into each other, or touch as the two of a blade do."""
        place, near = chains.middle(self.regions, chain), 3 * self.voxel
        chain.touching = chains.contact(self.regions, chain.left, chain.right, place, near) is not None
        met = None if chain.touching else meet(self.equations((chain.left, chain.right)), place)
        if met is not None and self.is_tangent(chain, met[0]):
            first, second = (self.regions.outside(region, met[0]) for region in (chain.left, chain.right))
            chain.blade = dot(first, second) < 0
            found = meet(self.equations((chain.left, chain.right)) + [self.touch(chain)], met[0])
            chain.touching = found is not None and found[1] < SLOPPY and distance(found[0], met[0]) < near

    def solve(self, equations: Sequence[Equations], start: Vector, lost: str) -> Vector:
        check(self.progress, self.done)
        found = meet(equations, start)
        if found is None or found[1] > SLOPPY or not chains.reached(equations, start, found[0], 4, self.voxel):
            raise self.fail(lost, x=start[0], y=start[1], z=start[2])
        self.left = max(self.left, found[1])
        return found[0]

    def place_corners(self) -> list[Vector]:
        """Corners, each where its faces meet; and of each edge that closes without one, a point of it."""
        meeting: dict[int, list[Equations]] = {}
        beside: dict[int, set[int]] = {}
        for chain in self.chains:
            for vertex in () if chain.closed else (chain.vertices[0], chain.vertices[-1]):
                beside.setdefault(vertex, set()).update((chain.left, chain.right))
                if chain.touching:
                    meeting.setdefault(vertex, []).append(self.touch(chain))
        corners: list[Vector] = []
        cells: dict[tuple[int, ...], list[int]] = {}  # corners by cubes as wide as they may be apart
        for vertex in sorted(beside):
            place = self.solve(self.equations(sorted(beside[vertex])) + meeting.get(vertex, []),
                               self.regions.vertices[vertex], "corner lost")
            cell = [math.floor(x / SLOPPY) for x in place]
            near = (k for way in product((-1, 0, 1), repeat=3)
                    for k in cells.get((cell[0] + way[0], cell[1] + way[1], cell[2] + way[2]), ())
                    if distance(corners[k], place) < SLOPPY)
            self.corner_of[vertex] = min(near, default=len(corners))
            if self.corner_of[vertex] == len(corners):
                cells.setdefault(tuple(cell), []).append(len(corners))
                corners.append(place)
        for chain in self.chains:
            if chain.closed:
                vertex = chain.vertices[0]
                self.corner_of[vertex] = len(corners)
                corners.append(self.solve(self.contact(chain), self.regions.vertices[vertex], "edge lost"))
        return corners

    def settle_corners(self, corners: list[Vector]) -> None:
        """Where three faces touch in a corner, their equations leave it open by the root of what numbers are exact to:
        it goes to the end of the circle along which two of them touch."""
        for chain in self.chains:
            if not chain.touching or chain.closed or self.is_point(chain):
                continue
            ends = [self.corner_of[chain.vertices[0]], self.corner_of[chain.vertices[-1]]]
            try:
                points = self.samples(chain, corners[ends[0]], corners[ends[1]])
            except NotAnalytic:
                continue  # told when its turn has come
            shapes, close = (self.shape(chain.left), self.shape(chain.right)), CLOSE + 2 * self.left
            if len(points) < 4 or _is_line(points, close) or _circle(*shapes, points, close):
                continue
            circle = _circle(*shapes, points[1:-1], close)
            if circle is None:
                continue
            centre, axis, radius = circle
            for corner in ends:
                out = add(corners[corner], centre, -1)
                place = add(centre, unit(add(out, axis, -dot(out, axis))), radius)
                beside = {region for other in self.chains for region in (other.left, other.right)
                          if corner in (self.corner_of.get(other.vertices[0]), self.corner_of.get(other.vertices[-1]))}
                if distance(place, corners[corner]) < UNSETTLED and all(
                        abs(self.shape(region).see(place)[0]) <= close for region in beside):
                    corners[corner] = place

    def is_point(self, chain: Chain) -> bool:
        """Whether a chain has no length: where four faces meet in a point, the mesh has two corners beside each
        other."""
        start, end = chain.vertices[0], chain.vertices[-1]
        return not chain.closed and self.corner_of[start] == self.corner_of[end] and all(
            distance(self.regions.vertices[vertex], self.regions.vertices[start]) < 4 * self.voxel
            for vertex in chain.vertices)

    def samples(self, chain: Chain, start: Vector, end: Vector) -> list[Vector]:
        """Points of the edge from end to end, in order: the mesh's own and some between them."""
        equations = self.contact(chain)
        mesh = [self.regions.vertices[vertex] for vertex in chain.vertices]
        if chain.touching and not chain.closed and len(mesh) > 3:  # it wanders: what is near the ends may lie beyond
            mesh = [mesh[0]] + [p for p in mesh[1:-1]
                                if min(distance(p, mesh[0]), distance(p, mesh[-1])) > 2 * self.voxel] + [mesh[-1]]
        mesh = mesh[:-1:1 + len(mesh) // MOST_SAMPLES] + mesh[-1:]
        found = [start]
        for a, b in zip(mesh, mesh[1:]):
            parts = 4 if len(mesh) == 2 else 2 if len(mesh) < 5 else 1
            for part in range(1, parts + 1):
                if b is mesh[-1] and part == parts:
                    break
                found.append(self.solve(equations, add(a, add(b, a, -1), part / parts), "edge lost"))
        if chain.touching:
            found = _forwards(found, end)
        return found + [end]

    def edge(self, chain: Chain, corners: list[Vector]) -> Edge:
        """The curve of a chain."""
        start, end = self.corner_of[chain.vertices[0]], self.corner_of[chain.vertices[-1]]
        if start != end and self.shape(chain.left).kind == self.shape(chain.right).kind == PLANE:
            return Edge(start, end)  # however flatly they cross: between, it would be less exact
        points = self.samples(chain, corners[start], corners[end])
        closeness = [CLOSE, CLOSE + 2 * self.left]  # a short arc may be as good as a line where corners are inexact
        if chain.touching:  # and where faces touch they are by the root of what is left
            closeness.append(CLOSE + 4 * math.sqrt(self.left))
        for close in closeness:
            if start != end and _is_line(points, close):
                return Edge(start, end)
            circle = _circle(self.shape(chain.left), self.shape(chain.right), points, close)
            if circle is not None:
                centre, axis, radius = circle
                turn = sum(dot(cross(add(a, centre, -1), add(b, centre, -1)), axis) for a, b in zip(points, points[1:]))
                return Edge(start, end, centre, axis if turn > 0 else (-axis[0], -axis[1], -axis[2]), radius)
        return self.curve(chain, start, end, points)

    def curve(self, chain: Chain, start: int, end: int, points: list[Vector]) -> Edge:
        """A curve of cubics, finer and finer until their middles are on it."""
        if chain.touching:
            raise self.fail("curve touched")
        equations = self.contact(chain)
        points = self.apart(chain, points)
        directions = [self.direction(chain, point, add(points[min(k + 1, len(points) - 1)], points[max(k - 1, 0)], -1))
                      for k, point in enumerate(points)]
        tips = [(tip, beside) for tip, beside in ((0, 1), (-1, -2)) if self.is_tangent(chain, points[tip])]
        if len(tips) == len(points):
            raise self.fail("curve rough", x=points[0][0], y=points[0][1], z=points[0][2])
        k = 0
        while k + 1 < len(points):
            for tip, beside in tips:
                directions[tip] = _mirrored(directions[beside], add(points[beside], points[tip], -1))
            length = distance(points[k], points[k + 1])
            middle = add(add(points[k], add(points[k + 1], points[k], -1), 0.5),
                         add(directions[k], directions[k + 1], -1), length / 8)
            true = self.solve(equations, middle, "edge lost")
            if distance(true, middle) < CURVE:
                k += 1
                continue
            longer = max(distance(points[k], true), distance(true, points[k + 1]))
            if longer > HALF * length or length < SHORT * self.voxel or len(points) >= MOST_POINTS:
                raise self.fail("curve rough", x=true[0], y=true[1], z=true[2])
            directions.insert(k + 1, self.direction(chain, true, add(points[k + 1], points[k], -1)))
            points.insert(k + 1, true)
        for k, (a, b) in enumerate(zip(points, points[1:])):
            way = unit(add(b, a, -1))
            if min(dot(directions[k], way), dot(directions[k + 1], way)) < FOLD:
                raise self.fail("curve rough", x=a[0], y=a[1], z=a[2])
        return Edge(start, end, points=points, directions=directions)

    def apart(self, chain: Chain, points: list[Vector]) -> list[Vector]:
        """Points without those that are as good as another, and those inside where the faces are tangent: there they
        are not where the edge is but where its solution ended."""
        kept = points[:1]
        for point in points[1:-1]:
            if (min(distance(point, kept[-1]), distance(point, points[-1])) > SHORT * self.voxel
                    and not self.is_tangent(chain, point)):
                kept.append(point)
        return kept + points[-1:]

    def along(self, chain: Chain, place: Vector) -> Vector:
        """Where the edge goes at a place, this way or that; of no length where the faces are tangent."""
        return cross(self.shape(chain.left).see(place)[1], self.shape(chain.right).see(place)[1])

    def is_tangent(self, chain: Chain, place: Vector) -> bool:
        """Whether the faces' normals do not tell where their edge goes."""
        return math.hypot(*self.along(chain, place)) < TANGENT

    def direction(self, chain: Chain, place: Vector, way: Vector) -> Vector:
        """Where the edge goes at a place, about along a way."""
        along = unit(self.along(chain, place))
        return along if dot(along, way) > 0 else add((0.0, 0.0, 0.0), along, -1)

    def make(self, progress: Report) -> Brep:
        self.progress = progress
        for chain in self.chains:
            check(progress, 0.0)
            self.tell_touching(chain)
        corners = self.place_corners()
        self.settle_corners(corners)
        edges: list[Edge] = []
        edge_of: dict[int, int] = {}
        for number, chain in enumerate(self.chains):
            self.done = number / len(self.chains)
            if not self.is_point(chain):
                edge_of[number] = len(edges)
                edges.append(self.edge(chain, corners))
        faces: list[Face] = []
        shells: dict[int, list[int]] = {}
        for region, loops in enumerate(self.regions.loops()):
            if not loops:
                raise self.fail("face without edge")
            kept_loops = []
            for loop in loops:
                steps = [self.chain_of[half] for half in loop]
                kept = [(edge_of[chain], forwards) for k, (chain, forwards) in enumerate(steps)
                        if loop[k][0] in self.corner_of and chain in edge_of]
                if not kept:
                    raise self.fail("face is point")
                kept_loops.append(kept)
            faces.append(Face(self.shape(region), self.regions.outwards[region], kept_loops))
            shells.setdefault(self.regions.shell[region], []).append(region)
        keys = sorted(shells)
        meshes = [self.regions.shell_mesh(key) for key in keys]
        solids = pieces([mesh.measure() for mesh in meshes], meshes.__getitem__)
        if sum(map(len, solids)) != len(keys):
            raise self.fail("hollow")
        made = Brep(corners, edges, faces, [shells[key] for key in keys], solids, self.left)
        self.check(made)
        return made

    def check(self, made: Brep) -> None:
        """Every loop closes, every edge is between two faces, once forwards and once back."""
        used: set[tuple[int, bool]] = set()
        for face in made.faces:
            for loop in face.loops:
                ends = [(made.edges[edge].start, made.edges[edge].end)[::1 if forwards else -1]
                        for edge, forwards in loop]
                if any(end != start for (_, end), (start, _) in zip(ends, ends[1:] + ends[:1])):
                    raise self.fail("loops open")
                if used & set(loop):
                    raise self.fail("edge twice")
                used.update(loop)
        if len(used) != 2 * len(made.edges):
            raise self.fail("edge one side")


def _mirrored(direction: Vector, chord: Vector) -> Vector:
    """The direction at the other end of an arc of a circle."""
    way = unit(chord)
    return add(add((0.0, 0.0, 0.0), way, 2 * dot(direction, way)), direction, -1)


def _forwards(points: list[Vector], end: Vector) -> list[Vector]:
    """Points without those that turn back."""
    kept = points[:1]
    for point in points[1:]:
        if len(kept) < 2 or dot(add(point, kept[-1], -1), add(kept[-1], kept[-2], -1)) > 0:
            kept.append(point)
    while len(kept) > 2 and dot(add(end, kept[-1], -1), add(kept[-1], kept[-2], -1)) <= 0:
        kept.pop()
    return kept


def _is_line(points: list[Vector], close: float) -> bool:
    way = add(points[-1], points[0], -1)
    length = math.hypot(*way)
    return length > 0 and all(math.hypot(*cross(add(point, points[0], -1), way)) <= close * length for point in points)


def _axes(a: Shape, b: Shape, place: Vector) -> Iterator[tuple[Vector, Vector]]:
    """Points and directions of the lines about which a circle through a place may turn where it is on both shapes:
    their axes, what two spheres or a sphere and a plane turn about, and across a torus' tube."""
    for shape, other in ((a, b), (b, a)):
        if shape.kind in (CYLINDER, CONE, TORUS):
            yield shape.point, shape.axis
        if shape.kind == SPHERE and other.kind == PLANE:
            yield shape.point, other.axis
        if shape.kind == TORUS:
            out = add(place, shape.point, -1)
            away = unit(add(out, shape.axis, -dot(out, shape.axis)))
            yield add(shape.point, away, shape.radius), cross(shape.axis, away)
    if a.kind == b.kind == SPHERE:
        yield a.point, unit(add(a.point, b.point, -1))


def _circle(a: Shape, b: Shape, points: list[Vector], close: float) -> Optional[tuple[Vector, Vector, float]]:
    """Centre, axis and radius of the circle through points of two shapes; None where there is none."""
    for foot, axis in _axes(a, b, points[len(points) // 2]):
        centre = add(foot, axis, dot(add(points[0], foot, -1), axis))
        radius = distance(points[0], centre)
        if radius > close and all(
                abs(distance(point, centre) - radius) <= close and abs(dot(add(point, centre, -1), axis)) <= close
                for point in points):
            return centre, axis, radius
    return None


def make(mesh: Mesh, surface: Surface, voxel: float, *, moves: Optional[int] = None, progress: Report = None) -> Brep:
    """The solid of a closed mesh on a Surface, made of voxels this large (mm), with little left out of it
    (Mesh.from_stock(error=MESH_ERROR * voxel)). NotAnalytic where it is not bounded by planes, cylinders, cones,
    spheres and tori alone, of too many faces, or comes out wrong; ValueError for a mesh that is empty or open."""
    if not mesh.triangle_count or not mesh.closed:
        raise ValueError(Said("no mesh"))
    regions = find(mesh, surface, voxel, moves, share(progress, 0, 0.5))
    if regions.unknown:
        x, y, z = regions.unknown[0]
        percent = min(math.floor(1000 * regions.known_share) / 10, 99.9)
        raise NotAnalytic(Said("unknown surface", percent=percent, x=x, y=y, z=z), regions.known_share)
    try:
        strips.mend(regions, surface, voxel, moves, share(progress, 0.5, 0.6))
        made = _Maker(regions, voxel).make(share(progress, 0.6, 0.9))
    except LookupError:  # borders that do not lead on
        raise NotAnalytic(Said("faces apart"), regions.known_share) from None
    made.off_mm, made.off_at = truth.measure(made, regions, surface, voxel, moves, share(progress, 0.9, 1))
    if made.off_mm > NEAR * voxel:
        x, y, z = made.off_at
        raise NotAnalytic(Said("solid off", off=made.off_mm, x=x, y=y, z=z), regions.known_share)
    off = abs(volume.of(made) - mesh.volume)
    if off > MESH_ERROR * voxel * mesh.area:
        raise NotAnalytic(Said("volume off", off=off), regions.known_share)
    return made
