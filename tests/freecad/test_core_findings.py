# SPDX-License-Identifier: LGPL-2.1-or-later
"""Findings without Qt and FreeCAD: the checks of a job, their places in the program, the order they are shown in."""

import array
import dataclasses
import itertools
import math
import zlib
from types import SimpleNamespace

import pytest
from swarf_cam import native
from swarf_cam.core import findings, legend, navigation, program
from swarf_cam.core.clock import Clock
from swarf_cam.core.findings import Finding
from swarf_cam.core.job import JobData
from swarf_cam.core.listing import Listing
from test_core_program import Command

LO, HI = (0.0, 0.0, -10.0), (40.0, 20.0, 0.0)


def box_mesh(lo, hi):
    """A block as (points, triangles), outwards."""
    points = array.array("d", itertools.chain(*itertools.product(*zip(lo, hi))))
    quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    return points, array.array("I", [i for a, b, c, d in quads for i in (a, b, c, a, c, d)])


def make(design=None):
    """JobData and Listing: a rapid into the block, then a slot 2 mm deep."""
    lines = [["G0 X20 Y15 Z5", "G0 Z-3", "G0 Z5"], ["G0 X-5 Y5", "G0 Z-2", "G1 X45 F10", "G0 Z5"]]
    operations = [program.Operation(name, [Command(line) for line in own], 1, "a",
                                    [Command("M6 T1"), Command("M3 S1000")])
                  for name, own in zip(("Plunge", "Slot"), lines)]
    table = program.build(operations)
    mill = [("flutes", [(0, 0, 0), (3, 0, 0), (3, 20, 0), (0, 20, 0)])]
    data = JobData("Job", table, {1: ("Mill", mill)}, {"kind": "box", "lo": LO, "hi": HI}, design,
                   operations=operations)
    return data, Listing(table, operations)


def run(data, listing, tolerance=0.05, progress=lambda done: False):
    from swarf_cam import checks

    return findings.from_verdicts(checks.run(native.to_job(data), 0.5, tolerance, progress).verdicts, listing)


def test_a_rapid_into_material_is_found_where_the_tip_meets_the_top(swarf):
    data, listing = make()
    found = run(data, listing)
    rapid = found[0]
    assert rapid.severity == "error" and listing.operations[rapid.operation].name == "Plunge"
    assert listing.text(rapid.line) == "G0 Z-3"
    # from Z5 to Z-3: the top, Z0, is five eighths along
    assert rapid.place - int(rapid.place) == pytest.approx(5 / 8, abs=0.05 / 8)
    tip = Clock(data.moves).tip_at(rapid.place)
    assert tip == pytest.approx((20, 15, 0), abs=0.05) and rapid.point == pytest.approx(tip, abs=1e-6)


def test_the_design_tells_what_should_not_have_been_cut(swarf):
    data, listing = make(box_mesh(LO, HI))
    found = run(data, listing)
    gouges = {listing.operations[item.operation].name: item for item in found if item.kind == "gouge"}
    assert set(gouges) == {"Plunge", "Slot"}
    assert gouges["Slot"].amount == pytest.approx(-2, abs=0.05)
    assert listing.text(gouges["Slot"].line) == "G1 X45 F600"
    # it is seen behind the move that made it
    assert gouges["Slot"].place == listing.moves_of(gouges["Slot"].line)[1]
    assert findings.worst_places(found, 1) == [gouges["Plunge"]]
    assert not [item for item in run(data, listing, tolerance=5.0) if item.kind == "gouge"]


def test_what_is_left_is_seen_at_the_end(swarf):
    data, listing = make(box_mesh(LO, (40.0, 20.0, -1.0)))
    left = [item for item in run(data, listing) if item.kind in ("excess", "not reached")]
    assert left and all(item.place == len(data.moves) for item in left)


def test_a_design_that_is_open_is_told_and_the_rest_checked(swarf):
    points, triangles = box_mesh(LO, HI)
    data, listing = make((points, triangles[:12]))
    found = run(data, listing)
    assert {"design", "rapid"} <= {item.kind for item in found}, found
    assert next(item for item in found if item.kind == "design").place is None


def test_checks_can_be_broken_off(swarf, every_piece):
    data, listing = make(box_mesh(LO, HI))
    told = []
    run(data, listing, progress=told.append)
    assert told == sorted(told) and told[-1] <= 1.0
    for limit in (0.0, 0.5, told[-1]):
        with pytest.raises(swarf.Cancelled):
            run(data, listing, progress=lambda done, limit=limit: done >= limit)


def test_progress_does_not_run_backwards_where_there_are_fixtures(swarf, monkeypatch):
    from swarf.verify import solids_of

    scope = solids_of.__globals__  # of the module: swarf.verify is its function
    real = scope["Solid"]

    def solid(mesh, progress):  # as one of many triangles is made
        for done in (0.0, 0.5, 1.0):
            progress(done)
        return real(mesh)

    monkeypatch.setitem(scope, "Solid", solid)
    for design in (None, box_mesh(LO, HI)):
        data, listing = make(design)
        data.fixtures = [("Clamp", box_mesh((x, 30.0, -10.0), (x + 5.0, 40.0, 10.0))) for x in (0.0, 30.0)]
        told = []
        run(data, listing, progress=told.append)
        assert told == sorted(told) and told[-1] <= 1.0


def test_reading_fixtures_tells_its_progress_and_can_be_broken_off(swarf, every_piece):
    """Those of a set-up before are in the first half."""
    stock = swarf.Mesh.from_stock(swarf.Stock.cylinder((0, 0, 20), (0, 0, 20), 20, 0.5))
    round_one = array.array("f", bytes(stock.vertices)), array.array("I", bytes(stock.triangles))
    before, _ = make()
    before.fixtures = [("Round", round_one)]
    data = dataclasses.replace(before, stock={"kind": "result", "job": before}, fixtures=2 * before.fixtures)
    told = []
    assert len(native.to_job(data, told.append).fixtures) == 2
    assert told == sorted(told) and told[0] < 0.5 and 0.5 < told[-1] <= 1.0
    for limit in (0.0, 0.5, 0.75):
        with pytest.raises(swarf.Cancelled):
            native.to_job(data, lambda done, limit=limit: done >= limit)


def test_another_tolerance_is_judged_without_cutting_again(swarf):
    from swarf_cam import checks

    data, listing = make(box_mesh(LO, (40.0, 20.0, -0.3)))
    job = native.to_job(data)
    first = checks.run(job, 0.5, 0.05, lambda done: False)
    wide = checks.judge(first, 1.0, lambda done: False)
    assert wide.verification.result is first.verification.result, "nothing was cut again"
    allowed = checks.judge(first, 0.05, lambda done: False, 0.28)
    assert allowed.verification.result is first.verification.result and allowed.verification.allowance == 0.28
    left = checks.run(job, 0.5, 0.05, lambda done: False, allowance_mm=0.28)
    assert findings.from_verdicts(allowed.verdicts, listing) == findings.from_verdicts(left.verdicts, listing)
    assert allowed.deviation.not_reached_area < first.deviation.not_reached_area, "0.3 mm are left"
    again = checks.run(job, 0.5, 1.0, lambda done: False)
    assert findings.from_verdicts(wide.verdicts, listing) == findings.from_verdicts(again.verdicts, listing)
    assert wide.deviation.gouge_area < first.deviation.gouge_area
    without = checks.run(native.to_job(make()[0]), 0.5, 0.05, lambda done: False)
    assert checks.judge(without, 0.4, lambda done: False) is without and without.deviation is None


def test_stopping_at_the_first_error(swarf):
    from swarf_cam import checks

    for design in (None, box_mesh(LO, HI)):
        data, listing = make(design)
        job, told = native.to_job(data), []
        stopped = checks.run(job, 0.5, 0.05, told.append, stop=True)
        assert stopped.stopped and stopped.deviation is None
        assert [item.kind for item in stopped.verdicts if item.severity == "error"] == ["rapid"]
        assert told == sorted(told)
    data, listing = make(box_mesh(LO, HI))
    data.operations = data.operations[1:]  # the slot alone, nothing collides
    data.moves = program.build(data.operations)
    told = []
    whole = checks.run(native.to_job(data), 0.5, 0.05, told.append, stop=True)
    assert not whole.stopped and whole.deviation is not None and told == sorted(told)


def test_an_error_that_is_accepted_stops_nothing(swarf):
    from swarf_cam import checks

    for design in (None, box_mesh(LO, HI)):
        data, _ = make(design)
        data.accepted = [{"reason": "it is air there", "kind": "rapid"}]
        job = native.to_job(data)
        outcome = checks.run(job, 0.5, 0.05, lambda done: False, stop=True)
        assert not outcome.stopped and (outcome.deviation is not None) == (design is not None)
        assert [item.accepted for item in outcome.verdicts if item.kind == "rapid"] == ["it is air there"]
        whole = checks.run(job, 0.5, 0.05, lambda done: False)
        assert [item.text for item in outcome.verdicts] == [item.text for item in whole.verdicts]


def test_loose_pieces_are_found_without_a_design(swarf):
    from swarf_cam import checks

    data, listing = make()
    assert not [item for item in run(data, listing) if item.kind == "loose"]
    # through the block, across
    operations = data.operations
    operations[1] = program.Operation("Slot", [Command(line) for line in (
        "G0 X10 Y-5 Z5", "G0 Z-12", "G1 Y30 F10", "G0 Z5")], 1, "a")
    data.moves = program.build(operations)
    listing = Listing(data.moves, operations)
    loose, = [item for item in run(data, listing) if item.kind == "loose"]
    assert listing.operations[loose.operation].name == "Slot" and loose.severity == "warning"
    assert checks.run(native.to_job(data), 0.5, 0.05, lambda done: False, stop=True).stopped


def test_an_acceptance_knows_its_finding_and_no_worse_one(swarf):
    from swarf_cam import checks

    data, listing = make(box_mesh(LO, HI))
    job = native.to_job(data)
    outcome = checks.run(job, 0.5, 0.05, lambda done: False)
    for verdict in outcome.verdicts:
        entry = findings.acceptance(verdict, "seen", 0.5)
        known, = native.to_accepted("Job", [entry])
        assert [item for item in outcome.verdicts if known.knows(item)] == [verdict], entry
        if "most" in entry:
            worse = SimpleNamespace(**dict(vars(verdict), amount=1.2 * verdict.amount))
            assert not known.knows(worse)
        if verdict.kind in findings.DEVIATIONS:
            other = SimpleNamespace(**dict(vars(verdict), allowance=0.1))
            assert not known.knows(other), "over an allowance it is another finding"
    gouge = next(item for item in outcome.verdicts if item.kind == "gouge")
    entries = native.to_accepted("Job", [findings.acceptance(gouge, "meant so", 0.5)])
    settled = checks.accept(outcome, entries)
    found = findings.from_verdicts(settled.verdicts, listing)
    assert found[-1].accepted == "meant so" and found[-1].severity == "note" and gouge.accepted is None
    assert found[-1] not in findings.worst_places(found, 9)
    assert found[-1].text not in [text for _, _, text in findings.marks(found)
                                  if sum(text == item.text for item in found) == 1]
    idle = checks.accept(checks.accept(outcome, native.to_accepted("Job", [{"reason": "x", "kind": "load"}])), entries)
    assert len(idle.verdicts) == len(outcome.verdicts), "a note on an idle acceptance goes with it"
    assert findings.kinds(found) == list(dict.fromkeys(item.kind for item in found))


def test_the_histogram_is_on_the_scale_of_the_legend(swarf):
    from swarf_cam import checks
    from swarf_cam.core import histogram

    data, _ = make(box_mesh(LO, (40.0, 20.0, -0.3)))
    outcome = checks.run(native.to_job(data), 0.5, 1.0, lambda done: False)
    shown = histogram.of(outcome.deviation, 1.0)
    top = max(range(len(shown.areas)), key=shown.areas.__getitem__)
    assert shown.bounds(top)[0] <= 1e-9 and shown.bounds(top)[1] >= -1e-9, "sides and bottom fit"
    # the slot's floor less a voxel and a half at its edges, with what the walls have at that depth
    at = next(i for i in range(len(shown.areas)) if shown.bounds(i)[0] < -1.7 <= shown.bounds(i)[1])
    assert (6 - 1.5) * (40 - 1.5) < sum(shown.areas[at - 1:at + 2]) < 6 * 40 + 3 * 0.125 * (2 * 40 + 6 * math.pi)
    assert shown.bounds(0)[0] == -math.inf and shown.bounds(len(shown.areas) - 1)[1] == math.inf
    assert max(shown.heights()) == 1.0 and min(shown.heights()) == 0.0
    assert shown.heights()[at] == pytest.approx(math.sqrt(shown.areas[at] / max(shown.areas)))


def test_order_marks_and_counts():
    listing = SimpleNamespace(begin=[0, 5, 9], line_of=lambda move: move // 5, operation_at=lambda move: 0)
    verdicts = [SimpleNamespace(severity=severity, text=severity, kind=kind, move=move, t=0.5, place=point,
                                amount=amount, accepted=None)
                for severity, kind, move, point, amount in (
                    ("note", "design", -1, None, None), ("warning", "not reached", 2, (1, 1, 1), 4.0),
                    ("error", "rapid", 7, (1, 2, 3), 0.2), ("error", "gouge", 3, (0, 0, 0), -0.5))]
    found = findings.from_verdicts(verdicts, listing)
    assert [(item.severity, item.place, item.line) for item in found] == [
        ("error", 4.0, 0), ("error", 7.5, 1), ("warning", 9.0, 0), ("note", None, -1)]
    assert [mark[:2] for mark in findings.marks(found)] == [(4.0, "error"), (7.5, "error"), (9.0, "warning")]
    assert findings.counts(found) == {"error": 2, "warning": 1, "note": 1}
    assert [item.kind for item in findings.worst_places(found, 5)] == ["not reached", "gouge"]
    verdicts[2].accepted = "the old clamp"
    found = findings.from_verdicts(verdicts, listing)
    assert findings.counts(found) == {"error": 1, "warning": 1, "note": 2} and found[-1].accepted == "the old clamp"
    together = [Finding("error", "a", place=1.0), Finding("note", "b", place=1.0)]
    assert [mark[1] for mark in findings.marks(together)] == ["note", "error"], "the worst is drawn last"
    overview = findings.from_overview([(3.0, "warning", "w"), (7.0, "error", "e")], listing)
    assert [(item.text, item.line) for item in overview] == [("e", 1), ("w", 0)]


@pytest.mark.parametrize("perspective", (False, True))
def test_approach_brings_a_place_to_the_middle(swarf, perspective):
    camera = swarf.Camera.view("isometric", (LO, HI), 4 / 3, perspective=perspective)
    point = (35.0, 3.0, -2.0)
    navigation.approach(camera, point, 4 / 3, 10.0)
    x, y, _ = camera.project(point, 4 / 3)
    assert math.hypot(x, y) < 1e-6
    assert navigation.shown_height(camera, point) == pytest.approx(10.0)
    navigation.approach(camera, point, 4 / 3, 20.0)  # nearer already: stays
    assert navigation.shown_height(camera, point) == pytest.approx(10.0)


@pytest.mark.parametrize("tolerance", (0.001, 0.05, 2.0))
def test_the_legend_spans_four_tolerances(tolerance):
    for share in (0.0, 0.25, 0.5, 0.9, 1.0):
        assert legend.share_of(legend.value_at(share, tolerance), tolerance) == pytest.approx(share)
    assert legend.value_at(1.0, tolerance) == pytest.approx(4 * tolerance)
    assert legend.share_of(99 * tolerance, tolerance) == 1.0 and legend.share_of(-99 * tolerance, tolerance) == 0.0
    marks = legend.ticks(tolerance)
    assert [share for share, _ in marks] == sorted((share for share, _ in marks), reverse=True)
    assert all(value == pytest.approx(legend.value_at(share, tolerance)) for share, value in marks)


def test_a_tinted_frame_holds_the_deviations(swarf):
    from swarf_cam import session as sessions

    data, listing = make(box_mesh(LO, (40.0, 20.0, -0.3)))
    watched = sessions.Session(data, 0.5, lambda done: False)
    camera = swarf.Camera.view("top", watched.box, 4 / 3)
    view = sessions.View(camera, 200, 150, tolerance_mm=0.1, show_cutter=False)
    sharp, moving = watched.draw(view, 0.0, None), watched.draw(view, 0.0, 1e-3)
    assert (sharp.width, sharp.height) == (200, 150) and moving.width < 200, "fewer rays while things move"
    for frame in (sharp, moving):
        middle = frame.values[frame.height // 2, frame.width // 2]
        assert middle == pytest.approx(0.3, abs=0.01) and math.isnan(frame.values[0, 0])
    assert watched.draw(sessions.View(camera, 200, 150), 0.0, None).values is None
    assert watched.pick(view, 0.0, 0.0, 0).deviation == pytest.approx(0.3, abs=0.01)
    allowed = dataclasses.replace(view, allowance_mm=0.25)
    assert watched.draw(allowed, 0.0, None).values[75, 100] == pytest.approx(0.05, abs=0.01)
    assert watched.pick(allowed, 0.0, 0.0, 0).deviation == pytest.approx(0.05, abs=0.01)
    # the slot's floor, 2 mm deep
    while watched.step(len(data.moves), 1.0) != len(data.moves):
        pass
    x, y, _ = camera.project((20, 5, -2), 4 / 3)
    assert watched.pick(view, x, y, len(data.moves)).deviation == pytest.approx(-1.7, abs=0.02)


def test_the_set_up_before_is_shown_exactly(swarf):
    from swarf_cam import session as sessions

    before, _ = make()
    operations = [program.Operation("Across", [Command(line) for line in ("G0 X-5 Y15", "G0 Z-1", "G1 X45 F10")], 1,
                                    "a", [Command("M6 T1"), Command("M3 S1000")])]
    data = dataclasses.replace(before, name="Next", moves=program.build(operations), operations=operations,
                               stock={"kind": "result", "job": before})
    watched = sessions.Session(data, 0.5, lambda done: False)
    camera = swarf.Camera.view("top", watched.box, 4 / 3)
    view = sessions.View(camera, 400, 300, (("colouring", "operation"), ("selected", (0, len(data.moves)))))
    end = float(len(data.moves))
    while watched.step(end, 1.0) != end:
        pass
    for y, bottom, made in ((5, -2, False), (8 - 1e-3, -2, None), (8 + 1e-3, 0, None), (10, 0, False),
                            (12 - 1e-3, 0, None), (12 + 1e-3, -1, True)):
        x, y, _ = camera.project((10, y, bottom), 4 / 3)
        found = watched.pick(view, x, y, end)
        assert found.point[2] == pytest.approx(bottom, abs=1e-6), found
        assert made is None or (found.move >= 0, found.line >= 0) == (made, made), found
    # what this set-up cut has its operation's colour, what the one before cut has not
    picture = watched.draw(view, end, None)

    def colour(y, z):
        x, y, _ = camera.project((10, y, z), 4 / 3)
        at = 4 * (int((1 - y) / 2 * 300) * 400 + int((x + 1) / 2 * 400))
        return picture.rgba[at:at + 3]
    assert colour(5, -2) != colour(15, -1) and max(colour(5, -2)) - min(colour(5, -2)) < 40, "as the stock's own face"


def test_design_and_both_in_the_picture(swarf, tmp_path):
    """The design alone, half of each, the same in a file; without a design there is only the stock."""
    from swarf_cam import session as sessions
    from swarf_cam.core import pixels

    data, _ = make(box_mesh(LO, (20.0, 20.0, 0.0)))  # the left half of the stock
    watched = sessions.Session(data, 0.5, lambda done: False)
    camera = swarf.Camera.view("top", watched.box, 2.0)

    def frame(shown, place=0.0):
        return watched.draw(sessions.View(camera, 160, 80, shown=shown, show_cutter=False), place, None)

    def pixel(image, share):
        at = 4 * (40 * 160 + int(share * 160))
        return tuple(image.rgba[at:at + 3])
    stock, design, both = (frame(shown) for shown in (sessions.STOCK, sessions.DESIGN, sessions.BOTH))
    background = pixel(stock, 0.02)
    assert pixel(stock, 0.7) != background and pixel(design, 0.7) == background and pixel(design, 0.3) != background
    assert math.isinf(design.depth[40, 112]) and math.isfinite(both.depth[40, 112])
    for share in (0.02, 0.3, 0.7):
        halves = [(a + b) / 2 for a, b in zip(pixel(stock, share), pixel(design, share))]
        assert all(abs(a - b) <= 0.5 for a, b in zip(pixel(both, share), halves))
    path = str(tmp_path / "both.png")
    watched.write_png(path, sessions.View(camera, 160, 80, shown=sessions.BOTH, show_cutter=False), 0.0)
    data = (tmp_path / "both.png").read_bytes()
    size = int.from_bytes(data[33:37], "big")
    assert data[:8] == b"\x89PNG\r\n\x1a\n" and data[37:41] == b"IDAT"
    rows = zlib.decompress(data[41:41 + size])
    assert b"".join(rows[row * 641 + 1:(row + 1) * 641] for row in range(80)) == both.rgba
    view = sessions.View(camera, 160, 80, shown=sessions.DESIGN)
    assert watched.pick(view, 0.0, 0.0, 0) is None, "the stock is not seen"
    assert pixels.blend(bytes((0, 255, 1, 254)), bytes((255, 255, 2, 255))) == bytes((127, 255, 1, 254))
    bare = sessions.Session(make()[0], 0.5, lambda done: False)
    view = sessions.View(camera, 160, 80, shown=sessions.BOTH, show_cutter=False)
    assert bare.draw(view, 0.0, None).rgba == stock.rgba
