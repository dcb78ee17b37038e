# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``swarf``: collects the subcommands of the package ``commands`` and runs one.

Exit status: 0 done, 1 done with findings of class error, 2 could not run (one line on stderr says why).
"""
from __future__ import annotations

import os
import signal
import sys
import threading
from types import ModuleType
from typing import Optional, Sequence

from . import _native
from .commands import collect
from .console import FAILED, Parser, one_line, tell


def make_parser(commands: dict[str, ModuleType]) -> Parser:
    parser = Parser(prog="swarf", description="Milling simulation: what a program does to the stock.")
    parser.add_argument("--version", action="version", version=f"swarf {_native.version()}")
    subparsers = parser.add_subparsers(dest="command", metavar="COMMAND", required=True, parser_class=Parser)
    for command in commands.values():
        command.add(subparsers)
    return parser


def check_words(words: Sequence[str]) -> None:
    """ValueError for a file or a value without a letter, as of a script's variable that was never set."""
    for before, word in zip(("swarf", *words), words):
        if not word or (word.startswith("--") and word.find("=") == len(word) - 1):
            raise ValueError(f"nothing stands after {before if not word else word}: a name or a value is wanted there")


def interrupt_by_signals() -> None:
    """Let SIGTERM, Ctrl-C and a terminal that is closed end the work in order: by their defaults they would leave
    half-written files behind."""
    if threading.current_thread() is not threading.main_thread():
        return
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    for number in (signal.SIGINT, signal.SIGHUP):
        if signal.getsignal(number) == signal.SIG_DFL:  # not in the background, not after nohup
            signal.signal(number, signal.default_int_handler)


def open_streams() -> None:
    """Standard streams that were closed become ones that swallow: Python has None there."""
    for name in ("stdin", "stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "r" if name == "stdin" else "w", encoding="utf-8"))


def of_system(error: OSError) -> str:
    """What the system says, as the library puts it: the file first, where it is known."""
    if error.strerror is None:
        return str(error) or type(error).__name__
    return error.strerror if error.filename is None else f"{os.fsdecode(error.filename)}: {error.strerror}"


def main(argv: Optional[Sequence[str]] = None) -> int:
    """Run the command with these words (default: of the process); returns the exit status."""
    open_streams()
    try:
        commands = collect()
        words = sys.argv[1:] if argv is None else argv
        check_words(words)
        arguments = make_parser(commands).parse_args(words)
        interrupt_by_signals()
        return int(commands[arguments.command].run(arguments))
    except OSError as error:
        message = one_line(of_system(error))
    except (_native.Error, ValueError, MemoryError) as error:
        message = one_line(error) or type(error).__name__
    except KeyboardInterrupt:
        message = "interrupted"
    tell(f"error: {message}")
    return FAILED
