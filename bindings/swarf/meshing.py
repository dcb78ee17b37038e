# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meshes of stocks on the command line, at one home for all subcommands that make them: options, what is said of the
outcome."""
from __future__ import annotations

import argparse
import os
import struct
from typing import Optional, Sequence

from ._native import Contour, Mesh
from .simulate import MESH_ERROR_VOXELS, MESH_SUFFIXES
from .wording import unseen_note

#: How near a kept volume is meant to come, of it; farther away is told.
VOLUME_NEAR = 1e-5


def add_options(command: argparse.ArgumentParser, of: str = "") -> None:
    """Add the options of meshes to a parser; ``of`` begins their help."""
    command.add_argument("--error", metavar="MM", type=float,
                         help=f"{of}leave vertices out up to this error (default: {MESH_ERROR_VOXELS:g} voxels; "
                         "0: none)")
    command.add_argument("--budget", metavar="N", type=int, default=0,
                         help=f"{of}no more triangles than N, if the error allows")
    command.add_argument("--keep-volume", action="store_true",
                         help=f"{of}shift vertices, by a fifth of the error at most, until the volume is that of the "
                         "surface that the mesh stands for; what is thinner than a voxel is in no mesh")


def check_meant(arguments: argparse.Namespace, made: bool, of_error: bool) -> None:
    """ValueError where an option of meshes would have nothing to do: where none is ``made``, or for ``--error`` nothing
    else that has one (``of_error``)."""
    given = [option for option, value, meant in (
        ("--error", arguments.error is not None, made or of_error), ("--budget", arguments.budget, made),
        ("--fine", arguments.fine, made), ("--keep-volume", arguments.keep_volume, made)) if value and not meant]
    if given:
        raise ValueError(f"{' and '.join(given)}: nothing that is made heeds it; give --output with "
                         f"{', '.join(MESH_SUFFIXES)} or --report")


def notes(made: Contour, files: Sequence[str], budget: int, error: float, kept_mm3: Optional[float]) -> list[str]:
    """Lines on what a mesh came to that was asked for with this ``--budget`` and error (mm); ``files`` have it. Its
    volume where it was to be kept and is known."""
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
    off = None if kept_mm3 is None else volume_off(made, kept_mm3)
    if kept_mm3 is not None and off is not None and abs(off) > VOLUME_NEAR:
        told.append(f"warning: the mesh has {kept_mm3:.8g} mm3, the surface it stands for {made.surface_mm3:.8g}, "
                    f"{abs(off):.1e} of it apart: --keep-volume may shift vertices no farther")
    return told


def volume_off(made: Contour, volume: float) -> Optional[float]:
    """How far a mesh's volume (mm3) is from that of the surface it stands for, of that; None: there is none."""
    return volume / made.surface_mm3 - 1 if made.surface_mm3 > 0 else None


def volume_of(mesh: Optional[Mesh], files: Sequence[str]) -> Optional[float]:
    """Volume of a mesh, mm3; where there is none of what was streamed to the one file, a binary .stl, which need not
    fit into memory. None: to a pipe."""
    if mesh is not None:
        return mesh.volume
    if not os.path.isfile(files[0]):
        return None
    six = 0.0
    with open(files[0], "rb") as stream:
        stream.seek(84)  # behind the header and the count
        while block := stream.read(50 << 16):
            for ax, ay, az, bx, by, bz, cx, cy, cz in struct.iter_unpack("<12x9f2x", block):
                six += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return six / 6
