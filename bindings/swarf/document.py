# SPDX-License-Identifier: LGPL-2.1-or-later
"""The report of a verification as one HTML file that needs nothing else: for the screen, for paper, for the record."""
from __future__ import annotations

import base64
import datetime
import html
import math
import struct
import zlib
from typing import Any, Callable, Optional, Sequence

from . import plots
from ._native import Camera, Picture, Scene, deviation_colours
from .aliases import View
from .loads import KINDS
from .verify import Verdict, Verification

#: Pictures of the whole part, and how many of the worst places get one of their own.
VIEWS: Sequence[View] = ("isometric", "top", "front", "right")
PLACES_SHOWN = 6
SIZE = (760, 570)
PLACE_SIZE = (480, 360)

STYLE = """
:root { --ink: #1d2329; --dim: #66707a; --rule: #d5dade; --ok: #2c7a3f; --bad: #b3121d; --warn: #a8620a; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 62rem; padding: 2rem 1.5rem 3rem; color: var(--ink); background: #fff;
  font: 15px/1.45 system-ui, "DejaVu Sans", sans-serif; }
h1 { margin: 0; font-size: 1.7rem; }
h2 { margin: 2.2rem 0 .6rem; font-size: 1.15rem; border-bottom: 1px solid var(--rule); }
p { margin: .4rem 0; } .dim { color: var(--dim); }
header { display: flex; justify-content: space-between; align-items: flex-start; gap: 2rem; }
.verdict { padding: .35rem 1.1rem; border: 2px solid; border-radius: .4rem; font-size: 1.5rem; font-weight: 700; }
.passed { color: var(--ok); } .failed, .error { color: var(--bad); }
.warning { color: var(--warn); } .note { color: var(--dim); }
table { width: 100%; border-collapse: collapse; font-variant-numeric: tabular-nums; }
th { text-align: left; font-weight: 600; color: var(--dim); }
th, td { padding: .25rem .5rem .25rem 0; vertical-align: top; border-bottom: 1px solid var(--rule); }
td.n, th.n { text-align: right; white-space: nowrap; }
.facts { display: grid; grid-template-columns: repeat(4, 1fr); gap: .8rem 1.5rem; margin-top: 1.2rem; }
.facts div { border-top: 2px solid var(--ink); padding-top: .25rem; } .facts b { display: block; font-size: 1.15rem; }
.place { white-space: nowrap; padding-right: .6rem; }
.pictures { display: grid; grid-template-columns: 1fr 1fr; gap: 1rem; }
.places { grid-template-columns: repeat(3, 1fr); }
figure { margin: 0; break-inside: avoid; } figure img { width: 100%; display: block; border: 1px solid var(--rule); }
figcaption { font-size: .85rem; color: var(--dim); margin-top: .2rem; }
svg { display: block; width: 100%; height: auto; }
svg text { font: 11px system-ui, "DejaVu Sans", sans-serif; fill: var(--dim); }
tr, svg { break-inside: avoid; } h2 { break-after: avoid; }
@media print { @page { margin: 14mm; } body { max-width: none; padding: 0; font-size: 10.5px; }
  * { -webkit-print-color-adjust: exact; print-color-adjust: exact; } }
"""


def png(width: int, height: int, rgba: bytes) -> bytes:
    """A PNG of RGBA rows from the top (opaque: alpha is left out)."""
    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rgb = bytearray(3 * width * height)
    for channel in range(3):
        rgb[channel::3] = rgba[channel::4]
    rows = b"".join(b"\0" + rgb[3 * width * row:3 * width * (row + 1)] for row in range(height))
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b"")


def deviation_map(done: Verification, scene: Scene, camera: Camera, size: tuple[int, int]) -> bytes:
    """PNG of the stock from a camera, its surface in the colours of its deviation."""
    width, height = size
    picture = scene.render(camera, width, height, samples=2, buffers=("rgba", "position", "seen"),
                           colour=(0.8, 0.8, 0.8), background=(1.0, 1.0, 1.0, 1.0),
                           background_top=(1.0, 1.0, 1.0, 1.0))
    picture.show_deviation(done.design, max(done.tolerance), allowance=done.allowance)
    return png(width, height, pixels(picture))


def pixels(picture: Picture) -> bytes:
    """The colours of a picture, RGBA rows from the top; ValueError where they were not asked for."""
    if picture.rgba is None:
        raise ValueError("the picture has no colours: they were not asked for")
    return bytes(picture.rgba)


def image(data: bytes, alternative: str) -> str:
    encoded = base64.b64encode(data).decode("ascii")
    return f'<img alt="{html.escape(alternative)}" src="data:image/png;base64,{encoded}">'


def scale_colour(value: float) -> str:
    """CSS colour of a deviation in tolerances."""
    values = memoryview(struct.pack("d", value)).cast("B").cast("d", (1, 1))
    colour = deviation_colours(values, bytes((184, 184, 184, 255)), 1.0)
    return "#%02x%02x%02x" % tuple(colour[:3])


def histogram(areas: Sequence[float], lo: float, hi: float, tolerance: tuple[float, float]) -> str:
    """SVG of the surface by its deviation: bars in the colours of the pictures, so that it is their legend too."""
    width, height, floor = 760.0, 170.0, 140.0
    most = max(max(areas), 1e-9)
    step = width / len(areas)
    parts = [f'<svg viewBox="0 0 {width:g} {height:g}" role="img" aria-label="surface by its deviation">']
    for index, area in enumerate(areas):
        middle = lo + (index + 0.5) * (hi - lo) / len(areas)
        # the root of the area, or the few square millimetres that matter would not show beside thousands
        top = math.sqrt(area / most) * (floor - 12)
        colour = scale_colour(middle / max(tolerance))
        parts.append(f'<rect x="{index * step:.2f}" y="{floor - top:.2f}" width="{step * 0.9:.2f}" height="{top:.2f}" '
                     f'fill="{colour}"><title>{middle:.4f} mm: {area:.3g} mm²</title></rect>')
        parts.append(f'<rect x="{index * step:.2f}" y="{floor + 2:g}" width="{step:.2f}" height="6" fill="{colour}"/>')
    for value in (-tolerance[1], tolerance[0]):
        x = (value - lo) / (hi - lo) * width
        parts.append(f'<line x1="{x:.1f}" x2="{x:.1f}" y1="4" y2="{floor:g}" stroke="#1d2329" stroke-dasharray="3 3"/>')
    for index in range(9):
        value = lo + index * (hi - lo) / 8
        anchor = "start" if index == 0 else "end" if index == 8 else "middle"
        parts.append(f'<text x="{index * width / 8:.1f}" y="{height - 8:g}" text-anchor="{anchor}">{value:+.3g}</text>')
    return "".join(parts) + "</svg>"


class Markup(str):
    """A text that is HTML already."""


def table(heads: Sequence[str], rows: Sequence[Sequence[Any]], numbers: Sequence[int]) -> str:
    """An HTML table; all cells are escaped but those that are Markup."""
    def cell(tag: str, index: int, value: Any) -> str:
        text = value if isinstance(value, Markup) else html.escape(str(value))
        return f"<{tag}{' class=n' if index in numbers else ''}>{text}</{tag}>"

    head = "".join(cell("th", index, text) for index, text in enumerate(heads))
    body = "".join("<tr>" + "".join(cell("td", index, value) for index, value in enumerate(row)) + "</tr>"
                   for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def finding_row(number: int, finding: Verdict) -> list[str]:
    place = "" if finding.place is None else ", ".join(f"{value:.2f}" for value in finding.place)
    text = html.escape(finding.text)
    if finding.accepted is not None:
        text += f'<br><span class="dim">accepted: {html.escape(finding.accepted)}</span>'
    severity = finding.severity if finding.accepted is None else "note"
    word = finding.severity if finding.accepted is None else f"({finding.severity})"
    return [str(number), Markup(f'<span class="{severity}">{word}</span>'), finding.operation or "",
            str(finding.line or ""), Markup(f'<span class="place">{place}</span>'), Markup(text)]


#: Of the volume of an operation; fewer thin layers are not worth a word.
UNSEEN_SHARE = 0.01


def operations(report: dict[str, Any]) -> str:
    """The table of operations: what each removed, and its peaks where loads were measured."""
    removed = report["removed_mm3_by_operation"]
    if "loads" not in report:
        total = sum(removed.values()) or 1.0
        parts = [[name, f"{value:,.1f}", f"{100 * value / total:.1f} %"] for name, value in removed.items()]
        return table(["operation", "removed, mm³", "share"], parts, (1, 2))
    entries = report["loads"]["operations"]
    kinds = [kind for kind in KINDS if any(kind in entry["peaks"] for entry in entries)]
    heads = ["operation", "time", Markup("removed<br>mm³"), "climb", *(
        Markup(f"{KINDS[kind][2]}<br>{plots.units(KINDS[kind][1])}") for kind in kinds)]
    rows = []
    for entry in entries:
        peaks = [Markup(f'{plots.nice(entry["peaks"][kind]["value"])}<br><span class=dim>line '
                        f'{entry["peaks"][kind]["line"]}</span>') if kind in entry["peaks"] else "–" for kind in kinds]
        climb = "–" if entry["climb"] is None or "engagement" not in entry["peaks"] else f"{100 * entry['climb']:.0f} %"
        rows.append([entry["operation"], plots.clock(entry["seconds"]), f"{removed[entry['operation']]:,.1f}", climb,
                     *peaks])
    unseen = "; ".join(
        f"{html.escape(entry['operation'])} {entry['volume_unseen_mm3']:,.1f} of {entry['volume_mm3']:,.1f} mm³"
        for entry in entries if entry["volume_unseen_mm3"] > UNSEEN_SHARE * entry["volume_mm3"] > 0)
    unseen = f" So was cut: {unseen}." if unseen else ""
    chips = "" if "chip" in kinds else " Chip thickness is not known: no tool tells its number of teeth."
    return table(heads, rows, range(1, len(heads))) + (
        "<p class=dim>The greatest loads of each operation and the line that makes them; engagement is that of moves "
        f"sideways. Climb: share of the volume that is cut in climb milling. Layers of about a voxel, "
        f"{report['voxel_mm']:.2g} mm, and less may not be seen, nor what takes less than 20° of a tool's turn: a load "
        f"there is greater than told.{unseen}{chips}</p>")


def load_plots(done: Verification, report: dict[str, Any]) -> str:
    """The loads over time, under their heading."""
    if "loads" not in report:
        return ""
    drawn = plots.course(report["loads"]["course"], report["operations"], plots.limits_of_all(done.limits))
    return f"<h2>Loads over time</h2>{drawn}" if drawn else ""


def close_ups(done: Verification, scene: Scene) -> list[str]:
    """Figures of the worst places."""
    figures: list[str] = []
    for number, finding in enumerate(done.findings, 1):
        if finding.cluster is None or finding.accepted is not None or len(figures) == PLACES_SHOWN:
            continue
        lo, hi = finding.cluster.box
        margin = max(1.0, 0.35 * max(high - low for low, high in zip(lo, hi)))
        box = ([low - margin for low in lo], [high + margin for high in hi])
        camera = Camera.view("isometric", box, PLACE_SIZE[0] / PLACE_SIZE[1])
        data = deviation_map(done, scene, camera, PLACE_SIZE)
        figures.append(f"<figure>{image(data, f'finding {number}')}<figcaption><b>{number}</b> "
                       f"{html.escape(finding.text)}</figcaption></figure>")
    return figures


def count(number: int, noun: str) -> str:
    """A number of things."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def facts(items: Sequence[tuple[str, str]]) -> str:
    return '<div class="facts">' + "".join(f"<div><b>{html.escape(value)}</b>{html.escape(name)}</div>"
                                           for name, value in items) + "</div>"


def make(done: Verification, report: dict[str, Any], progress: Optional[Callable[[float], Any]] = None) -> str:
    """The HTML text of a verification and its JSON report."""
    found, deviation, job = report["verification"], done.deviation, done.result.job
    scene, pictures = done.scene(), []
    box = done.result.stock.bounding_box()
    for number, view in enumerate(VIEWS):
        if progress is not None:
            progress(number / (len(VIEWS) + 1))
        camera = Camera.view(view, box, SIZE[0] / SIZE[1])
        pictures.append(f"<figure>{image(deviation_map(done, scene, camera, SIZE), view)}<figcaption>{view}"
                        "</figcaption></figure>")
    places = close_ups(done, scene)
    verdict = "passed" if done.passed else "failed"
    plus, minus = done.tolerance
    volumes, minutes = deviation.comparison, report["machine_seconds"] / 60
    percentiles = found["deviation_mm"]["percentiles"]
    severities = [finding.severity for finding in done.findings if finding.accepted is None]
    counts = [count(severities.count("error"), "error"), count(severities.count("warning"), "warning")]
    accepted = len(done.findings) - len(severities)
    if accepted:
        counts.append(f"{accepted} accepted")
    now = datetime.datetime.now().astimezone().strftime("%Y-%m-%d %H:%M %Z")
    parts = [
        '<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">'
        f"<title>{html.escape(job.name)}: {verdict}</title><style>{STYLE}</style></head><body>",
        f"<header><div><h1>{html.escape(job.name)}</h1><p class=dim>{html.escape(report['input'])}<br>{now}</p></div>"
        f'<div class="verdict {verdict}">{verdict.upper()}</div></header>',
        f"<p>{', '.join(counts)}. Tolerance +{plus:g} / −{minus:g} mm"
        f"{f', allowance {done.allowance:g} mm' if done.allowance else ''}. Voxel {report['voxel_mm']:.4g} mm; a value "
        f"on a smooth face is good to {deviation.error:.2g} mm, within a voxel of an edge to "
        f"{0.5 * report['voxel_mm']:.2g} mm, where only what is beyond tolerance by more than that counts.</p>",
        facts([("greatest excess, mm", f"{deviation.most:+.3f}"),
               ("greatest gouge, mm", f"{min(0.0, deviation.least):.3f}"),
               ("mean, mm", f"{deviation.mean:+.4f}"), ("root mean square, mm", f"{deviation.rms:.4f}"),
               ("material left, mm³", f"{volumes.excess_mm3:,.1f}"),
               ("material missing, mm³", f"{volumes.gouge_mm3:,.1f}"),
               ("surface out of tolerance, mm²", f"{deviation.excess_area + deviation.gouge_area:,.1f}"),
               ("not reached, mm²", f"{deviation.not_reached_area:,.1f}")]),
        f"<h2>Deviation of the stock from the design</h2><div class=pictures>{''.join(pictures)}</div>",
        "<h2>Surface by its deviation, mm</h2>",
        histogram(found["histogram"]["area_mm2"], found["histogram"]["lo"], found["histogram"]["hi"], done.tolerance),
        "<p class=dim>Heights by the root of the area; the outermost bars hold all beyond. Of the surface lie below: "
        + "; ".join(f"{share} %: {round(value, 4) + 0.0:.4f}" for share, value in percentiles.items()) + " mm.</p>",
        "<h2>Findings</h2>",
        table(["", "severity", "operation", "line", "place, mm", "what"],
              [finding_row(number, finding) for number, finding in enumerate(done.findings, 1)], (3,))
        if done.findings else "<p>None.</p>",
        f"<h2>The worst places</h2><div class='pictures places'>{''.join(places)}</div>" if places else "",
        "<h2>Operations</h2>", operations(report), load_plots(done, report),
        f"<p>{report['moves']:,} moves; {minutes:.1f} min at the programmed feeds, without acceleration. Stock "
        f"{report['volume_mm3']['initial']:,.1f} mm³, left {report['volume_mm3']['final']:,.1f} mm³, design "
        f"{volumes.design_mm3:,.1f} mm³.</p>",
        "<h2>Tools</h2>",
        table(["", "name", "diameter, mm", "teeth", "holder"],
              [[f"T{tool['number']}", tool["name"], f"{tool['diameter_mm']:.4g}", job.teeth.get(tool["number"], "–"),
                tool["holder"] or "none: not checked"] for tool in report["tools"]], (2, 3)),
        "".join(f"<p class=note>{html.escape(note)}</p>" for note in job.notes),
        f"<p class=dim>Swarf {html.escape(report['version'])}; {report['threads']} threads, {report['isa']}; cutting "
        f"{report['seconds']['cut']:.2f} s, comparing {report['seconds'].get('compare', 0.0):.2f} s.</p></body></html>",
    ]
    return "\n".join(part for part in parts if part) + "\n"
