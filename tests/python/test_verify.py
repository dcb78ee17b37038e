# SPDX-License-Identifier: LGPL-2.1-or-later
"""Verification: known deviations are found with their line, reports are whole, bad designs are refused."""
import json
import math
import os
import re
import subprocess
import sys

import pytest

import swarf
from swarf import document, report
from swarf.job import Job

LO, HI = (0.0, 0.0, -10.0), (40.0, 30.0, 0.0)


def box(lo, hi):
    corners = [[(lo, hi)[i >> k & 1][k] for k in range(3)] for i in range(8)]
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    return swarf.Mesh(corners, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def faced(depth, gouge=0.0):
    """A block faced to a depth by lines 1 to 30; line 40 cuts deeper once."""
    program = swarf.Program(start=(-10, -10, 5))
    program.add_operation("face")
    program.set_section(tool=1, spindle="cw", spindle_rpm=8000)
    line = 1
    for y in range(0, 31, 3):
        program.add_line((-5, y, 5), line=line, kind="rapid")
        program.add_line((-5, y, -depth), feed_mm_min=200, line=line + 1)
        program.add_line((45, y, -depth), feed_mm_min=400, line=line + 2)
        program.add_line((45, y, 5), line=line + 2, kind="rapid")
        line += 3
    if gouge:
        program.add_line((10, 15, 5), line=40, kind="rapid")
        program.add_line((10, 15, -depth - gouge), feed_mm_min=100, line=40)
        program.add_line((20, 15, -depth - gouge), feed_mm_min=100, line=40)
        program.add_line((20, 15, 5), line=41, kind="rapid")
    return Job("faced", program, {1: swarf.Cutter("flat:d=6,l=20")}, {1: "flat 6"}, {"kind": "box", "lo": LO, "hi": HI})


DESIGN = box(LO, (40.0, 30.0, -1.0))


def test_nothing_wrong():
    done = swarf.verify(faced(1.0), DESIGN, tolerance=0.02, voxel=0.25)
    assert done.passed and not done.findings
    assert done.deviation.comparison.gouge_mm3 < 0.5
    assert abs(done.deviation.most) < 0.006 and abs(done.deviation.least) < 0.006
    assert len(done.deviation.points) == len(done.deviation.values) == len(done.deviation.kinds)
    assert math.isclose(sum(done.deviation.histogram(-1, 1, 9)), done.deviation.area, rel_tol=0.2)


def test_a_gouge_names_its_line():
    done = swarf.verify(faced(1.0, 0.2), DESIGN, voxel=0.25)
    assert not done.passed
    (found,) = done.findings
    assert found.severity == "error" and found.operation == "face" and found.line in (40, 41)
    assert math.isclose(found.cluster.value, -0.2, abs_tol=0.006)
    assert math.isclose(found.cluster.volume, 0.2 * (60 + 9 * math.pi), rel_tol=0.05)


def three_operations():
    """Rough leaves 0.2 but plunges 0.3 too deep once (line 12); finish leaves a strip 0.1 too high (line 103); engrave,
    which the design knows nothing of, goes 0.2 too deep (line 201)."""
    program = swarf.Program(start=(-10, -10, 5))
    for name, first, depth in (("rough", 1, 0.8), ("finish", 101, 1.0)):
        program.set_section(tool=1, spindle="cw", spindle_rpm=8000, operation=program.add_operation(name))
        for row, y in enumerate(range(0, 31, 5)):  # 6 mm wide, so that no row does the work of the next
            down = 0.9 if (name, y) == ("finish", 10) else depth
            program.add_line((-5, y, 5), line=first + row, kind="rapid")
            program.add_line((-5, y, -down), feed_mm_min=200, line=first + row)
            program.add_line((45, y, -down), feed_mm_min=400, line=first + row)
            program.add_line((45, y, 5), line=first + row, kind="rapid")
        if name == "rough":
            program.add_line((30, 18, 5), line=11, kind="rapid")
            program.add_line((30, 18, -1.3), feed_mm_min=100, line=12)
            program.add_line((30, 18, 5), line=13, kind="rapid")
    program.set_section(tool=1, spindle="cw", spindle_rpm=8000, operation=program.add_operation("engrave"))
    program.add_line((10, 24, 5), line=200, kind="rapid")
    program.add_line((10, 24, -1.2), feed_mm_min=100, line=201)
    program.add_line((20, 24, -1.2), feed_mm_min=100, line=201)
    program.add_line((20, 24, 5), line=202, kind="rapid")
    return Job("blame", program, {1: swarf.Cutter("flat:d=6,l=20")}, {1: "flat 6"}, {"kind": "box", "lo": LO, "hi": HI})


def test_the_right_operation_is_blamed(tmp_path):
    """All three went over each of the places, or by them: it is neither the last nor the first that is named."""
    done = swarf.verify(three_operations(), DESIGN, tolerance=0.05, voxel=0.25, loads=False)
    report.write(report.make_verification(done, "blame"), str(tmp_path / "r.json"))
    read = json.loads((tmp_path / "r.json").read_text())["findings"]
    truth = {("gouge", "rough"): (12, -0.3, 30, 18), ("excess", "finish"): (103, 0.1, None, 10),
             ("gouge", "engrave"): (201, -0.2, None, 24)}
    assert {(found.kind, found.operation) for found in done.findings} == truth.keys() and len(done.findings) == 3
    assert [(row["line"], row["operation"]) for row in read] == [(f.line, f.operation) for f in done.findings]
    for found in done.findings:
        line, value, x, y = truth[found.kind, found.operation]
        assert found.line == line and found.severity == "error"
        assert math.isclose(found.cluster.value, value, abs_tol=0.006)
        assert abs(found.place[1] - y) < 3.1 and (x is None or abs(found.place[0] - x) < 3.1)


def test_too_deep_and_too_high():
    deep = swarf.verify(faced(1.03), DESIGN, tolerance=0.02, voxel=0.25)
    assert [found.cluster.kind for found in deep.findings] == ["gouge"]
    assert math.isclose(deep.findings[0].cluster.value, -0.03, abs_tol=0.006)
    high = swarf.verify(faced(0.9), DESIGN, voxel=0.25)
    assert [found.cluster.kind for found in high.findings] == ["excess"]
    assert swarf.verify(faced(0.9), DESIGN, excess=0.2, gouge=0.01, voxel=0.25).passed
    assert swarf.verify(faced(0.9), DESIGN, allowance=0.1, voxel=0.25).passed


def test_judged_again():
    job = faced(1.03)
    stock = swarf.Stock.box(LO, HI, 0.25)
    stock.cut(job.tools[1], job.program)
    measured = swarf.measure_deviation(stock, swarf.Solid(DESIGN))
    assert measured.passed and not measured.clusters
    del stock
    tight = measured.judge(gouge=0.02, program=job.program, tools=job.tools)
    (gouge,) = tight.clusters
    assert not tight.passed and gouge.kind == "gouge" and gouge.moves
    assert math.isclose(gouge.value, -0.03, abs_tol=0.006) and tight.points.tolist() == measured.points.tolist()
    assert measured.judge(gouge=0.02, allowance=-0.03).passed
    assert measured.judge(gouge=0.02, region=((0, 0, -11), (40, 30, -2))).passed
    marks = bytearray(set(row) in ({4, 5, 7}, {4, 7, 6}) for row in DESIGN.triangles.tolist())  # the top
    assert sum(marks) == 2 and measured.judge(gouge=0.02, ignore=marks).passed
    with pytest.raises(ValueError, match="11 marks for the 12 triangles"):
        measured.judge(ignore=marks[1:])
    with pytest.raises(TypeError, match="bytes"):
        measured.judge(ignore=object())
    with pytest.raises(TypeError, match="Program"):
        measured.judge(program=job.program)
    with pytest.raises(ValueError, match="tolerance"):
        measured.judge(excess=0)


def test_where_no_move_went():
    design = box(LO, (40.0, 30.0, -1.0))
    job = faced(1.0)
    job.stock = {"kind": "box", "lo": (0.0, 0.0, -12.0), "hi": HI}
    done = swarf.verify(job, design, voxel=0.25)
    assert done.passed and [found.severity for found in done.findings] == ["warning"]
    assert math.isclose(done.findings[0].cluster.volume, 2 * 40 * 30, rel_tol=0.01)
    assert not swarf.verify(job, design, voxel=0.25, complete=True).passed


def test_designs_that_cannot_be():
    job = faced(1.0)
    with pytest.raises(ValueError, match="no design"):
        swarf.verify(job)
    open_box = swarf.Mesh(DESIGN.vertices, [list(row) for row in DESIGN.triangles.tolist()][:-1])
    with pytest.raises(swarf.GeometryError, match="open edges"):
        swarf.verify(job, open_box, voxel=0.5)
    turned = swarf.Mesh(DESIGN.vertices, [row[::-1] for row in DESIGN.triangles.tolist()])
    with pytest.raises(swarf.GeometryError, match="inside out"):
        swarf.verify(job, turned, voxel=0.5)
    inch = box(tuple(v / 25.4 for v in LO), (40 / 25.4, 30 / 25.4, -1 / 25.4))
    assert any("inches" in found.text for found in swarf.verify(job, inch, voxel=0.5).findings)
    beside = box((100.0, 0.0, -10.0), (140.0, 30.0, -1.0))
    assert any("beside" in found.text for found in swarf.verify(job, beside, voxel=0.5).findings)
    with pytest.raises(ValueError, match="tolerance"):
        swarf.verify(job, DESIGN, voxel=0.5, tolerance=-1)


def test_designs_with_defects(tmp_path):
    """What meshes of the wild have: no triangles, NaN, crossing shells, a hole, coordinates beyond all measure."""
    job = faced(1.0)
    with pytest.raises(swarf.GeometryError, match="no triangles"):
        swarf.verify(job, swarf.Mesh([(0, 0, 0)], []), voxel=0.5)
    with pytest.raises(ValueError, match="finite"):
        swarf.Mesh([(0, 0, float("nan")), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    (tmp_path / "nan.stl").write_text("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\nvertex 1 0 0\n"
                                      "vertex 0 1 0\nendloop\nendfacet\nendsolid\n")
    with pytest.raises((ValueError, swarf.Error)):
        swarf.Mesh.read(str(tmp_path / "nan.stl"))
    # two boxes that cross are the union of both
    left, right = box(LO, (25.0, 30.0, -1.0)), box((15.0, 0.0, -10.0), (40.0, 30.0, -1.0))
    rows = left.triangles.tolist() + [[i + 8 for i in row] for row in right.triangles.tolist()]
    crossing = swarf.Mesh(left.vertices.tolist() + right.vertices.tolist(), rows)
    done = swarf.verify(job, crossing, voxel=0.5)
    assert done.passed and [found.severity for found in done.findings] == ["note"] and "cross" in done.findings[0].text
    # a pinhole passes, and is told
    rows = [row for row in DESIGN.triangles.tolist() if set(row) - {4, 5, 6, 7}]
    rows += [(4, 5, 8), (5, 9, 8), (5, 7, 9), (7, 10, 9), (7, 6, 10), (6, 8, 10), (6, 4, 8)]  # all but (8, 9, 10)
    around = swarf.Mesh(DESIGN.vertices.tolist() + [[20, 15, -1], [20.5, 15, -1], [20, 15.5, -1]], rows)
    hole = swarf.verify(job, around, tolerance=0.2, voxel=0.5)
    assert hole.passed and any("not closed: 3 open edges" in found.text for found in hole.findings)
    # a kilometre too large: said, and nothing breaks
    huge = swarf.verify(job, box((-1e6, -1e6, -1e6), (1e6, 1e6, 1e6)), voxel=0.5, loads=False)
    assert not huge.passed and any(found.kind == "design" for found in huge.findings)


def test_solid():
    solid = swarf.Solid(DESIGN)
    assert solid.open_edges == 0 and solid.triangle_count == 12
    assert math.isclose(solid.volume, 40 * 30 * 9, rel_tol=1e-6)
    assert solid.distance([(20, 15, -5), (20, 15, 0), (43, 34, -5)]).tolist() == pytest.approx([-4, 1, 5])
    with pytest.raises(ValueError):
        solid.distance([(0, 0, float("nan"))])


def test_checks():
    job = faced(1.0)
    job.program.add_line((20, 15, -3), kind="rapid", line=77)
    stock = swarf.Stock.box(LO, HI, 0.5)
    (found,) = stock.check(job.program, job.tools).findings
    assert (found.severity, found.kind, found.part, found.line) == ("error", "rapid", "flutes", 77)
    assert 0 < found.t < 1 and math.isclose(found.tip[2], -1, abs_tol=0.06) and "rapid" in found.text
    clamp = swarf.Solid(box((30.0, 10.0, -1.0), (40.0, 20.0, 9.0)))
    hits = swarf.Stock.box(LO, HI, 0.5).check(job.program, job.tools, fixtures=[clamp],
                                              travel=((-4, -50, -50), (90, 90, 90)))
    assert {"fixture", "travel", "rapid"} == {found.kind for found in hits.findings}
    assert len(swarf.Stock.box(LO, HI, 0.5).check(job.program, job.tools, fixtures=[clamp], stop=True).findings) == 1
    with pytest.raises(TypeError, match="item 0"):
        stock.check(job.program, job.tools, fixtures=[DESIGN])
    with pytest.raises(ValueError, match="clearance"):
        stock.check(job.program, job.tools, clearance=-1)
    done = swarf.verify(job, DESIGN, voxel=0.5)
    assert not done.passed and any(found.text.startswith("rapid") and found.line == 77 for found in done.findings)


def test_reports(tmp_path):
    done = swarf.verify(faced(1.0, 0.2), DESIGN, voxel=0.5)
    made = report.make_verification(done, "faced.nc")
    text = document.make(done, made)
    assert "FAILED" in text and "gouge" in text
    assert not re.search(r"(src|href)=\"(?!data:)", text), "it must need nothing else"
    assert text.count("<img ") == len(document.VIEWS) + 1
    report.write(made, str(tmp_path / "r.json"))
    read = json.loads((tmp_path / "r.json").read_text())
    assert read["verification"]["passed"] is False
    assert read["findings"][0]["line"] in (40, 41)
    assert math.isclose(sum(read["verification"]["histogram"]["area_mm2"]), done.deviation.area, rel_tol=0.3)


def test_command(tmp_path):
    gcode = tmp_path / "face.nc"
    gcode.write_text("G21 G90\nT1 M6\nM3 S8000\nG0 X-5 Y0 Z5\n" + "".join(
        f"G0 X-5 Y{y} Z5\nG1 Z-1 F200\nX45 F400\nG0 Z5\n" for y in range(0, 31, 3)) + "M2\n")
    DESIGN.write(str(tmp_path / "part.stl"))
    words = [sys.executable, "-m", "swarf", "verify", str(gcode), "--design", str(tmp_path / "part.stl"), "--voxel",
             "0.5", "--stock", "box:0,0,-10,40,30,0", "--tool", "1=flat:d=6,l=20"]
    done = subprocess.run([*words, "--report", str(tmp_path / "r.html")], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert "passed" in done.stdout and (tmp_path / "r.html").read_text().startswith("<!DOCTYPE html>")
    done = subprocess.run([*words, "--allowance", "0.5"], capture_output=True, text=True, timeout=120)
    assert done.returncode == 1 and "gouge" in done.stderr
    done = subprocess.run([*words, "--report", str(tmp_path / "r.doc")], capture_output=True, text=True, timeout=120)
    assert done.returncode == 2 and "r.doc" in done.stderr
    # PDF by a converter that is installed, here one that only copies; without one it is said what is needed
    tools = tmp_path / "bin"
    tools.mkdir()
    (tools / "weasyprint").write_text('#!/bin/sh\n/bin/cp "$1" "$2"\n')
    (tools / "weasyprint").chmod(0o755)
    paper = [*words, "--report", str(tmp_path / "r.pdf")]
    done = subprocess.run(paper, capture_output=True, text=True, timeout=120, env={**os.environ, "PATH": str(tools)})
    assert done.returncode == 0 and (tmp_path / "r.pdf").read_text().startswith("<!DOCTYPE html>"), done.stderr
    (tools / "weasyprint").write_text("#!/bin/sh\necho broken >&2\nexit 3\n")
    done = subprocess.run(paper, capture_output=True, text=True, timeout=120, env={**os.environ, "PATH": str(tools)})
    assert done.returncode == 2 and "status 3, saying broken" in done.stderr
    (tools / "weasyprint").unlink()
    done = subprocess.run(paper, capture_output=True, text=True, timeout=120, env={**os.environ, "PATH": str(tools)})
    assert done.returncode == 2 and "r.pdf: no converter" in done.stderr and "weasyprint" in done.stderr


def test_moves_that_cannot_be_simulated_fail(tmp_path):
    path = tmp_path / "turned.nc"
    path.write_text("G21 G90 G94\nT1 M6\nS8000 M3\nG0 X-5 Y15 Z5\nG0 A90\nG1 Z-1 F200\nG1 X45 F400\nG0 Z5\nM2\n")
    job = faced(1.0)
    job.program = swarf.Program.read_gcode(path)
    done = swarf.verify(job, box(LO, HI), voxel=0.5)
    assert not done.passed
    assert [found.line for found in done.findings if "turned and shifted poses" in found.text] == [6]


def command(tmp_path, text, *words):
    program, design = tmp_path / "part.nc", tmp_path / "design.stl"
    program.write_text(text)
    DESIGN.write(str(design))
    return subprocess.run(
        [sys.executable, "-P", "-m", "swarf", "verify", str(program), "--design", str(design), "--voxel", "0.5",
         "--stock", "box:0,0,-10,40,30,0", "--tool", "1=flat:d=6,l=20", *words],
        capture_output=True, text=True, timeout=120, check=False)


def test_an_empty_program_is_no_pass(tmp_path):
    done = command(tmp_path, "G21\nM2\n")
    assert done.returncode == 2 and "has no moves" in done.stderr


def test_verify_reads_gcode_as_it_is_told(tmp_path):
    lines = "G21 G90 G94\nT1 M6\nS8000 M3\nG0 X-5 Y15 Z5\n/ G38.9 X1\nG1 Z1 F200\nG0 Z5\nM2\n"
    assert command(tmp_path, lines).returncode == 2
    done = command(tmp_path, lines, "--block-delete")
    assert done.returncode == 0 and "passed" in done.stdout  # no move came near: see --complete
    assert "removes nothing" in done.stderr and "not reached" in done.stderr
    assert command(tmp_path, lines, "--block-delete", "--complete").returncode == 1


def test_fixtures_that_are_not_closed_are_told_by_who_gave_them():
    job = faced(1.0)
    bare = swarf.Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    clamp = box((40.0, 0.0, -9.0), (50.0, 30.0, -4.0))
    for own, given, says in (([clamp], [clamp, bare], "fixture 2: mesh: not closed"),
                             ([clamp, bare], [clamp], "fixture 2 of the job: mesh: not closed")):
        job.fixtures = own
        with pytest.raises(swarf.GeometryError, match=f"^{says}"):
            swarf.verify(job, DESIGN, voxel=1.0, loads=False, fixtures=given)
    job.fixtures, before = [], faced(1.0)
    before.name, before.fixtures = "before", [clamp, bare]
    job.stock = {"kind": "result", "job": before}
    with pytest.raises(swarf.GeometryError, match="^set-up 'before': fixture 2 of the job: mesh: not closed"):
        swarf.verify(job, DESIGN, voxel=1.0, loads=False)


def test_fixtures_in_the_stock():
    job = faced(1.0)
    inside = swarf.verify(job, DESIGN, voxel=0.5, loads=False, fixtures=[box((38.0, 10.0, -9.0), (50.0, 20.0, -4.0))])
    assert any("fixture 1 reaches into the stock" in found.text and found.severity == "warning" and found.amount > 1
               for found in inside.findings)
    around = swarf.verify(job, DESIGN, voxel=0.5, loads=False, fixtures=[box((-50, -50, -60), (90, 90, -2.0))])
    assert any("fixture 1 reaches into the stock" in found.text for found in around.findings)
    job.fixtures = [box((38.0, 10.0, -9.0), (50.0, 20.0, -4.0))] * 2
    both = swarf.verify(job, DESIGN, voxel=0.5, loads=False, fixtures=job.fixtures[:1])
    assert [found.text.partition(" reaches")[0] for found in both.findings if "reaches" in found.text] == [
        "fixture 1 of the job", "fixture 2 of the job", "fixture 1"]
    job.fixtures = []
    beside = swarf.verify(job, DESIGN, voxel=0.5, loads=False, fixtures=[box((40.0, 0.0, -9.0), (50.0, 30.0, -4.0))])
    assert not beside.findings


def test_a_verification_is_judged_again():
    """Another tolerance gives what a whole run with it gives; what is accepted stays accepted."""
    job = faced(1.0, gouge=0.3)
    job.fixtures = [box((38.0, 10.0, -9.0), (50.0, 20.0, -4.0))]
    accepted = swarf.accept.make({"reason": "the clamp is moved", "kind": "fixture"}, "here")
    first = swarf.verify(job, DESIGN, tolerance=0.02, voxel=0.25, loads=False, accept=[accepted])
    for tolerance in (0.1, 0.5):
        judged = first.judge(tolerance, accept=[accepted])
        again = swarf.verify(job, DESIGN, tolerance=tolerance, voxel=0.25, loads=False, accept=[accepted])
        assert judged.findings == again.findings and judged.passed == again.passed == (tolerance == 0.5)
        assert judged.tolerance == (tolerance, tolerance) and judged.result is first.result
    assert any(finding.accepted for finding in judged.findings)
    assert not any(finding.accepted for finding in first.judge(0.5).findings)


def test_fixtures_through_the_stock():
    """None of the rod's corners is in the block, nor one of the block's in the rod."""
    job = faced(1.0)
    rod = swarf.verify(job, DESIGN, voxel=0.5, loads=False, fixtures=[box((-10.0, 14.0, -6.0), (50.0, 16.0, -4.0))])
    (found,) = [found for found in rod.findings if found.kind == "fixture" and "reaches" in found.text]
    assert 0.9 < found.amount < 1.6 and 0 < found.place[0] < 40 and 13.9 < found.place[1] < 16.1


def test_overlap():
    stock = swarf.Stock.box(LO, HI, 0.5)
    for depth in (0.2, 0.5, 0.77, 1.3):  # of a rod along the face x = 40, ends far beyond the block
        deep, place = swarf.compare_overlap(stock, swarf.Solid(box((40.0 - depth, -20.0, -8.0), (50.0, 50.0, -3.0))))
        assert math.isclose(deep, depth, abs_tol=0.05) and place[0] > 38, depth
    for lo, hi in (((40, -20, -8), (50, 50, -3)), ((41, 0, -8), (50, 30, -3)), ((-9, -9, 0), (50, 50, 4))):
        deep, _ = swarf.compare_overlap(stock, swarf.Solid(box([float(v) for v in lo], [float(v) for v in hi])))
        assert deep < 0.02
    deep, _ = swarf.compare_overlap(stock, swarf.Solid(box((-50.0, -50.0, -50.0), (90.0, 90.0, 50.0))))
    assert deep >= 1.49  # all of it
