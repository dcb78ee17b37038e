# SPDX-License-Identifier: LGPL-2.1-or-later
"""The history by its Python face: positions, cancelling, what is refused, threads. What a position holds is tested in
C."""
import gc
import random
import threading

import pytest
from conftest import SLOT_MM3, TOOL, make_slot, make_zigzag

import swarf


@pytest.fixture
def history(stock):
    return swarf.History(stock, make_slot(steps=50), {1: swarf.Cutter(TOOL)})


def test_there_and_back(history):
    stock = history.stock
    whole, first = stock.volume(), stock.hash()
    assert (history.move, history.fraction) == (0, 0.0)
    history.seek(51)
    assert history.move == 51 and stock.volume() == pytest.approx(whole - SLOT_MM3, rel=1e-4)
    assert history.approach(51)
    history.seek(0)
    assert history.move == 0 and stock.hash() == first


def test_a_random_walk_meets_the_same_positions(history):
    rng, seen = random.Random(4), {}
    for _ in range(60):
        place = rng.randrange(52), rng.choice((0.0, 0.25, 0.5))
        place = (place[0], 0.0) if place[0] == 51 else place
        history.seek(*place)
        assert (history.move, history.fraction) == place
        assert seen.setdefault(place, history.stock.hash()) == history.stock.hash()


def test_part_of_a_move(history):
    history.seek(1)
    volumes = []
    for part in range(5):
        history.seek(1, part / 4)
        volumes.append(history.stock.volume())
    assert volumes == sorted(volumes, reverse=True) and len(set(volumes)) == 5
    assert (history.move, history.fraction) == (2, 0.0)


def test_approach_comes_nearer(stock):
    history = swarf.History(stock, make_zigzag(9000), {1: swarf.Cutter(TOOL)})
    places = []
    while not history.approach(9000):
        places.append(history.move)
    assert places == sorted(set(places)) and len(places) > 2 and history.move == 9000


def test_held_stays_within_the_limit(stock):
    limit = 300_000
    history = swarf.History(stock, make_zigzag(600), {1: swarf.Cutter(TOOL)}, memory_limit=limit)
    for place in (600, 300, 599, 20, 0):
        history.seek(place)
        held = history.held()
        assert held.bytes == held.first_bytes + held.record_bytes + held.keyframe_bytes
        assert held.record_bytes + held.keyframe_bytes <= limit
        assert held.oldest <= place


def test_cancelled_it_stands_between_moves(history):
    with pytest.raises(swarf.Cancelled):
        history.seek(40, 0.5, progress=lambda _: True)
    assert history.fraction == 0.0
    first = history.move
    history.seek(40, 0.5)
    assert first < 40 and history.fraction == 0.5

    def fail(_):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        history.seek(3, progress=fail)
    history.seek(3)
    assert history.move == 3


@pytest.mark.parametrize("place, text", [
    ((52,), "no position 52"), ((51, 0.5), "no position 51"), ((-1,), "no position -1"), ((3, 1.5), "part 1.5"),
    ((3, float("nan")), "0 to 1")])
def test_places_that_are_not(history, place, text):
    with pytest.raises(ValueError, match=text):
        history.seek(*place)
    assert history.move == 0


def test_arguments(stock, slot):
    with pytest.raises(ValueError, match="memory_limit -1"):
        swarf.History(stock, slot, {}, memory_limit=-1)
    with pytest.raises(TypeError):
        swarf.History(slot, slot, {})
    with pytest.raises(TypeError):
        swarf.History(stock, slot, {1: "flat"})


def test_a_stock_that_others_cut_is_refused(history):
    history.seek(20)
    history.stock.cut(swarf.Cutter("ball:d=8,l=20"), make_slot(depth=6.0))
    with pytest.raises(ValueError, match="changed by someone else"):
        history.seek(10)


def test_the_program_is_closed_while_it_lives(stock):
    program = make_slot()
    history = swarf.History(stock, program, {1: swarf.Cutter(TOOL)})
    with pytest.raises(BufferError):
        program.add_line((0, 0, 0), feed_mm_min=100)
    del history
    gc.collect()
    program.add_line((0, 0, 0), feed_mm_min=100)


def test_a_second_thread_is_told(stock):
    history = swarf.History(stock, make_zigzag(), {1: swarf.Cutter(TOOL)})
    inside, go_on, busy = threading.Event(), threading.Event(), []

    def wait(_):
        inside.set()
        go_on.wait(240)

    thread = threading.Thread(target=history.seek, args=(4000,), kwargs={"progress": wait})
    thread.start()
    assert inside.wait(240)
    for call in (lambda: history.seek(0), history.held, history.stock.volume):
        with pytest.raises(swarf.BusyError):
            call()
        busy.append(call)
    assert history.move == 0  # may be asked at any time
    go_on.set()
    thread.join()
    assert history.move == 4000 and len(busy) == 3
