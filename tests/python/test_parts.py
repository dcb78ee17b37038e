# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meshes in parts: split by planes, wall thickness, loose pieces and who freed them, colours of triangles."""
import importlib
import json
import math
import xml.etree.ElementTree as xml

import pytest

import swarf
from swarf import colours, parts, report, stocks
from swarf.cli import main
from swarf.job import Job

LO, HI, VOXEL = (0.0, 0.0, -5.0), (30.0, 20.0, 0.0), 0.25
BOX = {"kind": "box", "lo": LO, "hi": HI}

#: A groove, then a cut to the bottom along it but for its last quarter, which line 9 takes; a corner is cut off by line
#: 12.
PROGRAM = """\
T1 M6
S8000 M3
G0 X15 Y-5 Z5
G1 Z-3 F200
G1 Y25 F400
G1 Z-5.5
G1 Y8
G1 Y4
G1 Y-5
G0 Z5
G0 X30 Y9
G1 Z-6 F200
G1 X22 F400
G1 Y22
G0 Z5
M2
"""


@pytest.fixture(scope="module", name="job")
def fixture_job():
    return Job(name="cut", program=swarf.Program.parse_gcode(PROGRAM), tools={1: swarf.Cutter("flat:d=2,l=20")},
               stock=BOX, design=swarf.Mesh.from_stock(swarf.Stock.box(LO, (14.0, 20.0, 0.0), VOXEL)))


@pytest.fixture(scope="module", name="done")
def fixture_done(job):
    return swarf.simulate(job, voxel=VOXEL)


def boxes(count, hollow=False):
    """Cubes of 2 mm in a row; each with a hollow in it."""
    corners, triangles = [], []
    for number in range(count):
        for size, turned in ((2.0, False), (1.0, True))[:1 + hollow]:
            lo, first = (3 * number + 1 - size / 2, 1 - size / 2, 1 - size / 2), len(corners)
            corners += [tuple(low + size * (place >> axis & 1) for axis, low in enumerate(lo)) for place in range(8)]
            for a, b, c in ((0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7),
                            (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)):
                triangles.append(tuple(first + corner for corner in ((a, c, b) if turned else (a, b, c))))
    return swarf.Mesh(corners, triangles)


def test_pieces_are_made_in_one_pass():
    """Not one by one, which takes the whole mesh for each."""
    class Counting:
        """A mesh whose shells are asked for so many times."""
        def __init__(self, mesh):
            self.shells, self.mesh, self.asked = mesh.shells, mesh, 0

        def split_shells(self, groups, progress=None):
            self.asked += 1
            return self.mesh.split_shells(groups, progress=progress)

    mesh = Counting(boxes(20, hollow=True))
    told = []
    made = parts.split_pieces(mesh, told.append)
    assert [piece.volume for piece in made] == pytest.approx([7.0] * 20)
    assert len({piece.bounding_box for piece in made}) == 20
    assert mesh.asked == 2 and told == sorted(told) and told[-1] == 1
    for last in (0.25, 0.75):
        with pytest.raises(swarf.Cancelled):
            parts.split_pieces(boxes(20), lambda done: done >= last)


def test_split(done, tmp_path, capsys):
    below, above = done.mesh.split((0, 0, -3), (0, 0, 1))  # at the groove's floor, of which nothing is left
    assert below.closed and above.closed
    assert below.volume + above.volume == pytest.approx(done.mesh.volume, rel=1e-5)
    assert above.volume / below.volume == pytest.approx(3 / 2, rel=2e-2)
    with pytest.raises(swarf.GeometryError, match="only closed"):
        swarf.Mesh(done.mesh.vertices, done.mesh.triangles.tolist()[1:]).split((0, 0, -3), (0, 0, 1))
    with pytest.raises(ValueError, match="normal"):
        done.mesh.split((0, 0, -3), (0, 0, 0))
    done.mesh.write(tmp_path / "cut.ply")
    words = ["mesh", str(tmp_path / "cut.ply"), "--output", str(tmp_path / "part.ply")]
    assert main([*words, "--split-at", "z=-3"]) == 0
    assert swarf.Mesh.read(tmp_path / "part-1.ply").volume == pytest.approx(below.volume, rel=1e-6)
    assert swarf.Mesh.read(tmp_path / "part-2.ply").volume == pytest.approx(above.volume, rel=1e-6)
    assert main([*words, "--split-at", "5,5,-2,1,0.5,0", "--split-at", "z=-1", "--split"]) == 0
    files = sorted(tmp_path.glob("part-*.ply"))
    volumes = [swarf.Mesh.read(file).volume for file in files]
    assert len(files) == 8 and sum(volumes) == pytest.approx(done.mesh.volume, rel=1e-5)  # one of three pieces is cut
    for words in (["--split-at", "z"], ["--split-at", "1,2,3,0,0,0"], ["--split-at", "q=3"]):
        with pytest.raises(SystemExit):
            main(["mesh", str(tmp_path / "cut.ply"), "--output", str(tmp_path / "p.ply"), *words])
    capsys.readouterr()
    assert main(["mesh", str(tmp_path / "cut.ply"), "--measure", "--split-at", "z=1"]) == 2
    assert "give --output" in capsys.readouterr().err


def area_of(curve):
    """Within a closed curve, counter-clockwise above 0."""
    return sum(a * d - b * c for (a, b), (c, d) in zip(curve, (*curve[1:], curve[0]))) / 2


def curves_of(path):
    """The curves in a drawing, read as the formats say."""
    text = path.read_text()
    if path.suffix == ".svg":
        root = xml.fromstring(text)
        box, size = [float(word) for word in root.get("viewBox").split()], (root.get("width"), root.get("height"))
        assert size == tuple(f"{edge:.6f}mm" for edge in box[2:])  # a unit of the drawing is a millimetre
        (drawn,) = root
        found = [[tuple(map(float, word[word[0] in "ML":].split(","))) for word in part.split()]
                 for part in drawn.get("d").split(" Z")[:-1]]
        assert all(box[k] < corner[k] < box[k] + box[2 + k] for curve in found for corner in curve for k in (0, 1))
        return [[(x, -y) for x, y in curve] for curve in found]
    words = text.splitlines()
    found, pairs = [], list(zip(map(int, words[::2]), words[1::2]))
    assert pairs[-1] == (0, "EOF")
    for number, pair in enumerate(pairs):
        if pair == (0, "POLYLINE"):
            assert (70, "1") in pairs[number:number + 4]  # closed
            found.append([])
        elif pair == (0, "VERTEX"):
            values = dict(pairs[number + 1:number + 5])
            assert float(values[30]) == 0
            found[-1].append((float(values[10]), float(values[20])))
    return found


@pytest.mark.parametrize("suffix", [".svg", ".dxf"])
def test_sections(suffix, tmp_path, capsys):
    """A block with a hollow in it: areas in closed form, in the coordinates of the part."""
    outer, inner = ((2, 3, 4), (12, 8, 7)), ((3, 5, 4.5), (10, 6, 6))
    boxes = [stocks._box_mesh(box) for box in (outer, inner)]
    corners = [corner for box in boxes for corner in box.vertices.tolist()]
    hollow = swarf.Mesh(corners, boxes[0].triangles.tolist()
                        + [[8 + c, 8 + b, 8 + a] for a, b, c in boxes[1].triangles.tolist()])
    hollow.write(tmp_path / "hollow.ply")
    words = ["mesh", str(tmp_path / "hollow.ply")]
    drawn = tmp_path / ("cut" + suffix)
    for plane, box, area in (("z=5", ((2, 3), (12, 8)), 10 * 5 - 7 * 1), ("y=5.5", ((2, 4), (12, 7)), 10 * 3 - 7 * 1.5),
                             ("x=11", ((3, 4), (8, 7)), 5 * 3)):
        assert main([*words, "--section", plane, "--output", str(drawn)]) == 0
        curves = curves_of(drawn)
        assert len(curves) == (1 if plane == "x=11" else 2)
        assert abs(sum(map(area_of, curves))) == pytest.approx(area, abs=1e-4)
        for k in (0, 1):
            assert min(corner[k] for curve in curves for corner in curve) == pytest.approx(box[0][k], abs=1e-5)
            assert max(corner[k] for curve in curves for corner in curve) == pytest.approx(box[1][k], abs=1e-5)
    # a slope of 3 in 4 from an edge of the bottom on, seen against its normal: 5 long up to the top, 1 to 8 of the
    # hollow across, 2 / 0.8 to 1.5 / 0.6 + 5 / 6 of it along
    assert main([*words, "--section", "2,3,4,0,-0.6,0.8", "--output", str(drawn), "--output",
                 str(tmp_path / "copy.stl")]) == 0
    found = [(area_of(curve), [tuple(round(pick(corner[k] for corner in curve), 4) for k in (0, 1))
                               for pick in (min, max)]) for curve in curves_of(drawn)]
    assert sorted(found) == [(pytest.approx(-7 * 5 / 6, abs=1e-4), [(1, 2.5), (8, 3.3333)]),
                             (pytest.approx(50, abs=1e-4), [(0, 0), (10, 5)])]
    both = tmp_path / ("both" + suffix)
    assert main([*words, "--section", "z=5", "--section", "x=11", "--output", str(both)]) == 0
    assert [len(curves_of(tmp_path / f"both-{number}{suffix}")) for number in (1, 2)] == [2, 1] and not both.exists()
    assert main([*words, "--section", "z=5", "--section", "z=9", "--output", str(tmp_path / f"none{suffix}")]) == 2
    assert "hollow.ply: section 2 does not cut it" in capsys.readouterr().err
    assert not list(tmp_path.glob("none*"))
    # along its faces, corners alone; across z but for rounding, as across z
    for plane in ("z=4", "z=7", "0,0,7,1e-17,0,1"):
        assert main([*words, "--section", plane, "--output", str(drawn)]) == 0
        assert [sorted(curve) for curve in curves_of(drawn)] == [[(2, 3), (2, 8), (12, 3), (12, 8)]]
    assert swarf.Mesh.read(tmp_path / "copy.stl").volume == pytest.approx(hollow.volume)


def test_thickness(done, tmp_path, capsys):
    plate = stocks._box_mesh(((0, 0, 0), (20, 10, 1.5)))
    values = plate.thickness()
    assert values.format == "f" and len(values) == plate.triangle_count
    assert sorted({round(value, 3) for value in values}) == [1.5, 10, 20]
    thin = parts.thinnest(plate)
    assert thin["least_mm"] == pytest.approx(1.5, abs=1e-4)
    assert thin["place"][2] in (pytest.approx(0), pytest.approx(1.5))
    path = tmp_path / "plate.ply"
    plate.write(path)
    assert main(["mesh", str(path), "--thickness", "--measure", "--output", str(tmp_path / "thick.ply")]) == 0
    assert json.loads(capsys.readouterr().out)["thickness"]["least_mm"] == pytest.approx(1.5, abs=1e-4)
    assert colours.by_thickness(plate, 1.5) == [colours.STOPS[-1]] * plate.triangle_count
    assert parts.thinnest(swarf.Mesh([], []))["least_mm"] is None


def test_loose_pieces_and_their_lines(done):
    found = done.loose.pieces
    assert [piece.line for piece in found] == [9, 14] and done.loose.crumbs == 0
    assert found[0].operation == "T1" and found[0].move < found[1].move
    volumes = [14 * 20 * 5, 30 * 20 * 5 - 14 * 20 * 5]  # left of the cut; right of it less kerf and corner
    assert found[1].lump.volume_mm3 == pytest.approx(7 * 10 * 5, rel=0.1)
    assert "this move frees it" in found[0].text
    assert volumes[0] == pytest.approx(done.stock.lumps()[0][0].volume_mm3, rel=0.02)


def test_loose_pieces_are_findings(job):
    found = [finding for finding in swarf.verify(job, voxel=0.5, loads=False).findings if finding.kind == "loose"]
    told = [(finding.severity, finding.line, finding.operation) for finding in found]
    assert told == [("warning", 9, "T1"), ("warning", 14, "T1")]
    assert found[1].amount == pytest.approx(7 * 10 * 5, rel=0.15) and found[1].place[0] > 20


def test_who_looks_for_loose_pieces_can_be_cancelled(job):
    told = []
    swarf.simulate(job, voxel=0.5, compare=False, progress=lambda stage, done: told.append((stage, done)) and None)
    fractions = [done for stage, done in told if stage == "loose"]
    assert fractions == sorted(fractions) and 0 <= fractions[0] and fractions[-1] <= 1
    assert any(0.3 < done < 1 for done in fractions)  # the search for the moves, not only the lumps
    for wanted in (0.0, 0.11, 0.31, 0.5):
        late = []
        with pytest.raises(swarf.Cancelled):
            swarf.simulate(job, voxel=0.5, progress=lambda stage, done: stage == "loose" and done >= wanted)
        with pytest.raises(swarf.Cancelled):
            swarf.verify(job, voxel=0.5, loads=False, progress=lambda stage, done: stage == "loose" and (
                late.append(done) or done >= wanted))
        assert sum(done >= wanted for done in late) == 1


def test_loose_from_the_beginning(job):
    two = swarf.Stock.box((0, 0, -5), (10, 20, 0), VOXEL)
    other = swarf.Mesh.from_stock(swarf.Stock.box((12, 0, -5), (20, 20, 0), VOXEL))
    mesh = swarf.Mesh.from_stock(two)
    count = mesh.vertex_count
    both = swarf.Mesh(mesh.vertices.tolist() + other.vertices.tolist(),
                      mesh.triangles.tolist() + [[v + count for v in t] for t in other.triangles.tolist()])
    late = swarf.simulate(Job(name="two", program=job.program, tools=job.tools, stock={"kind": "mesh", "mesh": both}),
                          voxel=VOXEL)
    assert late.loose.pieces[0].move == -1 and "before the program" in late.loose.pieces[0].text


def test_drop(job, tmp_path, capsys):
    kept = swarf.simulate(job, voxel=VOXEL, drop_loose=True, outputs=[str(tmp_path / "part.vdb")])
    assert len(kept.stock.lumps()[0]) == 1 and len(kept.mesh.shells()) == 1
    assert kept.mesh.volume == pytest.approx(14 * 20 * 5, rel=1e-3)
    left = swarf.Stock.read(tmp_path / "part.vdb").volume()
    assert left == pytest.approx(14 * 20 * 5, rel=1e-2)
    assert kept.comparison.excess_mm3 + kept.comparison.gouge_mm3 < 0.01 * left  # the design is what is kept
    told = report.make(kept, "job")["volume_mm3"]
    assert told["final"] == pytest.approx(left) and told["loose_dropped"] > 7 * 10 * 4
    assert told["initial"] - told["removed"] - told["loose_dropped"] == pytest.approx(told["final"])
    program = tmp_path / "cut.nc"
    program.write_text(PROGRAM)
    status = main(["simulate", str(program), "--stock", "box:0,0,-5,30,20,0", "--tool", "1=flat:d=2,l=20", "--voxel",
                   "0.25", "--loose", "drop", "--colours", "operation", "--output", str(tmp_path / "part.ply"),
                   "--report", str(tmp_path / "report.json")])
    assert status == 0 and "line 9: a piece of" in capsys.readouterr().err
    assert swarf.Mesh.read(tmp_path / "part.ply").volume == pytest.approx(14 * 20 * 5, rel=1e-3)
    made = json.loads((tmp_path / "report.json").read_text())
    assert [piece["line"] for piece in made["loose_pieces"]] == [9, 14]


def test_what_is_dropped_is_not_in_the_picture(job, tmp_path, monkeypatch):
    """The picture is of what is kept, as that of a stock that never had more."""
    pictures = []

    class Recorded:
        def __init__(self, stock):
            self._scene = swarf.Scene(stock)
            self.show_surface = self._scene.show_surface

        def render(self, *words, **named):
            pictures.append(self._scene.render(*words, **named))
            return pictures[-1]

    monkeypatch.setattr(importlib.import_module("swarf.simulate"), "Scene", Recorded)
    for hi, drop in ((HI, True), ((14.0, 20.0, 0.0), False), (HI, False)):
        stock = {"kind": "box", "lo": LO, "hi": hi}
        swarf.simulate(Job(name="job", program=job.program, tools=job.tools, stock=stock), voxel=VOXEL, mesh=False,
                       drop_loose=drop, picture=str(tmp_path / f"{len(pictures)}.png"), picture_size=(200, 150))
    kept, never, whole = (bytes(picture.rgba) for picture in pictures)
    same, other = (sum(abs(a - b) > 30 for a, b in zip(kept, picture)) / len(kept) for picture in (never, whole))
    assert same < 0.01 and other > 0.1, (same, other)


def test_colours(done, job):
    tints = colours.make("operation", done.mesh, done.surface, job)
    assert set(tints) == {colours.FIRST_SHAPE, colours.OPERATIONS[0]}
    cut = 0.0
    vertices = done.mesh.vertices.tolist()
    for tint, triangle in zip(tints, done.mesh.triangles.tolist()):
        xs = [vertices[v][0] for v in triangle]
        if tint == colours.OPERATIONS[0] and max(xs) - min(xs) < 1e-3 and xs[0] < 15:
            a, b, c = (vertices[v] for v in triangle)
            cut += abs((b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1])) / 2
    assert cut == pytest.approx(20 * 5, rel=1e-2)  # the wall left of the cut, in two steps
    tints = colours.make("deviation", done.mesh, done.surface, job, 0.05)
    assert len(tints) == done.mesh.triangle_count and len(set(tints)) > 1
    loosely = colours.make("deviation", done.mesh, done.surface, job, 50.0)
    assert len(set(loosely)) == 1 and loosely != tints
    for kind in ("operation", "deviation"):
        with pytest.raises(ValueError, match="colours by " + kind):
            colours.make(kind, done.mesh, None, Job(name="none", program=job.program))
    with pytest.raises(ValueError, match="wanted operation"):
        colours.make("rainbow", done.mesh, None, job)
    assert math.isclose(sum(colours._scale(0.0)), sum(colours.STOPS[0]))


@pytest.mark.parametrize("kind", colours.KINDS)
def test_who_colours_can_be_cancelled(done, job, kind):
    told = []
    tints = colours.make(kind, done.mesh, done.surface, job, progress=told.append)
    assert tints == colours.make(kind, done.mesh, done.surface, job)
    assert told == sorted(told) and 0 <= told[0] and told[-1] <= 1
    for wanted in sorted(set(told)):
        with pytest.raises(swarf.Cancelled):
            colours.make(kind, done.mesh, done.surface, job, progress=lambda part: part >= wanted)


def test_the_tolerance_of_colours(tmp_path, capsys):
    program, files = tmp_path / "cut.nc", []
    program.write_text(PROGRAM)
    job = Job(name="box", program=swarf.Program.parse_gcode(PROGRAM), tools={1: swarf.Cutter("flat:d=2,l=20")},
              stock=BOX, design=stocks._box_mesh((LO, HI)))
    for tolerance in (0.05, 20.0):
        files.append(tmp_path / f"{tolerance}.ply")
        swarf.simulate(job, voxel=0.5, compare=False, colour="deviation", tolerance=tolerance, outputs=[str(files[-1])])
    assert files[0].read_bytes() != files[1].read_bytes()
    words = ["simulate", str(program), "--stock", "box:0,0,-5,30,20,0", "--tool", "1=flat:d=2,l=20", "--tolerance"]
    for wrong in ("0", "nan", "-1"):
        assert main([*words, wrong]) == 2 and "wanted a number above 0" in capsys.readouterr().err


def test_the_allowance_of_colours(capsys):
    """A plate that is 1 mm too large all round is what an allowance of 1 mm asks for."""
    plate = swarf.Mesh.from_stock(swarf.Stock.box((-1, -1, -6), (31, 21, 1), 0.5))
    design = stocks._box_mesh(((0, 0, -5), (30, 20, 0)))
    exact, left, missing = (colours.by_deviation(plate, design, 0.2, allowance=mm) for mm in (1.0, 0.0, 2.0))
    corners, solid = plate.vertices.tolist(), swarf.Solid(design)
    middles = [[sum(corners[v][k] for v in row) / 3 for k in range(3)] for row in plate.triangles.tolist()]
    faces = [i for i, value in enumerate(solid.distance(middles)) if value < 1.01]
    assert len(faces) > 6
    assert all(exact[i][1] > max(exact[i][0], exact[i][2]) for i in faces)  # green
    assert all(left[i][0] > left[i][2] and missing[i][2] > missing[i][0] for i in faces)
    words = ["simulate", "none.nc", "--allowance", "nan"]
    assert main(words) == 2 and "allowance nan" in capsys.readouterr().err


def test_lumps(done):
    lumps, places = done.stock.lumps([(5, 10, -2), (15, 10, -2), (18, 5, -2)])
    assert len(lumps) == 3 and places[0] == 0 and places[1] is None and places[2] in (1, 2)
    assert sum(lump.volume_mm3 for lump in lumps) == pytest.approx(done.stock.volume(), rel=0.02)
    with pytest.raises(ValueError, match="points"):
        done.stock.lumps([(1, 2)])


@pytest.mark.parametrize("tool, moves, wanted", [
    # a slot: planes, and a round end on either side
    ("flat:d=6,l=20", ((10, 20, 5), (10, 20, -4), (50, 20, -4)),
     {"plane": 2 * (2400 + 600 + 400) + 2 * 40 * 4, "cylinder": math.pi * 6 * 4}),
    # a ball's groove: a half cylinder below, at both ends a quarter of a sphere; walls above
    ("ball:d=6,l=20", ((10, 20, 5), (10, 20, -5), (50, 20, -5)),
     {"cylinder": 40 * math.pi * 3 + math.pi * 6 * 2, "sphere": 2 * math.pi * 9}),
    # a drill: a cylinder and its point
    ("drill:d=6,l=20,a=90", ((30, 20, 5), (30, 20, -7)),
     {"cylinder": math.pi * 6 * 4, "cone": math.pi * 9 * math.sqrt(2)}),
    # a bull-nose mill standing: the ring of its corner
    ("bull:d=8,r=1,l=20", ((30, 20, 5), (30, 20, -4)),
     {"torus": 2 * math.pi * (3 * math.pi / 2 + 1), "cylinder": math.pi * 8 * 3}),
    # down a slope: walls are planes, what the rim of the disc leaves is no face of these kinds
    ("flat:d=6,l=20", ((10, 20, 0), (50, 20, -8)), {"other": 6.0 * math.hypot(40, 8)}),
])
def test_faces(tool, moves, wanted):
    program = swarf.Program(start=moves[0])
    program.add_operation("cut")
    program.set_section(tool=1)
    for place in moves[1:]:
        program.add_line(place, feed_mm_min=100)
    job = Job(name="faces", program=program, tools={1: swarf.Cutter(tool)},
              stock={"kind": "box", "lo": (0, 0, -10), "hi": (60, 40, 0)})
    made = swarf.simulate(job, voxel=0.25)
    found = parts.faces(made.mesh, made.surface)
    assert sum(found.values()) == pytest.approx(made.mesh.area, rel=1e-6)
    for kind, area in wanted.items():
        within = 0.2 if kind == "other" else 0.04  # by the middles of triangles
        assert found[kind] == pytest.approx(area, rel=within), (kind, found)
    if "other" not in wanted:
        assert found["other"] < 1e-3 * made.mesh.area, found
