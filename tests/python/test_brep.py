# SPDX-License-Identifier: LGPL-2.1-or-later
"""Analytic faces: shapes against what they promise, solids against closed forms, and what is none."""
import math
import random
import re
import sys

import pytest

import swarf
from swarf.job import Job
from swarf.solids import brep, regions, shapes, step, volume
from swarf.solids.shapes import CONE, CYLINDER, PLANE, SPHERE, TORUS, Shape
from swarf.vectors import add, dot

VOXEL = 0.4
BLOCK = {"kind": "box", "lo": (0, 0, -10), "hi": (60, 40, 0)}


def job_of(tool, *moves, stock=None):
    """Moves in a block: places, and arcs (end, centre)."""
    program = swarf.Program(start=moves[0])
    program.add_operation("cut")
    program.set_section(tool=1)
    for move in moves[1:]:
        if len(move) == 2:
            program.add_arc(move[0], move[1], ccw=True, feed_mm_min=100)
        else:
            program.add_line(move, feed_mm_min=100)
    return Job(name="cut", program=program, tools={1: swarf.Cutter(tool)}, stock=stock or BLOCK)


def cut(tool, *moves, stock=None, voxel=VOXEL):
    """(mesh, surface) of a block after moves, as job_of()."""
    made = swarf.simulate(job_of(tool, *moves, stock=stock), voxel=voxel, compare=False)
    return swarf.Mesh.from_stock(made.stock, brep.MESH_ERROR * voxel, surface=made.surface), made.surface


@pytest.mark.parametrize("shape", [
    Shape(PLANE, (1, 2, 3), (0.6, 0, 0.8), 0, 0), Shape(CYLINDER, (1, 2, 3), (0.6, 0, 0.8), 2, 0),
    Shape(CONE, (1, 2, 3), (0.6, 0, 0.8), 0, 0.5), Shape(SPHERE, (1, 2, 3), (0, 0, 0), 2, 0),
    Shape(TORUS, (1, 2, 3), (0.6, 0, 0.8), 3, 1)])
def test_distances(shape):
    random.seed(5)
    for _ in range(50):
        place = tuple(random.uniform(-6, 6) for _ in range(3))
        value, gradient = shape.see(place)
        assert math.hypot(*gradient) == pytest.approx(1)
        foot = add(place, gradient, -value)
        if shape.kind in (PLANE, CYLINDER, SPHERE, CONE) and value > 0:  # inside, the foot may be beyond an apex
            assert shape.see(foot)[0] == pytest.approx(0, abs=1e-12)
        steps = [tuple(1e-6 * (k == i) for i in range(3)) for k in range(3)]
        slope = [(shape.see(add(place, way))[0] - shape.see(add(place, way, -1))[0]) / 2e-6 for way in steps]
        assert slope == pytest.approx(gradient, abs=1e-5)
    assert shape.is_same(shape, 1e-9, 1e-9)
    moved = Shape(shape.kind, add(shape.point, (0.01, 0, 0)), shape.axis, shape.radius, shape.second)
    assert not shape.is_same(moved, 1e-4, 1e-6) and shape.is_same(moved, 0.1, 1e-6)


def test_where_shapes_meet():
    sphere = Shape(SPHERE, (0, 0, 0), (0, 0, 0), 2, 0)
    planes = [Shape(PLANE, (0.5, 0, 0), (1, 0, 0), 0, 0), Shape(PLANE, (0, 0.5, 0), (0, 1, 0), 0, 0)]
    place, left = shapes.meet([shapes.on(shape) for shape in (sphere, *planes)], (0.4, 0.6, 2.2))
    assert left < 1e-12 and place == pytest.approx((0.5, 0.5, math.sqrt(3.5)))
    wall = Shape(PLANE, (2, 0, 0), (1, 0, 0), 0, 0)  # touches the sphere in a point
    touching = [shapes.on(sphere), shapes.on(wall), shapes.tangency(sphere, wall, True)]
    place, left = shapes.meet(touching, (1.9, 0.3, -0.2))
    assert left < 1e-9 and place == pytest.approx((2, 0, 0), abs=1e-8)


@pytest.mark.parametrize("tool, moves, faces, edges", [
    ("flat:d=6,l=20", ((10, 20, 5), (10, 20, -4), (50, 20, -4)), {PLANE: 9, CYLINDER: 2}, 24),  # a slot
    ("flat:d=6,l=20", ((30, 20, 5), (30, 20, -12)), {PLANE: 6, CYLINDER: 1}, 14),  # a hole through
    ("drill:d=6,l=20,a=90", ((30, 20, 5), (30, 20, -7)), {PLANE: 6, CYLINDER: 1, CONE: 1}, 14),
    ("bull:d=8,r=1,l=20", ((30, 20, 5), (30, 20, -4)), {PLANE: 7, CYLINDER: 1, TORUS: 1}, 15),
    ("ball:d=6,l=20", ((10, 20, 5), (10, 20, -5), (50, 20, -5)), {PLANE: 8, CYLINDER: 3, SPHERE: 2}, 26),
    # down a slope: four faces meet in one point at the ends
    ("ball:d=6,l=20", ((10, 20, 5), (10, 20, -4), (50, 25, -6)), {PLANE: 8, CYLINDER: 3, SPHERE: 2}, 26),
    ("flat:d=6,l=20", ((10, 20, 5), (10, 20, -4), (20, 20, -4), ((20, 30, -4), (20, 25, -4))),
     {PLANE: 9, CYLINDER: 4}, 30),
    ("flat:d=6,l=20", ((-5, 20, 5), (-5, 20, -4), (65, 20, -4), (65, 20, 5), (30, -5, 5), (30, -5, -2), (30, 45, -2)),
     {PLANE: 18}, 48),  # two grooves that cross
    # in passes; the middle of a wall's triangle, at a third of its height, is on the edge of the first one's cutter
    ("flat:d=6,l=20", ((-5, 20.1, 5), (-5, 20.1, -2), (65, 20.1, -2), (65, 20.1, -6), (-5, 20.1, -6)),
     {PLANE: 10}, 24),
    # a bend of 8 degrees: the outer wall turns in a cylinder that is no two voxels wide
    ("flat:d=10,l=20", ((10, 15, 5), (10, 15, -4), (30, 15, -4), (50, 15 + 20 * math.tan(math.radians(8)), -4)),
     {PLANE: 11, CYLINDER: 3}, 33),
    # quarters of circles between the tubes of a tool with rounded corners
    ("bull:d=6,r=1,l=20", ((10, 20, 5), (10, 20, -4), (40, 20, -4)), {PLANE: 9, CYLINDER: 4, TORUS: 2}, 32),
    ("bull:d=6,r=1,l=20", ((10, 10, 5), (10, 10, -4), (40, 10, -4), (40, 30, -4)),
     {PLANE: 11, CYLINDER: 7, TORUS: 3}, 47),
])
def test_solids(tool, moves, faces, edges, tmp_path):
    mesh, surface = cut(tool, *moves)
    made = brep.make(mesh, surface, VOXEL)
    kinds = [face.shape.kind for face in made.faces]
    assert {kind: kinds.count(kind) for kind in kinds} == faces
    assert len(made.edges) == edges and made.inexact_mm < 1e-9 and len(made.shells) == 1 and made.off_mm < 1e-12
    for face in made.faces:  # ends and middles of edges are on both faces
        for number, _ in (one for loop in face.loops for one in loop):
            edge = made.edges[number]
            for corner in (edge.start, edge.end):
                assert abs(face.shape.see(made.corners[corner])[0]) < 1e-9
            if edge.axis is not None:
                out = add(made.corners[edge.start], edge.centre, -1)
                assert abs(dot(out, edge.axis)) < 1e-9 and math.hypot(*out) == pytest.approx(edge.radius)
    step.write(made, tmp_path / "part.step", "it's")
    text = (tmp_path / "part.step").read_text()
    assert text.count("ADVANCED_FACE(") == len(kinds) and text.count("EDGE_CURVE(") == edges and "it''s" in text
    names = set(re.findall(r"^(#\d+)=", text, re.M))
    assert set(re.findall(r"#\d+", text)) == names  # all that is named is there
    assert list(tmp_path.iterdir()) == [tmp_path / "part.step"]


@pytest.mark.parametrize("tool, moves, removed", [
    ("flat:d=6,l=20", ((30, 20, 5), (30, 20, -12)), 90 * math.pi),
    ("drill:d=6,l=20,a=90", ((30, 20, 5), (30, 20, -7)), 36 * math.pi + 9 * math.pi),
    ("ball:d=6,l=20", ((30, 20, 5), (30, 20, -5)), 18 * math.pi + 18 * math.pi),
    ("ball:d=6,l=20", ((10, 20, 5), (10, 20, -5), (50, 20, -5)), 36 * math.pi + 40 * (12 + 4.5 * math.pi)),
    ("bull:d=8,r=1,l=20", ((30, 20, 5), (30, 20, -4)), math.pi * (48 + 9 + 6 * math.pi / 4 + 2 / 3)),
    ("flat:d=6,l=2", ((20, 20, -6), (40, 20, -6)), 2 * (9 * math.pi + 120)),  # a hollow
])
def test_volumes(tool, moves, removed):
    mesh, surface = cut(tool, *moves)
    assert volume.of(brep.make(mesh, surface, VOXEL)) == pytest.approx(24000 - removed, abs=1e-7)


def test_a_face_may_hold_poles_of_its_sphere():
    """Both, one and none of those about which angles are counted, far from its edge."""
    ball = Shape(SPHERE, (1, 2, 3), (0, 0, 0), 2.0, 0)
    for height in (-1.5, 0.2, 1.9):
        radius = math.sqrt(4 - height ** 2)
        edge = brep.Edge(0, 0, (1, 2, 3 + height), (0, 0, 1), radius)
        faces = [brep.Face(ball, True, [[(0, True)]]),
                 brep.Face(Shape(PLANE, (0, 0, 3 + height), (0, 0, 1), 0, 0), False, [[(0, False)]])]
        cap = brep.Brep([(1 + radius, 2, 3 + height)], [edge], faces, [[0, 1]], [[0]], 0.0)
        assert volume.of(cap) == pytest.approx(math.pi * (2 - height) ** 2 * (4 + height) / 3, rel=1e-8)


def moved(made):
    made.corners[0] = add(made.corners[0], (0, 0, 0.1))


def other_arc(made):
    arc = next(edge for edge in made.edges if edge.axis is not None and edge.start != edge.end)
    arc.axis = tuple(-x for x in arc.axis)


def inside_out(kind):
    def change(made):
        face = next(face for face in made.faces if face.shape.kind == kind)
        face.outwards = not face.outwards
    return change


def of_another(made):
    made.faces[-1].shape, made.faces[-2].shape = made.faces[-2].shape, made.faces[-1].shape


def left_out(made):
    made.faces.pop()


@pytest.mark.parametrize("change", [
    moved, other_arc, inside_out(PLANE), inside_out(CYLINDER), inside_out(SPHERE), of_another, left_out])
def test_what_comes_out_wrong_is_refused(change, monkeypatch):
    """A solid that is changed after it was made."""
    make = brep._Maker.make

    def make_wrong(self, progress):
        made = make(self, progress)
        change(made)
        return made

    monkeypatch.setattr(brep._Maker, "make", make_wrong)
    mesh, surface = cut("ball:d=6,l=20", (10, 20, 5), (10, 20, -5), (50, 20, -5))
    with pytest.raises(brep.NotAnalytic, match="off by"):
        brep.make(mesh, surface, VOXEL)


@pytest.mark.parametrize("voxel", [0.3, 0.37, 0.4, 0.47])
@pytest.mark.parametrize("bend_deg", [0.5, 1, 2, 4])
def test_a_bend_narrower_than_a_voxel(bend_deg, voxel):
    """The outer wall turns in a cylinder of a tenth of a voxel to a whole one: it ends where it touches the planes."""
    slope = math.radians(bend_deg)
    mesh, surface = cut("flat:d=10,l=20", (10, 15, 5), (10, 15, -4), (30, 15, -4), (50, 15 + 20 * math.tan(slope), -4),
                        voxel=voxel)
    made = brep.make(mesh, surface, voxel)
    kinds = [face.shape.kind for face in made.faces]
    assert (kinds.count(PLANE), kinds.count(CYLINDER), len(kinds), len(made.edges)) == (11, 3, 14, 33)
    assert made.off_mm < 1e-5
    ends = [(30, 10), (30 + 5 * math.sin(slope), 15 - 5 * math.cos(slope))]
    for x, y in ends:
        for z in (-4, 0):
            assert min(math.dist(corner, (x, y, z)) for corner in made.corners) < 1e-6


@pytest.mark.parametrize("bend_deg, voxel", [(0.05, 0.3), (0.08, 0.25), (0.1, 0.3)])
def test_planes_that_hardly_bend(bend_deg, voxel):
    """Inside they cross, voxels away from where the mesh may have their edge; outside the cylinder is some um wide,
    which is not found and no matter."""
    slope = math.radians(bend_deg)
    mesh, surface = cut("flat:d=10,l=20", (10, 15, 5), (10, 15, -4), (30, 15, -4), (50, 15 + 20 * math.tan(slope), -4),
                        voxel=voxel)
    made = brep.make(mesh, surface, voxel)
    assert len(made.faces) in (13, 14) and made.off_mm < 1e-5
    for z in (-4, 0):
        inside = (30 - 5 * math.tan(slope / 2), 20, z)
        assert min(math.dist(corner, inside) for corner in made.corners) < 1e-6


@pytest.mark.parametrize("voxel", [0.1, 0.2])
def test_a_star_of_short_lines(voxel):
    """Planes that cross at 0.08 degrees among others do so in lines, however flatly."""
    turns = [2 * math.pi * k / 60 for k in range(61)]
    path = [((15 + 0.6 * math.cos(5 * turn)) * math.cos(turn), (15 + 0.6 * math.cos(5 * turn)) * math.sin(turn))
            for turn in turns]
    mesh, surface = cut("flat:d=4,l=20", (45.6, 20, 5), *((30 + x, 20 + y, -4) for x, y in path), voxel=voxel)
    made = brep.make(mesh, surface, voxel)
    assert len(made.faces) == 183 and made.off_mm < 2e-3


@pytest.mark.parametrize("count, voxel", [(24, 0.2), (24, 0.4), (60, 0.25), (60, 0.4)])
def test_a_ring_of_short_lines(count, voxel):
    """Outside planes and cylinders in turn, inside planes: at 60 they are 0.2 to 0.9 mm wide."""
    turns = [2 * math.pi * k / count for k in range(count + 1)]
    mesh, surface = cut("flat:d=10,l=20", (38, 20, 5), *((30 + 8 * math.cos(turn), 20 + 8 * math.sin(turn), -4)
                                                         for turn in turns), voxel=voxel)
    made = brep.make(mesh, surface, voxel)
    kinds = [face.shape.kind for face in made.faces]
    assert (kinds.count(PLANE), kinds.count(CYLINDER), len(kinds)) == (2 * count + 8, count, 3 * count + 8)
    assert len(made.corners) == 6 * count + 8


@pytest.mark.parametrize("voxel", [0.16, 0.25])
def test_corners_of_no_width(voxel):
    """A step cleared in lines and an outline round a corner: where the outline turns, its cylinder touches the corner
    and is no face; at voxels of 0.16 a triangle cuts off the corner at the end of the step."""
    moves = [(56.5, 36.5, 20), (56.5, 36.5, 10)]
    for y in (41, 50, 59):
        moves += [(88, y - 4.5, 10), (88, y, 10), (56.5, y, 10), (56.5, y + 4.5, 10)]
    moves[-1:] = [(56.5, 63, 10), (88, 63, 10), (88, 63, 20), (82.5, 20, 20), (82.5, 20, 0), (82.5, 60, 0),
                  ((80, 62.5, 0), (80, 60, 0)), (40, 62.5, 0)]
    mesh, surface = cut("flat:d=5,l=30", *moves, stock={"kind": "box", "lo": (44, 24, 0), "hi": (83, 63, 16)},
                        voxel=voxel)
    kinds = [face.shape.kind for face in brep.make(mesh, surface, voxel).faces]
    assert (kinds.count(PLANE), kinds.count(CYLINDER), len(kinds)) == (11, 6, 17)


def test_moves_that_go_on_make_one_face():
    mesh, surface = cut("flat:d=6,l=20", (10, 20, 5), (10, 20, -4), (22.3, 20, -4), (41.7, 20, -4), (50, 20, -4))
    assert len(brep.make(mesh, surface, VOXEL).faces) == 11


def test_what_crosses_along_curves():
    """Two holes across each other: their edge is no line and no circle."""
    mesh, surface = cut("drill:d=6,l=20,a=90", (30, 20, 5), (30, 20, -7), (30, 20, 5), (30, 24, 5), (30, 24, -6))
    made = brep.make(mesh, surface, VOXEL)
    curves = [edge for edge in made.edges if edge.points]
    assert curves and all(len(edge.points) == len(edge.directions) > 1 for edge in curves)
    for edge in curves:
        beside = [face.shape for face in made.faces
                  if any(made.edges[n] is edge for loop in face.loops for n, _ in loop)]
        assert len(beside) == 2
        assert all(abs(shape.see(point)[0]) < 1e-6 for shape in beside for point in edge.points)
    assert "B_SPLINE_CURVE_WITH_KNOTS" in step.text(made)


def bend(edge, k):
    """Angle between the curve and the chord of one of its pieces at both ends."""
    chord = shapes.unit(add(edge.points[k + 1], edge.points[k], -1))
    return max(math.acos(min(dot(edge.directions[end], chord), 1.0)) for end in (k, k + 1))


@pytest.mark.parametrize("radius, voxel", [(2, 0.5), (1.99, 0.5), (1.99, 0.35)])
def test_curves_begin_where_faces_are_tangent(radius, voxel):
    """A tool with rounded corners ends beside where it began: the tubes cross in a curve whose end is on the floor, to
    which both are tangent. There it goes on as inside, and no piece of it is folded."""
    mesh, surface = cut(f"bull:d=8,r={radius},l=20", (15, 12, 5), (15, 12, -5), (45, 12, -5), (45, 28, -5),
                        (15, 28, -5), (15, 12.5, -5), (15, 12.5, 5), voxel=voxel)
    made = brep.make(mesh, surface, voxel)
    curves = [edge for edge in made.edges if edge.points]
    assert len(made.faces) == 34 and made.off_mm < 1e-9 and len(curves) == 5
    for edge in curves:
        lengths = [math.dist(a, b) for a, b in zip(edge.points, edge.points[1:])]
        assert min(lengths) > 0.05 and max(bend(edge, k) for k in range(len(lengths))) < 0.1
    end = (15 - math.sqrt((4 - radius) ** 2 - 0.25 ** 2), 12.25, -5)
    (way,) = (edge.directions[at] for edge in curves for at in (0, -1) if math.dist(edge.points[at], end) < 1e-9)
    assert abs(way[2]) < 1e-3 and abs(way[0]) == pytest.approx(1, abs=1e-6)  # along the floor


def test_step_files(tmp_path):
    """Ordinary files; names of any letters; tubes that cross their axis by the name that STEP has for them."""
    written = "it''s 5 \\\\ \\X2\\00C4\\X0\\\\X2\\000A\\X0\\\\X4\\0001F600\\X0\\"
    assert step._string("it's 5 \\ Ä\n\U0001F600") == written
    made = brep.make(*cut("bull:d=8,r=1,l=20", (30, 20, 5), (30, 20, -4)), VOXEL)
    step.write(made, tmp_path / "part.step", "Teil\nÄ")
    (tmp_path / "other").write_text("")
    assert (tmp_path / "part.step").stat().st_mode == (tmp_path / "other").stat().st_mode
    text = (tmp_path / "part.step").read_bytes().decode("ascii")
    assert r"PRODUCT('Teil\X2\000A\X0\\X2\00C4\X0\'," in text
    assert re.search(r"=TOROIDAL_SURFACE\('',#\d+,[\d.]+,[\d.]+\)", text)
    with pytest.raises(OSError, match="such.step: cannot write"):
        step.write(made, tmp_path / "no" / "such.step")
    for face in made.faces:
        if face.shape.kind == TORUS:
            face.shape = Shape(TORUS, face.shape.point, face.shape.axis, 1.0, 3.0)
    assert re.search(r"=DEGENERATE_TOROIDAL_SURFACE\('',#\d+,1\.0,3\.0,\.T\.\)", step.text(made))


def test_what_is_no_such_solid():
    with pytest.raises(brep.NotAnalytic, match="% of the surface is on planes") as told:
        brep.make(*cut("flat:d=6,l=20", (10, 20, 0), (50, 20, -8)), VOXEL)  # the rim of a disc on a slope
    assert 0.9 < told.value.share < 1
    with pytest.raises(brep.NotAnalytic) as told:
        brep.make(*cut("flat:d=6,l=20", (10, 20, 5), (10, 20, 4), stock={
            "kind": "cylinder", "base": (20, 20, -10), "axis": (0, 0, 10), "radius": 15}), VOXEL)
    assert told.value.share < 0.01
    mesh, surface = cut("flat:d=6,l=20", (10, 20, 5), (10, 20, -4))
    for open_mesh in (swarf.Mesh([], []), swarf.Mesh(mesh.vertices, mesh.triangles.tolist()[1:])):
        with pytest.raises(ValueError, match="closed"):
            brep.make(open_mesh, surface, VOXEL)
    made = brep.make(mesh, surface, VOXEL)
    made.faces[0].loops[0].pop()
    with pytest.raises(brep.NotAnalytic, match="do not close"):
        brep._Maker(regions.find(mesh, surface, VOXEL), VOXEL).check(made)


def test_a_hollow_is_in_its_solid(tmp_path):
    """A disc that cuts inside of a block alone; and a hollow that is in no solid."""
    mesh, surface = cut("flat:d=6,l=2", (20, 20, -6), (40, 20, -6))
    made = brep.make(mesh, surface, VOXEL)
    assert [len(shell) for shell in made.shells] == [6, 6] and made.solids == [[0, 1]] and made.off_mm < 1e-9
    assert {face.shape.kind for face in (made.faces[number] for number in made.shells[1])} == {PLANE, CYLINDER}
    text = step.text(made)
    assert re.search(r"=BREP_WITH_VOIDS\('',#\d+,\(#\d+\)\)", text) and "MANIFOLD_SOLID" not in text
    assert len(re.findall(r"=ORIENTED_CLOSED_SHELL\('',\*,#\d+,\.T\.\)", text)) == 1  # outwards is into the hollow
    with pytest.raises(brep.NotAnalytic, match="in no solid"):
        brep.make(mesh.keep_shells([1]), surface, VOXEL)


def test_a_hollow_is_in_what_is_round_it():
    """A block with a hollow, in the notch of an L that has less volume and a box round both."""
    hollow = job_of("flat:d=6,l=1", (10, 8, -6), (16, 8, -6))
    grooves = [place for y in (26, 30, 34, 38, 42) for place in ((-8, y, 5), (-8, y, -9.2), (53, y, -9.2), (53, y, 5))]
    grooves += [place for x in (36, 40, 44, 48, 52)
                for place in ((x, -8, 5), (x, -8, -9.2), (x, 48, -9.2), (x, 48, 5))]
    mesh, surface = cut("flat:d=6,l=20", (30, -10, 5), (30, -10, -12), (30, 20, -12), (-10, 20, -12), (-10, 20, 5),
                        *grooves, stock={"kind": "result", "job": hollow}, voxel=0.5)
    made = brep.make(mesh, surface, 0.5)
    owner, = (solid for solid in made.solids if len(solid) == 2)
    corners = [{made.edges[edge].start for number in made.shells[shell] for loop in made.faces[number].loops
                for edge, _ in loop} for shell in owner]
    boxes = [[max(made.corners[corner][axis] for corner in shell) for axis in range(3)] for shell in corners]
    assert len(made.solids) == 2 and boxes[0] == pytest.approx((27, 17, 0)) and boxes[1][2] == pytest.approx(-5)
    lines = [edge for edge in made.edges  # between the round end of the slot, and its wall and the groove beside it
             if all(math.dist(made.corners[at][:2], (33, 20)) < 1e-9 for at in (edge.start, edge.end))]
    assert len(lines) == 2 and not any(edge.points for edge in lines) and made.off_mm < 1e-12


def test_an_empty_mesh_has_no_regions():
    _, surface = cut("flat:d=6,l=20", (10, 20, 5), (10, 20, -4))
    found = regions.find(swarf.Mesh([], []), surface, VOXEL)
    assert (found.region_of, found.shape, found.unknown, found.known_share) == ([], [], [], 0)


def test_edges_that_turn_back_end():
    """A ball that turns back into its own slot: a curve whose points once went to and fro for ever."""
    mesh, surface = cut("ball:d=6,l=20", (23.5, 11, 5), (23.5, 11, -4), (23.5, 19.5, -4),
                        ((28, 15, -4), (28, 19.5, -4)))
    with pytest.raises(brep.NotAnalytic, match="an edge is no smooth curve|an edge is not found"):
        brep.make(mesh, surface, VOXEL)


def raster(rows, columns):
    """(mesh, surface) of a relief: a ball in lines up and down, each a shape of its own."""
    moves = [(2, 2, 5)]
    for row in range(rows):
        y = 2 + 36 * row / (rows - 1)
        xs = [2 + 56 * k / (columns - 1) for k in range(columns)][::-1 if row % 2 else 1]
        moves += [(x, y, -3 + math.sin(x / 4) * math.cos(y / 5)) for x in xs]
    return cut("ball:d=6,l=20", *moves)


def test_too_many_shapes():
    """They are refused before they are compared, and what is under way ends soon after it is cancelled."""
    mesh, surface = raster(24, 48)
    with pytest.raises(brep.NotAnalytic, match="more than 1000 shapes") as told:
        brep.make(mesh, surface, VOXEL)
    assert 0.9 < told.value.share <= 1
    mesh, surface = raster(12, 24)
    for wanted in (0.0, 0.24, 0.25):
        calls = []  # all that are made from the cancelling on: making it takes millions

        def progress(done):
            if done >= wanted:
                sys.setprofile(lambda frame, event, argument: calls.append(event))
            return done >= wanted

        try:
            with pytest.raises(swarf.Cancelled):
                brep.make(mesh, surface, VOXEL, progress=progress)
        finally:
            sys.setprofile(None)
        assert 0 < len(calls) < 100


def test_progress_is_told_all_along(monkeypatch):
    """Searching for shapes, for regions, for corners and along edges: some thousand turns at most between two
    reports."""
    mesh, surface = cut("bull:d=6,r=1,l=20", (10, 10, 5), (10, 10, -4), (40, 10, -4), (40, 30, -4))
    monkeypatch.setattr(regions, "TURNS", 16)
    told = []
    brep.make(mesh, surface, VOXEL, progress=told.append)
    assert told == sorted(told)
    assert told.count(0.25) > mesh.triangle_count / 16 and told.count(0.6) > 10  # per triangle; per corner
    assert len([done for done in told if done > 0.5]) > 200  # per point of an edge


def test_cancelled():
    mesh, surface = cut("flat:d=6,l=20", (10, 20, 5), (10, 20, -4))
    for wanted in (0.0, 0.3, 0.6):
        with pytest.raises(swarf.Cancelled):
            brep.make(mesh, surface, VOXEL, progress=lambda done: done >= wanted)
    told = []
    brep.make(mesh, surface, VOXEL, progress=lambda done: told.append(done) and None)
    assert told == sorted(told) and 0 <= told[0] and told[-1] <= 1
