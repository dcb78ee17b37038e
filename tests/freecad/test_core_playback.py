# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel's logic without Qt and FreeCAD: clock, listing, transport, playback, engine, navigation, cube."""

import itertools
import math
import os
import random
import string
import subprocess
import sys
import xml.etree.ElementTree
import threading

import pytest
from conftest import ADDON
from swarf_cam import native
from swarf_cam.core import listing as listings
from swarf_cam.core import navigation, program, transport, viewcube
from swarf_cam.core.clock import Clock, text_of
from swarf_cam.core.engine import Engine
from swarf_cam.core.job import JobData
from swarf_cam.core.section import Section
from test_core_program import Command

# More than anything takes on the busiest machine.
WAIT_SECONDS = 240


def operations():
    """Two operations with two tools: a slot with an arc, and a hole."""
    tools = [[Command("(tool)"), Command("M6 T%d" % number), Command("M3 S1000")] for number in (1, 2)]
    slot = ["(slot)", "G0 X-5 Y10 Z5", "G0 Z-2", "G1 X10 F10", "G2 X20 Y10 I5 J0", "G1 X45", "G4 P2", "G0 Z5"]
    hole = ["G0 X20 Y5", "G81 X20 Y5 Z-8 R1 F5", "G81 X30", "G80", "G0 Z20"]
    return [program.Operation("Slot", [Command(line) for line in slot], 1, "a", tools[0]),
            program.Operation("Hole", [Command(line) for line in hole], 2, "b", tools[1])]


@pytest.fixture
def table():
    return program.build(operations())


def test_clock_agrees_with_the_native_one(swarf, table):
    clock = Clock(table, rapid_mm_min=3000)
    assert clock.seconds == pytest.approx(table.play(swarf.Program()).seconds(3000), rel=1e-6)
    # by hand: 15 mm and 25 mm at 600 mm/min, a half circle of 5 mm, a dwell
    feeds = (15 + 25 + 5 * math.pi) / 10 + 2
    moves = [i for i in range(len(table)) if table.sections[int(table.row(i)[2])][1] == 0]
    rapids = (7 + 7) / 50
    assert clock.time_of(moves[-1] + 1) == pytest.approx(feeds + rapids)


def test_clock_goes_there_and_back(table):
    clock = Clock(table)
    assert clock.place_at(-1) == 0 and clock.time_of(-1) == 0
    assert clock.place_at(clock.seconds + 1) == len(clock) == len(table)
    rng = random.Random(7)
    for _ in range(200):
        seconds = rng.uniform(0, clock.seconds)
        assert clock.time_of(clock.place_at(seconds)) == pytest.approx(seconds, abs=1e-9)
    places = sorted(rng.uniform(0, len(clock)) for _ in range(50))
    times = [clock.time_of(place) for place in places]
    assert times == sorted(times)


def test_tip_follows_lines_and_arcs(table):
    clock = Clock(table)
    arc = next(i for i in range(len(table)) if table.row(i)[0] == 1)
    assert clock.tip_at(0) is None
    assert clock.tip_at(arc) == pytest.approx((10, 10, -2))
    assert clock.tip_at(arc + 0.5) == pytest.approx((15, 15, -2))  # clockwise from the left end: over the top
    assert clock.tip_at(arc + 1) == pytest.approx((20, 10, -2))
    assert clock.tip_at(arc + 1.5) == pytest.approx((32.5, 10, -2))
    assert clock.tip_at(len(table)) == pytest.approx((30, 5, 20))


def test_full_circle_and_helix():
    table = program.build([program.Operation("Helix", [Command(line) for line in (
        "G0 X5 Y0 Z0", "G3 X5 Y0 Z-4 I-5 J0 P2 F10")], 1)])
    clock = Clock(table)
    assert clock.tip_at(len(table) - 1 + 0.25) == pytest.approx((-5, 0, -1))
    assert clock.seconds == pytest.approx(math.hypot(4 * math.pi * 5, 4) / 10)


def test_times_for_people():
    assert [text_of(value) for value in (0, 59.4, 61, 3723)] == ["0:00", "0:59", "1:01", "1:02:03"]


def test_listing_finds_lines_and_moves(table):
    listing = listings.Listing(table, operations())
    texts = [listing.text(line) for line in range(len(listing))]
    assert texts[:5] == ["Slot", "(tool)", "M6 T1", "M3 S1000", "(slot)"]
    assert "G2 X20 Y10 I5 J0" in texts and "G81 X30" in texts and "G1 X10 F600" in texts
    assert listing.begin[0] == 0 and listing.begin[-1] == len(table)
    assert listing.begin == sorted(listing.begin)
    for move in range(len(table)):
        line = listing.line_of(move)
        first, end = listing.moves_of(line)
        assert first <= move < end
        assert abs(listing.number[line]) == table.row(move)[3]
        assert listing.operation[line] == listing.operation_at(move) == table.sections[int(table.row(move)[2])][1]
    cycle = texts.index("G81 X30")
    assert listing.moves_of(cycle)[1] - listing.moves_of(cycle)[0] >= 3


def test_listing_steps(table):
    listing = listings.Listing(table, operations())
    place, seen = 0.0, []
    while place < len(table):
        place = listing.next_line(place)
        seen.append(place)
    assert seen == sorted(set(seen)) and seen[-1] == len(table)
    back = []
    while place > 0:
        place = listing.previous_line(place)
        back.append(place)
    assert back == [0.0 if value == 0 else value for value in reversed([0.0] + seen[:-1])]
    second = float(listing.operation_begin[1])
    assert listing.next_operation(0.0) == second and listing.next_operation(second) == len(table)
    assert listing.previous_operation(second + 1) == second and listing.previous_operation(second) == 0.0


def test_words_as_a_machinist_reads_them():
    assert listings.text_of("G1", {"Y": -0.00001, "X": 1.25, "F": 10.0}) == "G1 X1.25 Y0 F600"
    assert listings.text_of("G0", {"F": 0.0, "Z": 100.0}) == "G0 Z100"
    assert listings.text_of("(a comment)", {}) == "(a comment)"


def play_on(player, seconds, lag=0):
    """Tick with the cutting `lag` ticks behind; places wanted."""
    wanted = []
    for tick in range(int(seconds / 0.05)):
        wanted.append(player.tick(0.05))
        if tick >= lag:
            player.arrived(wanted[tick - lag])
        if not player.playing:
            break
    return wanted


def test_transport_obeys_the_clock(table):
    clock = Clock(table)
    player = transport.Transport(clock, {})
    player.set_speed(2.0)
    player.play()
    play_on(player, 1.0)
    assert player.time == pytest.approx(2.0, abs=0.2)
    player.pause()
    at = player.at
    assert player.tick(1.0) == at and not player.playing
    player.set_speed(transport.AS_FAST_AS_POSSIBLE)
    player.play()
    assert player.tick(0.05) == len(table)
    player.arrived(float(len(table)))
    assert not player.playing
    player.play()
    assert player.playing and player.tick(0.0) == 0 and player.at == len(table)


def test_transport_waits_for_the_cutting(table):
    player = transport.Transport(Clock(table), {})
    player.set_speed(1.0)
    player.play()
    for _ in range(100):
        player.tick(0.05)  # nothing arrives: five seconds go by
    assert player.clock.time_of(player.wanted) <= transport.LEAD_SECONDS + 0.1


def test_transport_stops_where_told(table):
    listing = listings.Listing(table, operations())
    second = float(listing.operation_begin[1])
    for speed in (50.0, transport.AS_FAST_AS_POSSIBLE):
        player = transport.Transport(Clock(table), {transport.STOP_OPERATION: [second, float(len(table))]})
        player.set_speed(speed)
        player.enabled = {transport.STOP_OPERATION}
        player.play()
        play_on(player, 10)
        assert player.at == second and not player.playing
        player.play()
        play_on(player, 10)
        assert player.at == len(table) and not player.playing


def test_a_late_picture_of_the_end_does_not_stop_what_begins_again(table):
    player = transport.Transport(Clock(table), {})
    player.seek(len(table))
    player.arrived(float(len(table)))
    player.play()
    player.tick(0.05)
    player.arrived(float(len(table)))
    assert player.playing


def test_playing_again_from_the_end_begins_at_the_beginning(table):
    player = transport.Transport(Clock(table), {})
    player.set_speed(transport.AS_FAST_AS_POSSIBLE)
    player.seek(player.end)
    player.arrived(player.end)
    player.play()
    assert player.tick(0.05) == 0 and player.tick(0.05) == 0
    player.arrived(0.0)
    assert player.tick(0.05) == player.end
    player.arrived(player.end)
    assert not player.playing


def test_a_stop_where_playing_begins_does_not_end_it(table):
    second = float(listings.Listing(table, operations()).operation_begin[1])
    player = transport.Transport(Clock(table), {transport.STOP_OPERATION: [second]})
    player.enabled = {transport.STOP_OPERATION}
    player.seek(second)
    player.arrived(second)
    player.play()
    player.arrived(second)  # the same picture, sharper
    assert player.playing


def job_data(table):
    flat = [("flutes", [(0, 0, 0), (3, 0, 0), (3, 20, 0), (0, 20, 0)])]
    return JobData("Job", table, {1: ("Mill", flat), 2: ("Drill", flat)},
                   {"kind": "box", "lo": (0, 0, -10), "hi": (40, 20, 0)}, operations=operations())


@pytest.fixture
def session(swarf, table):
    from swarf_cam import session as sessions

    return sessions.Session(job_data(table), 0.5, lambda done: False)


def go(session, place):
    """Stand at a move."""
    for _ in range(10000):
        if session.step(place, 0.01) == place:
            return session._playback.stock
    raise AssertionError("never there")


def test_any_way_to_a_place_gives_the_same_stock(swarf, session, table):
    job = native.to_job(job_data(table))
    rng = random.Random(11)
    places = [rng.randrange(len(table)) + rng.choice((0.0, 0.25, 0.7)) for _ in range(25)] + [0.0, float(len(table))]
    for place in places:
        fresh = swarf.Stock.box((0, 0, -10), (40, 20, 0), 0.5)
        swarf.History(fresh, job.program, job.tools).seek(int(place), place - int(place))
        assert go(session, place).hash() == fresh.hash(), place


def test_the_stock_follows_the_cutter_within_a_move(session, table):
    long = max(range(len(table)), key=lambda index: session.overview.removed and session.clock.time_of(index + 1) -
               session.clock.time_of(index))
    volumes = [go(session, long + part).volume() for part in (0.0, 0.25, 0.5, 0.75, 1.0, 0.5)]
    assert volumes[:5] == sorted(volumes[:5], reverse=True) and volumes[0] > volumes[4]
    assert volumes[5] == volumes[2]


def test_overview_is_the_whole_program(swarf, session, table):
    job = native.to_job(job_data(table))
    fresh = swarf.Stock.box((0, 0, -10), (40, 20, 0), 0.5)
    done = fresh.simulate(job.program, job.tools)
    assert session.overview.removed == pytest.approx(list(done.removed_by_operation), rel=1e-6, abs=1e-6)
    assert session.overview.volume_final == pytest.approx(done.volume_final)
    assert session.overview.findings == [] and len(session.tool_changes) == 2


def test_a_missing_tool_is_found(swarf, table):
    from swarf_cam import session as sessions

    data = job_data(table)
    del data.tools[2]
    found = sessions.Session(data, 1.0, lambda done: False)
    assert [severity for _, severity, _ in found.overview.findings] == ["error"]
    assert found.stops[transport.STOP_FINDING] == [found.overview.findings[0][0]]
    go(found, len(table))


def test_pick_tells_the_line(swarf, session, table):
    from swarf_cam import session as sessions

    camera = swarf.Camera.view("top", session.box, 4 / 3)
    view = sessions.View(camera, 400, 300)
    go(session, len(table))
    for point, expected in (((15, 15, -2), "G2 X20 Y10 I5 J0"), ((30, 10, -2), "G1 X45 F600"), ((30, 4, -8), "G81 X30"),
                            ((3, 3, 0), None)):
        x, y, _ = camera.project(point, 4 / 3)
        found = session.pick(view, x, y, len(table))
        assert found.point == pytest.approx(point, abs=0.3)
        if expected is None:
            assert found.move == -1
        else:
            assert session.listing.text(found.line).split(" F")[0] == expected.split(" F")[0]
            assert found.depth_below_top == pytest.approx(-point[2], abs=0.05)
    assert session.pick(view, 0.999, 0.999, len(table)) is None


def test_pick_beside_a_wall_names_no_neighbour(swarf, session, table):
    from swarf_cam import session as sessions

    go(session, len(table))
    camera = swarf.Camera.view("top", session.box, 4 / 3)
    view = sessions.View(camera, 400, 300)
    for x, y, _ in (camera.project((35, 13 + away, 0), 4 / 3) for away in (0.05, 0.1, 0.2)):  # the slot ends at y 13
        assert session.pick(view, x, y, len(table)).move == -1
    x, y, _ = camera.project((35, 12.95, -2), 4 / 3)
    found = session.pick(view, x, y, len(table))
    assert found.point[2] == pytest.approx(-2, abs=1e-3) and session.listing.text(found.line).startswith("G1 X45")


def test_pick_of_a_picture_that_the_stock_is_past(swarf, session, table):
    from swarf_cam import session as sessions

    camera = swarf.Camera.view("top", session.box, 4 / 3)
    view = sessions.View(camera, 400, 300)
    x, y, _ = camera.project((35, 10, 0), 4 / 3)
    go(session, len(table))
    assert session.pick(view, x, y, 0).point[2] == pytest.approx(0, abs=1e-3), "nothing was cut in that picture"
    assert session.at == 0
    assert session.pick(view, x, y, len(table)).point[2] == pytest.approx(-2, abs=1e-3)


def test_pick_knows_the_move_that_is_being_cut(swarf, session, table):
    from swarf_cam import session as sessions

    place = next(i for i in range(len(table)) if session.listing.text(session.listing.line_of(i)) == "G1 X45") + 0.5
    camera = swarf.Camera.view("top", session.box, 4 / 3)
    view = sessions.View(camera, 400, 300)
    go(session, place)  # the tool stands at x 32.5
    for point, expected in (((30, 10, -2), "G1 X45"), ((34.5, 10, -2), "G1 X45"), ((15, 15, -2), "G2 X20 Y10 I5 J0"),
                            ((18.9, 10, -2), "G2 X20 Y10 I5 J0"), ((38, 10, 0), None)):
        x, y, _ = camera.project(point, 4 / 3)
        found = session.pick(view, x, y, place)
        assert session.at == place and found.point == pytest.approx(point, abs=0.05)
        assert (session.listing.text(found.line) if found.move >= 0 else None) == expected


def test_a_pick_can_be_broken_off(swarf, session, table):
    from swarf_cam import session as sessions

    camera = swarf.Camera.view("top", session.box, 4 / 3)
    view = sessions.View(camera, 400, 300)
    x, y, _ = camera.project((35, 10, 0), 4 / 3)
    with pytest.raises(swarf.Cancelled):
        session.pick(view, x, y, len(table), lambda done: True)
    assert session.at < len(table)
    assert session.pick(view, x, y, len(table), lambda done: False).point[2] == pytest.approx(-2, abs=1e-3)


def test_a_picture_for_a_file_is_of_its_place(swarf, session, table, tmp_path):
    from swarf_cam import session as sessions

    view = sessions.View(swarf.Camera.view("top", session.box, 4 / 3), 80, 60, show_cutter=False)
    for name, stand in (("here", 0), ("there", len(table))):
        go(session, stand)
        session.write_png(str(tmp_path / name), view, 0.0)
    assert (tmp_path / "here").read_bytes() == (tmp_path / "there").read_bytes()


def test_a_late_picture_does_not_hide_a_stop(table):
    second = float(listings.Listing(table, operations()).operation_begin[1])
    player = transport.Transport(Clock(table), {transport.STOP_OPERATION: [second]})
    player.enabled = {transport.STOP_OPERATION}
    player.set_speed(transport.AS_FAST_AS_POSSIBLE)
    player.arrived(float(len(table)))
    player.play()
    player.tick(0.05)
    player.arrived(float(len(table)))
    assert player.tick(0.05) == 0 and player.playing, "where playing begins has not been shown yet"
    player.arrived(0.0)
    assert player.tick(0.05) == second
    player.arrived(0.0)
    assert player.tick(0.05) == second and player.playing
    player.arrived(second)
    assert not player.playing


def test_a_late_picture_does_not_move_who_pauses(table):
    player = transport.Transport(Clock(table), {})
    player.set_speed(transport.AS_FAST_AS_POSSIBLE)
    for before, begin in ((player.end, 1.0), (0.0, 2.0)):
        player.arrived(before)
        player.seek(begin)
        player.play()
        assert player.tick(0.05) == begin, "nothing is wanted before a picture of the place that was sought"
        player.set_speed(player.speed)
        assert player.wanted == begin
        player.pause()
        assert player.wanted == begin and not player.playing
    player.play()
    player.arrived(2.0)
    player.tick(0.05)
    player.arrived(5.0)
    player.pause()
    assert player.wanted == 5.0


class Listener:
    """Keeps what an engine tells."""

    def __init__(self):
        self.frames, self.errors, self.opened_with = [], [], None
        self.end, self.changed = threading.Event(), threading.Condition()

    def opened(self, session):
        self.opened_with = session

    def progress(self, fraction):
        pass

    def failed(self, error):
        with self.changed:
            self.errors.append(error)
            self.changed.notify()

    def frame(self, frame):
        with self.changed:
            self.frames.append(frame)
            self.changed.notify()

    def finished(self):
        self.end.set()

    def wait(self, condition):
        """Until a condition on what was told holds."""
        with self.changed:
            assert self.changed.wait_for(condition, WAIT_SECONDS)


class Cancelled(Exception):
    pass


class FakeSession:
    """Counts what the engine asks for. refining: set when it begins to draw sharp; endless: which then ends only by
    being broken off."""

    def __init__(self):
        self.at, self.steps, self.broken_off = 0, 0, 0
        self.exact = []
        self.refining, self.endless = threading.Event(), False

    def step(self, move, seconds, progress=None):
        if move == 13:
            raise MemoryError("full")
        self.steps += 1
        self.at = min(self.at + 10, move) if move > self.at else move
        return self.at

    def draw(self, view, place, budget_ms, progress, rays):
        if budget_ms is None and rays == 1:
            self.exact.append(place)
        elif budget_ms is None:
            self.refining.set()
            while self.endless:
                threading.Event().wait(0.001)
                if progress(0):
                    self.broken_off += 1
                    raise Cancelled
        return view, place, budget_ms is None and rays > 1


def running(session):
    listener = Listener()
    engine = Engine(lambda progress: session, listener, Cancelled)
    engine.start()
    return engine, listener


def test_engine_goes_to_the_newest_wish_and_refines_it():
    session = FakeSession()
    engine, listener = running(session)
    engine.wish(35.5, "view")
    listener.wait(lambda: ("view", 35.5, True) in listener.frames)
    places = [place for _, place, _ in listener.frames]
    assert places == sorted(places) and session.steps >= 4, "it shows what lies between"
    assert session.exact == [35.5], "with one ray a pixel first: edges are sharp soon"
    engine.wish(5.0)
    listener.wait(lambda: ("view", 5.0, True) in listener.frames)
    engine.wish(view="other")
    listener.wait(lambda: ("other", 5.0, False) in listener.frames)
    engine.wish(view="third")
    listener.wait(lambda: ("third", 5.0, True) in listener.frames)
    engine.stop()
    assert engine.join(WAIT_SECONDS) and listener.end.is_set() and not listener.errors


def test_engine_breaks_off_refining_for_something_newer():
    session = FakeSession()
    session.endless = True
    engine, listener = running(session)
    engine.wish(view="first")
    assert session.refining.wait(WAIT_SECONDS)
    session.refining.clear()
    engine.wish(view="second")
    listener.wait(lambda: any(frame[0] == "second" for frame in listener.frames))
    assert session.broken_off == 1
    assert session.refining.wait(WAIT_SECONDS)
    answers = []
    engine.call(lambda session, progress: session.broken_off, lambda result, error: answers.append(result))
    engine.wish(view="third")
    listener.wait(lambda: any(frame[0] == "third" for frame in listener.frames))
    assert answers == [2], "nor does a call wait for it"
    session.endless = False
    listener.wait(lambda: listener.frames[-1][0] == "third" and listener.frames[-1][2])
    session.endless = True
    session.refining.clear()
    engine.wish(view="last")
    assert session.refining.wait(WAIT_SECONDS)
    engine.stop()
    assert engine.join(WAIT_SECONDS) and session.broken_off >= 3 and not listener.errors


def test_engine_breaks_off_the_call_that_is_meant():
    session = FakeSession()
    engine, listener = running(session)
    begun, go_on, answers = threading.Event(), threading.Event(), []

    def wait(name):
        def function(_, progress):
            begun.set()
            assert go_on.wait(WAIT_SECONDS)
            if progress(0.5):
                raise Cancelled
            return name
        return function
    calls = [engine.call(wait(name), lambda result, error: answers.append(result or type(error))) for name in "abcd"]
    assert begun.wait(WAIT_SECONDS)
    calls[0].cancel()
    calls[2].cancel()  # not begun yet
    go_on.set()
    engine.wish(view="view")
    listener.wait(lambda: listener.frames)
    assert answers == [Cancelled, "b", Cancelled, "d"]
    engine.stop()
    assert engine.join(WAIT_SECONDS)


def test_engine_goes_back_to_the_wish_from_where_a_call_left_the_stock():
    session = FakeSession()
    engine, listener = running(session)
    engine.wish(35.0, "view")
    listener.wait(lambda: ("view", 35.0, True) in listener.frames)
    steps = session.steps
    engine.call(lambda session, progress: setattr(session, "at", 5.0), lambda result, error: None)
    listener.wait(lambda: listener.frames.count(("view", 35.0, True)) == 2)
    assert session.at == 35.0 and session.steps == steps + 3, "15, 25, 35"
    # where it was left at what is wished now it stays
    steps = session.steps
    engine.call(lambda session, progress: (setattr(session, "at", 12.0), engine.wish(12.0)), lambda result, error: None)
    listener.wait(lambda: ("view", 12.0, True) in listener.frames)
    assert session.steps == steps + 1
    engine.stop()
    assert engine.join(WAIT_SECONDS) and not listener.errors


def test_engine_tells_an_error_once_and_goes_on():
    session = FakeSession()
    engine, listener = running(session)
    engine.wish(13.0, "view")
    listener.wait(lambda: listener.errors)
    threading.Event().wait(0.2)
    assert len(listener.errors) == 1 and isinstance(listener.errors[0], MemoryError)
    engine.wish(20.0)
    listener.wait(lambda: ("view", 20.0, True) in listener.frames)
    answers = []
    engine.call(lambda *_: 1 / 0, lambda result, error: answers.append(error))
    engine.call(lambda session, progress: session.at, lambda result, error: answers.append(result))
    engine.wish(21.0)
    listener.wait(lambda: ("view", 21.0, True) in listener.frames)
    assert isinstance(answers[0], ZeroDivisionError) and answers[1] == 20
    engine.stop()
    assert engine.join(WAIT_SECONDS)


def test_engine_that_cannot_open_says_so():
    def fail(progress):
        raise MemoryError("no room")

    listener = Listener()
    engine = Engine(fail, listener, Cancelled)
    engine.start()
    assert engine.join(WAIT_SECONDS) and listener.end.is_set()
    assert [str(error) for error in listener.errors] == ["no room"]


def test_navigation_styles():
    cad, blender = "Gui::CADNavigationStyle", "Gui::BlenderNavigationStyle"
    assert navigation.action(cad, {"middle"}, ()) == navigation.PAN
    assert navigation.action(cad, {"middle", "left"}, ()) == navigation.ORBIT
    assert navigation.action(blender, {"middle"}, ()) == navigation.ORBIT
    assert navigation.action(blender, {"middle"}, {"shift"}) == navigation.PAN
    for style in [*navigation.STYLES, "one that comes with a later FreeCAD"]:
        done = {navigation.action(style, {button}, keys) for button in ("left", "middle", "right")
                for keys in ((), {"shift"}, {"ctrl"}, {"alt"})}
        assert {navigation.ORBIT, navigation.PAN} <= done, style
        assert navigation.action(style, (), ()) is None


def test_point_under_the_mouse(swarf):
    for perspective in (False, True):
        camera = swarf.Camera.view("isometric", ((0, 0, 0), (40, 30, 20)), 1.5, perspective=perspective)
        point = (12.0, 7.0, 20.0)
        x, y, depth = camera.project(point, 1.5)
        assert navigation.point_at(camera, x, y, 1.5, depth) == pytest.approx(point, abs=1e-9)
        navigation.centre(camera, point, 1.5)
        assert camera.project(point, 1.5)[:2] == pytest.approx((0, 0), abs=1e-9)


def test_cube(swarf):
    box = ((0, 0, 0), (40, 30, 20))
    for name, normal in viewcube.FACES.items():
        camera = swarf.Camera.view(name, box)
        assert [face for face, _, _ in viewcube.faces(camera)] == [name]
        assert viewcube.pick(camera, 0, 0) == normal
        assert viewcube.axes(viewcube.look_from(swarf.Camera, camera, normal))[2] == pytest.approx(normal)
    top = swarf.Camera.view("top", box)
    assert viewcube.pick(top, 0.9, 0) == (1, 0, 1) and viewcube.pick(top, -0.9, 0.9) == (-1, 1, 1)
    assert viewcube.pick(top, 1.5, 0) is None
    corner = viewcube.look_from(swarf.Camera, top, (1, -1, 1))
    assert len(viewcube.faces(corner)) == 3 and viewcube.pick(corner, 0, 0) == (1, -1, 1)


def test_turning_from_view_to_view_is_steady(swarf):
    box = ((0, 0, 0), (40, 30, 20))
    views = [swarf.Camera.view(name, box) for name in (*viewcube.FACES, "isometric")]
    for begin, end in itertools.permutations(views, 2):
        for step in range(11):
            axes = viewcube.axes(viewcube.between(swarf.Camera, begin, end, step / 10))
            assert all(sum(v * v for v in axis) == pytest.approx(1) for axis in axes)
        assert axes[2] == pytest.approx(viewcube.axes(end)[2], abs=1e-9)


def test_translations_are_complete():
    """Every text of the add-on is translated: run freecad_mod/translate after changing one."""
    done = subprocess.run([sys.executable, os.path.join(ADDON, "translate"), "--check"], stdout=subprocess.PIPE)
    assert done.returncode == 0, done.stdout.decode()
    folder = os.path.join(ADDON, "freecad", "swarf_cam", "translations")
    assert {os.path.splitext(name)[0] for name in os.listdir(folder) if name.endswith(".qm")} == {"swarf_de"}


def test_translations_have_the_same_values():
    """A translation that names a value that is none would fail when it is shown; one that leaves it out says less."""
    def values(text):
        return sorted((name, spec) for _, name, spec, _ in string.Formatter().parse(text) if name is not None)

    file = xml.etree.ElementTree.parse(os.path.join(ADDON, "freecad", "swarf_cam", "translations", "swarf_de.ts"))
    told = 0
    for context in file.getroot().iter("context"):
        for message in context.iter("message"):
            source, translation = message.findtext("source"), message.findtext("translation")
            told += context.findtext("name") == "SwarfFinding"
            assert set(values(source)) == set(values(translation)), source
    assert told > 70


def test_the_section_takes_away_the_side_in_front():
    box = ((0.0, 0.0, -15.0), (80.0, 50.0, 0.0))
    plane = Section()
    assert plane.planes(box) == (((40.0, 25.0, -7.5), (0.0, -1.0, 0.0)),)
    plane.move_to(box, 10.0)
    assert plane.position(box) == 10.0
    plane.axis, plane.flipped = 2, True
    assert plane.planes(box) == (((40.0, 25.0, -12.0), (0.0, 0.0, -1.0)),), "the share of the way is kept"
    for position, expected in ((-99.0, -15.0), (99.0, 0.0)):
        plane.move_to(box, position)
        assert plane.position(box) == expected


def test_a_section_is_seen_and_not_picked_through(swarf, session, table):
    from swarf_cam import session as sessions

    go(session, len(table))
    camera = swarf.Camera.view("front", session.box, 4 / 3)
    look = (("sections", Section(share=0.5).planes(session.box)),)
    # the slot lies across the middle, y = 10: the cut face has its profile
    picture = session._current_scene().render(camera, 400, 300, buffers=("seen", "position"), samples=1,
                                              **session._look(sessions.View(camera, 400, 300, look), 0.0))
    x, y, _ = camera.project((10, 10, -6), 4 / 3)
    row, column = int((1 - y) / 2 * 300), int((x + 1) / 2 * 400)
    assert picture.seen[row, column] == 2 and abs(picture.position[row * 400 + column, 1] - 10) < 1e-6
    assert session.pick(sessions.View(camera, 400, 300, look), x, y, len(table)) is None
    assert session.pick(sessions.View(camera, 400, 300), x, y, len(table)).point[1] == pytest.approx(0, abs=0.01)
