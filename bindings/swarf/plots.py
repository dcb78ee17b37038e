# SPDX-License-Identifier: LGPL-2.1-or-later
"""Loads over time as one SVG: a strip for each kind, operations side by side below."""
from __future__ import annotations

import html
from typing import Any, Mapping, Optional, Sequence

from .loads import KINDS

WIDTH, LEFT, STRIP, GAP = 760.0, 104.0, 58.0, 16.0
INK, FILL, LIMIT = "#2f5d8a", "#b9cfe4", "#b3121d"

#: Two tints in turn tell neighbouring operations apart.
BANDS = ("#f3f5f7", "#ffffff")


def clock(seconds: float) -> str:
    """Seconds as m:ss, or h:mm:ss."""
    whole = int(round(seconds))
    minutes, rest = divmod(whole, 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"


def units(unit: str) -> str:
    """A unit as it is printed."""
    return unit.replace("mm3", "mm³").replace("deg", "°")


def nice(value: float) -> str:
    """A number with three digits that matter."""
    return f"{value:,.0f}" if value >= 100 else f"{value:.3g}"


def _strip(series: Sequence[float], top: float, most: float) -> str:
    """The outline of a series, as steps."""
    width = WIDTH - LEFT
    step = width / len(series)
    points = [f"M{LEFT:g},{top + STRIP:.1f}"]
    last = None
    for index, value in enumerate(series):
        y = top + STRIP * (1 - min(value / most, 1.0))
        if last is None or value != last:
            points.append(f"H{LEFT + index * step:.1f}V{y:.1f}")
        last = value
    return "".join(points) + f"H{WIDTH:g}V{top + STRIP:.1f}Z"


def course(data: Mapping[str, Any], names: Sequence[str], limits: Mapping[str, float]) -> str:
    """SVG of loads.course(); ``names``: of the operations; ``limits``: of all tools, drawn as lines."""
    seconds = data["seconds"]
    kinds = [kind for kind in KINDS if max(data[kind]) > 0]
    if not (seconds > 0 and kinds):
        return ""
    width, top = WIDTH - LEFT, 6.0
    bottom = top + len(kinds) * (STRIP + GAP)
    begins = sorted((begin, name) for begin, name in zip(data["operations"], names) if begin is not None)
    height = bottom + 12.0 + 13.0 * len(begins)
    parts = [f'<svg viewBox="0 0 {WIDTH:g} {height:g}" role="img" aria-label="loads over time">']
    x_of = [LEFT + begin / seconds * width for begin, _ in begins] + [WIDTH]
    for index, (x, end) in enumerate(zip(x_of, x_of[1:])):
        parts.append(f'<rect x="{x:.1f}" y="{top:g}" width="{max(end - x, 0.5):.1f}" height="{bottom - top - GAP:g}" '
                     f'fill="{BANDS[index % 2]}"/>')
    for index, kind in enumerate(kinds):
        _, unit, name = KINDS[kind]
        y, peak, limit = top + index * (STRIP + GAP), max(data[kind]), limits.get(kind)
        most = 1.08 * max(peak, limit or 0.0)
        parts.append(f'<path d="{_strip(data[kind], y, most)}" fill="{FILL}" stroke="{INK}" stroke-width="0.7"/>')
        parts.append(f'<text x="{LEFT - 8:g}" y="{y + 12:.1f}" text-anchor="end" style="fill:#1d2329">{name}</text>'
                     f'<text x="{LEFT - 8:g}" y="{y + 26:.1f}" text-anchor="end">most {nice(peak)} '
                     f'{units(unit)}</text>')
        if limit is not None:
            at = y + STRIP * (1 - limit / most)
            parts.append(f'<line x1="{LEFT:g}" x2="{WIDTH:g}" y1="{at:.1f}" y2="{at:.1f}" stroke="{LIMIT}" '
                         f'stroke-dasharray="4 3"/>')
        parts.append(f'<line x1="{LEFT:g}" x2="{WIDTH:g}" y1="{y + STRIP:.1f}" y2="{y + STRIP:.1f}" stroke="#d5dade"/>')
    for index in range(7):
        anchor = "start" if index == 0 else "end" if index == 6 else "middle"
        parts.append(f'<text x="{LEFT + index * width / 6:.1f}" y="{bottom - 2:.1f}" text-anchor="{anchor}">'
                     f'{clock(seconds * index / 6)}</text>')
    parts += _names(begins, x_of, bottom + 12.0)
    return "".join(parts) + "</svg>"


def _names(begins: Sequence[tuple[float, str]], x_of: Sequence[float], top: float) -> list[str]:
    """The operations' names, each on a row of its own, beginning (or ending) where its operation does."""
    parts = []
    for row, ((_, name), x) in enumerate(zip(begins, x_of)):
        y, late = top + 13.0 * row + 6, x > LEFT + 0.7 * (WIDTH - LEFT)
        place, anchor = (x - 4, "end") if late else (x + 4, "start")
        parts.append(f'<line x1="{x:.1f}" x2="{x:.1f}" y1="{top - 14:.1f}" y2="{y:.1f}" stroke="#9aa4ad" '
                     f'stroke-width="0.7"/><text x="{place:.1f}" y="{y:.1f}" text-anchor="{anchor}">'
                     f'{html.escape(name)}</text>')
    return parts


def limits_of_all(limits: Optional[Mapping[Optional[int], Mapping[str, float]]]) -> Mapping[str, float]:
    """The limits that hold for all tools: those that a line can show."""
    return {} if not limits else limits.get(None, {})
