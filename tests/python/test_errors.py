# SPDX-License-Identifier: LGPL-2.1-or-later
"""Statuses become exceptions that say what was wrong."""
import math

import pytest
from hypothesis import given, strategies

import swarf
from conftest import HI, LO, VOXEL


def test_classes():
    for kind in (swarf.FormatError, swarf.GeometryError, swarf.Cancelled, swarf.BusyError):
        assert issubclass(kind, swarf.Error) and kind.__module__ == "swarf" and kind.__doc__
    assert not issubclass(swarf.Error, (ValueError, OSError))


@pytest.mark.parametrize("voxel", [0, -1, math.nan, math.inf])
def test_impossible_voxels(voxel):
    with pytest.raises(ValueError, match="voxel"):
        swarf.Stock.box(LO, HI, voxel)


@pytest.mark.parametrize("voxel", [1e-9, 1e-4, 5e-324])
def test_voxels_that_do_not_fit_into_memory(voxel):
    with pytest.raises((MemoryError, ValueError), match="voxel"):
        swarf.Stock.box((0, 0, 0), (1000, 1000, 1000), voxel)


def test_memory_limit():
    with pytest.raises(MemoryError, match="voxel"):
        swarf.Stock.box(LO, HI, 0.1, memory_limit=1000)
    with pytest.raises(ValueError, match="memory_limit -5 is negative"):
        swarf.Stock.box(LO, HI, 0.1, memory_limit=-5)


@pytest.mark.parametrize("text", ["", "flat", "flat:", "flat:d=3", "flat:d=x,l=5", "cube:d=3,l=5", "flat:d=3,l=18,q=1"])
def test_cutter_text(text):
    with pytest.raises((swarf.FormatError, ValueError)) as caught:
        swarf.Cutter(text)
    assert str(caught.value)


def test_cutter_parts():
    with pytest.raises(swarf.GeometryError):
        swarf.Cutter.from_parts([("flutes", [(0, 0, 0), (-1, 0, 0), (0, 5, 0)])])
    with pytest.raises(ValueError, match="kind: 'blade' is none of flutes, shank, holder"):
        swarf.Cutter.from_parts([("blade", [(0, 0, 0)])])
    with pytest.raises(ValueError):
        swarf.Cutter.from_parts([])
    for wrong in (5, [5], [("flutes",)], [(1, [])]):
        with pytest.raises(TypeError):
            swarf.Cutter.from_parts(wrong)


def test_diameters_that_are_no_dict():
    for wrong in (5, [5], [[1, 2.0]]):
        with pytest.raises(TypeError, match="diameters: a dict"):
            swarf.Program.parse_gcode("G0 X1", diameters=wrong)


@given(strategies.text(max_size=40))
def test_any_cutter_text_is_refused_or_understood(text):
    try:
        cutter = swarf.Cutter(text)
    except (swarf.FormatError, swarf.GeometryError, ValueError):
        return
    assert math.isfinite(cutter.volume())


@given(strategies.binary(max_size=200))
def test_any_gcode_is_refused_or_understood(text):
    try:
        program = swarf.Program.parse_gcode(text)
    except (swarf.FormatError, ValueError):
        return
    assert math.isfinite(program.seconds())


def test_gcode_errors_name_the_place(tmp_path):
    with pytest.raises(swarf.FormatError, match=r"^job:2:\d+: error: "):
        swarf.Program.parse_gcode("G0 X1\nG999 X5\n", name="job")
    with pytest.raises(OSError):
        swarf.Program.read_gcode(tmp_path / "none.nc")
    with pytest.raises(OSError):
        swarf.Program.read_gcode(tmp_path)
    with pytest.raises(ValueError):
        swarf.Program.read_gcode("a\0b")


def test_program_arguments(slot, stock, cutter):
    with pytest.raises(ValueError, match="kind"):
        slot.add_line((0, 0, 0), kind="warp")
    with pytest.raises(ValueError, match="plane"):
        slot.add_arc((0, 0, 0), (1, 1, 1), plane="zz")
    with pytest.raises(ValueError):
        slot.add_arc((0, 0, -4), (49, 20, -4))  # radii 1 and 53
    with pytest.raises(ValueError):
        slot.set_section(operation=5)
    with pytest.raises(ValueError, match="first"):
        stock.simulate(slot, {1: cutter}, first=3)
    with pytest.raises(ValueError, match="count"):
        stock.simulate(slot, {1: cutter}, first=1, count=2)
    with pytest.raises(ValueError, match="batch"):
        stock.simulate(slot, {1: cutter}, batch=-1)
    for tools in ({"1": cutter}, {1: "flat:d=3,l=5"}, {2**40: cutter}):
        with pytest.raises(TypeError, match="tool"):
            stock.simulate(slot, tools)
    with pytest.raises(TypeError, match="progress"):
        stock.simulate(slot, {1: cutter}, progress=5)
    assert len(slot) == 2
    slot.add_line((0, 0, 0))  # the refused calls have left it open


def test_numbers_beyond_those_of_the_machine(stock, tmp_path):
    mesh = swarf.Mesh.from_stock(stock)
    for shell in (-1, -2 ** 70, 2 ** 70):
        with pytest.raises(ValueError, match="shell"):
            mesh.keep_shells([shell])
    assert mesh.keep_shells([0]).triangle_count == mesh.triangle_count
    counts = {swarf.Mesh.from_stock(stock, 0.1, budget=budget).triangle_count for budget in (2 ** 30, 2 ** 70)}
    assert len(counts) == 1  # more than there are, whatever the number
    assert swarf.Mesh.stream(stock, tmp_path / "s.stl", memory_limit=2 ** 70).triangles == mesh.triangle_count
    with pytest.raises(ValueError, match="not a number of triangles"):
        swarf.Mesh.from_stock(stock, 0.1, budget=-2 ** 70)
    with pytest.raises(ValueError, match="not a number of bytes"):
        swarf.Mesh.stream(stock, tmp_path / "s.stl", memory_limit=-2 ** 70)
    with pytest.raises(TypeError):
        swarf.Mesh.from_stock(stock, 0.1, budget=1.5)


def test_no_stock_out_of_nothing():
    for kind in (swarf.Stock, swarf.Simulation):
        with pytest.raises(TypeError):
            kind()


def test_files_that_are_not_what_they_should_be(tmp_path, stock):
    stock.write(tmp_path / "good.vdb")
    good = (tmp_path / "good.vdb").read_bytes()
    for name, content in (("empty", b""), ("text", b"solid nothing at all"), ("short", good[: len(good) // 2])):
        (tmp_path / f"{name}.vdb").write_bytes(content)
        with pytest.raises((swarf.FormatError, OSError)):
            swarf.Stock.read(tmp_path / f"{name}.vdb")
    swarf.Mesh.from_stock(stock).write(tmp_path / "good.stl")
    good = (tmp_path / "good.stl").read_bytes()
    for name, content in (("empty", b""), ("short", good[:-7])):
        (tmp_path / f"{name}.stl").write_bytes(content)
        with pytest.raises(swarf.FormatError):
            swarf.Mesh.read(tmp_path / f"{name}.stl")
    with pytest.raises(OSError):
        swarf.Mesh.read(tmp_path / "none.stl")
    with pytest.raises(OSError):
        stock.write(tmp_path / "none" / "a.vdb")


def test_open_mesh_is_no_stock():
    mesh = swarf.Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 2, 1), (0, 1, 3), (1, 2, 3)])
    assert not mesh.closed and mesh.boundary_edges == 3
    with pytest.raises(swarf.GeometryError, match="3"):
        swarf.Stock.from_mesh(mesh, 0.1)


def test_stocks_of_other_voxels(stock):
    with pytest.raises(ValueError):
        stock.union(swarf.Stock.box(LO, HI, VOXEL / 2))
    with pytest.raises(TypeError):
        stock.union(5)


def test_picture_arguments(stock):
    for wrong in ({"width": 0}, {"height": 99999}, {"view": "inside"}, {"samples": 9}):
        with pytest.raises(ValueError):
            stock.picture(None, **{"width": 8, "height": 8, **wrong})
    with pytest.raises(ValueError, match="rows"):
        stock.cast([(0, 0, 0)], [])


def test_threads_out_of_range():
    for count in (-1, 1025):
        with pytest.raises(ValueError, match="threads"):
            swarf.set_threads(count)


def test_no_interval_of_progress():
    with pytest.raises(ValueError, match="-1 ms is negative"):
        swarf.set_progress_interval(-1)
