# SPDX-License-Identifier: LGPL-2.1-or-later
"""Moves as a flat table: what the reader of Path commands makes and what the native program is filled from.

A row is COLUMNS doubles: type, code, section, line, feed, end x y z, centre x y z, turns.
    type 0, straight move: code is the move's kind; centre and turns are 0
    type 1, arc or helix:  code is the plane (0 XY, 1 ZX, 2 YZ); turns is the number of passes, negative for clockwise
    type 2, event:         code is the move's kind (dwell, tool change), feed its value
Lengths in mm, feeds in mm/min, line is the number of the command in its operation, from 1. Appended to
front to back, read front to back.
"""

import array
import sys

COLUMNS = 12

LINE, ARC, EVENT = 0, 1, 2

# swarf_move_kind
RAPID, FEED, DWELL, TOOL_CHANGE, PROBE = 0, 1, 2, 3, 4

# swarf_plane, and the index of each plane's normal and of its two axes, counter-clockwise about that normal
PLANE_XY, PLANE_ZX, PLANE_YZ = 0, 1, 2
PLANE_AXES = {PLANE_XY: (0, 1, 2), PLANE_ZX: (2, 0, 1), PLANE_YZ: (1, 2, 0)}
PLANE_OF_NORMAL = {2: PLANE_XY, 1: PLANE_ZX, 0: PLANE_YZ}

SPINDLE_OFF, SPINDLE_CW, SPINDLE_CCW = 0, 1, 2
COOLANT_MIST, COOLANT_FLOOD = 1, 2

# What swarf.Program calls them
KIND_NAMES = ("rapid", "feed", "dwell", "tool_change", "probe")
PLANE_NAMES = ("xy", "zx", "yz")
SPINDLE_NAMES = ("off", "cw", "ccw")


class MoveTable:
    """Rows, the sections they point to (tool, operation, spindle, coolant, rpm) and the operations' names."""

    def __init__(self):
        self.rows = array.array("d")
        self.sections = []
        self.operations = []
        self._section_index = {}
        self._current = -1

    def __len__(self):
        return len(self.rows) // COLUMNS

    def row(self, index):
        """Row `index` as a tuple of COLUMNS numbers."""
        return tuple(self.rows[index * COLUMNS:(index + 1) * COLUMNS])

    def add_operation(self, name):
        """Add an operation's name; its index."""
        self.operations.append(name)
        return len(self.operations) - 1

    def set_section(self, tool, operation, spindle=SPINDLE_OFF, coolant=0, spindle_rpm=0.0):
        """What the following moves share."""
        key = (tool, operation, spindle, coolant, spindle_rpm)
        if key not in self._section_index:
            self._section_index[key] = len(self.sections)
            self.sections.append(key)
        self._current = self._section_index[key]

    def add_line(self, kind, end, feed_mm_min, line):
        """A straight move to `end`."""
        self.rows.extend((LINE, kind, self._current, line, feed_mm_min, *end, 0, 0, 0, 0))

    def add_arc(self, end, centre, plane, ccw, turns, feed_mm_min, line):
        """An arc or helix about `centre`."""
        self.rows.extend((ARC, plane, self._current, line, feed_mm_min, *end, *centre, turns if ccw else -turns))

    def add_event(self, kind, value, line):
        """A dwell (value: seconds) or a tool change."""
        self.rows.extend((EVENT, kind, self._current, line, value, 0, 0, 0, 0, 0, 0, 0))

    def feeds_with(self, tool):
        """Whether a tool makes a feed move: only probing and rapids need no flutes."""
        sections = {index for index, section in enumerate(self.sections) if section[0] == tool}
        rows = self.rows
        return any(rows[base + 2] in sections and (rows[base] == ARC or rows[base] == LINE and rows[base + 1] == FEED)
                   for base in range(0, len(rows), COLUMNS))

    def to_bytes(self):
        """The rows as little-endian doubles."""
        rows = self.rows
        if sys.byteorder != "little":
            rows = array.array("d", rows)
            rows.byteswap()
        return rows.tobytes()

    @classmethod
    def from_bytes(cls, data, sections, operations):
        """The inverse of to_bytes(); ValueError when the data are not whole rows."""
        table = cls()
        if len(data) % (8 * COLUMNS):
            raise ValueError("the moves are cut off: %d bytes are not whole rows" % len(data))
        table.rows.frombytes(data)
        if sys.byteorder != "little":
            table.rows.byteswap()
        table.sections = [tuple(section) for section in sections]
        table._section_index = {section: index for index, section in enumerate(table.sections)}
        table.operations = list(operations)
        return table

    def play(self, program):
        """Fill a native program: any object with the methods of swarf.Program."""
        for name in self.operations:
            program.add_operation(name)
        current = None
        rows = self.rows
        for base in range(0, len(rows), COLUMNS):
            kind, code, section, line, feed, ex, ey, ez, cx, cy, cz, turns = rows[base:base + COLUMNS]
            line = int(line)
            if section != current:
                current = section
                tool, operation, spindle, coolant, rpm = self.sections[int(section)]
                program.set_section(tool=tool, operation=operation, spindle=SPINDLE_NAMES[spindle], coolant=coolant,
                                    spindle_rpm=rpm)
            if kind == LINE:
                program.add_line((ex, ey, ez), kind=KIND_NAMES[int(code)], feed_mm_min=feed, line=line)
            elif kind == ARC:
                program.add_arc((ex, ey, ez), (cx, cy, cz), plane=PLANE_NAMES[int(code)], ccw=turns > 0,
                                turns=int(abs(turns)), feed_mm_min=feed, line=line)
            elif code == DWELL:
                program.add_dwell(feed, line=line)
            else:
                program.add_tool_change(line=line)
        return program
