# SPDX-License-Identifier: LGPL-2.1-or-later
"""``swarf check``: what is wrong with a G-code file."""
from __future__ import annotations

import argparse
from typing import Any

from .. import gcode
from .._native import Program
from ..console import DONE, FINDINGS, say
from ..progress import Bar


def add(subparsers: Any) -> None:
    """Add the parser of ``swarf check``."""
    command = subparsers.add_parser(
        "check",
        help="errors and warnings of a G-code file",
        description="Read a G-code file and print its errors and warnings, one a line: FILE:LINE:COLUMN: error: what "
        "is wrong and what would be right. Nothing is read after an error. Exit status: 0 no error, 1 an error, 2 "
        "could not run.",
    )
    command.add_argument("input", metavar="FILE", help="a G-code file")
    command.add_argument("--messages", action="store_true", help="print what the program says by MSG, PRINT, DEBUG too")
    gcode.add_arguments(command)


def run(arguments: argparse.Namespace) -> int:
    """Print the notes of the file."""
    with Bar() as bar:
        notes = Program.check_gcode(
            arguments.input, progress=lambda fraction: bar("read", fraction), **gcode.options(arguments)
        )
    say(gcode.note_text(note) for note in notes if note[0] != "message" or arguments.messages)
    return FINDINGS if any(note[0] == "error" for note in notes) else DONE
