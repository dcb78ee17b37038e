# SPDX-License-Identifier: LGPL-2.1-or-later
"""Is the part right? A job is simulated and what is left of its stock held against the design."""
from __future__ import annotations

import math
import os
from dataclasses import dataclass, field, replace
from typing import Any, Callable, Optional, Sequence

from . import accept as accepting
from . import loads as loading
from . import loose, readers
from ._native import (Check, CheckFinding, Cluster, Deviation, Finding, GeometryError, Mesh, Scene, Simulation, Solid,
                      Stock, compare_overlap, compare_place, measure_deviation)
from .accept import Acceptance
from .aliases import Box, Severity
from .job import Job, number_of, operation_of
from .loads import Limits
from .records import MOVE
from .progress import Report, Stages, share
from .simulate import Progress, Result
from .stocks import First, make_first
from .wording import FORMS, Said, shortened

#: What a design file can be, by its suffix.
DESIGN_SUFFIXES = (".stl", ".ply", ".obj")


@dataclass
class Verdict:
    """Something that was found: kind "gouge", "excess", "not reached" (deviation), those of CheckFinding, "load",
    "uncut" (moves that were not simulated, operations that remove nothing), "design" or "acceptance". ``amount`` is
    what was measured: mm of a deviation or contact, the value of a load. ``accepted`` is the reason why it does not
    count, None: it does."""

    severity: Severity
    text: str  #: a wording.Said, but for what was an exception
    kind: str
    operation: Optional[str] = None
    line: int = 0
    move: int = -1
    place: Optional[tuple[float, float, float]] = None
    cluster: Optional[Cluster] = None
    amount: Optional[float] = None
    accepted: Optional[str] = None
    t: float = 0.0  #: how far along the move it is, 0 .. 1
    at_least: bool = False  #: it may be more than ``amount``
    tolerance: Optional[float] = None  #: mm, that a deviation is beyond
    allowance: Optional[float] = None  #: mm, that a deviation is measured over


@dataclass
class Verification:
    """What a verification came to."""

    result: Result
    design: Solid
    deviation: Deviation
    tolerance: tuple[float, float]
    allowance: float
    findings: list[Verdict] = field(default_factory=list)  #: errors, warnings, notes, at last what is accepted
    complete: bool = False  #: whether material that no move went to counts as an error
    loads: Optional[dict[str, memoryview]] = None  #: Check.loads, None: not asked for
    limits: Limits = field(default_factory=dict)
    region: Optional[Box] = None  #: that the deviation was measured in

    @property
    def passed(self) -> bool:
        """Whether nothing of class error was found that is not accepted."""
        return not any(finding.severity == "error" and finding.accepted is None for finding in self.findings)

    def judge(self, tolerance: float, *, accept: Sequence[Acceptance] = (),
              progress: Optional[Callable[[float], Any]] = None) -> Verification:
        """The same measurements by another tolerance (mm) for both sides, without simulating or measuring again."""
        job = self.result.job
        deviation = self.deviation.judge(
            excess=tolerance, gouge=tolerance, allowance=self.allowance, region=self.region, program=job.program,
            tools=job.tools, progress=progress)
        found = [finding for finding in self.findings if finding.cluster is None]
        judged = replace(self, deviation=deviation, tolerance=(tolerance, tolerance))
        found += [_cluster_finding(judged, cluster) for cluster in deviation.clusters]
        return replace(judged, findings=settle(found, [*job.accepted, *accept]))

    def scene(self) -> Scene:
        """A Scene of what is left of the stock."""
        return Scene(self.result.stock)


#: Designs that a CAD program has to read, by suffix; its reader is an entry point, see readers.DESIGNS.
CAD_SUFFIXES = (".step", ".stp", ".brep", ".brp", ".iges", ".igs", ".fcstd")


def read_design(path: str, tolerance: float = 0.05, progress: Optional[Callable[[float], Any]] = None) -> Mesh:
    """The design (or a fixture) in a mesh file, or in a CAD file whose faces become triangles no farther away than a
    fifth of the tolerance (mm). ValueError for an unknown suffix, and where the reader that it needs is missing;
    OSError, FormatError, what the reader raises."""
    suffix = os.path.splitext(path)[1].lower()
    if suffix in DESIGN_SUFFIXES:
        return Mesh.read(path)
    known = readers.design_suffixes()
    if suffix in known:
        mesh: Mesh = readers.load(known[suffix], path, suffix)(path, 0.2 * tolerance, progress=progress)
        return mesh
    if suffix in CAD_SUFFIXES:
        raise ValueError(f"{path}: {suffix} files are read through FreeCAD and the add-on of Swarf, which is not "
                         f"installed; without it a design is {', '.join(DESIGN_SUFFIXES)}")
    raise ValueError(f"{path}: unknown suffix {suffix!r}; a design is "
                     f"{', '.join([*DESIGN_SUFFIXES, *sorted(known or CAD_SUFFIXES)])}")


def verify(
    job: Job,
    design: Optional[Mesh] = None,
    *,
    tolerance: float = 0.05,
    excess: Optional[float] = None,
    gouge: Optional[float] = None,
    allowance: float = 0.0,
    complete: bool = False,
    region: Optional[Box] = None,
    voxel: Optional[float] = None,
    resolution: Optional[float] = None,
    fixtures: Sequence[Mesh] = (),
    clearance: float = 0.0,
    loads: bool = True,
    limits: Optional[Limits] = None,
    accept: Sequence[Acceptance] = (),
    progress: Optional[Progress] = None,
) -> Verification:
    """Simulate a job and hold what is left of its stock against a design, the job's own unless given.

    ``tolerance`` in mm is for both sides; ``excess`` (material left) and ``gouge`` (material missing) set one of them.
    ``allowance`` is material that is meant to be left. Material left where no move went is a warning, with
    ``complete`` an error. Rapids through material, shanks and holders that touch it, and all else that Stock.check()
    looks for are findings too, as are moves that cannot be simulated (turned axes) and operations that remove nothing,
    in the set-ups before as well, each with its own tools, holders and fixtures; ``fixtures``, with those of the job,
    and ``clearance``, of all set-ups, are handed to it. ``loads`` measures what each move asks of its tool; beyond
    ``limits`` (see swarf.loads) it is a warning. Findings that ``accept`` or the job's document knows do not fail.
    ValueError without a design or moves; GeometryError where the design encloses nothing; whatever make_first() and
    Stock.check() raise.
    """
    mesh = _design_of(job, design)
    if len(job.program) == 0:
        raise ValueError(f"{job.name}: the program has no moves: there is nothing to verify")
    tolerances = (tolerance if excess is None else excess, tolerance if gouge is None else gouge)
    for side in tolerances:
        check_tolerance(side)
    limits = {} if limits is None else limits
    loading.check_limits(limits)
    if not all(isinstance(item, Acceptance) for item in accept):
        raise TypeError("accept: Acceptances are wanted, as swarf.accept.read() and make() give them")
    stages = Stages(progress)
    solid = stages.run("design", lambda report: _solid(mesh, "design", report))
    fixtures = [*job.fixtures, *fixtures]
    clamps = stages.run("fixtures", lambda report: solids_of(fixtures, report, len(job.fixtures)))
    earlier = SetUps(clearance)
    made_first = stages.run("stock", lambda report: make_first(
        job.stock, voxel=voxel, resolution=resolution, play=earlier.play, progress=report))
    first, before = made_first.stock, made_first.played
    stock = first.copy()
    checked = stages.run("cut", lambda report: stock.check(
        job.program, job.tools, fixtures=clamps, clearance=clearance, teeth=job.teeth, loads=loads or bool(limits),
        progress=report))
    result = Result(job, stock, checked.simulation, seconds=stages.seconds, before=before)
    deviation = stages.run("compare", lambda report: measure_deviation(
        stock, solid, excess=tolerances[0], gouge=tolerances[1], allowance=allowance, region=region, first=first,
        program=job.program, tools=job.tools, progress=report))
    result.comparison = deviation.comparison
    made = Verification(result, solid, deviation, tolerances, allowance, complete=complete, loads=checked.loads,
                        limits=limits, region=region)
    found = [*earlier.findings(made_first), *findings_of(job, checked, stock.voxel, clearance),
             *_load_findings(job, checked, limits), *_design_findings(solid, first, mesh),
             *fixture_findings(first, clamps, len(job.fixtures)),
             *stages.run("loose", lambda report: loose_findings(job, stock, first, report)),
             *(_cluster_finding(made, cluster) for cluster in deviation.clusters)]
    made.findings = settle(found, [*job.accepted, *accept])
    stages.end()
    return made


def check_tolerance(value: float) -> None:
    """ValueError unless it is a length above 0."""
    if not (math.isfinite(value) and value > 0):
        raise ValueError(f"tolerance {value:g}: wanted a number above 0")


def _design_of(job: Job, given: Optional[Mesh]) -> Mesh:
    """The design that is given, else the job's own; ValueError where there is none."""
    mesh = job.design if given is None else given
    if mesh is None:
        raise ValueError(f"{job.name}: there is no design to verify against")
    return mesh


def settle(findings: Sequence[Verdict], acceptances: Sequence[Acceptance]) -> list[Verdict]:
    """Findings by what is accepted, whatever was accepted of them before: errors, warnings, notes, at last what is
    accepted; a note on each acceptance that knows none. The findings that are given are left alone."""
    settled = [replace(finding, accepted=None) for finding in findings if finding.kind != "acceptance"]
    settled += [Verdict("note", _idle_text(idle), "acceptance", idle.operation, idle.line or 0, place=idle.place)
                for idle in accepting.apply(acceptances, settled)]
    order = ("error", "warning", "note")
    return sorted(settled, key=lambda found: (found.accepted is not None, order.index(found.severity)))


def _idle_text(idle: Acceptance) -> Said:
    of = {name: value for name, value in (("tolerance", idle.tolerance), ("allowance", idle.allowance))
          if value is not None}
    if not of:
        return Said("idle acceptance", reason=idle.reason)
    key = "of both" if len(of) == 2 else f"of {next(iter(of))}"
    return Said("idle acceptance of", reason=idle.reason, circumstances=Said(key, **of))


def findings_of(job: Job, checked: Check, voxel: float, clearance: float = 0.0) -> list[Verdict]:
    """What Stock.check() found on a job at a voxel size and clearance, and what it says of moves that were not
    simulated."""
    return [*_check_findings(job, checked, voxel, clearance), *_uncut_findings(job, checked)]


class SetUps:
    """Plays the set-ups before a job with all checks, each with its own tools, holders and fixtures: the ``play`` of
    make_first()."""

    def __init__(self, clearance: float = 0.0) -> None:
        self._clearance = clearance
        self._found: list[Verdict] = []

    def play(self, job: Job, stock: Stock, progress: Report = None) -> Simulation:
        """Play a job on its stock. What Stock.check() raises."""
        try:
            clamps = solids_of(job.fixtures, share(progress, 0, 0.1))
        except GeometryError as error:
            raise GeometryError(f"set-up '{job.name}': {error}") from None
        doubts = fixture_findings(stock, clamps)
        checked = stock.check(job.program, job.tools, fixtures=clamps, clearance=self._clearance, teeth=job.teeth,
                              progress=share(progress, 0.1, 1))
        found = [*doubts, *findings_of(job, checked, stock.voxel, self._clearance)]
        accepting.apply(job.accepted, found)
        for item in found:
            if item.accepted is None:
                text = Said("set-up line" if item.line else "set-up", job=job.name, line=item.line, text=item.text)
                self._found.append(Verdict(item.severity, text, item.kind, amount=item.amount, at_least=item.at_least))
        return checked.simulation

    def findings(self, made: First) -> list[Verdict]:
        """What was found, less what the set-ups' own jobs accept, and which of them were not played. Lines, moves,
        operations and places are of another program than the job's: the text has the lines."""
        return self._found + [Verdict("note", Said("set-up kept", job=job.name, path=path), "uncut")
                              for job, path in made.kept]


def check_text(found: CheckFinding, job: Job, clearance: float) -> str:
    """What is said of one, in words that can be translated."""
    keys = {"fixture": f"fixture {found.part}", "design": f"design {found.part}",
            "spindle": "spindle stopped" if found.severity == "error" else "spindle backwards",
            "tool": "tool blunt" if found.tool in job.tools else "tool none" if found.tool < 0 else "tool missing"}
    key = keys.get(found.kind, found.kind)
    if key not in FORMS:  # of what is not asked for here: travel, plunges
        return found.text
    return Said(key, depth=found.depth, clearance=clearance, tool=number_of(job, found.tool))


def uncut_text(found: Finding, job: Job) -> Said:
    """What is said of moves that were not simulated, in words that can be translated."""
    names = job.program.operations
    name = names[found.operation] if 0 <= found.operation < len(names) else ""
    return Said(f"uncut {found.kind}", operation=shortened(name),
                tool=number_of(job, found.tool), axis=found.axis, value=found.value)


def _check_findings(job: Job, checked: Check, voxel: float, clearance: float) -> list[Verdict]:
    names = job.program.operations
    return [Verdict(found.severity, check_text(found, job, clearance), found.kind,
                    names[found.operation] if 0 <= found.operation < len(names) else None, found.line, found.move,
                    found.tip, amount=found.depth, t=found.t,
                    at_least=found.depth > 2.99 * voxel)  # of a contact no more than three voxels are told
            for found in checked.findings]


def _uncut_findings(job: Job, checked: Check) -> list[Verdict]:
    """What the simulation says of moves that cut nothing, less what the checks tell as well (missing tools)."""
    told = {found.operation for found in checked.findings if found.kind == "tool"}
    return [Verdict(found.severity, uncut_text(found, job), "uncut", *operation_of(job, found.move), found.move)
            for found in checked.simulation.findings if found.operation not in told]


def _load_findings(job: Job, checked: Check, limits: Limits) -> list[Verdict]:
    if checked.loads is None or not limits:
        return []
    return [Verdict("warning", found.text, "load", *operation_of(job, found.move), found.move,
                    _end_of(job, found.move), amount=found.value)
            for found in loading.exceeded(job.program, checked.loads, _limits_of(job, limits))]


def _limits_of(job: Job, limits: Limits) -> Limits:
    """Limits with those of the tool that is used where none is named."""
    unnamed = number_of(job, -1)
    return {**limits, -1: limits[unnamed]} if unnamed in limits else limits


def _end_of(job: Job, move: int) -> tuple[float, float, float]:
    """Where a move ends."""
    x, y, z, *_ = MOVE.unpack_from(job.program.moves, move * MOVE.size)
    return x, y, z


def loose_findings(job: Job, left: Stock, first: Stock, progress: Report = None) -> list[Verdict]:
    """Pieces of what is left of a job's stock that hang on nothing any more. Cancelled."""
    return [Verdict("warning", piece.text, "loose", piece.operation, piece.line, piece.move, piece.lump.inside,
                    amount=piece.lump.volume_mm3, t=1.0) for piece in
            loose.find(job, left, lambda _: first.copy(), progress).pieces]


def _design_findings(solid: Solid, first: Stock, mesh: Mesh) -> list[Verdict]:
    found = []
    kind, value, factor, _ = compare_place(first, solid)
    if kind:
        found.append(Verdict("warning", place_text(kind, value, factor, first, mesh), "design"))
    if solid.open_edges or solid.turned_edges:
        found.append(Verdict("warning", Said("design open", open=solid.open_edges, turned=solid.turned_edges,
                                             hole=solid.hole_mm2), "design"))
    if solid.crossing_triangles:
        found.append(Verdict("note", Said("design crossing", crossing=solid.crossing_triangles,
                                          all=mesh.triangle_count), "design"))
    return found


#: What compare_place() tells of units: how many times as large, and its words.
_UNITS = ((25.4, "inch in mm"), (1 / 25.4, "mm in inch"), (10.0, "cm in mm"), (0.1, "mm in cm"), (1000.0, "m in mm"),
          (0.001, "mm in m"))


def place_text(kind: str, value: float, factor: float, first: Stock, mesh: Mesh) -> Said:
    """What is said of a design that can hardly belong to a stock."""
    if kind == "unit":
        units = min(_UNITS, key=lambda unit: abs(unit[0] - factor))[1]
        return Said("place unit", value=value, units=Said(units))
    if kind == "beside":
        boxes = [Said("box", **dict(zip("abcdef", [x for corner in box or ((0.0,) * 3,) * 2 for x in corner])))
                 for box in (mesh.bounding_box, first.bounding_box())]
        return Said("place beside", design=boxes[0], stock=boxes[1])
    return Said(f"place {kind}", value=value)


def solids_of(meshes: Sequence[Mesh], progress: Report = None, own: Optional[int] = None) -> list[Solid]:
    """Solids of meshes, fixtures, of which the first ``own`` (None: all) are the job's. Cancelled, what Solid()
    raises."""
    return [_solid(mesh, _fixture(number, own), share(progress, number / len(meshes), (number + 1) / len(meshes)))
            for number, mesh in enumerate(meshes)]


def _fixture(number: int, own: Optional[int]) -> Said:
    """Which fixture it is, to whoever gave it: the job's and those given besides count from 1 each."""
    if own is None or number < own:
        return Said("fixture of job", number=number + 1)
    return Said("fixture given", number=number - own + 1)


def _solid(mesh: Mesh, what: str, progress: Report) -> Solid:
    """A Solid; GeometryError says of what."""
    try:
        return Solid(mesh, progress=progress)
    except GeometryError as error:
        raise GeometryError(f"{what}: {error}") from None


def fixture_findings(first: Stock, solids: Sequence[Solid], own: Optional[int] = None) -> list[Verdict]:
    """Fixtures that reach into the stock before anything is cut: they stand elsewhere, or the stock does. ``own`` as of
    solids_of()."""
    found = []
    for number, solid in enumerate(solids):
        depth, place = compare_overlap(first, solid)
        if depth > 0.35 * first.voxel:
            text = Said("fixture inside", fixture=_fixture(number, own), depth=depth)
            found.append(Verdict("warning", text, "fixture", place=place, amount=depth, at_least=True))
    return found


def _cluster_finding(made: Verification, cluster: Cluster) -> Verdict:
    operation, line = operation_of(made.result.job, cluster.moves[0]) if cluster.moves else (None, 0)
    amount = Said("amount at least" if cluster.at_least else "amount", value=abs(cluster.value), area=cluster.area,
                  volume=cluster.volume)
    severity: Severity = "error"
    key: str = cluster.kind
    if cluster.kind == "gouge":
        key = "gouge" if cluster.moves else "gouge of no move"
    elif cluster.kind == "excess":
        key = "excess away" if cluster.moves and cluster.away >= 0.001 else "excess"
    elif not made.complete:
        severity = "warning"
    return Verdict(severity, Said(key, amount=amount, away=cluster.away), cluster.kind, operation, line,
                   cluster.moves[0] if cluster.moves else -1, cluster.place, cluster, cluster.value,
                   at_least=bool(cluster.at_least), tolerance=made.tolerance[cluster.kind == "gouge"],
                   allowance=made.allowance)
