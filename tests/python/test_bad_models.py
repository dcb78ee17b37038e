# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stocks as models where there is little or nothing to model, and files that cannot be written."""
import contextlib
import json
import os
import resource

import pytest

import swarf
from swarf import parts
from swarf.cli import main
from swarf.job import Job

SUFFIXES = (".stl", ".ply", ".obj", ".3mf", ".glb")


def cut_away():
    """A stock of which nothing is left."""
    stock = swarf.Stock.box((0, 0, 0), (4, 4, 2), 0.5)
    program = swarf.Program(start=(-9, 2, -1))
    program.add_line((9, 2, -1))
    stock.cut(swarf.Cutter("flat:d=12,l=9"), program)
    return stock


def test_everything_cut_away(tmp_path, capsys):
    stock = cut_away()
    assert stock.bounding_box() is None and stock.lumps() == ((), ())
    mesh = swarf.Mesh.from_stock(stock)
    assert mesh.triangle_count == 0 and mesh.shells() == () and mesh.section((0, 0, 0), (0, 0, 1)) == ()
    assert list(mesh.thickness()) == [] and parts.thinnest(mesh)["least_mm"] is None
    assert [side.triangle_count for side in mesh.split((0, 0, 0), (1, 0, 0))] == [0, 0]
    with pytest.raises(swarf.GeometryError, match="nothing is left"):
        stock.placed(((0.6, -0.8, 0, 0), (0.8, 0.6, 0, 0), (0, 0, 1, 0)))
    stock.write(tmp_path / "none.vdb")
    assert main(["mesh", str(tmp_path / "none.vdb"), "--measure", "--thickness"]) == 0
    assert json.loads(capsys.readouterr().out)["pieces"] == 0
    for words in (["--split"], ["--split-at", "z=1"]):
        assert main(["mesh", str(tmp_path / "none.vdb"), *words, "--output", str(tmp_path / "piece.stl")]) == 2
        assert "none.vdb: nothing is left of it" in capsys.readouterr().err
    for suffix in SUFFIXES:
        mesh.write(tmp_path / ("none" + suffix))
        if suffix in (".stl", ".ply"):
            assert swarf.Mesh.read(tmp_path / ("none" + suffix)).triangle_count == 0
    program = swarf.Program(start=(-9, 2, -1))
    program.add_operation("all")
    program.set_section(tool=1)
    program.add_line((9, 2, -1), feed_mm_min=100)
    job = Job(name="all", program=program, tools={1: swarf.Cutter("flat:d=12,l=9")},
              stock={"kind": "box", "lo": (0, 0, 0), "hi": (4, 4, 2)})
    done = swarf.simulate(job, voxel=0.5, drop_loose=True, colour="operation", outputs=[str(tmp_path / "all.ply")])
    assert done.mesh.triangle_count == 0 and not done.loose.pieces


def test_one_voxel(tmp_path):
    stock = swarf.Stock.box((0, 0, 0), (1, 1, 1), 1.0)
    program = swarf.Program(start=(9, 9, 9))
    surface = swarf.Surface(stock, program, {})
    mesh = swarf.Mesh.from_stock(stock, surface=surface)
    assert mesh.closed and mesh.volume == pytest.approx(1, rel=1e-5)
    assert stock.lumps()[0][0].voxels == 1
    turned = stock.placed(((0, -1, 0, 5), (1, 0, 0, 0.3), (0, 0, 1, 0)))
    assert turned.lumps()[0][0].voxels == 1
    below, above = mesh.split((0.5, 0.5, 0.5), (1, 1, 1))
    assert below.closed and above.closed and below.volume == pytest.approx(0.5, rel=1e-5)
    assert min(mesh.thickness()) == pytest.approx(1, rel=1e-4)
    for suffix in SUFFIXES:
        mesh.write(tmp_path / ("one" + suffix))


def test_walls_thinner_than_a_voxel():
    """Two slots leave a wall of 0.3 voxels, which voxel centres may or may not see: closed either way."""
    for shift in (0.0, 0.2, 0.4, 0.6, 0.8):
        stock = swarf.Stock.box((0, 0, -4), (20, 12, 0), 0.5)
        program = swarf.Program(start=(-5, 3 + shift, -2))
        program.add_operation("slots")
        program.set_section(tool=1)
        program.add_line((25, 3 + shift, -2), feed_mm_min=100)
        program.add_line((25, 7.15 + shift, 5))
        program.add_line((25, 7.15 + shift, -2))
        program.add_line((-5, 7.15 + shift, -2), feed_mm_min=100)
        tools = {1: swarf.Cutter("flat:d=4,l=20")}
        surface = swarf.Surface(stock, program, tools)
        stock.simulate(program, tools)
        mesh = swarf.Mesh.from_stock(stock, 0.02, surface=surface)
        assert mesh.closed and mesh.nonmanifold_edges == 0
        left = 20 * (12 * 4 - 2 * 4 * 2 - 0.15 * 2)  # without the wall
        assert left * (1 - 1e-4) < mesh.volume < (left + 20 * 0.15 * 2) * (1 + 1e-4)
        below, above = mesh.split((0, 0, -1), (0, 0.1, 1))
        assert below.closed and above.closed


def test_targets_that_cannot_be(tmp_path):
    mesh = swarf.Mesh.from_stock(swarf.Stock.box((0, 0, 0), (4, 4, 2), 0.5))
    (tmp_path / "file").write_text("")
    for path in (tmp_path / "file" / "part.stl", tmp_path / "none" / "part.stl", "/proc/part.stl"):
        with pytest.raises(OSError, match="part.stl: cannot write"):
            mesh.write(path)
    with pytest.raises(ValueError, match="written as"):
        mesh.write(tmp_path / "part.dwg")


@contextlib.contextmanager
def small_disk(size):
    """No file can be longer than ``size`` bytes: as on a disk that is full."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@pytest.mark.parametrize("name",
                         ["part.stl", "part.ply", "part.obj", "part.3mf", "part.glb", "part.vdb", "streamed.stl"])
def test_disk_full(tmp_path, name):
    """The old content is kept, nothing is left beside."""
    stock, path = swarf.Stock.box((0, 0, 0), (20, 20, 20), 0.5), tmp_path / name
    mesh = swarf.Mesh.from_stock(stock)
    path.write_text("before")

    def write():
        if name == "part.vdb":
            stock.write(path)
        elif name == "streamed.stl":
            swarf.Mesh.stream(stock, path, memory_limit=1)
        else:
            mesh.write(path)

    with small_disk(100), pytest.raises(OSError, match=f"{name}: cannot write: File too large"):
        write()
    assert path.read_text() == "before" and os.listdir(tmp_path) == [name]
    write()
    assert path.stat().st_size > 100 and os.listdir(tmp_path) == [name]


def test_command_on_a_full_disk(tmp_path, capsys):
    stock = swarf.Stock.box((0, 0, 0), (20, 20, 20), 0.5)
    stock.write(tmp_path / "stock.vdb")
    for suffix in ("stl", "3mf"):
        with small_disk(100):
            assert main(["mesh", str(tmp_path / "stock.vdb"), "--output", str(tmp_path / f"part.{suffix}")]) == 2
        told = capsys.readouterr().err.strip().splitlines()
        assert len(told) == 1 and f"part.{suffix}: cannot write: File too large" in told[0]
    assert os.listdir(tmp_path) == ["stock.vdb"]
