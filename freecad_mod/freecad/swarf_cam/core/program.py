# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD Path commands -> moves.

A command is anything with a Name and Parameters (a mapping of letters to numbers): lengths in mm, F in mm/s,
P in seconds, angles in degrees, arc centres relative to the start, R of cycles absolute. An error names the
operation, the number of the command in it (from 1) and the word.
"""

import functools
import math
import re
from collections import namedtuple

from . import cycles, moves
from .errors import JobError
from .placement import Placement

UNKNOWN = float("nan")

# Chords that stand for an arc whose plane was turned out of the three coordinate planes; mm.
CHORD_TOLERANCE_MM = 0.001

# Words that choose what is so anyway in a Path object: absolute centres off, millimetres, feed per minute,
# compensation off, fixed offsets, path control, pause, stop, override switches.
NO_EFFECT = frozenset(
    "G21 G40 G43 G49 G54 G55 G56 G57 G58 G59 G59.1 G59.2 G59.3 G61 G61.1 G64 G91.1 G94 G97 "
    "M0 M1 M2 M30 M48 M49".split())

AXES = ("X", "Y", "Z")
CENTRES = ("I", "J", "K")
ROTARY = ("A", "B", "C")
PLANES = {"G17": moves.PLANE_XY, "G18": moves.PLANE_ZX, "G19": moves.PLANE_YZ}
WORDS = {  # the letters that a command may carry; N is a line number
    "G0": "XYZABCF", "G1": "XYZABCF", "G2": "XYZIJKPRABCF", "G3": "XYZIJKPRABCF",
    "G4": "PX", "G38.2": "XYZF", "G38.3": "XYZF", "G38.4": "XYZF", "G38.5": "XYZF",
}
CYCLE_WORDS = "XYZRPQFLSIJKABC"


# A command as plain data, for what cannot be read from FreeCAD's own objects any more: in another thread, or later.
Command = namedtuple("Command", "Name Parameters")


class Operation:
    """What the reader needs of one operation.

    name: shown in results. commands: its Path commands. tool: number of its tool. controller: any value that
    is equal for operations that share a tool controller. tool_commands: the controller's own commands, played
    when the controller changes. placement: of the operation, None for none. source: the document's name of it.
    """

    def __init__(self, name, commands, tool, controller=None, tool_commands=(), placement=None, source=None):
        self.name = name
        self.commands = commands
        self.tool = tool
        self.controller = tool if controller is None else controller
        self.tool_commands = tool_commands
        self.placement = placement or Placement()
        self.source = source


@functools.lru_cache(maxsize=1024)
def canonical(name):
    """A command's name without leading zeros and in capitals: g01 -> G1, G38.20 -> G38.2."""
    match = re.fullmatch(r"\s*([A-Za-z])0*(\d+)(?:\.(\d+))?\s*", name)
    if not match:
        return name.strip()
    letter, number, decimals = match.groups()
    decimals = (decimals or "").rstrip("0")
    return letter.upper() + number + ("." + decimals if decimals else "")


def is_comment(name):
    """True for the commands that hold text for people."""
    text = name.strip()
    return not text or text.startswith(("(", ";", "%"))


class Reader:
    """Plays operations into a MoveTable. One object per program, one thread."""

    def __init__(self, table=None, chord_tolerance_mm=CHORD_TOLERANCE_MM):
        self.table = table if table is not None else moves.MoveTable()
        self.chord_tolerance_mm = chord_tolerance_mm
        self._world = (UNKNOWN,) * 3
        self._controller = None
        self._tool = -1
        self._spindle = moves.SPINDLE_OFF
        self._rpm = 0.0
        self._coolant = 0
        self._operation_index = 0
        self._operation = None
        self._reset_modes()

    def _reset_modes(self):
        """What holds at the start of every operation: posts write each as a block of its own."""
        self._relative = False
        self._plane = moves.PLANE_XY
        self._return_to_initial = True
        self._series_z = None
        self._feed = 0.0
        self._cycle_words = {}

    def add(self, operation):
        """Append one operation, with its controller's commands before it when the controller changes."""
        self._operation = operation
        self._operation_index = self.table.add_operation(operation.name)
        self._reset_modes()
        self._position = list(self._world)
        if operation.controller != self._controller:
            self._placement = Placement()
            self._play(operation.tool_commands, "tool controller of ")
            if self._tool != operation.tool:  # the controller's own commands lack an M6
                self._tool = operation.tool
                self._set_section()
                self.table.add_event(moves.TOOL_CHANGE, 0.0, 0)
            self._controller = operation.controller
        self._placement = operation.placement
        self._position = list(operation.placement.inverse_point(self._world))
        self._set_section()
        self._play(operation.commands, "")
        return self

    def _play(self, commands, source):
        for number, command in enumerate(commands, 1):
            if is_comment(command.Name):
                continue
            self._source, self._line = source, number
            self._name = command.Name
            words = {}
            for letter, value in dict(command.Parameters).items():
                value = float(value)
                if not math.isfinite(value):
                    self._fail("the word %s is not a finite number" % letter)
                words[letter.upper()] = value
            self._command(canonical(command.Name), words)

    def _fail(self, text):
        raise JobError("%soperation '%s', command %d, '%s': %s"
                       % (self._source, self._operation.name, self._line, self._name, text))

    def _set_section(self):
        self.table.set_section(self._tool, self._operation_index, self._spindle, self._coolant, self._rpm)

    def _check_words(self, words, allowed):
        for letter, value in words.items():
            if letter == "N":
                continue
            if letter not in allowed:
                self._fail("the word %s%g has no meaning here" % (letter, value))
            if letter in ROTARY and abs(value) > 1e-9:
                self._fail("the word %s%g turns a rotary axis; only three axes can be simulated" % (letter, value))

    def _command(self, name, words):
        if name in WORDS:
            self._check_words(words, WORDS[name])
        if name in ("G0", "G1"):
            self._straight(moves.RAPID if name == "G0" else moves.FEED, words)
        elif name in ("G2", "G3"):
            self._arc(words, ccw=name == "G3")
        elif name in cycles.CYCLES:
            self._check_words(words, CYCLE_WORDS)
            self._cycle(name, words)
        elif name.startswith("G38"):
            self._straight(moves.PROBE, words)
        elif name == "G4":
            seconds = words.get("P", words.get("X"))
            if seconds is None or seconds < 0:
                self._fail("needs a time P of 0 or more seconds")
            self.table.add_event(moves.DWELL, seconds, self._line)
        elif name in PLANES:
            self._plane = PLANES[name]
        elif name == "G80":
            self._end_series()
        elif name in ("G90", "G91"):
            self._relative = name == "G91"
        elif name in ("G98", "G99"):
            self._return_to_initial = name == "G98"
        elif name in ("M3", "M4", "M5"):
            self._set_spindle(name, words)
        elif name in ("M7", "M8", "M9"):
            self._coolant = {"M7": self._coolant | moves.COOLANT_MIST, "M8": self._coolant | moves.COOLANT_FLOOD,
                             "M9": 0}[name]
            self._set_section()
        elif name == "M6":
            self._change_tool(words)
        elif name not in NO_EFFECT:
            self._fail("is not a command that can be simulated")

    def _set_spindle(self, name, words):
        self._spindle = {"M3": moves.SPINDLE_CW, "M4": moves.SPINDLE_CCW, "M5": moves.SPINDLE_OFF}[name]
        self._rpm = words.get("S", self._rpm)
        self._set_section()

    def _change_tool(self, words):
        if "T" not in words or words["T"] != int(words["T"]) or words["T"] < 0:
            self._fail("needs a tool number T")
        self._tool = int(words["T"])
        self._spindle = moves.SPINDLE_OFF
        self._set_section()
        self.table.add_event(moves.TOOL_CHANGE, 0.0, self._line)

    def _end_series(self):
        self._series_z = None
        self._cycle_words = {}

    def _target(self, words):
        target = list(self._position)
        for i, letter in enumerate(AXES):
            if letter in words:
                target[i] = words[letter] + (self._position[i] if self._relative else 0.0)
        return target

    def _go(self, kind, target):
        """A straight move in the operation's coordinates; nothing is known of its place until all three are."""
        known = not any(map(math.isnan, target))
        if not known and kind != moves.RAPID:
            missing = ", ".join(letter for letter, value in zip(AXES, target) if math.isnan(value))
            self._fail("starts before %s is known; a rapid to a known place must come first" % missing)
        self._position = list(target)
        if known:
            self._world = self._placement.point(target)
            self.table.add_line(kind, self._world, 0.0 if kind == moves.RAPID else self._feed, self._line)

    def _rapid(self, target):
        """A rapid that a cycle makes only where it leads somewhere."""
        if tuple(self._position) != tuple(target):
            self._go(moves.RAPID, target)

    def _straight(self, kind, words):
        self._end_series()
        if kind != moves.RAPID:
            self._take_feed(words)
        if any(letter in words for letter in AXES):
            self._go(kind, self._target(words))

    def _take_feed(self, words):
        if "F" in words:
            if words["F"] < 0:
                self._fail("the feed F%g is negative" % words["F"])
            if words["F"] > 0:
                self._feed = words["F"] * 60.0

    def _centre(self, words, target, ccw):
        """Centre of an arc from its I J K or R words, in the operation's coordinates."""
        first, second, normal = moves.PLANE_AXES[self._plane]
        start = self._position
        if any(CENTRES[i] in words for i in (first, second)):
            centre = list(start)
            for i in (first, second):
                centre[i] += words.get(CENTRES[i], 0.0)
            if abs(words.get(CENTRES[normal], 0.0)) > 1e-9:
                self._fail("the word %s%g leaves the arc's plane" % (CENTRES[normal], words[CENTRES[normal]]))
            return centre
        if "R" not in words:
            self._fail("an arc needs its centre (%s, %s) or its radius R" % (CENTRES[first], CENTRES[second]))
        du, dv = target[first] - start[first], target[second] - start[second]
        chord, radius = math.hypot(du, dv), words["R"]
        if chord == 0.0 or chord > 2 * abs(radius) + 0.002:
            self._fail("the radius R%g does not fit ends %g mm apart" % (radius, chord))
        rise = math.sqrt(max(radius * radius - chord * chord / 4, 0.0)) / chord
        if ccw != (radius > 0):
            rise = -rise
        centre = list(start)
        centre[first] += du / 2 - dv * rise
        centre[second] += dv / 2 + du * rise
        return centre

    def _arc(self, words, ccw):
        self._end_series()
        self._take_feed(words)
        target = self._target(words)
        if any(map(math.isnan, list(target) + list(self._position))):
            self._fail("an arc starts before the place of the tool is known")
        centre = self._centre(words, target, ccw)
        turns = words.get("P", 1.0)
        if turns < 1 or turns != int(turns):
            self._fail("the number of turns P%g is not a whole number from 1" % turns)
        first, second, normal = moves.PLANE_AXES[self._plane]
        start_radius = math.hypot(self._position[first] - centre[first], self._position[second] - centre[second])
        end_radius = math.hypot(target[first] - centre[first], target[second] - centre[second])
        if start_radius == 0.0 or abs(end_radius - start_radius) > max(0.002, 1e-3 * start_radius):
            self._fail("the arc's radius is %.6g mm at its start and %.6g mm at its end" % (start_radius, end_radius))
        turned = self._placement.axis(normal)
        if turned is None:
            self._chords(target, centre, ccw, int(turns))
            return
        axis, sign = turned
        self._position = list(target)
        self._world = self._placement.point(target)
        self.table.add_arc(self._world, self._placement.point(centre), moves.PLANE_OF_NORMAL[axis],
                           ccw == (sign > 0), int(turns), self._feed, self._line)

    def _chords(self, target, centre, ccw, turns):
        """An arc as straight moves that leave it by at most the chord tolerance."""
        first, second, normal = moves.PLANE_AXES[self._plane]
        start = list(self._position)
        u, v = start[first] - centre[first], start[second] - centre[second]
        radius = math.hypot(u, v)
        begin = math.atan2(v, u)
        sweep = math.atan2(target[second] - centre[second], target[first] - centre[first]) - begin
        full = 2 * math.pi
        if ccw:
            sweep = sweep % full or full
            sweep += full * (turns - 1)
        else:
            sweep = -((-sweep) % full or full)
            sweep -= full * (turns - 1)
        step = 2 * math.acos(max(1 - self.chord_tolerance_mm / radius, 0.0))
        count = max(math.ceil(abs(sweep) / step), 2)
        for i in range(1, count):
            share = i / count
            angle = begin + sweep * share
            point = [0.0] * 3
            point[first] = centre[first] + radius * math.cos(angle)
            point[second] = centre[second] + radius * math.sin(angle)
            point[normal] = start[normal] + (target[normal] - start[normal]) * share
            self._go(moves.FEED, point)
        self._go(moves.FEED, target)

    def _cycle(self, name, words):
        """A drilling cycle: to the hole at the height reached, to R, into it, back to R (G99) or up (G98)."""
        if self._plane != moves.PLANE_XY:
            self._fail("a drilling cycle needs the plane G17")
        if self._relative:
            self._fail("a drilling cycle with G91 is not supported")
        self._take_feed(words)
        self._cycle_words.update((letter, words[letter]) for letter in "ZRPQ" if letter in words)
        for letter in "ZR":
            if letter not in self._cycle_words:
                self._fail("needs the word %s" % letter)
        z, retract = self._cycle_words["Z"], self._cycle_words["R"]
        if words.get("L", 1.0) != 1.0:
            self._fail("repeats (L%g) are not supported" % words["L"])
        if math.isnan(self._position[2]):
            self._position[2] = retract
        if self._series_z is None:
            self._series_z = self._position[2]
        clear = max(self._series_z, retract) if self._return_to_initial else retract
        try:
            steps = list(cycles.expand(name, z, retract, clear, self._cycle_words.get("Q"),
                                       self._cycle_words.get("P", 0.0)))
        except ValueError as error:
            self._fail(str(error))
        x, y = words.get("X", self._position[0]), words.get("Y", self._position[1])
        if math.isnan(x) or math.isnan(y):
            self._fail("needs the words X and Y: the place of the hole is not known")
        height = max(self._position[2], retract)
        self._rapid((self._position[0], self._position[1], height))
        self._rapid((x, y, height))
        self._rapid((x, y, retract))
        for action, value in steps:
            if action == "dwell":
                self.table.add_event(moves.DWELL, value, self._line)
            elif action == "feed":
                self._go(moves.FEED, (x, y, value))
            else:
                self._rapid((x, y, value))


def build(operations, chord_tolerance_mm=CHORD_TOLERANCE_MM):
    """The MoveTable of operations in order. JobError when there are none or a command cannot be simulated."""
    if not operations:
        raise JobError("the job has no active operation")
    reader = Reader(chord_tolerance_mm=chord_tolerance_mm)
    for operation in operations:
        reader.add(operation)
    return reader.table
