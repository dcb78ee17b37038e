# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the subcommands share: exit statuses, the parser's class, standard output, checks of output files."""
from __future__ import annotations

import argparse
import contextlib
import os
import sys
import tempfile
from typing import IO, Iterable, NoReturn, Optional, Sequence

#: Exit statuses: done, done with findings of class error, could not run (one line on stderr says why).
DONE, FINDINGS, FAILED = 0, 1, 2


class Parser(argparse.ArgumentParser):
    """An ArgumentParser whose errors are one line like all others."""

    def error(self, message: str) -> NoReturn:
        self.exit(FAILED, f"swarf: error: {message}\n")

    def _print_message(self, message: str, file: Optional[IO[str]] = None) -> None:
        """Help and version are said as all else is: argparse itself swallows errors from Python 3.12 on."""
        if file is sys.stdout:
            say([message.rstrip("\n")])
        else:
            super()._print_message(message, file)


def say(lines: Iterable[str]) -> None:
    """Write lines to standard output, all of them at once: what is left in a buffer would fail when nobody looks any
    more. OSError names standard output; a reader that has gone, e.g. head, has what it wanted."""
    try:
        sys.stdout.writelines(f"{line}\n" for line in lines)
        sys.stdout.flush()
    except OSError as error:
        discard(sys.stdout)
        if not isinstance(error, BrokenPipeError):
            raise OSError(error.errno, error.strerror, "standard output") from None


def tell(line: str) -> None:
    """Write a line to standard error; when that fails, as in a terminal that was closed, the work goes on unheard."""
    try:
        print(f"swarf: {line}", file=sys.stderr)
    except OSError:
        discard(sys.stderr)


def discard(stream: IO[str]) -> None:
    """Let a stream that cannot be written swallow what it still holds: Python would try again when it ends."""
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, stream.fileno())
    os.close(null)


def one_line(text: object) -> str:
    """A text without line breaks, so that one message is one line."""
    return " ".join(str(text).split())


def check_writable(path: str) -> None:
    """OSError unless a file can be put there; leaves nothing behind."""
    if os.path.exists(path) and not os.path.isfile(path):
        raise OSError(f"{path}: cannot be written: it is not a regular file")
    place = os.path.realpath(path)
    try:
        with contextlib.suppress(FileNotFoundError):  # other errors: a name too long, links that go round
            os.stat(place)
        # Outputs are written beside their place and renamed: what counts is the folder.
        with tempfile.TemporaryFile(dir=os.path.dirname(place)):
            pass
    except OSError as error:
        raise OSError(f"{path}: cannot be written: {error.strerror or error}") from None


def check_outputs(paths: Sequence[Optional[str]], sources: Sequence[Optional[str]]) -> None:
    """Refuse, before the long work, outputs (None: not given) that could not be written after it.

    OSError where a file cannot be put; ValueError for one that is given twice, or one of the files that are read,
    ``sources``, the input first (None: not given).
    """
    given = [path for path in paths if path is not None]
    for path in given:
        check_writable(path)
        for number, source in enumerate(sources):
            if source is None or not (os.path.exists(path) and os.path.exists(source)):
                continue
            if os.path.samefile(path, source):
                raise ValueError(f"{path}: is {'read, too' if number else 'the input'}; an output must not replace it")
    places = [os.path.realpath(path) for path in given]
    for path, place in zip(given, places):
        if places.count(place) > 1:
            raise ValueError(f"{path}: given for two outputs")
