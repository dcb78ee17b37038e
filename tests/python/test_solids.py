# SPDX-License-Identifier: LGPL-2.1-or-later
"""STEP files: faces as they were cut where these are known, else facets, and the reason."""
import json
import math
import os
import random
import re

import pytest

import swarf
from conftest import GCODE
from swarf import parts, solids
from swarf.solids import brep, export, regions, strips
from swarf.cli import main
from swarf.vectors import add, cross, dot

WORDS = ("--stock", "box:0,0,-10,60,40,0", "--tool", "1=flat:d=6,l=20", "--voxel", "0.5")


def volume(made):
    """Of a Brep of triangles."""
    total = 0.0
    for face in made.faces:
        (loop,) = face.loops
        a, b, c = (made.corners[made.edges[edge].start if forwards else made.edges[edge].end]
                   for edge, forwards in loop)
        total += dot(a, cross(b, c)) / 6
        assert dot(cross(add(b, a, -1), add(c, a, -1)), face.shape.axis) > 0
    return total


def test_facets_enclose_what_the_mesh_does():
    stock = swarf.Stock.box((0, 0, 0), (6, 5, 4), voxel=0.5)
    mesh = swarf.Mesh.from_stock(stock, 0.05)
    made = solids.facets(mesh)
    assert len(made.faces) == mesh.triangle_count and len(made.shells) == 1
    assert len(made.corners) - len(made.edges) + len(made.faces) == 2
    assert volume(made) == pytest.approx(mesh.volume, rel=1e-9)
    uses = [(edge, forwards) for face in made.faces for loop in face.loops for edge, forwards in loop]
    assert sorted(uses) == [(edge, way) for edge in range(len(made.edges)) for way in (False, True)]


def test_two_solids_and_what_is_none():
    box = solids_box((0, 0, 0), (1, 1, 1))
    apart = solids_box((0, 0, 0), (1, 1, 1), (2, 0, 0), (3, 1, 1))
    assert len(solids.facets(box).shells) == 1 and len(solids.facets(apart).shells) == 2
    hollow = swarf.Mesh(*join((0, 0, 0), (3, 3, 3), (1, 1, 1), (2, 2, 2), turned=True))
    made = solids.facets(hollow)
    assert made.solids == [[0, 1]] and volume(made) == pytest.approx(27 - 1)
    assert solids.facets(apart).solids == [[0], [1]]
    with pytest.raises(ValueError, match="in no solid"):
        solids.facets(hollow.keep_shells([1]))
    with pytest.raises(ValueError, match="closed"):
        solids.facets(swarf.Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]))


def test_a_hollow_goes_with_what_is_round_it(tmp_path):
    """A box with a hollow, in the notch of an L that has less volume and a bounding box round both."""
    outline = ((0, 0), (10, 0), (10, 1), (1, 1), (1, 10), (0, 10))
    caps = ((0, 1, 2), (0, 2, 3), (0, 3, 5), (3, 4, 5))
    vertices = [(x, y, z) for z in (0, 10) for x, y in outline]
    triangles = [tuple(k + 6 for k in one) for one in caps] + [one[::-1] for one in caps]
    for k in range(6):
        after = (k + 1) % 6
        triangles += [(k, after, after + 6), (k, after + 6, k + 6)]
    corners, others = join((2, 2, 1), (9, 9, 9), (3, 3, 3), (5, 5, 5), turned=True)
    both = swarf.Mesh(vertices + corners, triangles + [tuple(k + 12 for k in one) for one in others])
    assert both.volume == pytest.approx(190 + 392 - 8)
    made = solids.facets(both)
    assert sorted(map(len, made.solids)) == [1, 2] and len(made.shells) == 3
    (owner,) = (solid for solid in made.solids if len(solid) == 2)
    assert max(made.corners[made.edges[edge].start][0] for number in made.shells[owner[0]]
               for edge, _ in made.faces[number].loops[0]) == 9
    assert parts.largest(both).volume == pytest.approx(392 - 8)
    both.write(tmp_path / "both.ply")
    assert main(["mesh", str(tmp_path / "both.ply"), "--split", "--output", str(tmp_path / "part.ply")]) == 0
    volumes = [swarf.Mesh.read(tmp_path / f"part-{number}.ply").volume for number in (1, 2)]
    assert volumes == pytest.approx([392 - 8, 190])


def join(*corners, turned=False):
    """Vertices and triangles of boxes; the last one's turned inside out."""
    quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    vertices, triangles = [], []
    for number in range(0, len(corners), 2):
        lo, hi, first = corners[number], corners[number + 1], len(vertices)
        vertices += [((lo, hi)[i >> 2][0], (lo, hi)[i >> 1 & 1][1], (lo, hi)[i & 1][2]) for i in range(8)]
        for a, b, c, d in quads:
            both = [(a, b, c), (a, c, d)]
            if turned and number + 2 == len(corners):
                both = [tuple(reversed(one)) for one in both]
            triangles += [tuple(first + vertex for vertex in one) for one in both]
    return vertices, triangles


def solids_box(*corners):
    return swarf.Mesh(*join(*corners))


def test_faces_as_they_were_cut(tmp_path, capsys):
    program = tmp_path / "slot.nc"
    program.write_text(GCODE)
    names = [str(tmp_path / name) for name in ("part.step", "part.stl", "report.json")]
    status = main(["simulate", str(program), *WORDS, "--output", names[0], "--output", names[1], "--report", names[2]])
    assert status == 0 and capsys.readouterr().err == ""
    text = (tmp_path / "part.step").read_text()
    faces = text.count("ADVANCED_FACE(")
    planes, cylinders = text.count("=PLANE("), text.count("=CYLINDRICAL_SURFACE(")
    assert faces == planes + cylinders and cylinders > 0
    assert json.loads((tmp_path / "report.json").read_text())["solids"] == [
        {"file": names[0], "faces": faces, "facets_because": None, "off_mm": pytest.approx(0, abs=1e-6)}]


def test_a_missing_face_is_told(tmp_path, capsys, monkeypatch):
    """The cylinder of a bend left out on purpose: the planes beside it meet farther out, by r (1 / cos(bend / 2) - 1)
    at their edge, and it is less beside that."""
    monkeypatch.setattr(strips, "mend", lambda *arguments: None)
    monkeypatch.setattr(regions, "NARROW", 2.0)
    program, bend = tmp_path / "bend.nc", math.radians(5)
    program.write_text("G21 G90\nT1 M6\nS1000 M3\nG0 X10 Y15 Z5\nG1 Z-4 F100\nG1 X30\n"
                       f"G1 X50 Y{15 + 20 * math.tan(bend):.6f}\nG0 Z5\nM30\n")
    words = ["simulate", str(program), "--stock", "box:0,0,-10,60,40,0", "--tool", "1=flat:d=10,l=20", "--voxel", "0.5",
             "--output", str(tmp_path / "part.step"), "--report", str(tmp_path / "report.json")]
    assert main(words) == 0
    most = 5 * (1 / math.cos(bend / 2) - 1)
    (made,) = json.loads((tmp_path / "report.json").read_text())["solids"]
    assert made["facets_because"] is None and most / 2 < made["off_mm"] < most
    told = capsys.readouterr().err
    assert re.search(r"note: .*part.step: a narrow face is missing near \(30.\d+, 10.\d+, .* off by 0.00\d+ mm", told)
    monkeypatch.setattr(brep, "NEAR", 0.005)  # what is farther off than that is refused
    assert main(words) == 0
    assert "it would be off by 0.00" in capsys.readouterr().err


def test_facets_and_why(tmp_path, capsys):
    """A flat end down a slope leaves a face that is none of the five."""
    program = tmp_path / "ramp.nc"
    program.write_text("G21 G90\nT1 M6\nS1000 M3\nG0 X10 Y20 Z5\nG1 Z-1 F100\nG1 X45 Y25 Z-4\nG0 Z5\nM30\n")
    step = tmp_path / "part.stp"
    status = main(["simulate", str(program), *WORDS, "--output", str(step), "--report", str(tmp_path / "report.json")])
    told = capsys.readouterr().err
    text = step.read_text()
    made = json.loads((tmp_path / "report.json").read_text())["solids"][0]
    assert made["off_mm"] is None
    assert status == 0 and re.search(r"note: .*part.stp: \d+ facets, .*not what is near \(", told)
    assert text.count("ADVANCED_FACE(") == text.count("=PLANE(") == made["faces"] and "near" in made["facets_because"]
    assert text.count("=LINE(") == made["faces"] * 3 // 2


def test_meshes_and_too_many(tmp_path, capsys, monkeypatch):
    stock = swarf.Stock.box((0, 0, 0), (6, 5, 4), voxel=0.5)
    stock.write(tmp_path / "stock.vdb")
    words = ["mesh", str(tmp_path / "stock.vdb"), "--output", str(tmp_path / "part.step")]
    assert main(words) == 0 and "swarf simulate --output knows" in capsys.readouterr().err
    assert (tmp_path / "part.step").read_text().count("ADVANCED_FACE(") >= 12
    (tmp_path / "part.step").unlink()
    monkeypatch.setattr(export, "FACETS_MAX", 3)
    assert main(words) == 2 and "too many for facets" in capsys.readouterr().err
    assert not (tmp_path / "part.step").exists()


def test_nothing_left(tmp_path, capsys):
    program = tmp_path / "all.nc"
    program.write_text("G21 G90\nT1 M6\nS1000 M3\nG0 X-5 Y-5 Z5\nG1 Z-2 F100\nG1 X5 Y5\n")
    assert main(["simulate", str(program), "--stock", "box:0,0,-1,1,1,0", *WORDS[2:], "--output",
                 str(tmp_path / "part.step")]) == 2
    assert "part.step: cannot be written: nothing is left of the stock\n" in capsys.readouterr().err
    assert not (tmp_path / "part.step").exists()


def test_writing_can_be_cancelled_at_any_time(tmp_path):
    """The old file stays, nothing is left beside it; once the new one is there it is too late."""
    path = tmp_path / "part.step"
    path.write_text("old")
    mesh = swarf.Mesh.from_stock(swarf.Stock.box((0, 0, 0), (6, 5, 4), voxel=0.5))
    told = []
    solids.write_facets(mesh, str(tmp_path / "other.step"), "no", told.append)
    (tmp_path / "other.step").unlink()
    writing = [done for done in told if 0.7 <= done < 1.0]
    assert told == sorted(told) and len(writing) >= 3, "vertices, edges and faces of the file"
    for limit in writing:
        with pytest.raises(swarf.Cancelled):
            solids.write_facets(mesh, str(path), "no", lambda done, limit=limit: done >= limit)
        assert path.read_text() == "old" and os.listdir(tmp_path) == ["part.step"]


def test_solids_that_touch_along_an_edge():
    """Four triangles share an edge there: in any order each edge of the file has two."""
    vertices, triangles = join((0, 0, 0), (1, 1, 1), (1, 1, 0), (2, 2, 1))
    number = {place: index for index, place in enumerate(dict.fromkeys(vertices))}
    triangles = [tuple(number[vertices[vertex]] for vertex in triangle) for triangle in triangles]
    for seed in range(20):
        random.Random(seed).shuffle(triangles)
        made = solids.facets(swarf.Mesh(list(number), triangles))
        uses = [(edge, forwards) for face in made.faces for loop in face.loops for edge, forwards in loop]
        assert sorted(uses) == [(edge, way) for edge in range(len(made.edges)) for way in (False, True)]


def test_a_triangle_without_area_is_no_face():
    vertices, triangles = join((0, 0, 0), (1, 1, 1))
    (a, b, c), *others = triangles
    middle = tuple((p + q) / 2 for p, q in zip(vertices[a], vertices[b]))
    split = [(a, len(vertices), c), (len(vertices), b, c), (a, b, len(vertices)), *others]
    with pytest.raises(ValueError, match="no area"):
        solids.facets(swarf.Mesh([*vertices, middle], split))


def test_a_refused_solid_leaves_the_rest(tmp_path, capsys, monkeypatch):
    program = tmp_path / "ramp.nc"
    program.write_text("G21 G90\nT1 M6\nS1000 M3\nG0 X10 Y20 Z5\nG1 Z-1 F100\nG1 X45 Y25 Z-4\nG0 Z5\nM30\n")
    monkeypatch.setattr(export, "FACETS_MAX", 3)
    names = [str(tmp_path / name) for name in ("part.step", "part.stl", "part.png")]
    assert main(["simulate", str(program), *WORDS, "--output", names[0], "--output", names[1], "--picture",
                 names[2]]) == 2
    assert "too many for facets" in capsys.readouterr().err
    written = {path.name for path in tmp_path.iterdir()}
    assert "part.step" not in written and {"part.stl", "part.png"} <= written
