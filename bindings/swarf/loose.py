# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pieces of a stock that have come loose, and the moves that freed them.

A piece is freed by the move after which it hangs on no larger one. Material only goes, so that what is apart stays
apart: the move is found by halving the program, on copies of the stock as it was first. It costs some more simulations,
and only where something is loose.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Optional, Sequence

from ._native import Lump, Stock
from .job import Job, operation_of
from .progress import Report, share
from .wording import Said

#: Pieces of fewer voxels are crumbs: what a voxel between two passes leaves may be none.
CRUMB_VOXELS = 27

#: So many pieces are told apart, the largest ones.
MOST_PIECES = 20


@dataclass(frozen=True)
class Loose:
    """A piece that hangs on nothing."""

    lump: Lump
    move: int  #: that freed it; -1: it was loose before
    operation: Optional[str]
    line: int

    @property
    def text(self) -> Said:
        """What happened, in a sentence."""
        x, y, z = self.lump.inside
        return Said("loose before" if self.move < 0 else "loose", volume=self.lump.volume_mm3, x=x, y=y, z=z)


@dataclass(frozen=True)
class LoosePieces:
    """All of them, the largest first, and how many crumbs there are beside."""

    pieces: Sequence[Loose] = ()
    crumbs: int = 0


class _Search:
    """Who freed the lumps of a stock, the largest first; freed: the move of each that is known."""

    def __init__(self, job: Job, lumps: Sequence[Lump], progress: Report) -> None:
        self._job, self._lumps, self._progress = job, lumps, progress
        self._played, count = 0, len(job.program)
        self._to_play = max(1, count * count.bit_length() // 2)  # at most: half of the program in each round
        self.freed: dict[Lump, int] = {}

    def apart(self, stock: Stock) -> set[Lump]:
        """Those that hang on none of the larger ones; the first is the largest, the part itself."""
        _, places = stock.lumps([lump.inside for lump in self._lumps], progress=self._part(0))
        return {lump for index, lump in enumerate(self._lumps) if index and places[index] not in places[:index]}

    def _part(self, count: int) -> Report:
        begin, end = (min(1.0, played / self._to_play) for played in (self._played, self._played + count))
        return share(self._progress, begin, end)

    def run(self, left: list[tuple[Stock, set[Lump], int, int]]) -> None:
        """Find who freed the lumps of each entry, and empty the list, so that no stock is held longer than it is looked
        at: its lumps hang on a larger one before the moves begin .. end - 1, which the stock has not seen, and on none
        after."""
        while left:
            stock, wanted, begin, end = left.pop()
            if end - begin == 1:
                self.freed.update({lump: begin for lump in wanted})
                continue
            middle = (begin + end) // 2
            later = stock.copy()
            later.simulate(self._job.program, self._job.tools, first=begin, count=middle - begin,
                           progress=self._part(middle - begin))
            self._played += middle - begin
            apart = self.apart(later) & wanted
            if apart:
                left.append((stock, apart, begin, middle))
            if wanted - apart:
                left.append((later, wanted - apart, middle, end))
            del stock, later


def find(job: Job, left: Stock, make_first: Callable[[Report], Stock], progress: Report = None) -> LoosePieces:
    """The loose pieces of what is `left` of a job's stock; make_first(progress) gives the stock as it was first,
    where it is needed. Cancelled, and what make_first() raises."""
    lumps, _ = left.lumps(progress=share(progress, 0, 0.1))
    pieces = [lump for lump in lumps[1:] if lump.voxels >= CRUMB_VOXELS][:MOST_PIECES]
    if not pieces:
        return LoosePieces(crumbs=max(0, len(lumps) - 1))
    first = make_first(share(progress, 0.1, 0.3))
    search = _Search(job, [lumps[0], *pieces], share(progress, 0.3, 1))
    freed = search.freed
    freed.update({lump: -1 for lump in search.apart(first)})
    wanted = set(pieces) - set(freed)
    waiting = [(first, wanted, 0, len(job.program))] if wanted else []
    del first
    search.run(waiting)
    found = [Loose(lump, freed[lump], *(operation_of(job, freed[lump]) if freed[lump] >= 0 else (None, 0)))
             for lump in pieces]
    return LoosePieces(found, len(lumps) - 1 - len(found))
