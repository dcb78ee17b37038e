# SPDX-License-Identifier: LGPL-2.1-or-later
"""Real jobs of FreeCAD 0.20, 1.0 and 1.1: what is left of the stock against the job's own model, a tenth of a voxel.

Faces are those of the model that lie across an axis, holes those that the program drills; both are met by rays through
the stock. The dish is left out: its finishing leaves scallops on purpose.
"""

import array
import collections
import copy
import math
import os
import random

import pytest
from swarf_cam import native, reader
from swarf_cam.core.moves import ARC, COLUMNS, FEED

VOXEL = 0.1
TOLERANCE = VOXEL / 10

# Faces smaller than this, mm2, are facets of rounded ones.
LEAST_FACE = 50

# Points of a face keep this far from its edges, mm: a ray must not see the neighbours' band.
MARGIN = 0.6

# Rays onto faces start this far outside, mm: in the air of the narrowest pocket.
APPROACH = 1.5

# Adaptive rounds its path, so that its walls stand out from the model's by up to this much, mm. There the envelope of
# the path is the truth.
ADAPTIVE_LEFT = 0.1

JOBS = ("job-0.20", "job-1.0", "job-1.1")


class Milled:
    """A job, its data and what is left of its stock."""

    def __init__(self, swarf, path):
        self.swarf = swarf
        self.data = reader.read_data(path)
        self.job = native.to_job(self.data)
        self.done = swarf.simulate(self.job, voxel=VOXEL, compare=False, mesh=False)
        self.removed = dict(zip(self.data.moves.operations, self.done.simulation.removed_by_operation))

    def rows(self, operation):
        """Rows of the moves of one operation."""
        moves = self.data.moves
        for index in range(len(moves)):
            row = moves.row(index)
            if moves.operations[moves.sections[int(row[2])][1]] == operation:
                yield row

    def cast(self, rays):
        """Distances of rays (origin, direction)."""
        tables = [array.array("d", (value for ray in rays for value in ray[side])) for side in (0, 1)]
        distances, _ = self.done.stock.cast(*(memoryview(table).cast("B").cast("d", (len(rays), 3))
                                              for table in tables))
        return list(distances)

    def holes(self, operation):
        """(x, y) -> least z, of where an operation's tool goes below the stock."""
        depth = {}
        for row in self.rows(operation):
            if row[7] < self.data.stock["lo"][2]:
                place = (round(row[5], 6), round(row[6], 6))
                depth[place] = min(depth.get(place, math.inf), row[7])
        return depth

    def segments(self, operation):
        """(x, y, x, y, least z) of an operation's feed moves, arcs by their chords."""
        before, found = None, []
        for row in self.rows(operation):
            if before and (row[0] == ARC or row[1] == FEED):
                found.append((before[5], before[6], row[5], row[6], min(before[7], row[7])))
            before = row
        return found

    def walls(self, operation):
        """(axis, side, place) of the walls around an operation's feed moves, as they face inwards."""
        radius = self.radius(operation)
        segments = self.segments(operation)
        return [(axis, side, side * (min(side * end for segment in segments for end in segment[axis:4:2]) - radius))
                for axis in (0, 1) for side in (1, -1)]

    def radius(self, operation):
        """Radius of an operation's tool."""
        row = next(self.rows(operation))
        tool = self.data.moves.sections[int(row[2])][0]
        return max(node[0] for kind, nodes in self.data.tools[tool][1] if kind == "flutes" for node in nodes)


@pytest.fixture(scope="module", params=JOBS)
def milled(request):
    swarf = pytest.importorskip("swarf", reason="the native module is not on PYTHONPATH")
    try:
        reader.find_freecadcmd()
    except reader.JobError as error:
        pytest.skip(str(error))
    root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    shared = os.environ.get("SWARF_SHARED") or os.path.join(os.path.dirname(root), "shared")
    path = os.path.join(shared, "freecad", request.param + ".FCStd")
    if not os.path.exists(path):
        pytest.skip("the sample jobs are not here: set SWARF_SHARED")
    return Milled(swarf, path)


def flat_faces(design):
    """(axis, side +1 or -1, place) -> triangles, of the model's faces across an axis."""
    points, index = design
    faces, area = collections.defaultdict(list), collections.Counter()
    for base in range(0, len(index), 3):
        a, b, c = (points[3 * i:3 * i + 3] for i in index[base:base + 3])
        u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
        normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        length = math.hypot(*normal)
        for axis in range(3):
            if length > 0 and abs(normal[axis]) > (1 - 1e-9) * length:
                key = axis, int(math.copysign(1, normal[axis])), round(a[axis], 5)
                faces[key].append((a, b, c))
                area[key] += length / 2
    return {key: triangles for key, triangles in faces.items() if area[key] > LEAST_FACE}


def covers(triangles, x, y, point):
    """Whether a point lies in one of the triangles, seen along the axis that is neither x nor y."""
    for corners in triangles:
        sides = [(b[x] - a[x]) * (point[y] - a[y]) - (b[y] - a[y]) * (point[x] - a[x])
                 for a, b in zip(corners, corners[1:] + corners[:1])]
        if min(sides) >= 0 or max(sides) <= 0:
            return True
    return False


def points_of(face, triangles, margin, count, chance):
    """Points of a face, this far away from its edges."""
    x, y = (other for other in range(3) if other != face[0])
    found = []
    for _ in range(50 * count):
        a, b, c = chance.choice(triangles)
        s, t = sorted((chance.random(), chance.random()))
        point = [p * s + q * (t - s) + r * (1 - t) for p, q, r in zip(a, b, c)]
        ring = []
        for turn in range(8):
            near = list(point)
            near[x] += margin * math.cos(turn * math.pi / 4)
            near[y] += margin * math.sin(turn * math.pi / 4)
            ring.append(near)
        if all(covers(triangles, x, y, near) for near in ring):
            found.append(point)
            if len(found) == count:
                break
    return found


def distance_to_path(segments, point):
    """Least distance in x and y from a point to the moves that go at least as deep."""
    best = math.inf
    for ax, ay, bx, by, z in segments:
        if z > point[2]:
            continue
        ux, uy, px, py = bx - ax, by - ay, point[0] - ax, point[1] - ay
        square = ux * ux + uy * uy
        t = min(1, max(0, (px * ux + py * uy) / square)) if square else 0
        best = min(best, math.hypot(px - t * ux, py - t * uy))
    return best


def test_every_operation_removes(milled):
    """All seven do; but peck drilling goes into the holes that Drilling made, and finds nothing there."""
    assert len(milled.removed) == 7
    assert milled.holes("DrillingPeck") == milled.holes("Drilling") != {}
    assert milled.removed.pop("DrillingPeck") == 0
    assert min(milled.removed.values()) > 1000


def test_pecking_removes_what_drilling_does(milled):
    """With Drilling left out the holes are those of peck drilling, whole."""
    data = copy.copy(milled.data)
    data.moves = copy.copy(data.moves)
    left_out = {number for number, section in enumerate(data.moves.sections)
                if data.moves.operations[section[1]] == "Drilling"}
    data.moves.rows = array.array("d")
    for index in range(len(milled.data.moves)):
        row = milled.data.moves.row(index)
        if row[2] not in left_out:
            data.moves.rows.extend(row)
    assert len(data.moves.rows) % COLUMNS == 0 and len(data.moves) < len(milled.data.moves)
    done = milled.swarf.simulate(native.to_job(data), voxel=VOXEL, compare=False, mesh=False)
    removed = dict(zip(data.moves.operations, done.simulation.removed_by_operation))
    assert removed["Drilling"] == 0
    assert removed["DrillingPeck"] == pytest.approx(milled.removed["Drilling"], rel=1e-6)


def test_faces(milled):
    """Top, floors and walls are where the model has them."""
    chance = random.Random(20)
    segments, radius, rounded = milled.segments("Adaptive"), milled.radius("Adaptive"), milled.walls("Adaptive")
    measured = 0
    for face, triangles in sorted(flat_faces(milled.data.design).items()):
        axis, side, place = face
        is_rounded = any(face[:2] == wall[:2] and abs(place - wall[2]) < ADAPTIVE_LEFT for wall in rounded)
        # The step's corner is sharp; the mill leaves its own radius there.
        margin = radius + MARGIN if is_rounded else MARGIN
        rays = []
        for point in points_of(face, triangles, margin, 40, chance):
            point[axis] = place + side * APPROACH
            rays.append((point, [-side if other == axis else 0 for other in range(3)]))
        if not rays:
            continue
        measured += 1
        for (origin, _), distance in zip(rays, milled.cast(rays)):
            if is_rounded:
                hit = [value - side * distance if k == axis else value for k, value in enumerate(origin)]
                assert distance_to_path(segments, hit) == pytest.approx(radius, abs=TOLERANCE), "%s: %s" % (face, hit)
                assert APPROACH - ADAPTIVE_LEFT < distance < APPROACH + TOLERANCE
            else:
                assert distance == pytest.approx(APPROACH, abs=TOLERANCE), "face %s at %s" % (face, origin)
    # The outside of a block, the pocket's floor and four walls, the step's floor and two walls.
    assert measured == 6 + 5 + 3


def test_depths(milled):
    """The depth that an operation cuts to is a floor of the model, and of what is left."""
    floors = {place for axis, side, place in flat_faces(milled.data.design) if (axis, side) == (2, 1)}
    for operation in ("MillFace", "Pocket", "Adaptive"):
        lowest = min(segment[4] for segment in milled.segments(operation))
        assert min(abs(lowest - floor) for floor in floors) < 1e-6, operation


def test_holes(milled):
    """Drilled holes are as wide as the model's, where the model has them, and go through."""
    points = milled.data.design[0]
    radius = milled.radius("Drilling")
    lo, hi = min(points[2::3]), max(points[2::3])
    holes = milled.holes("Drilling")
    assert len(holes) == 4
    for x, y in holes:
        near = [math.hypot(points[i] - x, points[i + 1] - y) for i in range(0, len(points), 3)]
        assert min(near) == pytest.approx(radius, abs=TOLERANCE), "the model has no such hole"
        rays = [((x, y, z), (math.cos(turn), math.sin(turn), 0))
                for z in (lo + 0.1 * (hi - lo), lo + 0.5 * (hi - lo), lo + 0.9 * (hi - lo))
                for turn in (step * math.pi / 18 for step in range(36))]
        for (origin, direction), distance in zip(rays, milled.cast(rays)):
            assert distance == pytest.approx(radius, abs=TOLERANCE), "from %s along %s" % (origin, direction)
        assert milled.cast([((x, y, hi + 10), (0, 0, -1))]) == [math.inf]
