# SPDX-License-Identifier: LGPL-2.1-or-later
"""A job being watched: its stock at any move, pictures of it, and what made a point of its surface.

Made and used in one thread, the engine's; only what is named as read only may be read elsewhere. Imports no FreeCAD.
"""

import inspect
import math
import os
import time
from dataclasses import dataclass, field, replace
from typing import Any

from . import native
from .core import moves, pixels
from .core.clock import Clock
from .core.engine import RAYS_AT_REST
from .core.listing import Listing
from .core.playback import Playback
from .core.transport import STOP_FINDING, STOP_OPERATION, STOP_TOOL_CHANGE

# Memory for going back, as a share of what the stock may take.
HISTORY_SHARE = 2.0

# Rays along the edge of a pixel in the best pictures.
SAMPLES = RAYS_AT_REST[-1]

# Pixels of the picture per edge of one ray while things move, at most: more cannot be made out.
COARSE_MAX = 4

# The box that tells which move made a point: its half edge, in voxels of the stock, where the point is of the voxels
# alone, and where it is exact and names its move but for what was never cut; its voxels, as a part of that.
PROBE_REACH, PROBE_REACH_EXACT, PROBE_VOXEL = 0.35, 0.05, 0.3

# Stock in the colours of its deviation: as light as the colours of the legend want it, linear.
TINTED_MATERIAL = (0.8, 0.8, 0.8)

# Until when, about, opening looks at the fixtures, makes the stock, and cuts it once; the rest is finding the exact
# surface.
FIXTURES_SHARE, OPEN_SHARE, SURFACE_SHARE = 0.02, 0.3, 0.9


# What of stock and design a picture shows.
STOCK, DESIGN, BOTH = "stock", "design", "both"

# The design is told from the stock by its colour, linear.
DESIGN_COLOUR = (0.20, 0.42, 0.72)


@dataclass(frozen=True)
class View:
    """What a picture shows. camera: a swarf.Camera that nobody changes any more. look: further keywords of
    Scene.render, as pairs; those that the native module does not know are left out."""

    camera: Any
    width: int
    height: int
    look: tuple = ()
    show_cutter: bool = True
    show_path: bool = False
    tolerance_mm: float = 0.0  # > 0: the colours of the deviation from the design
    allowance_mm: float = 0.0  # meant to be left on the design: no deviation
    shown: str = STOCK


@dataclass
class Frame:
    """A picture, read only. rgba: bytes, rows from the top. depth: rows of mm along the view, inf for nothing.
    place: where the stock stood. sharp: whether it is as good as it gets. values: rows of deviations in mm, NaN for
    nothing, inf beyond what is known; None when they are not shown. view: what was asked for."""

    width: int
    height: int
    rgba: bytes
    depth: Any
    camera: Any
    place: float
    sharp: bool
    values: Any = None
    view: Any = None


@dataclass
class Picked:
    """What is seen at a place: point and normal in mm; move -1 for the stock as it was; line of the listing."""

    point: tuple
    normal: tuple
    move: int = -1
    line: int = -1
    operation: int = -1
    tool: int = -1
    depth_below_top: float = 0.0
    slope_deg: float = 0.0
    deviation: Any = None  # mm, where there is a design


@dataclass
class Overview:
    """The whole program's outcome, read only: mm3 removed by each operation, findings as (place, severity, text)."""

    removed: list = field(default_factory=list)
    volume_initial: float = 0.0
    volume_final: float = 0.0
    findings: list = field(default_factory=list)


def known_keywords():
    """Keywords of Scene.render that this native module has."""
    return frozenset(inspect.signature(native.load().Scene.render).parameters)


class Session:
    """data: JobData with its operations. progress as in native.simulate().

    clock, listing, box, overview, stops, tool_changes, tools and data are read only, any thread.
    """

    def __init__(self, data, voxel_mm, progress):
        swarf = native.load()
        self.data, self.voxel_mm = data, voxel_mm
        from swarf.progress import share  # of the package, once it is known to be there
        from swarf.stocks import make_first, stock_box

        self.job = native.to_job(data, share(progress, 0, FIXTURES_SHARE))
        self.program, self.tools = self.job.program, self.job.tools
        self.box = tuple(tuple(float(value) for value in corner) for corner in stock_box(self.job.stock))
        first = make_first(self.job.stock, voxel=voxel_mm, progress=share(progress, FIXTURES_SHARE, OPEN_SHARE))
        stock = first.stock
        self.clock = Clock(data.moves)
        self.listing = Listing(data.moves, data.operations)
        self._keywords = known_keywords()
        self._swarf = swarf
        self.overview = self._look_ahead(stock, share(progress, OPEN_SHARE, SURFACE_SHARE))
        self.tool_changes = [float(index) for index in range(len(data.moves)) if self._is_tool_change(index)]
        self.stops = {STOP_OPERATION: [float(begin) for begin in self.listing.operation_begin[1:]],
                      STOP_TOOL_CHANGE: self.tool_changes,
                      STOP_FINDING: sorted({place for place, _, _ in self.overview.findings})}
        self._coarse = {False: 1, True: COARSE_MAX}  # of pictures with deviations, which cost most
        self._design, self._design_is_bad, self._design_scene = None, False, None
        self._stock, self._scene = stock, swarf.Scene(stock)
        self._exact = hasattr(swarf.Scene, "show_surface")  # the native module can show more than the voxels
        if self._exact:
            self._scene.show_surface(
                first.surface(self.program, self.tools, progress=share(progress, SURFACE_SHARE, 1)))
        if hasattr(swarf.Scene, "set_fixtures"):
            self._scene.set_fixtures(self.job.fixtures)
        limit = int(HISTORY_SHARE * native.estimate(*self.box, voxel_mm))
        self._playback = Playback(swarf.History(stock, self.program, self.tools, memory_limit=limit))

    def _is_tool_change(self, index):
        row = self.data.moves.row(index)
        return row[0] == moves.EVENT and row[1] == moves.TOOL_CHANGE

    def _look_ahead(self, stock, progress):
        """Cut a copy of the stock once: what each operation removes, what is noticed."""
        done = stock.copy().simulate(self.program, self.tools, progress=progress)
        findings, seen = [], set()
        for item in done.findings:
            if (item.operation, item.text) not in seen:
                seen.add((item.operation, item.text))
                findings.append((float(max(item.move, 0)), item.severity, native.text_of(item, self.job)))
        return Overview(list(done.removed_by_operation), done.volume_initial, done.volume_final, findings)

    @property
    def at(self):
        """Where the stock stands."""
        return self._playback.at

    def step(self, place, seconds, progress=None):
        """Go towards a place, for about so many seconds; where it stands then."""
        return self._playback.step(place, seconds, progress)

    def _current_scene(self):
        if self._exact:
            self._scene.set_moves(self._playback.moves, self._playback.fraction)
        return self._scene

    def _look(self, view, place):
        """Keywords of Scene.render for a view, as far as the native module knows them."""
        look = dict(view.look)
        if view.show_cutter:
            tool = self.tool_at(place)
            tip = self.clock.tip_at(place)
            if tool in self.tools and tip is not None:
                look["cutter"] = (self.tools[tool], tip)
        look.update(program=self.program, moves_done=float(place), path=view.show_path)
        return {key: value for key, value in look.items() if key in self._keywords}

    def _solid(self, progress=None):
        """The design as a swarf.Solid, None when there is none or it encloses nothing; the checks tell of that."""
        if self._design is None and self.job.design is not None and not self._design_is_bad:
            try:
                self._design = self._swarf.Solid(self.job.design, progress=progress)
            except self._swarf.GeometryError:
                self._design_is_bad = True
        return self._design

    def _picture(self, view, place, progress, **how):
        """(picture, values): values as in Frame."""
        look = dict(self._look(view, place), **how)
        design = self._solid(progress) if view.tolerance_mm > 0 else None
        if design is None:
            return self._current_scene().render(view.camera, view.width, view.height, buffers=("rgba", "depth"),
                                                progress=progress, **look), None
        look["colour"] = TINTED_MATERIAL
        picture = self._current_scene().render(view.camera, view.width, view.height, progress=progress,
                                               buffers=("rgba", "depth", "position", "seen"), **look)
        return picture, picture.show_deviation(
            design, view.tolerance_mm, allowance=view.allowance_mm, progress=progress)

    def _design_picture(self, view, tolerance_mm, progress, **how):
        """(picture, values) of the design alone, in the colours of the stock's deviation where there is a tolerance;
        None when there is none that encloses anything."""
        if self._design_scene is None:
            if self._solid(progress) is None:
                return None
            self._design_scene = self._swarf.Scene(
                self._swarf.Stock.from_mesh(self.job.design, self.voxel_mm, progress=progress))
        look = dict(view.look, colour=TINTED_MATERIAL if tolerance_mm > 0 else DESIGN_COLOUR, colouring="material",
                    **how)
        picture = self._design_scene.render(
            view.camera, view.width, view.height, buffers=("rgba", "depth", "position", "seen"), progress=progress,
            **{key: value for key, value in look.items() if key in self._keywords})
        if tolerance_mm <= 0:
            return picture, None
        return picture, picture.show_deviation(
            self._stock, tolerance_mm, allowance=view.allowance_mm, progress=progress)

    def _compose(self, view, place, progress, **how):
        """(rgba, depth, values) of what a view shows."""
        alone = view.shown == DESIGN
        design = None
        if view.shown != STOCK:
            design = self._design_picture(view, view.tolerance_mm if alone else 0.0, progress, **how)
        if design is not None and alone:
            return bytes(design[0].rgba), design[0].depth, design[1]
        picture, values = self._picture(view, place, progress, **how)
        rgba = bytes(picture.rgba)
        return rgba if design is None else pixels.blend(rgba, bytes(design[0].rgba)), picture.depth, values

    def draw(self, view, place, budget_ms, progress=None, samples=SAMPLES):
        """A Frame; budget_ms None: exact, with samples x samples rays for pixels at edges."""
        asked, tinted = view, view.tolerance_mm > 0
        coarse, how = 1 if budget_ms is None else self._coarse[tinted], {"samples": samples}
        if budget_ms is not None:
            how = {"samples": 1}
            # coarse rays make steps of the edges' lines
            off = {"occlusion", "shadow"} | ({"edges"} if coarse > 1 else set())
            seen = dict(view.look)
            if seen.get("colouring") == "material" and not seen.get("selected"):  # else it alone knows the moves
                off.add("exact")
            how.update((name, False) for name in off if name in self._keywords)
            if tinted:  # a value for each ray, not for each pixel
                view = replace(view, width=max(view.width // coarse, 1), height=max(view.height // coarse, 1))
            else:
                how["coarse"] = coarse
        started = time.monotonic()
        rgba, depth, values = self._compose(view, place, progress, **how)
        if budget_ms is not None:
            took = 1000 * (time.monotonic() - started)
            if took > 1.5 * budget_ms:
                coarse = min(coarse + 1, COARSE_MAX)
            elif took < 0.5 * budget_ms:
                coarse = max(coarse - 1, 1)
            self._coarse[tinted] = coarse
        return Frame(view.width, view.height, rgba, depth, view.camera, place, budget_ms is None and samples == SAMPLES,
                     values, asked)

    def tool_at(self, place):
        """Number of the tool in the spindle at a place, -1 for none."""
        count = len(self.data.moves)
        if not count:
            return -1
        index = min(int(place), count - 1)
        return self.data.moves.sections[int(self.data.moves.row(index)[2])][0]

    def pick(self, view, x, y, place, progress=None):
        """Picked at a place of the picture (x to the right, y upwards, -1 .. 1) of the stock as it is at a place, or
        None where nothing is. Stays there."""
        if view.shown == DESIGN:
            return None
        self._go(place, progress)
        found = self._current_scene().pick(view.camera, x, y, view.width, view.height,
                                           sections=dict(view.look).get("sections") or None)
        if found is None or found.seen != "stock":
            return None
        move = found.move if found.move >= 0 else self._maker(found.point, int(place), progress)
        result = Picked(found.point, found.normal, depth_below_top=self.box[1][2] - found.point[2],
                        slope_deg=math.degrees(math.acos(min(max(found.normal[2], -1.0), 1.0))))
        design = self._solid(progress)
        if design is not None:
            result.deviation = design.distance([found.point])[0] - view.allowance_mm
        if move >= 0:
            tool, operation = self.data.moves.sections[int(self.data.moves.row(move)[2])][:2]
            result.move, result.line = move, self.listing.line_of(move)
            result.operation, result.tool = operation, tool
        return result

    def _go(self, place, progress=None):
        """Stand at a place."""
        while self._playback.at != place:
            self.step(place, 0.1, progress)

    def _maker(self, point, place, progress):
        """The last of the moves before a place that takes something from a tiny block about a point of the surface:
        no move takes more than up to the surface. -1 when none does."""
        if not place:
            return -1
        reach = (PROBE_REACH_EXACT if self._exact else PROBE_REACH) * self.voxel_mm
        block = self._swarf.Stock.box([value - reach for value in point], [value + reach for value in point],
                                      PROBE_VOXEL * reach)
        done = block.simulate(self.program, self.tools, first=0, count=place, batch=1, removed_per_move=True,
                              progress=progress)
        taken = done.removed_per_move
        return next((index for index in range(place - 1, -1, -1) if taken[index] > 0.0), -1)

    def write_png(self, path, view, place, progress=None):
        """The picture of the stock as it is at a place, as good as it gets, to a file. Stays there."""
        self._go(place, progress)
        if view.shown == STOCK:
            self._picture(view, place, progress, samples=SAMPLES)[0].write(path)
        else:
            pixels.write_png(path, view.width, view.height, self._compose(view, place, progress, samples=SAMPLES)[0])

    def write_frames(self, folder, view, places, progress=None, on_frame=None):
        """The stock at each of some places as frame-00000.png ... -> number of files. Stays at the last."""
        for number, place in enumerate(places):
            self.write_png(os.path.join(folder, "frame-%05d.png" % number), view, place, progress)
            if on_frame:
                on_frame((number + 1) / len(places))
        return len(places)
