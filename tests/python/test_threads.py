# SPDX-License-Identifier: LGPL-2.1-or-later
"""The GIL, busy objects, cancelling, exceptions and signals in callbacks, and memory."""
import gc
import os
import queue
import random
import signal
import threading

import pytest

import swarf
from conftest import HI, LO, TOOL, VOXEL, make_slot, make_zigzag, resident_kib


class Marker(Exception):
    """Raised in a callback, expected outside."""


def test_exception_in_progress_comes_out_unchanged(stock, cutter):
    error = Marker("mine")

    def progress(fraction):
        raise error

    with pytest.raises(Marker) as caught:
        stock.simulate(make_zigzag(), {1: cutter}, batch=1, progress=progress)
    assert caught.value is error
    assert stock.volume() > 0  # not left busy


def test_true_answer_cancels(stock, cutter):
    with pytest.raises(swarf.Cancelled):
        stock.simulate(make_zigzag(), {1: cutter}, batch=1, progress=lambda fraction: True)
    assert stock.volume() > 0


def test_progress_runs_on_the_calling_thread_and_never_falls(stock, cutter):
    seen = []
    program = make_zigzag()
    stock.simulate(program, {1: cutter}, batch=1, progress=lambda f: seen.append((f, threading.get_ident())))
    fractions = [fraction for fraction, _ in seen]
    assert fractions and fractions == sorted(fractions) and 0 <= fractions[0] and fractions[-1] <= 1
    assert {ident for _, ident in seen} == {threading.get_ident()}


def test_progress_is_told_by_pieces_or_by_time(cutter, every_piece):
    def told(milliseconds):
        swarf.set_progress_interval(milliseconds)
        reports = []
        swarf.Stock.box(LO, HI, VOXEL).simulate(make_zigzag(400), {1: cutter}, progress=reports.append)
        return reports

    pieces = told(0)
    assert told(0) == pieces and len(told(3600000)) < len(pieces) / 10


def test_interrupt_stops_a_long_call(stock, cutter):
    def progress(fraction):
        os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        stock.simulate(make_zigzag(), {1: cutter}, batch=1, progress=progress)
    assert stock.volume() > 0


def test_an_object_in_use_says_so(stock, cutter):
    program = make_zigzag()
    caught = []

    def progress(fraction):
        for call in (stock.volume, stock.hash, lambda: stock.cut(cutter, program), lambda: program.add_operation("x")):
            with pytest.raises(swarf.BusyError) as info:
                call()
            caught.append(str(info.value))
        return True

    with pytest.raises(swarf.Cancelled):
        stock.simulate(program, {1: cutter}, batch=1, progress=progress)
    assert len(caught) == 4 and all(caught)
    program.add_operation("x")
    stock.volume()


def test_other_threads_run_meanwhile(cutter):
    program = make_zigzag()

    def is_met():
        """Whether this thread, once the work of another one has begun, meets its stock in use. Progress is told to a
        function in C: one in Python gives the GIL away itself."""
        stock, told = swarf.Stock.box(LO, HI, VOXEL), queue.SimpleQueue()
        thread = threading.Thread(target=stock.simulate, args=(program, {1: cutter}),
                                  kwargs={"batch": 1, "progress": told.put})
        thread.start()
        told.get(timeout=240)
        try:
            stock.volume()
            return False
        except swarf.BusyError:
            return True
        finally:
            thread.join()
    # With the GIL held nobody would ever: the call is over when this thread wakes. Else only a late core misses it.
    assert any(is_met() for _ in range(20))


@pytest.mark.parametrize("seed", range(8))
def test_cancelling_at_any_time_leaves_a_usable_stock(seed, cutter):
    choice = random.Random(seed)
    program, stock = make_zigzag(1500), swarf.Stock.box(LO, HI, VOXEL)
    before, left = stock.volume(), choice.randint(0, 12)

    def progress(fraction):
        nonlocal left
        left -= 1
        return left < 0

    try:
        stock.simulate(program, {1: cutter}, batch=choice.choice((0, 1, 10, 100)), progress=progress)
    except swarf.Cancelled:
        pass
    between = stock.volume()
    assert between <= before * (1 + 1e-9)
    stock.simulate(program, {1: cutter})
    whole = swarf.Stock.box(LO, HI, VOXEL)
    whole.simulate(program, {1: cutter})
    # Cutting again what was cut changes nothing: the order of moves does not matter.
    assert stock.volume() == pytest.approx(whole.volume(), rel=1e-6)
    assert stock.volume() <= between * (1 + 1e-9)


def round_of_everything(path):
    """Every kind of object once, with failures on the way."""
    cutter, program = swarf.Cutter(TOOL), make_slot(steps=20)
    stock = swarf.Stock.box((0, 0, -10), (60, 40, 0), 1.0)
    simulation = stock.simulate(program, {1: cutter}, removed_per_move=True, progress=lambda fraction: None)
    stock.simulate(program, {}).findings
    mesh = swarf.Mesh.from_stock(stock)
    views = [mesh.vertices, mesh.triangles, program.moves, program.sections, simulation.removed_per_move, cutter.parts]
    swarf.Mesh(mesh.vertices, mesh.triangles)
    swarf.Cutter.from_parts(cutter.parts)
    mesh.write(path)
    swarf.Mesh.read(path)
    stock.sample(mesh.vertices)
    stock.copy().difference(stock)
    for failing in (
        lambda: swarf.Cutter("no such"),
        lambda: swarf.Mesh(mesh.vertices, [(0, 0, 10**9)]),
        lambda: swarf.Program.parse_gcode("G999"),
        lambda: program.add_line((0, 0, 0)),
        lambda: stock.simulate(program, {1: 5}),
    ):
        with pytest.raises((swarf.Error, ValueError, BufferError, TypeError)):
            failing()
    return views


@pytest.fixture
def two_threads():
    """Each of many keeps memory of its own."""
    swarf.set_threads(2)
    yield
    swarf.set_threads(0)


def test_memory_does_not_grow(tmp_path, two_threads):
    path = tmp_path / "mesh.stl"
    for _ in range(20):
        round_of_everything(path)
    gc.collect()
    before = resident_kib()
    for _ in range(60):
        round_of_everything(path)
    gc.collect()
    # A leaked mesh or stock is about 1 MB a round; the allocator alone moves a few.
    assert resident_kib() - before < 12_000


def test_small_objects_do_not_leak(stock):
    tracker = pytest.importorskip("tracemalloc")
    point = [(1.0, 2.0, -3.0)]

    def rounds(count):
        for _ in range(count):
            stock.sample(point)
            swarf.Cutter(TOOL).parts
            with pytest.raises(ValueError):
                stock.sample([(1.0, 2.0, float("nan"))])

    rounds(50)
    gc.collect()
    tracker.start()
    try:
        rounds(1)
        gc.collect()
        before = tracker.get_traced_memory()[0]
        rounds(300)
        gc.collect()
        assert tracker.get_traced_memory()[0] - before < 20_000  # 300 leaked views would be 40,000 and more
    finally:
        tracker.stop()
