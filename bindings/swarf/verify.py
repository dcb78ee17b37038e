# SPDX-License-Identifier: LGPL-2.1-or-later
"""Is the part right? A job is simulated and what is left of its stock held against the design."""
from __future__ import annotations

import os
import struct
import time
from dataclasses import dataclass, field
from typing import Any, Callable, Optional, Sequence

from ._native import CheckFinding, Cluster, Deviation, Mesh, Scene, Solid, Stock, compare_place, measure_deviation
from .job import Job
from .simulate import Progress, Result, make_stock, simulate

#: What a design file can be, by its suffix.
DESIGN_SUFFIXES = (".stl", ".ply", ".obj")


@dataclass
class Verdict:
    """Something that was found: severity "error", "warning" or "note"."""

    severity: str
    text: str
    operation: Optional[str] = None
    line: int = 0
    move: int = -1
    place: Optional[tuple[float, float, float]] = None
    cluster: Optional[Cluster] = None


@dataclass
class Verification:
    """What a verification came to."""

    result: Result
    design: Solid
    deviation: Deviation
    tolerance: tuple[float, float]
    allowance: float
    findings: list[Verdict] = field(default_factory=list)
    complete: bool = False  #: whether material that no move went to counts as an error

    @property
    def passed(self) -> bool:
        """Whether nothing of class error was found."""
        return not any(finding.severity == "error" for finding in self.findings)

    def scene(self) -> Scene:
        """A Scene of what is left of the stock."""
        return Scene(self.result.stock)


def read_design(path: str) -> Mesh:
    """The design in a mesh file. ValueError for an unknown suffix; OSError, FormatError."""
    suffix = os.path.splitext(path)[1].lower()
    if suffix not in DESIGN_SUFFIXES:
        raise ValueError(f"{path}: unknown suffix {suffix!r}; a design is {', '.join(DESIGN_SUFFIXES)} "
                         "(or the model of the job in a .FCStd file)")
    return Mesh.read(path)


def verify(
    job: Job,
    design: Optional[Mesh] = None,
    *,
    tolerance: float = 0.05,
    excess: Optional[float] = None,
    gouge: Optional[float] = None,
    allowance: float = 0.0,
    complete: bool = False,
    region: Optional[Any] = None,
    voxel: Optional[float] = None,
    resolution: Optional[float] = None,
    fixtures: Sequence[Mesh] = (),
    clearance: float = 0.0,
    progress: Optional[Progress] = None,
) -> Verification:
    """Simulate a job and hold what is left of its stock against a design, the job's own unless given.

    ``tolerance`` in mm is for both sides; ``excess`` (material left) and ``gouge`` (material missing) set one of them.
    ``allowance`` is material that is meant to be left. Material left where no move went is a warning, with
    ``complete`` an error. Rapids through material, shanks and holders that touch it, and all else that Stock.check()
    looks for are findings too, as are moves that cannot be simulated (turned axes) and
    operations that remove nothing; ``fixtures`` and ``clearance`` are
    handed to it. ValueError without a design; GeometryError where it encloses nothing; whatever simulate() raises.
    """
    mesh = job.design if design is None else design
    if mesh is None:
        raise ValueError(f"{job.name}: there is no design to verify against")
    limits = (tolerance if excess is None else excess, tolerance if gouge is None else gouge)

    def stage(name: str) -> Optional[Callable[[float], Any]]:
        return None if progress is None else lambda fraction: progress(name, fraction)

    solid = Solid(mesh, progress=stage("design"))
    result = simulate(job, voxel=voxel, resolution=resolution, compare=False, mesh=False, progress=progress)
    first = make_stock(job.stock, voxel=None if job.stock and job.stock["kind"] == "vdb" else result.stock.voxel)
    started = time.perf_counter()
    checked = first.copy().check(
        job.program, job.tools, fixtures=[Solid(fixture) for fixture in fixtures], clearance=clearance,
        progress=stage("check"))
    result.seconds["check"] = time.perf_counter() - started
    started = time.perf_counter()
    deviation = measure_deviation(
        result.stock, solid, excess=limits[0], gouge=limits[1], allowance=allowance, region=region, first=first,
        program=job.program, tools=job.tools, progress=stage("compare"))
    result.seconds["compare"] = time.perf_counter() - started
    result.seconds["total"] += result.seconds["check"] + result.seconds["compare"]
    result.comparison = deviation.comparison
    made = Verification(result, solid, deviation, limits, allowance, complete=complete)
    made.findings = _check_findings(job, checked) + _uncut_findings(job, result, checked) + _design_findings(solid, first, mesh) + [
        _cluster_finding(job, cluster, complete) for cluster in deviation.clusters]
    return made


#: The records of Program.moves and Program.sections (see the stub), for struct.
MOVE, SECTION = struct.Struct("3dfIiI"), struct.Struct("4id2i")


def operation_of(job: Job, move: int) -> tuple[Optional[str], int]:
    """Name of the operation (None: none) and line of a move."""
    *_, line, _, section_kind = MOVE.unpack_from(job.program.moves, move * MOVE.size)
    index = SECTION.unpack_from(job.program.sections, (section_kind >> 3) * SECTION.size)[1]
    names = job.program.operations
    return (names[index] if 0 <= index < len(names) else None), line


def _check_findings(job: Job, checked: Sequence[CheckFinding]) -> list[Verdict]:
    names = job.program.operations
    return [Verdict(found.severity, found.text, names[found.operation] if 0 <= found.operation < len(names) else None,
                    found.line, found.move, found.tip) for found in checked]


def _uncut_findings(job: Job, result: Result, checked: Sequence[CheckFinding]) -> list[Verdict]:
    """What the simulation says of moves that cut nothing, less what the checks tell as well (missing tools)."""
    told = {found.operation for found in checked if found.kind == "tool"}
    return [Verdict(found.severity, found.text, *operation_of(job, found.move), found.move)
            for found in result.simulation.findings if found.operation not in told]


def _design_findings(solid: Solid, first: Stock, mesh: Mesh) -> list[Verdict]:
    found = []
    doubt = compare_place(first, solid)
    if doubt:
        found.append(Verdict("warning", doubt))
    if solid.open_edges or solid.turned_edges:
        found.append(Verdict("warning", f"the design is not closed: {solid.open_edges} open edges, {solid.turned_edges} "
                             f"between triangles turned different ways; the holes have at most {solid.hole_mm2:.3g} mm2 "
                             "and inside is told by the winding number"))
    if solid.crossing_triangles:
        found.append(Verdict("note", f"{solid.crossing_triangles} of the design's {mesh.triangle_count} triangles cross "
                             "or touch others; it is taken as the union of what they enclose"))
    return found


def _cluster_finding(job: Job, cluster: Cluster, complete: bool) -> Verdict:
    operation, line = operation_of(job, cluster.moves[0]) if cluster.moves else (None, 0)
    least = "at least " if cluster.at_least else ""
    amount = f"{least}{abs(cluster.value):.3f} mm, {cluster.area:.4g} mm2, {cluster.volume:.4g} mm3"
    if cluster.kind == "gouge":
        severity, text = "error", f"gouge: {amount} missing"
        if not cluster.moves:
            text += "; no move made it: the stock is too small here"
    elif cluster.kind == "excess":
        severity, text = "error", f"material left: {amount}"
        if cluster.moves and cluster.away >= 0.001:
            text += f"; the nearest cut stays {cluster.away:.3f} mm away"
    else:
        severity, text = "error" if complete else "warning", f"not reached: {amount} left where no move went"
    return Verdict(severity, text, operation, line, cluster.moves[0] if cluster.moves else -1, cluster.place, cluster)
