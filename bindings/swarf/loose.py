# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pieces of a stock that have come loose, and the moves that freed them.

A piece is freed by the move after which it hangs on no larger one. Material only goes, so that what is apart stays
apart: the move is found by halving the program, on copies of the stock as it was first. It costs some more simulations,
and only where something is loose.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Optional, Sequence

from ._native import Lump, Stock
from .job import Job, operation_of

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
    def text(self) -> str:
        """What happened, in a sentence."""
        place = ", ".join(f"{value:.4g}" for value in self.lump.inside)
        freed = "it was before the program began" if self.move < 0 else "this move frees it"
        return f"a piece of {self.lump.volume_mm3:.4g} mm3 at {place} is loose; {freed}"


@dataclass(frozen=True)
class LoosePieces:
    """All of them, the largest first, and how many crumbs there are beside."""

    pieces: Sequence[Loose] = ()
    crumbs: int = 0


def _apart(stock: Stock, lumps: Sequence[Lump]) -> set[Lump]:
    """Those that hang on none of the larger ones; the first is the largest, the part itself."""
    _, places = stock.lumps([lump.inside for lump in lumps])
    return {lump for index, lump in enumerate(lumps) if index and places[index] not in places[:index]}


def _freed_by(stock: Stock, job: Job, lumps: Sequence[Lump], wanted: set[Lump], begin: int, end: int,
              freed: dict[Lump, int]) -> None:
    """The moves in begin .. end - 1 that free the wanted ones of these lumps, which hang on a larger one before and on
    none after; the stock has seen the moves before `begin`, and may be changed."""
    if not wanted:
        return
    if end - begin == 1:
        freed.update({lump: begin for lump in wanted})
        return
    middle = (begin + end) // 2
    later = stock.copy()
    later.simulate(job.program, job.tools, first=begin, count=middle - begin)
    apart = _apart(later, lumps) & wanted
    _freed_by(later, job, lumps, wanted - apart, middle, end, freed)
    _freed_by(stock, job, lumps, apart, begin, middle, freed)


def find(job: Job, left: Stock, make_first: Callable[[], Any]) -> LoosePieces:
    """The loose pieces of what is `left` of a job's stock; make_first() gives the stock as it was first, where it is
    needed."""
    lumps, _ = left.lumps()
    pieces = [lump for lump in lumps[1:] if lump.voxels >= CRUMB_VOXELS][:MOST_PIECES]
    if not pieces:
        return LoosePieces(crumbs=max(0, len(lumps) - 1))
    first, ordered = make_first(), [lumps[0], *pieces]
    freed: dict[Lump, int] = {lump: -1 for lump in _apart(first, ordered)}
    _freed_by(first, job, ordered, set(pieces) - set(freed), 0, len(job.program), freed)
    found = [Loose(lump, freed[lump], *(operation_of(job, freed[lump]) if freed[lump] >= 0 else (None, 0)))
             for lump in pieces]
    return LoosePieces(found, len(lumps) - 1 - len(found))
