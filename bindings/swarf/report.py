# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a simulation came to, as a dictionary for JSON and as a few lines for people."""
from __future__ import annotations

import json
from typing import Any, Optional

from . import _native, loads, parts, timing
from .files import write_text
from .job import Job, number_of, operation_of
from .meshing import volume_off
from .simulate import Result
from .verify import Verification, uncut_text


def _unique(names: tuple[str, ...]) -> list[str]:
    """Names made different by a number where they repeat, so that they can be keys."""
    taken: set[str] = set()
    result = []
    for name in names:
        unique, number = name, 1
        while unique in taken:
            number += 1
            unique = f"{name} ({number})"
        taken.add(unique)
        result.append(unique)
    return result


def _findings(job: Job, names: list[str], simulation: _native.Simulation) -> list[dict[str, Any]]:
    return [
        {
            "severity": finding.severity,
            "operation": names[finding.operation] if 0 <= finding.operation < len(names) else None,
            "move": finding.move,
            "line": finding.line,
            "tool": number_of(job, finding.tool),
            "text": uncut_text(finding, job),
        }
        for finding in simulation.findings
    ]


def _set_up(job: Job, simulation: _native.Simulation) -> dict[str, Any]:
    """What is told of a set-up before the last one."""
    names = _unique(job.program.operations)
    return {
        "job": job.name,
        "moves": len(job.program),
        "volume_mm3": {"initial": simulation.volume_initial, "final": simulation.volume_final},
        "removed_mm3_by_operation": dict(zip(names, simulation.removed_by_operation)),
        "findings": _findings(job, names, simulation),
    }


def make(
    result: Result, input_path: str, seconds_read: float = 0.0, machine: Optional[dict[str, Any]] = None
) -> dict[str, Any]:
    """Report of a result; plain types only. ``machine``: limits as of timing.read_machine()."""
    job, simulation = result.job, result.simulation
    names = _unique(job.program.operations)
    removed = dict(zip(names, simulation.removed_by_operation))
    times = timing.summary(job.program, machine)
    box = result.stock.bounding_box()
    seconds = {"read": seconds_read, **result.seconds}
    for stage in ("stock", "cut", "mesh", "picture", "total"):
        seconds.setdefault(stage, 0.0)
    seconds["total"] += seconds_read
    report: dict[str, Any] = {
        "version": _native.version(),
        "input": input_path,
        "job": job.name,
        "voxel_mm": result.stock.voxel,
        "threads": _native.threads(),
        "isa": _native.isa(),
        "moves": len(job.program),
        "machine_seconds": times["total"],
        "machine_seconds_by_tool": {
            str(number_of(job, tool)): seconds for tool, seconds in sorted(times["by_tool"].items())},
        "machine_seconds_by_operation": dict(zip(names, times["by_operation"])),
        "operations": names,
        "tools": [
            {
                "number": number,
                "name": job.tool_names.get(number, ""),
                "diameter_mm": 2 * cutter.radius(),
                "flutes_mm": list(cutter.extent()),
                "holder": job.holders.get(number, "own shape" if cutter.radius("holder") > 0 else None),
            }
            for number, cutter in sorted(job.tools.items()) if number_of(job, number) == number
        ],
        "seconds": {stage: round(value, 6) for stage, value in seconds.items()},
        "volume_mm3": {
            "initial": simulation.volume_initial,
            "removed": simulation.volume_initial - simulation.volume_final,
            "loose_dropped": result.dropped_mm3,
            "final": simulation.volume_final - result.dropped_mm3,
        },
        "removed_mm3_by_operation": removed,
        "memory_peak_mb": round(_native.memory_peak() / 1e6, 3),
        "bounding_box": None if box is None else {"lo": list(box[0]), "hi": list(box[1])},
        "mesh": _mesh(result),
        "solids": [{"file": solid.path, "faces": solid.faces, "facets_because": solid.reason,
                    "off_mm": solid.off_mm}
                   for solid in result.solids],
        "findings": _findings(job, names, simulation),
        "notes": list(job.notes),
        "loose_pieces": [
            {
                "volume_mm3": piece.lump.volume_mm3,
                "place": list(piece.lump.inside),
                "bounding_box": {"lo": list(piece.lump.bounding_box[0]), "hi": list(piece.lump.bounding_box[1])},
                "move": piece.move,
                "line": piece.line,
                "operation": piece.operation,
                "text": piece.text,
            }
            for piece in result.loose.pieces
        ],
        "loose_crumbs": result.loose.crumbs,
        "resampled_voxels": result.resampled_voxels,
        "set_ups_before": [_set_up(before, played) for before, played in result.before],
    }
    if result.comparison is not None:
        fields = ("design_mm3", "stock_mm3", "excess_mm3", "gouge_mm3")
        report["comparison"] = {name: getattr(result.comparison, name) for name in fields}
    return report


def make_verification(done: Verification, input_path: str, seconds_read: float = 0.0) -> dict[str, Any]:
    """Report of a verification: that of its simulation, and what the comparison found; plain types only."""
    made = make(done.result, input_path, seconds_read)
    deviation = done.deviation
    reach = 4 * max(done.tolerance)
    made["verification"] = {
        "passed": done.passed,
        "tolerance_mm": {"excess": done.tolerance[0], "gouge": done.tolerance[1]},
        "allowance_mm": done.allowance,
        "complete": done.complete,
        "error_mm": deviation.error,
        "design_triangles": done.design.triangle_count,
        "area_mm2": {
            "measured": deviation.area,
            "excess": deviation.excess_area,
            "gouge": deviation.gouge_area,
            "not_reached": deviation.not_reached_area,
        },
        "deviation_mm": {
            "mean": deviation.mean,
            "rms": deviation.rms,
            "least": deviation.least,
            "most": deviation.most,
            "percentiles": dict(zip(("1", "5", "25", "50", "75", "95", "99"), deviation.percentiles)),
        },
        "histogram": {"lo": -reach, "hi": reach, "area_mm2": list(deviation.histogram(-reach, reach, 80))},
    }
    if done.loads is not None:
        made["loads"] = _loads(done, made["operations"])
    made["findings"] = [
        {
            "severity": finding.severity,
            "kind": finding.kind,
            "text": finding.text,
            "operation": finding.operation,
            "line": finding.line,
            "move": finding.move,
            "place": None if finding.place is None else list(finding.place),
            "amount": finding.amount,
            "at_least": finding.at_least,
            "accepted": finding.accepted,
        }
        for finding in done.findings
    ]
    return made


def _loads(done: Verification, names: list[str]) -> dict[str, Any]:
    """Peaks by operation with the lines of the moves that make them, and the course over time."""
    program, times = done.result.job.program, done.result.job.program.times()
    assert done.loads is not None
    operations = []
    for name, part in zip(names, loads.summaries(program, done.loads, times)):
        operations.append({
            "operation": name,
            "seconds": part.seconds,
            "seconds_cutting": part.cutting,
            "volume_mm3": part.volume,
            "volume_unseen_mm3": part.unseen,
            "climb": part.climb,
            "peaks": {kind: {"value": peak.value, "unit": loads.KINDS[kind][1], "move": peak.move,
                             "line": operation_of(done.result.job, peak.move)[1]}
                      for kind, peak in part.peaks.items()},
        })
    return {
        "limits": {"all" if tool is None else str(tool): dict(entries) for tool, entries in done.limits.items()},
        "teeth": {str(tool): teeth for tool, teeth in sorted(done.result.job.teeth.items())},
        "operations": operations,
        "course": loads.course(program, done.loads, times),
    }


def _mesh(result: Result) -> Optional[dict[str, Any]]:
    """What is known of the mesh; of one that was streamed how many triangles, and that it is closed, as it would have
    failed. ``volume_off`` is its volume against ``surface_mm3``, of that; not where pieces were left out."""
    mesh, contour = result.mesh, result.contour
    made = {
        "error_mm": None if contour is None else contour.error_mm,
        "budget_met": None if contour is None else contour.budget_met,
        "intersections_found": None if contour is None else contour.intersections_found,
        "intersections_left": None if contour is None else contour.intersections_left,
        "split_edges": None if contour is None else contour.split_edges,
        "surface_mm3": None if contour is None else contour.surface_mm3,
        "unseen_mm3": None if contour is None else contour.unseen_mm3,
    }
    if mesh is None:
        return None if contour is None else {"triangles": contour.triangles, "closed": True, **made}
    areas = None if result.surface is None else parts.faces(mesh, result.surface)
    return {
        "vertices": mesh.vertex_count,
        "triangles": mesh.triangle_count,
        "closed": mesh.closed,
        "volume_mm3": mesh.volume,
        "volume_off": None if contour is None or result.dropped_mm3 else volume_off(contour, mesh.volume),
        **made,
        "area_mm2_by_face": areas,
        "analytic_share": None if not areas or not mesh.area else 1 - areas["other"] / sum(areas.values()),
    }


def summary(report: dict[str, Any]) -> str:
    """The report in a few lines of text."""
    volume, seconds = report["volume_mm3"], report["seconds"]
    lines = [
        f"{report['input']}: {report['moves']} moves in {len(report['operations'])} operation(s), "
        f"voxel {report['voxel_mm']:g} mm, {seconds['total']:.2f} s ({seconds['cut']:.2f} s cutting)",
        f"volume {volume['initial']:.1f} mm3, removed {volume['removed']:.1f}, left {volume['final']:.1f}",
    ]
    lines += [f"  {name}: {removed:.1f} mm3" for name, removed in report["removed_mm3_by_operation"].items()]
    if "comparison" in report:
        comparison = report["comparison"]
        lines.append(f"against the design: {comparison['excess_mm3']:.1f} mm3 too much, "
                     f"{comparison['gouge_mm3']:.1f} mm3 missing")
    return "\n".join(lines)


def write(report: dict[str, Any], path: str) -> None:
    """Write a report as JSON, beside the target and renamed, so that a failure loses nothing. OSError."""
    write_text(json.dumps(report, indent=2, allow_nan=False) + "\n", path)
