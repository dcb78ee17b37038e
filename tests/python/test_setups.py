# SPDX-License-Identifier: LGPL-2.1-or-later
"""From one set-up to the next: placements in words, chains of jobs, stocks placed, and the command line."""
import json
import math

import pytest

import swarf
from swarf import placement, readers
from swarf.accept import Acceptance
from swarf.cli import main
from swarf.job import Job
from swarf.stocks import make_first, make_stock, stock_box
from swarf.verify import SetUps

LO, HI, VOXEL = (0.0, 0.0, -10.0), (60.0, 40.0, 0.0), 0.5
BOX = {"kind": "box", "lo": LO, "hi": HI}
TOOLS = {1: "flat:d=6,l=20"}
#: A slot right through, 6 wide and 4 deep, and what it takes.
TOP = "T1 M6\nS8000 M3\nG0 X-10 Y20 Z5\nG1 Z-4 F200\nG1 X70 F600\nG0 Z5\nM2\n"
#: Across it from the other side: 8 mm deep of 10, so that both meet.
BOTTOM = "T1 M6\nS8000 M3\nG0 X20 Y-10 Z5\nG1 Z-8 F200\nG1 Y50 F600\nG0 Z5\nM2\n"
#: After the slot, a move that is not simulated.
TURNED = TOP.replace("M2\n", "G1 X0 A45 F100\nM2\n")
LEFT_MM3 = 60 * 40 * 10 - 60 * 6 * 4 - 40 * 6 * 8 + 6 * 6 * 2


def make_job(text, stock, name="job"):
    return Job(name=name, program=swarf.Program.parse_gcode(text), tools={1: swarf.Cutter(TOOLS[1])}, stock=stock)


def area_of(mesh, triangle):
    a, b, c = (mesh.vertices.tolist()[vertex] for vertex in mesh.triangles.tolist()[triangle])
    u, v = ([q - p for p, q in zip(a, end)] for end in (b, c))
    return math.hypot(*(u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3] for k in range(3))) / 2


def close(rows, wanted):
    return all(a == pytest.approx(b, abs=1e-12) for row, other in zip(rows, wanted) for a, b in zip(row, other))


def test_words():
    box = ((10, 20, -6), (30, 24, -1))
    over = placement.parse("x180,top=0").rows(box)
    assert placement.box_of(over, box) == ((10, 20, -5), (30, 24, 0)) and placement.is_quarter(over)
    assert placement.point(over, (10, 20, -6)) == (10, 24, 0)  # the low corner is at the top now
    assert close(placement.parse("z90").rows(box), ((0, -1, 0, 42), (1, 0, 0, 2), (0, 0, 1, 0)))
    both = placement.parse("x90, z-30, left=1, back=2, dz=0.5").rows(box)
    lo, hi = placement.box_of(both, box)
    assert lo[0] == pytest.approx(1) and hi[1] == pytest.approx(2)
    assert placement.point(both, (20, 22, -3.5))[2] == pytest.approx(-3)
    turned = placement.direction(both, (0, 1, 0))  # about X by 90: up; about Z: still up
    assert turned == pytest.approx((0, 0, 1))
    assert not placement.is_quarter(both)
    back = placement.after(placement.rotation_about(0, 90), placement.rotation_about(0, 270))
    assert close(back, placement.IDENTITY)


@pytest.mark.parametrize("text, part", [
    ("x180,left=1,right=2", "along X"), ("q180", "'q180' is no turn"), ("xabc", "'xabc'"), ("top=nan", "'top=nan'"),
    ("upper=3", "'upper=3'"), ("", "''"), ("dx", "'dx'"), ("x=3", "'x=3'"),
])
def test_words_that_are_none(text, part):
    with pytest.raises(ValueError, match="turn .*" + part):
        placement.parse(text)


def test_placed_keeps_or_says_what_it_cannot():
    stock = swarf.Stock.box(LO, HI, VOXEL)
    stock.simulate(swarf.Program.parse_gcode(TOP), {1: swarf.Cutter(TOOLS[1])})
    rows = placement.parse("y90,z90,dx=3.3").rows(stock.bounding_box())
    there = stock.placed(rows)
    assert there.voxel == stock.voxel and there.volume() == pytest.approx(stock.volume(), rel=1e-7)
    back = placement.after(placement.rotation_about(1, -90), placement.rotation_about(2, -90))
    home = placement.shifted(back, [-value for value in placement.direction(back, [row[3] for row in rows])])
    assert there.placed(home).hash() == stock.hash()
    for wrong, part in (([[1, 0, 0, 0]], "1 rows"), ([[1, 0, 0], [0, 1, 0], [0, 0, 1]], "3 numbers where 4"),
                        ([[2, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]], "skews or scales")):
        with pytest.raises(ValueError, match=part):
            stock.placed(wrong)
    with pytest.raises(ValueError, match="voxel"):
        stock.placed(rows, voxel=0)
    with pytest.raises(ValueError, match="moves"):
        stock.placed(rows, moves=3)
    with pytest.raises(TypeError, match="surface"):
        stock.placed(rows, surface=3)


@pytest.mark.parametrize("turn, voxel", [("x180,top=0", None), ("x180,top=0", 0.4), ("x180,z30,top=0", None)])
def test_a_chain_is_cut_from_both_sides(turn, voxel):
    """The mesh is exact in both set-ups, whatever the turn: its volume is that of the closed form."""
    top = make_job(TOP, BOX, "top")
    bottom = make_job(BOTTOM, {"kind": "result", "job": top, "placement": placement.parse(turn)}, "bottom")
    if "z30" in turn:  # the cut turned along: from above, through the part's middle line at X 20
        rows = placement.parse(turn).rows((LO, HI))
        ends = [placement.point(rows, (20, y, -2)) for y in (60, -20)]
        bottom.program = swarf.Program.parse_gcode(
            "T1 M6\nG0 X{0:.6f} Y{1:.6f} Z5\nG1 Z-8 F200\nG1 X{2:.6f} Y{3:.6f}\n".format(*ends[0][:2], *ends[1][:2]))
    done = swarf.simulate(bottom, voxel=VOXEL if voxel is None else voxel)
    assert done.mesh.closed and done.mesh.volume == pytest.approx(LEFT_MM3, rel=2e-5)
    assert done.stock.volume() == pytest.approx(LEFT_MM3, rel=2e-3)
    assert done.resampled_voxels == (0.02 if "z30" in turn else 0)
    assert [(job.name, len(played.removed_by_operation)) for job, played in done.before] == [("top", 1)]
    removed = done.simulation.volume_initial - done.simulation.volume_final
    assert removed == pytest.approx(40 * 6 * 8 - 6 * 6 * 2, rel=5e-3)
    origins = done.mesh.origins(done.surface).tolist()
    assert {row[0] for row in origins} == {0, 1}
    unknown = sum(area_of(done.mesh, index) for index, row in enumerate(origins) if row[1] == -2)
    assert unknown < 1e-4 * done.mesh.area  # slivers, whose normals may be any
    by_set_up = [sum(row[0] == number and row[1] >= 0 for row in origins) for number in (0, 1)]
    assert min(by_set_up) > 3


def test_a_kept_result_is_as_good(tmp_path):
    """A .vdb file of the first set-up, with the job that made it, gives the same bits as playing it."""
    top = make_job(TOP, BOX, "top")
    done = swarf.simulate(top, voxel=VOXEL, outputs=[str(tmp_path / "top.vdb")])
    assert done.mesh is not None
    over = placement.parse("x180,top=0")
    played = make_first({"kind": "result", "job": top, "placement": over}, voxel=VOXEL)
    kept = make_first({"kind": "result", "job": top, "placement": over, "path": str(tmp_path / "top.vdb")})
    assert kept.stock.hash() == played.stock.hash() and kept.played == [] and len(played.played) == 1
    finer = make_first({"kind": "result", "job": top, "placement": over, "path": str(tmp_path / "top.vdb")}, voxel=0.3)
    assert finer.stock.voxel == pytest.approx(0.3)
    assert finer.stock.volume() == pytest.approx(60 * 40 * 10 - 60 * 6 * 4, rel=2e-3)


def test_shapes_are_turned_not_their_voxels():
    over = placement.parse("z30").rows((LO, HI))
    box = make_stock({**BOX, "placement": over}, voxel=VOXEL)
    assert box.volume() == pytest.approx(24000, rel=2e-4)
    assert stock_box({**BOX, "placement": placement.parse("z90,left=0")})[1] == pytest.approx((40, 50, 0))
    bar = make_stock({"kind": "cylinder", "base": (0, 0, 0), "axis": (0, 0, 20), "radius": 5,
                      "placement": placement.parse("y90,left=0")}, voxel=0.25)
    assert bar.bounding_box()[0] == pytest.approx((0, -5, 5), abs=0.13)
    mesh = swarf.Mesh.from_stock(swarf.Stock.box(LO, HI, VOXEL))
    turned = mesh.placed(over)
    assert turned.volume == pytest.approx(mesh.volume, rel=1e-5)
    turned = make_stock({"kind": "mesh", "mesh": mesh, "placement": over}, voxel=VOXEL)
    assert turned.volume() == pytest.approx(24000, rel=1e-3)


def test_chains_that_cannot_be():
    ring = make_job(TOP, None)
    ring.stock = {"kind": "result", "job": ring}
    with pytest.raises(ValueError, match="after itself|extent|recursion"):
        make_stock(ring.stock, voxel=VOXEL)
    away = make_job("T1 M6\nG0 X30 Y20 Z5\nG1 Z-12 F100\n", {"kind": "box", "lo": (29, 19, -10), "hi": (31, 21, 0)})
    with pytest.raises(swarf.GeometryError, match="job: .*nothing is left"):
        make_stock({"kind": "result", "job": away, "placement": placement.parse("x180")}, voxel=VOXEL)
    with pytest.raises(ValueError, match="does not say"):
        make_stock({"kind": "result", "job": make_job(TOP, None)}, voxel=VOXEL)


def run(capsys, *words):
    status = main(["simulate", *map(str, words)])
    return status, capsys.readouterr().err


def test_command_line(tmp_path, capsys):
    top, bottom = tmp_path / "top.nc", tmp_path / "bottom.nc"
    top.write_text(TOP)
    bottom.write_text(BOTTOM)
    common = ("--tool", "1=" + TOOLS[1], "--voxel", VOXEL)
    status, errors = run(capsys, top, "--stock", "box:0,0,-10,60,40,0", *common, "--then", bottom, "--turn",
                         "x180,top=0", "--output", tmp_path / "both.ply", "--report", tmp_path / "both.json")
    assert (status, errors) == (0, "")
    assert swarf.Mesh.read(tmp_path / "both.ply").volume == pytest.approx(LEFT_MM3, rel=2e-5)
    report = json.loads((tmp_path / "both.json").read_text())
    assert report["job"] == "bottom.nc" and [entry["job"] for entry in report["set_ups_before"]] == ["top.nc"]
    # the same in two runs, by a file: faces are as good, edges as the voxels know them
    assert run(capsys, top, "--stock", "box:0,0,-10,60,40,0", *common, "--output", tmp_path / "top.vdb")[0] == 0
    status, _ = run(capsys, bottom, "--stock", tmp_path / "top.vdb", "--turn", "x180,top=0", *common[:2], "--output",
                    tmp_path / "two.ply")
    assert status == 0
    assert swarf.Mesh.read(tmp_path / "two.ply").volume == pytest.approx(LEFT_MM3, rel=2e-3)
    # what other turns cost is said
    status, errors = run(capsys, bottom, "--stock", tmp_path / "top.vdb", "--turn", "x180,z30,top=0", *common[:2],
                         "--report", tmp_path / "turned.json")
    assert status == 0 and "off by 0.1 voxels at most at its edges, at corners by up to 0.3;" in errors
    assert json.loads((tmp_path / "turned.json").read_text())["resampled_voxels"] == 0.1
    assert report["resampled_voxels"] == 0


def test_command_line_mistakes(tmp_path, capsys):
    top = tmp_path / "top.nc"
    top.write_text(TOP)
    common = ("--stock", "box:0,0,-10,60,40,0", "--tool", "1=" + TOOLS[1], "--voxel", VOXEL)
    with pytest.raises(SystemExit) as exit_info:
        run(capsys, top, *common, "--turn", "x180", "--turn", "y180")
    assert exit_info.value.code == 2 and "given twice for one set-up" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        run(capsys, top, *common, "--turn", "upside-down")
    assert "'upside-down' is no turn" in capsys.readouterr().err
    status, errors = run(capsys, top, *common, "--then", tmp_path / "none.nc")
    assert status == 2 and "none.nc" in errors
    status, errors = run(capsys, top, *common, "--then", top, "--holder", "7=SK40-ER16,stickout=35")
    assert status == 2 and "there is no tool 7" in errors


def test_an_earlier_set_up_that_fails_fails_the_verification(tmp_path, capsys):
    """What is left is the design, but a move of the first program was not simulated: verify fails as simulate does."""
    top, bottom, report = tmp_path / "top.nc", tmp_path / "bottom.nc", tmp_path / "report.json"
    top.write_text(TURNED)
    bottom.write_text(BOTTOM)
    design = tmp_path / "design.ply"
    common = ("--stock", "box:0,0,-10,60,40,0", "--tool", "1=" + TOOLS[1], "--voxel", VOXEL, "--then", bottom, "--turn",
              "x180,top=0")
    status, errors = run(capsys, top, *common, "--output", design)
    assert status == 1 and "error: top.nc: line" in errors
    words = ["verify", top, *common, "--design", design, "--report", report]
    assert main([str(word) for word in words]) == 1
    assert "set-up 'top.nc', line" in capsys.readouterr().err
    told = json.loads(report.read_text())
    assert not told["verification"]["passed"] and [entry["job"] for entry in told["set_ups_before"]] == ["top.nc"]
    (found,) = (entry for entry in told["findings"] if entry["severity"] == "error")
    assert (found["kind"], found["line"], found["move"], found["operation"]) == ("uncut", 0, -1, None)
    accepted = tmp_path / "accepted.json"
    accepted.write_text(json.dumps([{"reason": "the fourth axis is locked", "text": "set-up 'top.nc'"}]))
    assert main([str(word) for word in [*words, "--accept", accepted]]) == 0


def test_what_an_earlier_job_accepts_is_settled():
    top = make_job(TURNED, BOX, "top")
    chain = {"kind": "result", "job": top}

    def found():
        earlier = SetUps()
        return [item.severity for item in earlier.findings(make_first(chain, voxel=VOXEL, play=earlier.play))]

    assert found() == ["error"]
    top.accepted = [Acceptance("locked", kind="uncut")]
    assert found() == []


def box_mesh(lo, hi):
    corners = [[(lo, hi)[i >> k & 1][k] for k in range(3)] for i in range(8)]
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    return swarf.Mesh(corners, [triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))])


def test_earlier_set_ups_are_checked_with_their_own_fixtures(tmp_path):
    """A clamp of the first set-up stands where its slot leaves the block; in the second it is gone, so that the same
    place is free there. The clamp is on the first set-up's coordinates, X 62 on: the tool's side gets there with its
    tip at X 59."""
    clamp = box_mesh((62, 10, -12), (70, 30, 2))
    top = make_job(TOP, BOX, "top")
    bottom = make_job(TOP, {"kind": "result", "job": top}, "bottom")
    bottom.design = swarf.simulate(top, voxel=VOXEL).mesh
    assert [found.text for found in swarf.verify(bottom, voxel=VOXEL, tolerance=0.3).findings
            if found.severity == "error"] == []
    top.fixtures = [clamp]
    done = swarf.verify(bottom, voxel=VOXEL, tolerance=0.3)
    hits = [found for found in done.findings if found.kind == "fixture"]
    assert hits and not done.passed and all(found.text.startswith("set-up 'top', line ") for found in hits)
    assert "line 5: flutes hit a fixture, at least" in hits[0].text or "line 5: flutes hit a fixture, " in hits[0].text
    assert hits[0].line == 0 and hits[0].place is None and hits[0].severity == "error"
    # the holder of the first set-up is its own, too
    top.fixtures, top.tools = [], {1: swarf.Cutter("flat:d=6,l=2,sd=6,sl=1,hd=20,hl=20")}
    kinds = {(found.kind, found.text.partition(",")[0])
             for found in swarf.verify(bottom, voxel=VOXEL, tolerance=0.3).findings
             if found.severity == "error"}
    assert ("holder", "set-up 'top'") in kinds and all(text == "set-up 'top'" for _, text in kinds)
    # of a kept outcome it is said that nothing was checked
    top.tools = {1: swarf.Cutter(TOOLS[1])}
    swarf.simulate(top, voxel=VOXEL, outputs=[str(tmp_path / "top.vdb")])
    bottom.stock["path"] = str(tmp_path / "top.vdb")
    (note,) = (found for found in swarf.verify(bottom, tolerance=0.3).findings if "not checked here" in found.text)
    assert note.severity == "note" and "set-up 'top'" in note.text


@pytest.mark.parametrize("turn, wanted", [((), LEFT_MM3), (("--turn", "dx=0"), LEFT_MM3 + (4 - 2) * 6 * 6)])
def test_a_document_says_how_its_job_turns_the_stock(tmp_path, capsys, monkeypatch, turn, wanted):
    """A reader's job that cuts the result of another keeps its placement behind --then, unless --turn gives one: both
    slots from above, 4 and 8 deep, have 4 mm of depth in common instead of 2."""
    (tmp_path / "top.nc").write_text(TOP)
    read = readers.read

    def read_document(path, *words):
        if not str(path).endswith(".doc"):
            return read(path, *words)
        rows = placement.parse("x180,top=0").rows((LO, HI))
        return make_job(BOTTOM, {"kind": "result", "job": make_job(TOP, BOX), "placement": rows}, "bottom")

    monkeypatch.setattr(readers, "read", read_document)
    status, _ = run(capsys, tmp_path / "top.nc", "--stock", "box:0,0,-10,60,40,0", "--tool", "1=" + TOOLS[1], "--voxel",
                    VOXEL, "--then", "part.doc", *turn, "--output", tmp_path / "both.ply")
    assert status == 0
    assert swarf.Mesh.read(tmp_path / "both.ply").volume == pytest.approx(wanted, rel=2e-5)
