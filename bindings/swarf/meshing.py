# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meshes of stocks on the command line, at one home for all subcommands that make them: options, what is said of the
outcome."""
from __future__ import annotations

import argparse
from typing import Sequence

from ._native import Contour
from .simulate import MESH_ERROR_VOXELS
from .wording import unseen_note


def add_options(command: argparse.ArgumentParser, of: str = "") -> None:
    """Add the options of meshes to a parser; ``of`` begins their help."""
    command.add_argument("--error", metavar="MM", type=float,
                         help=f"{of}leave vertices out up to this error (default: {MESH_ERROR_VOXELS:g} voxels; "
                         "0: none)")
    command.add_argument("--budget", metavar="N", type=int, default=0,
                         help=f"{of}no more triangles than N, if the error allows")
    command.add_argument("--keep-volume", action="store_true",
                         help=f"{of}shift vertices, by a fifth of the error at most, until the volume is that of the "
                         "stock")


def notes(made: Contour, files: Sequence[str], budget: int, error: float) -> list[str]:
    """Lines on what a mesh came to that was asked for with this ``--budget`` and error (mm); ``files`` have it."""
    told = []
    if not made.triangles:
        why = "what is left of the stock is thinner than a voxel" if made.unseen_mm3 else "nothing is left of the stock"
        told.append(f"warning: {why}" + (f": no triangles in {', '.join(files)}" if files else ""))
    if made.intersections_left:
        told.append(f"warning: {made.intersections_left} pairs of triangles cut each other: the surface touches itself "
                    "there")
    thin = unseen_note(made)
    if thin:
        told.append(f"note: {thin}")
    if not made.budget_met:
        told.append(f"warning: {made.triangles} triangles are more than {budget}: an error of {error:g} mm leaves no "
                    "fewer; allow a larger --error")
    return told
