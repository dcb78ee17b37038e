# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is in buffers: the records of a Program, for struct, as swarf_move, swarf_arc, swarf_section and swarf_axes hold
them; rows of tables."""
from __future__ import annotations

import struct
from typing import Any, cast

#: end x y z in mm, feed in mm/min (of a dwell: seconds), line, arc or -1, section * 8 + kind
MOVE = struct.Struct("=dddfIiI")
#: centre, angle in radians, plane, 0
ARC = struct.Struct("=dddd2i")
#: tool, operation, spindle, coolant, speed in rpm, work offset, source
SECTION = struct.Struct("=iiiidii")
#: move from which on they hold, then A B C in degrees and U V W in mm
AXES = struct.Struct("=Q6d")


def section_and_kind(packed: int) -> tuple[int, int]:
    """The parts of a move's last number."""
    return packed >> 3, packed & 7


def rows(table: memoryview) -> list[list[Any]]:
    """The rows of a view of two dimensions."""
    return cast("list[list[Any]]", table.tolist())  # which type checkers take to be of one dimension
