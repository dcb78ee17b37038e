# SPDX-License-Identifier: LGPL-2.1-or-later
"""read_gcode(), its buffers, swarf check and swarf moves."""
import json
import math
import re
import struct

import conftest
import pytest

import swarf
from swarf import camotics, cli, gcode, readers, timing

TEXT = """\
G21 G90 F100
T1 M6
S1000 M3
G0 X0 Y0 Z5
(print, hello #5420)
o100 repeat [2]
G91 G1 X1
o100 endrepeat
G90 G3 X2 Y4 J2
G4 P1.5
G0 A90 Z9
M2
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "part.ngc"
    path.write_text(TEXT)
    return path


def test_moves_are_buffers(file):
    program = swarf.read_gcode(file, start=(0, 0, 0))
    assert len(program) == 7 == program.moves.shape[0]
    ends = [move[:3] for move in struct.iter_unpack("=dddfIiI", program.moves)]
    assert ends[1:4] == [(0, 0, 5), (1, 0, 5), (2, 0, 5)] and ends[-1] == (2, 4, 9)
    assert struct.unpack("=dddd2i", program.arcs)[:4] == pytest.approx((2, 2, 5, math.pi))
    assert struct.unpack("=Q6d", program.axes) == (6, 90, 0, 0, 0, 0, 0)
    assert program.sources == (str(file),)
    assert program.notes == (("message", str(file), 5, 2, " hello 0.000000"),)


def test_options(file, tmp_path):
    (tmp_path / "t.tbl").write_text("T1 Z10 D6\n")
    (tmp_path / "sub.ngc").write_text("o<sub> sub\nG0 X#1\no<sub> endsub\n")
    main = tmp_path / "main.ngc"
    main.write_text("T1 M6 G43\no<sub> call [3]\n/G0 X4\nM2\n")
    for tools in (tmp_path / "t.tbl", [(1, 6.0, 10.0)]):
        program = swarf.read_gcode(main, tools=tools, start=(0, 0, 0), block_delete=True)
        assert [move[0] for move in struct.iter_unpack("=dddfIiI", program.moves)] == [0, 0, 3]
    inch = swarf.read_gcode(main, tools=tmp_path / "t.tbl", start=(0, 0, 0), machine_unit="inch", block_delete=True)
    assert [move[2] for move in struct.iter_unpack("=dddfIiI", inch.moves)][-1] == -254.0
    with pytest.raises(ValueError, match="machine_unit"):
        swarf.read_gcode(main, machine_unit="foot")
    with pytest.raises(ValueError, match="dialect"):
        swarf.read_gcode(main, dialect="french")
    with pytest.raises(ValueError, match="line_limit"):
        swarf.read_gcode(main, line_limit=-1)
    with pytest.raises(TypeError):
        swarf.read_gcode(main, tools=[(1, 2)])
    with pytest.raises(OSError):
        swarf.read_gcode(main, tools=tmp_path / "none.tbl")
    with pytest.raises(swarf.FormatError, match=r"main.ngc:1:4: error: .* not in the tool table"):
        swarf.read_gcode(main, tools=[])


def test_times():
    program = swarf.Program(start=(0, 0, 0))
    program.add_line((120, 0, 0), feed_mm_min=6000)
    assert program.times(feed_mm_min=6000, acceleration_mm_s2=500).tolist() == pytest.approx([1.4])
    assert program.times(feed_mm_min=(600, 1, 1), acceleration_mm_s2=(0, 0, 0)).tolist() == pytest.approx([12])
    with pytest.raises(ValueError, match="rotary"):
        program.times(rotary_deg_min=0)


def test_swarf_moves(file, capsys):
    assert cli.main(["moves", str(file), "--start", "0,0,0"]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "operation 0 T1", "tool 1", "spindle off 0.000000", "coolant off", "offset G54",
        "2 tool 1",
        "spindle cw 1000.000000",
        "4 rapid X0.000000 Y0.000000 Z5.000000",
        "7 feed X1.000000 Y0.000000 Z5.000000 F100.000000",
        "7 feed X2.000000 Y0.000000 Z5.000000 F100.000000",
        "9 arc xy X2.000000 Y4.000000 Z5.000000 I2.000000 J2.000000 K5.000000 A180.000000 F100.000000",
        "10 dwell 1.500000",
        "11 rapid X2.000000 Y4.000000 Z9.000000 A90.000000 B0.000000 C0.000000 U0.000000 V0.000000 W0.000000",
    ]


def test_swarf_check(file, tmp_path, capsys):
    assert cli.main(["check", str(file)]) == 0
    assert capsys.readouterr().out == ""
    assert cli.main(["check", str(file), "--messages"]) == 0
    assert capsys.readouterr().out == f"{file}:5:2: message: hello 0.000000\n"
    bad = tmp_path / "bad.ngc"
    bad.write_text("M101\nG0 X1\nG1 Y2\n")
    assert cli.main(["check", str(bad)]) == 1
    assert capsys.readouterr().out.splitlines() == [
        f"{bad}:1:1: warning: 'M101' runs a program of the machine's owner; it is not simulated",
        f"{bad}:3:1: error: 'G1' has no feed; write F and the feed first",
    ]
    assert cli.main(["check", str(tmp_path / "none.ngc")]) == 2
    assert cli.main(["check", str(bad), "--start", "1,2"]) == 2
    assert "wanted X,Y,Z" in capsys.readouterr().err


def test_feeds_whose_place_is_not_known_are_said_once():
    to, start = "feeds to a place whose Y is not known", "feeds from a place whose XYZ is not known"
    for text, said in (("G0 X0 Z5\nG1 X20 F3\nX30\nM2\n", [(2, to)]), ("G1 X0 Y0 Z0 F3\nX20\nM2\n", [(1, start)]),
                       ("G0 Z5\nX0\nG0 Y0\nG1 X20 F3\nM2\n", [])):
        notes = swarf.Program.parse_gcode(text).notes
        assert [(line, said) for (_, _, line, _, told), (_, said) in zip(notes, said) if said in told] == said, text
        assert len(notes) == len(said) and swarf.Program.parse_gcode(text, start=(0, 0, 9)).notes == ()


def test_note_text_is_one_line():
    assert gcode.note_text(("error", "a", 1, 2, "b\nc")) == "a:1:2: error: b c"


def test_times_by_tool_and_operation(tmp_path):
    text = "G21 F6000\nG0 X0 Y0 Z0\nT1 M6\nG1 X120\nT2 M6\nG1 X0\nT1 M6\nG1 X120\nM2\n"
    program = swarf.Program.parse_gcode(text, start=(0, 0, 0))
    machine = tmp_path / "m.json"
    machine.write_text('{"feed_mm_min": 6000, "acceleration_mm_s2": [500, 500, 500], "tool_change_s": 8}')
    times = timing.summary(program, timing.read_machine(machine))
    assert times["total"] == pytest.approx(3 * 1.4 + 3 * 8)
    assert times["by_tool"] == pytest.approx({-1: 0, 1: 2 * 9.4, 2: 9.4})
    assert times["by_operation"] == pytest.approx([0, 9.4, 9.4, 9.4])


@pytest.mark.parametrize(
    "text, says",
    [
        ("{", "is no JSON"),
        ("[]", "wanted an object"),
        ('{"speed": 1}', "'speed' is not known"),
        ('{"rapid_mm_min": [1, 2]}', "rapid_mm_min"),
        ('{"junction_mm": [1, 2, 3]}', "junction_mm"),
        ('{"feed_mm_min": "fast"}', "feed_mm_min"),
        ('{"feed_mm_min": true}', "feed_mm_min"),
        ('{"feed_mm_min": NaN}', "feed_mm_min"),
        ('{"feed_mm_min": 1%s}' % (400 * "0"), "feed_mm_min"),
        ('{"rapid_mm_min": 0}', "rapid_mm_min of X is 0; above 0"),
        ('{"feed_mm_min": [1, 1, 1e10]}', r"feed_mm_min of Z is 1e\+10; above 0 and up to 1e9"),
        ('{"acceleration_mm_s2": [1, -1, 1]}', "acceleration_mm_s2 of Y is -1; 0 "),
        ('{"junction_mm": -1}', "junction_mm is -1; 0 to 1000"),
        ('{"rotary_deg_min": 0}', "rotary_deg_min is 0; above 0"),
        ('{"tool_change_s": 1e7}', r"tool_change_s is 1e\+07; 0 to 1e6"),
    ],
)
def test_impossible_machines(tmp_path, text, says):
    machine = tmp_path / "m.json"
    machine.write_text(text)
    with pytest.raises(ValueError, match=f"^{re.escape(str(machine))}: .*{says}"):
        timing.read_machine(machine)


def test_rotary_axes_are_refused_by_the_stock():
    stock = swarf.Stock.box((0, 0, -10), (60, 40, 0), 1)
    program = swarf.Program.parse_gcode("T1 M6 F100\nG0 X-5 Y20 Z-2\nG1 X30\nG0 Z5 A90\nG1 Z-20\nM2\n",
                                        start=(-5, 20, 5))
    simulation = stock.simulate(program, {1: swarf.Cutter("flat:d=6,l=20")})
    assert [(f.severity, f.line) for f in simulation.findings] == [("error", 4)]
    assert "axis A moves to 90" in simulation.findings[0].text
    removed = simulation.volume_initial - simulation.volume_final
    assert removed == pytest.approx(2 * (30 * 6 + math.pi * 4.5), rel=0.02)  # the slot before it, nothing after


def project(**changes):
    tool = {"units": "metric", "shape": "cylindrical", "length": 20, "diameter": 6}
    return {"units": "metric", "tools": {"1": {**tool, **changes}}, "files": ["slot.nc"],
            "workpiece": {"automatic": False, "bounds": {"min": [0, 0, -10], "max": [60, 40, 0]}}}


def test_camotics_project(tmp_path):
    (tmp_path / "slot.nc").write_text(conftest.GCODE)
    path = tmp_path / "slot.camotics"
    path.write_text(json.dumps(project()))
    job = readers.read(str(path))
    assert job.stock == {"kind": "box", "lo": (0, 0, -10), "hi": (60, 40, 0)} and list(job.tools) == [1]
    report = tmp_path / "r.json"
    assert cli.main(["simulate", str(path), "--voxel", "0.5", "--report", str(report)]) == 0
    assert json.loads(report.read_text())["volume_mm3"]["removed"] == pytest.approx(conftest.SLOT_MM3, rel=2e-3)


@pytest.mark.parametrize(
    "changes, volume",
    [
        ({}, math.pi * 9 * 20),
        ({"units": "imperial", "diameter": 6 / 25.4, "length": 20 / 25.4}, math.pi * 9 * 20),
        ({"shape": "ballnose"}, math.pi * (18 + 9 * 17)),
        ({"shape": "conical"}, math.pi * 9 * 20 / 3),
        ({"shape": "snubnose", "snub_diameter": 2}, math.pi * 20 * (9 + 3 + 1) / 3),
        ({"shape": "spheroid", "length": 6}, math.pi * 36),
    ],
)
def test_camotics_tools(changes, volume):
    assert camotics.cutter(project(**changes)["tools"]["1"]).volume() == pytest.approx(volume)


@pytest.mark.parametrize(
    "text, says",
    [
        ("{", "is no JSON"),
        ("[]", "an object is wanted"),
        ("{}", "files"),
        (json.dumps(project(shape="cube")), "'cube' is not known"),
        (json.dumps(project(diameter=-1)), "diameter: -1 is no positive length"),
        (json.dumps({**project(), "files": ["a", "b"]}), "2 programs"),
        (json.dumps({**project(), "files": "slot.nc"}), "files: 'slot.nc': a list of names"),
        (json.dumps({**project(), "files": [3]}), "files: .3.: a list of names"),
        (json.dumps({**project(), "tools": {"x": {}}}), "'x' is no number of a tool"),
        (json.dumps({**project(), "tools": {"1": 3}}), "tool 1: 3: an object"),
        (json.dumps({**project(), "workpiece": {"bounds": {"min": [0, 0], "max": [1, 1, 1]}}}), "min: .0, 0.: three"),
        (json.dumps({**project(), "workpiece": {"bounds": {"min": [0, 0, 0], "max": [1, 1, None]}}}), "max: .*three"),
        (json.dumps({**project(), "workpiece": {"bounds": {"min": [0, 0, 0]}}}), "no 'max'"),
    ],
)
def test_impossible_projects(tmp_path, text, says):
    path = tmp_path / "bad.camotics"
    path.write_text(text)
    with pytest.raises(swarf.FormatError, match=f"^{re.escape(str(path))}: .*{says}"):
        readers.read(str(path))


COMPENSATED = "G21 G90 F100\nT1 M6\nG0 X0 Y0 Z1\nG41 G1 X0 Y10\nX20\nG40 G1 X30\nM2\n"


def ends(text):
    return [move[:2] for move in struct.iter_unpack("=dddfIiI", text.moves) if not math.isnan(move[0])]


def test_the_tools_given_serve_compensation(tmp_path, capsys):
    path = tmp_path / "side.ngc"
    path.write_text(COMPENSATED)
    with pytest.raises(swarf.FormatError, match="side.ngc:4:1: error: .*diameter of tool T1"):
        swarf.read_gcode(path)
    table = swarf.read_gcode(path, tools=[(1, 6.0, 0.0)])
    given = swarf.read_gcode(path, diameters={1: 6.0, 2: 9.0})
    assert ends(table) == ends(given) and ends(given)[-2] == (20.0, 13.0)
    # the control's own table comes first, where it tells
    assert ends(swarf.read_gcode(path, tools=[(1, 6.0, 0.0)], diameters={1: 8.0})) == ends(table)
    assert ends(swarf.read_gcode(path, tools=[(1, 0.0, 0.0)], diameters={1: 6.0})) == ends(table)

    class Pairs(dict):
        def items(self):
            return [7]

    with pytest.raises(TypeError):
        swarf.read_gcode(path, diameters=Pairs({1: 6.0}))
    for wrong in ({1: -1.0}, {-1: 1.0}, {1: math.nan}):
        with pytest.raises(ValueError, match="diameter 1: tool"):
            swarf.read_gcode(path, diameters=wrong)
    assert cli.main(["check", str(path)]) == 1
    assert "give the tool or a tool table" in capsys.readouterr().out
    assert cli.main(["check", str(path), "--tool", "1=flat:d=6,l=20"]) == 0
    assert cli.main(["moves", str(path), "--tool", "1=ball:d=6,l=20"]) == 0
    assert "feed X20.000000 Y13.000000" in capsys.readouterr().out
    assert cli.main(["simulate", str(path), "--tool", "1=flat:d=6,l=20", "--stock", "box:0,0,-5,30,20,2",
                     "--voxel", "0.5"]) == 0
    assert cli.main(["check", str(path), "--tool", "1=flat:d=6,l=20", "--tool", "1=flat:d=5,l=20"]) == 2
    assert "given twice" in capsys.readouterr().err


def test_a_camotics_project_tells_diameters(tmp_path):
    (tmp_path / "side.ngc").write_text(COMPENSATED)
    project = tmp_path / "side.camotics"
    project.write_text(json.dumps({
        "files": ["side.ngc"], "tools": {"1": {"shape": "cylindrical", "diameter": 6, "length": 20}}}))
    assert ends(camotics.read(str(project)).program)[-2] == (20.0, 13.0)
