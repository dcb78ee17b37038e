# SPDX-License-Identifier: LGPL-2.1-or-later
"""Path commands -> moves."""

import math
import random

import pytest
from swarf_cam.core import moves, program
from swarf_cam.core.errors import JobError
from swarf_cam.core.placement import Placement


class Command:
    def __init__(self, text):
        if text.startswith("("):
            self.Name, self.Parameters = text, {}
            return
        name, *words = text.split()
        self.Name = name
        self.Parameters = {word[0]: float(word[1:]) for word in words}


def read(text, **options):
    lines = [line.strip() for line in text.strip().splitlines()]
    operation = program.Operation("Op", [Command(line) for line in lines], 1, **options)
    return program.build([operation])


def rows(table, kind=None):
    """(kind, end, feed, line) of the straight moves, without the tool change that the builder puts first."""
    result = []
    for index in range(len(table)):
        row = table.row(index)
        if row[0] == moves.LINE and (kind is None or row[1] == kind):
            result.append((int(row[1]), row[5:8], row[4], int(row[3])))
    return result


def path(table):
    """Kind and end of every straight move."""
    return [("GF"[kind], *end) for kind, end, _, _ in rows(table)]


def test_lines_feeds_and_command_numbers():
    table = read("""(text)
        G0 Z5
        G00 X1 Y2 F0
        G1 Z-1 F10
        g01 X3
        G0 Z5 F99
        G1 Z0""")
    assert rows(table) == [
        (moves.RAPID, (1, 2, 5), 0, 3), (moves.FEED, (1, 2, -1), 600, 4), (moves.FEED, (3, 2, -1), 600, 5),
        (moves.RAPID, (3, 2, 5), 0, 6), (moves.FEED, (3, 2, 0), 600, 7)]


def test_relative_moves():
    table = read("""G0 X1 Y1 Z1
        G91
        G1 X2 F1
        G1 Z-1
        G90
        G1 X0""")
    assert path(table)[1:] == [("F", 3, 1, 1), ("F", 3, 1, 0), ("F", 0, 1, 0)]


def test_tool_changes_come_with_the_controller():
    tools = {number: [Command("(tool)"), Command("M6 T%d" % number), Command("M%d S%d" % (number + 2, number * 100))]
             for number in (1, 2)}
    go = [Command("G0 X0 Y0 Z0"), Command("G1 X1 F1")]
    operations = [program.Operation(str(i), go, tool, "TC%d" % tool, tools[tool]) for i, tool in enumerate((1, 1, 2))]
    table = program.build(operations)
    changes = [index for index in range(len(table)) if table.row(index)[:2] == (moves.EVENT, moves.TOOL_CHANGE)]
    assert [table.sections[int(table.row(index)[2])][:2] for index in changes] == [(1, 0), (2, 2)]
    assert table.sections[int(table.row(len(table) - 1)[2])] == (2, 2, moves.SPINDLE_CCW, 0, 200.0)
    assert table.operations == ["0", "1", "2"]


def test_tool_without_own_commands_is_changed_too():
    table = read("G0 X0 Y0 Z0")
    assert table.row(0)[:2] == (moves.EVENT, moves.TOOL_CHANGE)
    assert table.sections[int(table.row(0)[2])][0] == 1


@pytest.mark.parametrize("plane,start,words,centre,end", [
    ("G17", (0, 0, 0), "X2 I1 J0", (1, 0, 0), (2, 0, 0)),
    ("G18", (0, 5, 0), "X2 I1 K0", (1, 5, 0), (2, 5, 0)),
    ("G19", (7, 0, 0), "Y2 J1 K0", (7, 1, 0), (7, 2, 0)),
    ("G17", (0, 0, 0), "X2 Z3 I1", (1, 0, 0), (2, 0, 3)),
    ("G17", (0, 0, 0), "X1 Y1 R1", (1, 0, 0), None),
])
def test_arcs(plane, start, words, centre, end):
    table = read("G0 X%g Y%g Z%g\n%s\nG2 %s F1" % (*start, plane, words))
    row = table.row(len(table) - 1)
    assert row[0] == moves.ARC and row[11] == -1
    assert row[1] == {"G17": moves.PLANE_XY, "G18": moves.PLANE_ZX, "G19": moves.PLANE_YZ}[plane]
    assert row[8:11] == pytest.approx(centre)
    if end:
        assert row[5:8] == end


def test_full_circle_and_turns():
    row = read("G0 X0 Y0 Z0\nG3 X0 Y0 Z-2 I1 J0 P2 F1")
    assert row.row(len(row) - 1)[5:] == (0, 0, -2, 1, 0, 0, 2)


CYCLES = {
    "G81": [("F", 0, 0, -4), ("G", 0, 0, 10)],
    "G85": [("F", 0, 0, -4), ("F", 0, 0, 1), ("G", 0, 0, 10)],
    "G83": [("F", 0, 0, -1), ("G", 0, 0, 1), ("G", 0, 0, -0.746), ("F", 0, 0, -3), ("G", 0, 0, 1),
            ("G", 0, 0, -2.746), ("F", 0, 0, -4), ("G", 0, 0, 10)],
    "G73": [("F", 0, 0, -1), ("G", 0, 0, -0.746), ("F", 0, 0, -3), ("G", 0, 0, -2.746), ("F", 0, 0, -4),
            ("G", 0, 0, 10)],
}


@pytest.mark.parametrize("name", CYCLES)
def test_cycles(name):
    table = read("G0 X0 Y0 Z10\nG98\n%s X0 Y0 Z-4 R1 Q2 F2\nG80" % name)
    assert path(table)[0] == ("G", 0, 0, 10)
    expected = [(kind, x, y, pytest.approx(z)) for kind, x, y, z in CYCLES[name]]
    assert path(table)[-len(expected) - 1:] == [("G", 0, 0, 1)] + expected
    assert {row[3] for row in rows(table)[2:]} == {3}
    assert {row[2] for row in rows(table, moves.FEED)} == {120}


def test_return_to_r_and_sticky_words():
    table = read("""G0 X0 Y0 Z10
        G99
        G82 X1 Y0 Z-4 R1 P0.5 F2
        G82 X2
        G98
        G82 X3
        G80
        G0 X9""")
    assert path(table) == [
        ("G", 0, 0, 10), ("G", 1, 0, 10), ("G", 1, 0, 1), ("F", 1, 0, -4), ("G", 1, 0, 1), ("G", 2, 0, 1),
        ("F", 2, 0, -4), ("G", 2, 0, 1), ("G", 3, 0, 1), ("F", 3, 0, -4), ("G", 3, 0, 10), ("G", 9, 0, 10)]
    dwells = [table.row(i)[4] for i in range(len(table)) if table.row(i)[:2] == (moves.EVENT, moves.DWELL)]
    assert dwells == [0.5] * 3


def test_cycle_below_r_rises_first():
    assert path(read("G0 X5 Y0 Z0\nG99\nG81 X0 Y0 Z-4 R2 F1"))[1:] == [
        ("G", 5, 0, 2), ("G", 0, 0, 2), ("F", 0, 0, -4), ("G", 0, 0, 2)]


QUARTER = ((0, -1, 0), (1, 0, 0), (0, 0, 1))  # about z
TILTED = ((1, 0, 0), (0, 0, -1), (0, 1, 0))  # z -> -y
SKEW = ((1, 0, 0), (0, 0.8, -0.6), (0, 0.6, 0.8))


def test_placement_moves_and_turns_points():
    table = read("G0 X1 Y2 Z3\nG1 X2 F1", placement=Placement(QUARTER, (10, 0, 0)))
    assert path(table) == [("G", 8, 1, 3), ("F", 8, 2, 3)]


def test_placement_keeps_arcs_in_coordinate_planes():
    table = read("G0 X0 Y0 Z0\nG2 X2 I1 F1", placement=Placement(TILTED))
    row = table.row(len(table) - 1)
    assert (row[0], row[1]) == (moves.ARC, moves.PLANE_ZX)
    assert row[11] == 1  # the normal points the other way: clockwise becomes counter-clockwise
    assert row[5:11] == (2, 0, 0, 1, 0, 0)


@pytest.mark.parametrize("name", ["G2", "G3"])
def test_arcs_in_other_planes_become_chords_within_the_bound(name):
    placement = Placement(SKEW, (1, 2, 3))
    table = read("G0 X0 Y0 Z0\n%s X3 Y3 Z1 I3 J0 F1" % name, placement=placement)
    ends = [placement.inverse_point(end) for _, end, _, _ in rows(table)]
    assert math.dist(ends[-1], (3, 3, 1)) < 1e-9
    total = 0.0
    for a, b in zip(ends, ends[1:]):
        middle = [(p + q) / 2 for p, q in zip(a, b)]
        assert math.hypot(b[0] - 3, b[1]) == pytest.approx(3, abs=1e-9)
        assert abs(math.hypot(middle[0] - 3, middle[1]) - 3) <= program.CHORD_TOLERANCE_MM * 1.0001
        total += math.dist(a[:2], b[:2])
    assert total == pytest.approx(3 * math.pi * (0.5 if name == "G2" else 1.5), rel=1e-3)


def test_position_is_kept_between_operations_with_placements():
    first = program.Operation("A", [Command("G0 X1 Y2 Z3")], 1)
    second = program.Operation("B", [Command("G1 Z0 F1")], 1, placement=Placement(QUARTER, (5, 6, 7)))
    assert path(program.build([first, second]))[-1] == ("F", 1, 2, 7)


@pytest.mark.parametrize("text,word", [
    ("G0 X0 Y0 Z0\nG5 X1", "command 2, 'G5'"),
    ("G0 X0 Y0 Z0\nG1 X1 A10 F1", "A10"),
    ("G0 X0 Y0 Z0\nG1 X1 I10 F1", "I10"),
    ("G1 X1 F1", "Y, Z"),
    ("G0 X0 Y0 Z0\nG2 X2 F1", "centre"),
    ("G0 X0 Y0 Z0\nG2 X2 I5 J0 F1", "radius"),
    ("G0 X0 Y0 Z0\nG2 X9 R1 F1", "R1"),
    ("G0 X0 Y0 Z0\nG83 X0 Y0 Z-1 R1 F1", "Q"),
    ("G0 X0 Y0 Z0\nG83 X0 Y0 Z-1 R1 Q1e-9 F1", "pecks"),
    ("G0 X0 Y0 Z0\nG81 X0 Y0 Z2 R1 F1", "above"),
    ("G0 X0 Y0 Z0\nG81 X0 Y0 R1 F1", "word Z"),
    ("G0 X0 Y0 Z0\nG20", "G20"),
    ("G0 X0 Y0 Z0\nM6", "tool number"),
    ("G0 X0 Y0 Z0\nG1 X1 F-1", "F-1"),
    ("G0 X0 Y0 Znan", "Z is not a finite"),
])
def test_errors_name_operation_command_and_word(text, word):
    with pytest.raises(JobError, match="operation 'Op', command") as error:
        read(text)
    assert word in str(error.value)


def test_no_operation():
    with pytest.raises(JobError, match="no active operation"):
        program.build([])


def test_rotary_words_of_zero_and_no_effect_commands_pass():
    assert len(rows(read("G21\nG40\nG54\nM0\nG0 X0 Y0 Z0 A0\n(x)\n;y\nG94"))) == 1


def test_bytes_and_back():
    table = read("G0 X0 Y0 Z0\nG2 X2 I1 F1\nG4 P2")
    again = moves.MoveTable.from_bytes(table.to_bytes(), table.sections, table.operations)
    assert again.rows == table.rows and again.sections == table.sections
    with pytest.raises(ValueError, match="cut off"):
        moves.MoveTable.from_bytes(table.to_bytes()[:-8], table.sections, table.operations)


def native_moves(numpy, native):
    """(kind, end, arc?) of a swarf.Program, without changes of tool."""
    names = ("rapid", "feed", "dwell", "tool_change", "probe", "position")
    result = []
    for move in numpy.asarray(native.moves):
        kind = names[int(move["section_kind"]) & 7]
        if kind not in ("tool_change", "dwell"):
            result.append((kind, *(round(float(value), 9) for value in move["end"])))
    return result


def test_same_holes_as_the_gcode_reader(swarf):
    """The same cycles as text and as commands give the same moves."""
    numpy = pytest.importorskip("numpy")
    text = ["G90", "G0 X0 Y0 Z20", "G98", "G81 X1 Y2 Z-4 R2 F120", "G81 X3", "G80", "G0 X9", "G99",
            "G83 X1 Y5 Z-4 R2 Q1.5 F60", "G83 Y7", "G80", "G0 Z20", "G98", "G73 X1 Y9 Z-4 R2 Q1.7 F60", "G80",
            "G82 X1 Y8 Z-4 R2 P0.1", "G85 Y12 Z-3 R1", "G89 Y13 Z-3 R1 P0.2", "G80"]
    commands = [Command(line.replace("F120", "F2").replace("F60", "F1")) for line in text]
    table = program.build([program.Operation("Op", commands, 1)])
    ours = native_moves(numpy, table.play(swarf.Program()))
    theirs = native_moves(numpy, swarf.Program.parse_gcode("T1 M6\n" + "\n".join(text) + "\nM2\n"))
    assert ours == theirs


def test_native_program_takes_every_row(swarf):
    """Random arcs, helices and lines pass the native checks."""
    seed = 20240
    source = random.Random(seed)
    lines = ["G0 X0 Y0 Z0"]
    x = y = 0.0
    for _ in range(500):
        radius, begin, turn = source.uniform(0.1, 50), source.uniform(0, 6.28), source.uniform(0.01, 6.2)
        cx, cy = x - radius * math.cos(begin), y - radius * math.sin(begin)
        nx, ny = cx + radius * math.cos(begin + turn), cy + radius * math.sin(begin + turn)
        lines.append("G3 X%.6f Y%.6f Z%.6f I%.6f J%.6f F1" % (nx, ny, source.uniform(-5, 5), cx - x, cy - y))
        x, y = round(nx, 6), round(ny, 6)
    native = read("\n".join(lines)).play(swarf.Program())
    assert len(native) == 502, "seed %d" % seed
