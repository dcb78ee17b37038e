# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a file to a Job, by its suffix: G-code here, everything else by entry points (see ``job``)."""
from __future__ import annotations

import importlib.metadata
import os
from typing import Any, Callable, Optional

from . import camotics
from ._native import Program
from .job import Job

#: Suffixes that machine controls and post-processors give G-code.
GCODE_SUFFIXES = (".nc", ".ngc", ".gcode", ".gc", ".cnc", ".tap", ".txt")

#: Suffix of CAMotics' projects.
CAMOTICS_SUFFIX = ".camotics"

#: Entry point group of further readers.
GROUP = "swarf.readers"

#: Entry point group of readers of designs: functions ``read(path, deflection_mm, progress=None) -> Mesh``.
DESIGNS = "swarf.designs"

Reader = Callable[..., Job]


def readers() -> dict[str, importlib.metadata.EntryPoint]:
    """Registered readers by suffix with its dot; none is imported."""
    found = importlib.metadata.entry_points(group=GROUP)
    return {"." + entry.name.lower(): entry for entry in found}


def design_suffixes() -> dict[str, importlib.metadata.EntryPoint]:
    """Registered readers of designs by suffix with its dot; none is imported."""
    return {"." + entry.name.lower(): entry for entry in importlib.metadata.entry_points(group=DESIGNS)}


def load(entry: importlib.metadata.EntryPoint, path: str, suffix: str) -> Callable[..., Any]:
    """What an entry point names. OSError tells the file whose reader cannot be had."""
    try:
        loaded: Callable[..., Any] = entry.load()
        return loaded
    except (ImportError, AttributeError) as error:
        raise OSError(f"{path}: the reader for {suffix} cannot be loaded ({entry.value}): {error}") from error


def read_gcode(
    path: str, progress: Optional[Callable[[float], Any]] = None, options: Optional[dict[str, Any]] = None
) -> Job:
    """A Job with the program of a G-code file; tools and stock are for the caller to add."""
    program = Program.read_gcode(path, progress=progress, **(options or {}))
    return Job(name=os.path.basename(path), program=program)


def read(
    path: str,
    job: Optional[str] = None,
    progress: Optional[Callable[[float], Any]] = None,
    gcode: Optional[dict[str, Any]] = None,
) -> Job:
    """The Job in a file; ``job`` names one of several, ``gcode`` are keywords of Program.read_gcode() where it is
    G-code. ValueError for an unknown suffix or a job G-code cannot have."""
    suffix = os.path.splitext(path)[1].lower()
    if suffix in GCODE_SUFFIXES:
        if job is not None:
            raise ValueError(f"{path}: a G-code file is one program, it has no job to choose")
        return read_gcode(path, progress, gcode)
    if suffix == CAMOTICS_SUFFIX:
        if job is not None:
            raise ValueError(f"{path}: a CAMotics project is one job, there is none to choose")
        return camotics.read(path, progress, gcode)
    known = readers()
    entry = known.get(suffix)
    if entry is None:
        hint = "" if ".fcstd" in known else "; .FCStd needs the FreeCAD add-on of Swarf"
        suffixes = ", ".join([*GCODE_SUFFIXES, CAMOTICS_SUFFIX, *sorted(known)])
        raise ValueError(f"{path}: unknown suffix {suffix!r}; known: {suffixes}{hint}")
    reader: Reader = load(entry, path, suffix)
    return reader(path, job=job, progress=progress)
