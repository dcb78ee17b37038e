# SPDX-License-Identifier: LGPL-2.1-or-later
"""Progress of long work: shares of it, steps of loops, a bar for a terminal."""
from __future__ import annotations

import shutil
import sys
import time
from typing import Any, Callable, Iterable, Iterator, Optional, TextIO, TypeVar

from ._native import Cancelled
from .aliases import Progress as Report
from .console import discard

__all__ = ["Bar", "Report", "Stages", "TURNS", "check", "share", "told"]

T = TypeVar("T")

#: Turns of a loop between two reports: some milliseconds.
TURNS = 4096


def share(progress: Report, begin: float, end: float) -> Report:
    """The progress of a part of the work, from begin to end of the whole."""
    if progress is None:
        return None
    whole = progress
    return lambda fraction: whole(begin + (end - begin) * fraction)


def check(progress: Report, fraction: float) -> None:
    """Tell how much is done; Cancelled."""
    if progress is not None and progress(fraction):
        raise Cancelled("cancelled by the progress callback")


def told(items: Iterable[T], count: int, progress: Report) -> Iterator[T]:
    """The items of a loop, its progress told meanwhile; Cancelled."""
    for number, item in enumerate(items):
        if number % TURNS == 0:
            check(progress, number / count)
        yield item


class Stages:
    """Work in named stages: its progress by stage, and ``seconds`` of each and of all."""

    def __init__(self, progress: Optional[Callable[[str, float], Any]]) -> None:
        self.seconds: dict[str, float] = {}
        self._progress = progress
        self._begun = time.perf_counter()

    def run(self, stage: str, work: Callable[[Report], T]) -> T:
        """What the work, called with its progress, returns."""
        begun = time.perf_counter()
        try:
            return work(self._report(stage))
        finally:
            self.seconds[stage] = self.seconds.get(stage, 0.0) + time.perf_counter() - begun

    def _report(self, stage: str) -> Report:
        if self._progress is None:
            return None
        whole = self._progress
        return lambda fraction: whole(stage, fraction)

    def end(self) -> None:
        """All stages are done."""
        self.seconds["total"] = time.perf_counter() - self._begun


class Bar:
    """One line that is drawn over itself; silent where the stream is no terminal. A context that closes it."""

    def __init__(self, stream: Optional[TextIO] = None) -> None:
        self.stream = sys.stderr if stream is None else stream
        self.active = self.stream.isatty()
        self._drawn = ""

    def __enter__(self) -> Bar:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __call__(self, stage: str, fraction: float) -> None:
        """Show that ``fraction`` (0..1) of a stage is done."""
        if not self.active:
            return
        width = max(10, min(40, shutil.get_terminal_size().columns - 24))
        filled = round(max(0.0, min(1.0, fraction)) * width)
        line = f"{stage:8} [{'#' * filled}{'.' * (width - filled)}] {100 * filled // width:3d} %"
        if line != self._drawn:
            self._drawn = line
            self._draw("\r" + line)

    def close(self) -> None:
        """Remove the bar; what is written next starts on a clean line."""
        if self._drawn:
            self._draw("\r" + " " * len(self._drawn) + "\r")
            self._drawn = ""

    def _draw(self, text: str) -> None:
        """A terminal that has gone stops no work."""
        try:
            self.stream.write(text)
            self.stream.flush()
        except OSError:
            self.active = False
            discard(self.stream)
