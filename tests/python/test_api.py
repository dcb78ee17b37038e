# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the objects do, against closed forms."""
import math
import struct

import pytest

import swarf
from conftest import HI, LO, SLOT_MM3, VOXEL, make_slot

BOX_MM3 = math.prod(high - low for low, high in zip(LO, HI))


def test_cutter_of_text():
    cutter = swarf.Cutter("flat:d=6,l=20,sd=8,sl=15")
    assert cutter.radius() == 3
    assert cutter.radius("shank") == 4
    assert cutter.radius("holder") == 0
    assert cutter.extent() == (0, 20)
    assert cutter.volume() == pytest.approx(math.pi * 9 * 20, rel=1e-12)
    assert cutter.radius_at(10) == 3
    assert cutter.radius_at(21) == -1
    assert [kind for kind, _ in cutter.parts] == ["flutes", "shank"]


def test_cutter_of_parts_is_the_same_as_its_parts():
    ball = swarf.Cutter("ball:d=6,l=20")
    again = swarf.Cutter.from_parts(ball.parts)
    assert [(kind, nodes.tolist()) for kind, nodes in again.parts] == [(k, n.tolist()) for k, n in ball.parts]
    assert again.volume() == pytest.approx(math.pi * 9 * 17 + 2 / 3 * math.pi * 27, rel=1e-9)


def test_program_keeps_what_it_is_given():
    program = swarf.Program(start=(0, 0, 0))
    assert program.add_operation("first") == 0
    program.set_section(tool=7, operation=0, spindle="ccw", spindle_rpm=1200, coolant=2, work_offset=1)
    program.add_tool_change(line=1)
    program.add_line((1, 2, 3), kind="rapid", line=2)
    program.add_arc((1, 4, 3), (1, 3, 3), ccw=False, feed_mm_min=60, line=3)
    program.add_dwell(1.5, line=4)
    assert program.add_operation("second") == 1
    assert len(program) == 4
    assert program.operations == ("first", "second")
    assert program.tools == (7,)
    moves = program.moves
    assert (moves.nbytes, moves.itemsize, moves.readonly, moves.shape) == (160, 40, True, (4,))
    rows = list(struct.iter_unpack("=3dfIiI", moves.tobytes()))
    assert rows[1][:3] == (1, 2, 3)
    assert [row[4] for row in rows] == [1, 2, 3, 4]
    assert [row[5] for row in rows] == [-1, -1, 0, -1]
    assert [row[6] & 7 for row in rows] == [3, 0, 1, 2]
    centre_x, centre_y, _, angle, plane, _ = struct.unpack("=4dii", program.arcs.tobytes())
    assert (centre_x, centre_y, plane) == (1, 3, 0)
    assert angle == pytest.approx(-math.pi)
    assert struct.unpack("=4id2i", program.sections.tobytes()[-32:])[:1] == (7,)
    # pi mm at 60 mm/min, 1.5 s, and the rapid of sqrt(14) mm
    assert program.seconds(1000) == pytest.approx(math.pi + 1.5 + math.sqrt(14) * 60 / 1000, rel=1e-6)
    del moves  # while it lives the program cannot grow
    program.set_section(tool=8)  # of the operation added last
    program.add_line((0, 0, 0))
    assert struct.unpack("=4id2i", program.sections.tobytes()[-32:])[:2] == (8, 1)


def test_moves_are_records_in_numpy(slot):
    numpy = pytest.importorskip("numpy")
    moves = numpy.asarray(slot.moves)
    assert moves.dtype.names == ("end", "feed_mm_min", "line", "arc", "section_kind")
    assert moves["end"].tolist() == [[10, 20, -4], [50, 20, -4]]
    assert moves["line"].tolist() == [1, 2]


def test_stock_measures(stock):
    assert stock.voxel == VOXEL
    assert stock.volume() == pytest.approx(BOX_MM3, rel=1e-4)
    box = stock.bounding_box()
    assert box[0] == pytest.approx(LO, abs=VOXEL / 2)
    assert box[1] == pytest.approx(HI, abs=VOXEL / 2)
    leaves, size = stock.size()
    assert leaves > 0 and size > leaves * 2048
    assert stock.hash() == swarf.Stock.box(LO, HI, VOXEL).hash() != swarf.Stock.box(LO, (60, 40, 1), VOXEL).hash()
    assert swarf.Stock.estimate(LO, HI, VOXEL / 4) > swarf.Stock.estimate(LO, HI, VOXEL) > 0


def test_cylinder_volume():
    bar = swarf.Stock.cylinder((0, 0, 0), (0, 0, 30), 10, voxel=0.25)
    assert bar.volume() == pytest.approx(math.pi * 100 * 30, rel=1e-3)


def test_cut_and_sample(stock, slot, cutter):
    stock.cut(cutter, slot)
    samples = stock.sample([(30, 20, -2), (30, 20, -6), (30, 10, -5), (30, 24, -2), (30, 20, -3.75)])
    assert samples.format == "f" and samples.shape == (5,) and samples.readonly
    assert samples[0] > 0 > samples[1]
    assert samples[2] < 0
    assert samples[3] == pytest.approx(-1, abs=0.05)
    assert samples[4] == pytest.approx(0.25, abs=0.05)


def test_simulate(stock, slot, cutter):
    before = stock.volume()
    simulation = stock.simulate(slot, {1: cutter}, removed_per_move=True)
    assert simulation.volume_initial == pytest.approx(before, rel=1e-9)
    assert simulation.volume_final == pytest.approx(stock.volume(), rel=1e-9)
    assert simulation.removed_by_operation == pytest.approx((SLOT_MM3,), rel=1e-2)
    assert sum(simulation.removed_per_move) == pytest.approx(simulation.removed_by_operation[0], rel=1e-6)
    assert simulation.findings == ()


def test_simulate_in_two_halves_is_simulate(slot, cutter):
    whole, halves = swarf.Stock.box(LO, HI, VOXEL), swarf.Stock.box(LO, HI, VOXEL)
    whole.simulate(slot, {1: cutter})
    halves.simulate(slot, {1: cutter}, count=1)
    halves.simulate(slot, {1: cutter}, first=1)
    assert whole.hash() == halves.hash()


def test_missing_tool_is_a_finding(stock, slot):
    before = stock.hash()
    (finding,) = stock.simulate(slot, {}).findings
    assert (finding.severity, finding.operation, finding.tool) == ("error", 0, 1)
    assert "1" in finding.text
    assert stock.hash() == before


def test_booleans_and_copy(stock, slot, cutter):
    whole = stock.copy()
    stock.cut(cutter, slot)
    chips = whole.copy()
    chips.difference(stock)
    assert chips.volume() == pytest.approx(whole.volume() - stock.volume(), rel=2e-2)
    chips.union(stock)
    assert chips.volume() == pytest.approx(whole.volume(), rel=1e-3)
    chips.intersection(stock)
    assert chips.volume() == pytest.approx(stock.volume(), rel=1e-3)


def test_mesh_there_and_back(stock, slot, cutter, tmp_path):
    stock.cut(cutter, slot)
    mesh = swarf.Mesh.from_stock(stock)
    assert mesh.closed and mesh.boundary_edges == mesh.nonmanifold_edges == mesh.misoriented_edges == 0
    assert mesh.volume == pytest.approx(BOX_MM3 - SLOT_MM3, rel=1e-2)
    for suffix in ("stl", "ply", "obj"):
        path = tmp_path / f"mesh.{suffix}"
        mesh.write(path)
        again = swarf.Mesh.read(path)
        assert (again.triangle_count, again.closed) == (mesh.triangle_count, True)
        assert again.volume == pytest.approx(mesh.volume, rel=1e-4)
    assert swarf.Stock.from_mesh(mesh, VOXEL).volume() == pytest.approx(stock.volume(), rel=1e-2)


def test_vdb_there_and_back(stock, slot, cutter, tmp_path):
    stock.cut(cutter, slot)
    stock.write(tmp_path / "stock.vdb")
    again = swarf.Stock.read(tmp_path / "stock.vdb")
    assert again.voxel == pytest.approx(VOXEL)
    assert again.volume() == pytest.approx(stock.volume(), rel=1e-5)


def test_cutter_documents_the_names_it_takes():
    listed = swarf.Cutter.__doc__.split("(shapes ")[1].split(";")[0].split()
    with pytest.raises(swarf.FormatError) as refused:
        swarf.Cutter("none")
    assert listed == str(refused.value).split("names are ")[1].split(", ")


def test_compare_volume(stock, slot, cutter):
    design = swarf.Mesh.from_stock(stock)
    same = swarf.compare_volume(stock, design)
    assert same.design_mm3 == pytest.approx(same.stock_mm3, rel=1e-2)
    stock.cut(cutter, slot)
    cut = swarf.compare_volume(stock, design)
    assert cut.gouge_mm3 - same.gouge_mm3 == pytest.approx(SLOT_MM3, rel=2e-2)
    assert cut.excess_mm3 == pytest.approx(same.excess_mm3, abs=SLOT_MM3 * 0.02)


def test_picture(stock, tmp_path):
    pixels = stock.picture(None, 64, 48, view="top", samples=1)
    assert isinstance(pixels, bytes) and len(pixels) == 4 * 64 * 48
    assert len(set(struct.iter_unpack("4B", pixels))) > 1
    assert stock.picture(tmp_path / "stock.png", 64, 48) is None
    head = (tmp_path / "stock.png").read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n" and struct.unpack(">II", head[16:]) == (64, 48)


def test_cast(stock):
    distance, normal = stock.cast([(30, 20, 10), (30, 20, 10)], [(0, 0, -1), (0, 0, 1)])
    assert distance[0] == pytest.approx(10, abs=0.05)
    assert distance[1] == math.inf
    assert normal.tolist()[0] == pytest.approx([0, 0, 1], abs=1e-3)


def test_threads_do_not_change_the_result(cutter):
    program, hashes = make_slot(steps=50), set()
    try:
        for count in (1, 2, 3, 8):
            swarf.set_threads(count)
            assert swarf.threads() == count
            stock = swarf.Stock.box(LO, HI, VOXEL)
            stock.simulate(program, {1: cutter})
            hashes.add(stock.hash())
    finally:
        swarf.set_threads(0)
    assert len(hashes) == 1


def test_process():
    assert swarf.version() == swarf.__version__
    assert swarf.isa() in ("scalar", "avx2", "avx512")
    assert swarf.memory_peak() > 1e6


def test_job_simulate(slot, cutter, tmp_path):
    job = swarf.Job("part", slot, {1: cutter}, stock={"kind": "box", "lo": LO, "hi": HI})
    job.design = swarf.Mesh.from_stock(swarf.Stock.box(LO, HI, VOXEL))
    stages = []
    result = swarf.simulate(job, resolution=120, outputs=[str(tmp_path / "a.stl"), str(tmp_path / "a.vdb")],
                            picture=str(tmp_path / "a.png"), picture_size=(32, 24),
                            progress=lambda stage, fraction: stages.append((stage, fraction)))
    assert result.stock.voxel == pytest.approx(0.5)
    assert not result.failed
    assert result.comparison.gouge_mm3 == pytest.approx(SLOT_MM3, rel=0.05)
    assert {"stock", "cut", "loose", "compare", "mesh", "write", "picture", "total"} == set(result.seconds)
    assert {path.name for path in tmp_path.iterdir()} == {"a.stl", "a.vdb", "a.png"}
    assert all(0 <= fraction <= 1 for _, fraction in stages)


def bare_job(stock=None):
    return swarf.Job("bare", make_slot(), {1: swarf.Cutter("flat:d=6,l=20")},
                     stock={"kind": "box", "lo": LO, "hi": HI} if stock is None else stock)


@pytest.mark.parametrize("words, says", [
    ({"view": "iso", "picture": "a.png"}, "'iso' is none of isometric, top"),
    ({"picture": "a.jpg"}, "a picture is .png"), ({"picture": "a.png", "picture_size": (5, 0)}, "picture of 5 x 0"),
    ({"picture": b"a.png", "picture_size": (1.5, 2)}, "picture of 1.5 x 2"),
    ({"colour": "red"}, "wanted operation, deviation"), ({"colour": "deviation"}, "need a design"),
    ({"outputs": ["a.foo"]}, "an output is .stl"),
])
def test_what_cannot_be_made_is_refused_before_the_work(words, says):
    told = []
    with pytest.raises(ValueError, match=says):
        swarf.simulate(bare_job(), voxel=1.0, progress=lambda *stage: told.append(stage), **words)
    assert told == []


@pytest.mark.parametrize("words, says", [
    ({"tolerance": -1}, "tolerance -1: wanted a number above 0"), ({"gouge": float("nan")}, "tolerance nan"),
    ({"limits": {"1": {"chip": 1}}}, "'1' is no number of a tool"), ({"limits": [1]}, "limits: wanted {tool"),
    ({"accept": [{"reason": "x"}]}, "Acceptances are wanted"),
])
def test_what_cannot_be_verified_is_refused_before_the_work(words, says):
    told = []
    with pytest.raises((ValueError, TypeError), match=says):
        swarf.verify(bare_job(), swarf.Mesh.from_stock(swarf.Stock.box(LO, HI, 2.0)), voxel=1.0,
                     progress=lambda *stage: told.append(stage), **words)
    assert told == []


@pytest.mark.parametrize("stock, says", [
    ({}, "kind '' is not known: box, cylinder, mesh, vdb, result"), ({"kind": "ball"}, "kind 'ball' is not known"),
    ({"kind": "box", "lo": LO}, "kind 'box' without 'hi'; it needs lo, hi"), ({"kind": "mesh"}, "without 'mesh'"),
    ({"kind": ["box"]}, "kind \\['box'\\] is not known"),
    ({"kind": "vdb"}, "without 'path'"), ({"kind": "result"}, "without 'job'"),
    ({"kind": "box", "lo": LO, "hi": HI, "placement": "x180"}, "swarf.placement.parse"),
])
def test_stocks_that_are_not_told_rightly(stock, says):
    with pytest.raises(ValueError, match=says):
        swarf.simulate(bare_job(stock=stock), voxel=1.0)
