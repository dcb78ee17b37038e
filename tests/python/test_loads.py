# SPDX-License-Identifier: LGPL-2.1-or-later
"""Loads of moves, limits for them, and findings that are accepted: Python and command line."""
import dataclasses
import json
import math
import re
import subprocess
import sys

import pytest

import swarf
from swarf import accept, cli, document, loads, plots, report
from swarf.verify import Verdict
from test_verify import DESIGN, faced, HI, LO


def check(job, voxel=0.25, **options):
    return swarf.Stock.box(LO, HI, voxel).check(job.program, job.tools, loads=True, **options)


def test_a_slot_and_its_neighbour():
    job = faced(1.0)
    checked = check(job, teeth={1: 2})
    found = checked.loads
    assert set(found) == {"volume", *(entry[0] for entry in loads.KINDS.values()), "rate", "climb", "at"}
    assert all(len(view) == len(job.program) and view.readonly for view in found.values())
    assert found["volume"].format == "d" and found["angle"].format == "f"
    # at y = 0 half of the tool is in the block, on the left; then 3 mm of 6 each time
    assert math.isclose(found["angle"][2], 90, abs_tol=1) and math.isclose(found["width"][2], 3, abs_tol=0.03)
    assert math.isclose(found["depth"][2], 1, abs_tol=0.03) and math.isclose(found["climb"][2], -1, abs_tol=0.02)
    assert math.isclose(found["chip"][2], 400 / 8000 / 2, rel_tol=0.01)
    assert math.isclose(found["peak_rate"][2], 3 * 1 * 400 / 60, rel_tol=0.03)
    assert math.isclose(sum(found["volume"]), checked.simulation.volume_initial - checked.simulation.volume_final,
                        rel_tol=1e-6)
    assert found["angle"][0] == 0 and found["volume"][0] == 0  # a rapid through air
    program = swarf.Program.parse_gcode("G21 G90\nT1 M6\nS8000 M3\nG0 X-5 Y15 Z5\nG0 Z-1\nG0 X45\nG0 X900000\nM2\n")
    rapid = swarf.Stock.box(LO, HI, 0.5).check(program, job.tools, loads=True).loads
    assert max(rapid["volume"]) > 100 and not any(rapid["climb"]) and not any(rapid["angle"])
    again = swarf.Stock.box(LO, HI, 0.25).check(job.program, job.tools)
    assert again.loads is None
    assert math.isclose(again.simulation.volume_final, checked.simulation.volume_final, rel_tol=1e-9)


@pytest.mark.parametrize("diameter, thickness", [(6, 0.1), (6, 0.4), (1, 0.3)])
def test_layers_too_thin_to_be_seen_are_no_layers_without_load(diameter, thickness):
    """Below a voxel of 0.5 mm: its volume is told as not seen, nothing of it as a peak of 0, and the report speaks of
    layers of that thickness."""
    program = swarf.Program(start=(-5, 10, 5))
    for name, y, z in (("rough", 10, -1.5), ("fine", 20, -thickness)):
        program.add_operation(name)
        program.set_section(tool=1, spindle="cw", spindle_rpm=8000)
        program.add_line((-5, y, 5), kind="rapid")
        program.add_line((-5, y, z), kind="rapid")
        program.add_line((65, y, z), feed_mm_min=600, line=1)
        program.add_line((65, y, 5), kind="rapid")
    tools = {1: swarf.Cutter(f"flat:d={diameter},l=20")}
    job = swarf.Job("thin", program, tools, stock={"kind": "box", "lo": LO, "hi": HI})
    done = swarf.verify(job, swarf.Mesh.from_stock(swarf.Stock.box(LO, HI, 1.0)), tolerance=2.0, voxel=0.5)
    made = report.make_verification(done, "thin.nc")
    rough, fine = made["loads"]["operations"]
    assert rough["volume_unseen_mm3"] < 0.01 * rough["volume_mm3"] and rough["peaks"]["engagement"]["value"] > 170
    assert math.isclose(fine["volume_mm3"], (HI[0] - LO[0]) * diameter * thickness, rel_tol=0.01)
    assert fine["volume_unseen_mm3"] == fine["volume_mm3"] and set(fine["peaks"]) == {"rate"}
    text = document.make(done, made)
    assert f"So was cut: fine {fine['volume_mm3']:,.1f} of" in text
    assert float(re.search(r"Layers of about a voxel, (\S+) mm, and less", text)[1]) == 0.5


def test_views_outlive_their_check():
    view = check(faced(1.0), 0.5).loads["angle"]
    simulation = check(faced(1.0), 0.5).simulation
    assert max(view) > 80 and simulation.volume_final > 0 and simulation.removed_by_operation[0] > 1000


def test_teeth():
    job = faced(1.0)
    assert max(check(job, 0.5).loads["chip"]) == 0
    assert max(check(job, 0.5, teeth={7: 3}).loads["chip"]) == 0
    with pytest.raises(ValueError, match="tool 1"):
        check(job, teeth={1: -2})
    with pytest.raises(TypeError):
        check(job, teeth=[2])


def test_limits_make_warnings():
    job = faced(1.0)
    job.teeth = {1: 2}
    done = swarf.verify(job, DESIGN, voxel=0.5, limits={None: {"engagement": 80, "depth": 1.2}, 1: {"chip": 0.01}})
    assert done.passed
    texts = [(found.kind, found.severity, found.operation, found.text) for found in done.findings]
    assert [entry[:3] for entry in texts] == [("load", "warning", "face")] * 2
    assert "engagement 89" in texts[1][3] + texts[0][3] and "exceeds the limit of 80 deg" in texts[1][3] + texts[0][3]
    worst = [found for found in done.findings if found.text.startswith("engagement")][0]
    assert worst.amount > 80 and worst.line > 0 and worst.place is not None
    assert not swarf.verify(job, DESIGN, voxel=0.5, limits={1: {"engagement": 400}}).findings


def test_limits_that_cannot_be():
    for word in ("engagement", "engagement=", "speed=3", "x:chip=1", "chip=-1", "chip=nan", "1:2:chip=3"):
        with pytest.raises(ValueError, match="limit"):
            loads.parse(word)
    assert loads.parse("engagement=90") == {None: {"engagement": 90.0}}
    assert loads.parse("3:chip=0.05") == {3: {"chip": 0.05}}
    with pytest.raises(ValueError, match="torque"):
        swarf.verify(faced(1.0), DESIGN, voxel=0.5, limits={None: {"torque": 3}})


def test_limits_in_a_file(tmp_path):
    path = tmp_path / "limits.json"
    path.write_text(json.dumps({"all": {"engagement": 120, "rate": 9}, "tools": {"3": {"chip": 0.05, "rate": 5}},
                                "materials": {"steel": {"all": {"rate": 2}, "tools": {"3": {"chip": 0.03}}}}}))
    plain, steel = loads.read(str(path)), loads.read(str(path), "steel")
    assert loads.limit(plain, 3, "rate") == 5 and loads.limit(plain, 1, "rate") == 9
    assert loads.limit(steel, 3, "rate") == 2 and loads.limit(steel, 3, "chip") == 0.03
    assert loads.limit(steel, 3, "engagement") == 120 and loads.limit(steel, 1, "chip") is None
    with pytest.raises(ValueError, match="brass"):
        loads.read(str(path), "brass")
    for text in ("[]", "{", '{"any": {}}', '{"tools": {"x": {}}}', '{"all": {"rate": true}}', '{"tools": {"1": 3}}',
                 '{"all": 3}', '{"materials": []}', '{"materials": {"steel": {"materials": {}}}}'):
        path.write_text(text)
        with pytest.raises(ValueError, match="limits.json"):
            loads.read(str(path))


def test_acceptances():
    job = faced(1.0, 0.2)
    plain = swarf.verify(job, DESIGN, voxel=0.5)
    assert not plain.passed
    (gouge,) = [found for found in plain.findings if found.kind == "gouge"]
    entry = accept.make({"reason": "filled later", "kind": "gouge", "place": list(gouge.place), "most": 0.25}, "here")
    done = swarf.verify(job, DESIGN, voxel=0.5, accept=[entry])
    assert done.passed and [found.accepted for found in done.findings] == ["filled later"]
    made = report.make_verification(done, "faced.nc")
    assert made["verification"]["passed"] and made["findings"][0]["accepted"] == "filled later"
    text = document.make(done, made)
    assert "PASSED" in text and "accepted: filled later" in text and "0 errors, 0 warnings, 1 accepted" in text
    for other in ({"most": 0.1}, {"line": 3}, {"operation": "bore"}, {"kind": "excess"}, {"place": [0, 0, 0]},
                  {"text": "holder"}):
        wrong = accept.make({"reason": "no", "kind": "gouge", **other}, "here")
        done = swarf.verify(job, DESIGN, voxel=0.5, accept=[wrong])
        assert not done.passed and any(found.kind == "acceptance" for found in done.findings)


def test_what_is_only_known_to_be_as_much_is_not_accepted_as_no_more():
    acceptance = accept.make({"reason": "x", "kind": "holder", "most": 2}, "here")
    finding = Verdict("error", "holder", "holder", amount=1.5)
    assert acceptance.knows(finding)
    finding.at_least = True
    assert not acceptance.knows(finding)


def test_a_deviation_is_accepted_as_it_was_looked_at():
    """Over another allowance another thing is measured; a tighter tolerance asks anew, a coarser one asks for less."""
    found = Verdict("error", "material left", "excess", amount=0.3, tolerance=0.05, allowance=0.0)
    entry = accept.make({"reason": "x", "kind": "excess", "tolerance": 0.05, "allowance": 0}, "here")
    assert entry.knows(found) and entry.knows(dataclasses.replace(found, tolerance=0.1))
    for other in ({"allowance": 0.2}, {"tolerance": 0.02}, {"allowance": None}):
        assert not entry.knows(dataclasses.replace(found, **other)), other
    assert accept.make({"reason": "x", "kind": "excess"}, "here").knows(dataclasses.replace(found, allowance=0.2))
    job = faced(1.0, 0.2)
    done = swarf.verify(job, DESIGN, voxel=0.5, allowance=0.1)
    (gouge,) = [item for item in done.findings if item.kind == "gouge"]
    assert gouge.allowance == 0.1 and gouge.tolerance == 0.05
    entry = accept.make({"reason": "x", "kind": "gouge", "allowance": 0.1, "tolerance": 0.05}, "here")
    assert dataclasses.replace(done).judge(0.06, accept=[entry]).passed
    (idle,) = [item for item in dataclasses.replace(done, allowance=0.0).judge(0.05, accept=[entry]).findings
               if item.kind == "acceptance"]
    assert idle.text == ("nothing is found now of what is accepted, with a tolerance of 0.05 mm and an allowance of "
                         "0.1 mm, because 'x'")


def test_acceptances_that_cannot_be(tmp_path):
    path = tmp_path / "accept.json"
    for text, word in (("{}", "list"), ("[", "JSON"), ('[{"kind": "gouge"}]', "reason"),
                       ('[{"reason": " "}]', "reason"),
                       ('[{"reason": "x"}]', "everything"), ('[{"reason": "x", "what": 1}]', "wanted"),
                       ('[{"reason": "x", "line": "3"}]', "line"), ('[{"reason": "x", "place": [1, 2]}]', "place"),
                       ('[{"reason": "x", "text": ""}]', "text"), ('[{"reason": "x", "place": null}]', "place"),
                       ('[{"reason": "x", "line": 1, "most": 1%s}]' % (400 * "0"), "most"), (3000 * "[", "JSON"),
                       ('[{"reason": "x", "line": 1, "tolerance": 0}]', "tolerance"),
                       ('[{"reason": "x", "line": 1, "allowance": "0"}]', "allowance"),
                       ('[{"reason": "x", "kind": 3}]', "kind"), ('[{"reason": "x", "line": 1, "most": -1}]', "most")):
        path.write_text(text)
        with pytest.raises(ValueError, match=word) as raised:
            accept.read(str(path))
        assert "accept.json" in str(raised.value)


def test_the_report_tells_loads():
    job = faced(1.0)
    job.program.add_operation("<script>alert(1)</script>")
    job.teeth = {1: 2}
    done = swarf.verify(job, DESIGN, voxel=0.5, limits={None: {"engagement": 60}})
    made = report.make_verification(done, "faced.nc")
    json.dumps(made, allow_nan=False)
    face, empty = made["loads"]["operations"]
    assert math.isclose(face["volume_mm3"], 1200, rel_tol=0.01) and face["seconds"] > face["seconds_cutting"] > 0
    assert 0 <= face["climb"] <= 1 and empty["climb"] is None and not empty["peaks"]
    assert math.isclose(face["peaks"]["depth"]["value"], 1, abs_tol=0.05) and face["peaks"]["depth"]["line"] > 0
    course = made["loads"]["course"]
    assert math.isclose(course["seconds"], sum(job.program.times()), rel_tol=1e-9)
    assert math.isclose(max(course["engagement"]), face["peaks"]["engagement"]["value"])
    assert sum(value == 0 for value in course["depth"]) > 10  # the rapids back
    text = document.make(done, made)
    assert "Loads over time" in text and "chip thickness" in text and "<script>" not in text
    assert "loads" not in report.make_verification(swarf.verify(job, DESIGN, voxel=0.5, loads=False), "faced.nc")


def test_plots_of_nothing():
    assert plots.course({"seconds": 0.0, "operations": [], **{kind: [0.0] for kind in loads.KINDS}}, [], {}) == ""
    assert plots.clock(59.6) == "1:00" and plots.clock(3725) == "1:02:05" and plots.nice(1234.5) == "1,234"


def command(tmp_path, *words):
    program, design = tmp_path / "part.nc", tmp_path / "design.stl"
    program.write_text("G21 G90\nT1 M6\nM3 S8000\nG0 X-5 Y0 Z5\n" + "".join(
        f"G0 X-5 Y{y} Z5\nG1 Z-1.3 F200\nX45 F400\nG0 Z5\n" for y in range(0, 31, 3)) + "M2\n")
    DESIGN.write(str(design))
    return subprocess.run(
        [sys.executable, "-P", "-m", "swarf", "verify", str(program), "--design", str(design), "--voxel", "0.5",
         "--stock", "box:0,0,-10,40,30,0", "--tool", "1=flat:d=6,l=20,teeth=2", *words],
        capture_output=True, text=True, timeout=120, check=False)


def test_a_limit_of_chips_that_are_not_known_is_said(tmp_path, capsys):
    assert loads.unknown_chips({None: {"chip": 0.1}}, (1, 2, 3), {2: 2}) == [1, 3]
    assert loads.unknown_chips({3: {"chip": 0.1}, None: {"rate": 1}}, (1, 2, 3), {2: 2}) == [3]
    assert loads.unknown_chips({None: {"rate": 1}}, (1, 2, 3), {}) == []
    program, design = tmp_path / "part.nc", tmp_path / "design.stl"
    program.write_text("G21 G90 F300\nS8000 M3\nG0 X-5 Y5 Z5\nG1 Z-1\nX45\nG0 Z5\nM2\n")
    DESIGN.write(str(design))
    cli.main(["verify", str(program), "--design", str(design), "--voxel", "1", "--stock", "box:0,0,-10,40,30,0",
              "--tool", "4=flat:d=6,l=20", "--limit", "4:chip=0.1", "--limit", "4:engagement=10"])
    told = capsys.readouterr().err
    assert "limit of chip thickness is not checked for tool 4" in told
    assert "exceeds the limit of 10 deg" in told, "the program names no tool, and its only one has limits"


def test_command_line(tmp_path):
    done = command(tmp_path, "--limit", "engagement=80", "--limit", "1:chip=0.001", "--report",
                   str(tmp_path / "r.json"))
    assert done.returncode == 1 and "exceeds the limit of 80 deg" in done.stderr and "chip thickness" in done.stderr
    made = json.loads((tmp_path / "r.json").read_text())
    assert made["loads"]["teeth"] == {"1": 2} and made["loads"]["limits"] == {"all": {"engagement": 80.0},
                                                                              "1": {"chip": 0.001}}
    (tmp_path / "accept.json").write_text('[{"reason": "agreed", "kind": "gouge"}]')
    done = command(tmp_path, "--accept", str(tmp_path / "accept.json"), "--no-loads")
    assert done.returncode == 0 and "(accepted: agreed)" in done.stderr and "passed" in done.stdout
    assert command(tmp_path, "--limit", "speed=3").returncode == 2
    done = command(tmp_path, "--limit", "2:engagement=80")
    assert (done.returncode, done.stderr) == (
        2, "swarf: error: limit of tool 2: the set-up that is checked has no such tool; it has 1\n")
    assert "--limits" in command(tmp_path, "--material", "steel").stderr
    assert "teeth" in command(tmp_path, "--tool", "2=flat:d=6,l=20,teeth=0").stderr
