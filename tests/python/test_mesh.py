# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meshes of stocks: measures, pieces, sections, colours and the formats, read back by other means."""
import json
import itertools
import math
import os
import struct
import threading
import xml.etree.ElementTree as ElementTree
import zipfile

import pytest

import swarf
from swarf import report
from swarf.cli import main

VOXEL, ERROR = 0.2, 0.02


@pytest.fixture(scope="module", name="stock")
def fixture_stock():
    """A bar cut in two: 9 mm and 7 mm of 20 mm are left."""
    stock = swarf.Stock.box((0, 0, -6), (20, 8, 0), VOXEL)
    program = swarf.Program(start=(11, -5, -7))
    program.add_line((11, 13, -7))
    stock.cut(swarf.Cutter("flat:d=4,l=20"), program)
    return stock


@pytest.fixture(scope="module", name="mesh")
def fixture_mesh(stock):
    return swarf.Mesh.from_stock(stock, ERROR)


def test_contour_says_what_it_did(stock, mesh):
    full = swarf.Mesh.from_stock(stock)
    assert mesh.closed and full.closed
    assert mesh.contour.triangles == mesh.triangle_count < full.triangle_count / 20
    assert mesh.contour.full_triangles == full.contour.triangles == full.triangle_count
    assert 0 < mesh.contour.error_mm <= 0.02 * (1 + 1e-6) and full.contour.error_mm == 0
    assert mesh.contour.intersections_left == 0 and mesh.contour.budget_met is True
    assert mesh.contour.surface_mm3 == pytest.approx(16 * 8 * 6, rel=1e-4) and mesh.contour.unseen_mm3 == 0
    assert not swarf.Mesh.from_stock(stock, 0.001, budget=20).contour.budget_met
    assert swarf.Mesh(mesh.vertices, mesh.triangles).contour is None
    with pytest.raises(ValueError, match="error -1 mm"):
        swarf.Mesh.from_stock(stock, -1)
    with pytest.raises(ValueError, match="budget"):
        swarf.Mesh.from_stock(stock, 0.1, budget=-3)
    with pytest.raises(ValueError, match="budget of 5 triangles needs an error"):
        swarf.Mesh.from_stock(stock, budget=5)


def test_what_is_too_thin_is_told(tmp_path, capsys):
    """A floor of 0.4 voxels is not in the mesh: how much it was goes into the report and is said."""
    stock, program = swarf.Stock.box((0, 0, -2), (10, 10, 0), VOXEL), swarf.Program(start=(5, -5, -1.92))
    program.add_line((5, 15, -1.92))
    stock.cut(swarf.Cutter("flat:d=4,l=20"), program)
    made = swarf.Mesh.from_stock(stock, ERROR).contour
    floor, walls = 4 * 10 * 0.08, 6 * 10 * 2
    assert made.surface_mm3 == pytest.approx(walls, rel=3e-3)  # by the field alone edges are off
    assert made.unseen_mm3 == pytest.approx(floor, rel=0.15)
    stock.write(str(tmp_path / "stock.vdb"))
    assert main(["mesh", str(tmp_path / "stock.vdb"), "--measure"]) == 0
    said = capsys.readouterr()
    assert f"swarf: note: about {made.unseen_mm3:.3g} mm3" in said.err
    assert "is thinner than a voxel and not in the mesh" in said.err
    assert json.loads(said.out)["contour"]["unseen_mm3"] == pytest.approx(made.unseen_mm3)
    swarf.Stock.box((0, 0, -2), (10, 10, 0), VOXEL).write(str(tmp_path / "thick.vdb"))
    assert main(["mesh", str(tmp_path / "thick.vdb"), "--measure"]) == 0
    assert "thinner" not in capsys.readouterr().err


def test_loose_pieces(mesh):
    whole, shells = mesh.measure(), mesh.shells()
    assert [round(shell.volume_mm3 / 48) for shell in shells] == [9, 7]
    assert whole.volume_mm3 == pytest.approx(sum(shell.volume_mm3 for shell in shells))
    assert [shell.genus for shell in shells] == [0, 0] and whole.euler == 4
    assert shells[0].centre == pytest.approx((4.5, 4, -3), abs=0.02)
    assert shells[1].bounding_box[0] == pytest.approx((13, 0, -6), abs=0.02)
    part = mesh.keep_shells([1])
    assert part.closed and part.volume == pytest.approx(shells[1].volume_mm3)
    with pytest.raises(ValueError, match="shell 2 of 2"):
        mesh.keep_shells([2])
    with pytest.raises(TypeError):
        mesh.keep_shells(["a"])


def test_shells_in_groups(mesh):
    told = []
    for group, alone in zip(mesh.split_shells([[1], [], (0,)], progress=told.append), ([1], [], [0])):
        wanted = mesh.keep_shells(alone)
        assert group.vertices.tolist() == wanted.vertices.tolist()
        assert group.triangles.tolist() == wanted.triangles.tolist()
    assert told == [0, 1 / 3, 2 / 3, 1]
    assert mesh.split_shells([]) == ()
    (both,) = mesh.split_shells([[1, 0]])
    assert both.triangle_count == mesh.triangle_count
    for groups, match in (([[2]], "shell 2 of 2"), ([[0], [1, 0]], "shell 0 is in two"), ([[-1]], "not the place")):
        with pytest.raises(ValueError, match=match):
            mesh.split_shells(groups)
    for groups in ([["a"]], [3], 3):
        with pytest.raises(TypeError):
            mesh.split_shells(groups)
    with pytest.raises(swarf.Cancelled):
        mesh.split_shells([[0], [1]], progress=lambda done: done == 0.5)


def test_section(mesh):
    lines = mesh.section((0, 0, -3.03), (0, 0, 1))
    assert len(lines) == 2
    areas = [sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(line, line[1:] + line[:1])) / 2 for line in lines]
    assert sorted(areas) == pytest.approx([7 * 8, 9 * 8], rel=5e-3)
    assert mesh.section((0, 0, 5), (0, 0, 1)) == ()
    with pytest.raises(ValueError, match="no length"):
        mesh.section((0, 0, 0), (0, 0, 0))


def colours_of(mesh):
    return [(255, 128, 0) if i % 2 else (0, 7, 250) for i in range(mesh.triangle_count)]


@pytest.mark.parametrize("coloured", [False, True])
def test_3mf(mesh, tmp_path, coloured):
    path = tmp_path / "part.3mf"
    mesh.write(path, colours=colours_of(mesh) if coloured else None)
    with zipfile.ZipFile(path) as archive:
        assert archive.testzip() is None
        assert archive.namelist() == ["[Content_Types].xml", "_rels/.rels", "3D/3dmodel.model"]
        roots = {name: ElementTree.fromstring(archive.read(name)) for name in archive.namelist()}
    model = roots["3D/3dmodel.model"]
    core = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
    material = "{http://schemas.microsoft.com/3dmanufacturing/material/2015/02}"
    assert model.tag == core + "model" and model.get("unit") == "millimeter"
    vertices = [tuple(float(v.get(c)) for c in "xyz") for v in model.iter(core + "vertex")]
    triangles = [tuple(int(t.get(f"v{k}")) for k in (1, 2, 3)) for t in model.iter(core + "triangle")]
    again = swarf.Mesh(vertices, triangles)
    assert again.vertices.tolist() == mesh.vertices.tolist() and again.triangles.tolist() == mesh.triangles.tolist()
    palette = [color.get("color") for color in model.iter(material + "color")]
    assert palette == (["#0007FAFF", "#FF8000FF"] if coloured else [])
    if coloured:
        assert [int(t.get("p1")) for t in model.iter(core + "triangle")] == [i % 2 for i in range(len(triangles))]


@pytest.mark.parametrize("coloured", [False, True])
def test_gltf(mesh, tmp_path, coloured):
    path = tmp_path / "part.glb"
    mesh.write(path, colours=colours_of(mesh) if coloured else None)
    data = path.read_bytes()
    magic, version, length, size, kind = struct.unpack_from("<4sIII4s", data)
    assert (magic, version, length, kind) == (b"glTF", 2, len(data), b"JSON") and size % 4 == 0
    described = json.loads(data[20:20 + size])
    binary = data[28 + size:]
    assert struct.unpack_from("<I4s", data, 20 + size) == (len(binary), b"BIN\0")
    assert described["buffers"][0]["byteLength"] == len(binary)

    def table(number, kind, columns):
        accessor = described["accessors"][number]
        view = described["bufferViews"][accessor["bufferView"]]
        count = accessor["count"] * columns
        values = struct.unpack_from(f"<{count}{kind}", binary, view["byteOffset"])
        return [values[i:i + columns] for i in range(0, count, columns)]

    positions, corners = table(0, "f", 3), [c[0] for c in table(1, "I", 1)]
    wanted = mesh.vertices.tolist()
    assert [positions[c] for c in corners] == [tuple(wanted[c]) for row in mesh.triangles.tolist() for c in row]
    assert described["accessors"][0]["min"] == [min(p[k] for p in positions) for k in range(3)]
    assert described["accessors"][0]["max"] == [max(p[k] for p in positions) for k in range(3)]
    attributes = described["meshes"][0]["primitives"][0]["attributes"]
    assert ("COLOR_0" in attributes) == coloured
    if coloured:
        rgba = table(2, "B", 4)
        assert [rgba[c][:3] for c in corners[::3]] == colours_of(mesh)


def test_colours_of_ply_and_obj(mesh, tmp_path):
    colours = colours_of(mesh)
    for name in ("part.ply", "part.obj", "part.stl"):
        mesh.write(tmp_path / name, colours=colours)
        again = swarf.Mesh.read(tmp_path / name)
        assert again.triangle_count == mesh.triangle_count
        assert again.volume == pytest.approx(mesh.volume, rel=1e-9)
    head, body = (tmp_path / "part.ply").read_bytes().split(b"end_header\n", 1)
    assert b"property uchar blue" in head
    faces = body[12 * mesh.vertex_count:]
    assert [tuple(faces[16 * i + 13:16 * i + 16]) for i in range(mesh.triangle_count)] == colours
    first = next(line for line in (tmp_path / "part.obj").read_text().splitlines() if line.startswith("v "))
    assert len(first.split()) == 7
    with pytest.raises(ValueError, match="2 colours for"):
        mesh.write(tmp_path / "part.ply", colours=[(1, 2, 3)] * 2)
    with pytest.raises(ValueError, match="256"):
        mesh.write(tmp_path / "part.ply", colours=[(1, 2, 256)] * mesh.triangle_count)


def test_empty_meshes_can_be_written(tmp_path):
    empty = swarf.Mesh([], [])
    for suffix in ("stl", "ply", "obj", "3mf", "glb"):
        empty.write(tmp_path / f"empty.{suffix}")
    with zipfile.ZipFile(tmp_path / "empty.3mf") as archive:
        ElementTree.fromstring(archive.read("3D/3dmodel.model"))


def test_stream(stock, tmp_path):
    made = swarf.Mesh.stream(stock, tmp_path / "part.stl", ERROR)
    bands = swarf.Mesh.stream(stock, tmp_path / "bands.stl", ERROR, memory_limit=1)
    part, in_bands = (swarf.Mesh.read(tmp_path / name) for name in ("part.stl", "bands.stl"))
    assert made.triangles == part.triangle_count and bands.triangles == in_bands.triangle_count
    assert part.closed and in_bands.closed and in_bands.volume == pytest.approx(part.volume, rel=1e-4)
    stock.write(tmp_path / "stock.vdb")
    assert main(["mesh", str(tmp_path / "stock.vdb"), "--error", str(ERROR), "--output",
                 str(tmp_path / "told.stl")]) == 0
    swarf.Mesh.from_stock(swarf.Stock.read(tmp_path / "stock.vdb"), ERROR).write(tmp_path / "whole.stl")
    assert (tmp_path / "told.stl").read_bytes() == (tmp_path / "whole.stl").read_bytes()
    with pytest.raises(ValueError, match="streamed to .stl only"):
        swarf.Mesh.stream(stock, tmp_path / "part.ply")
    with pytest.raises(ValueError, match="memory_limit: -1"):
        swarf.Mesh.stream(stock, tmp_path / "part.stl", memory_limit=-1)
    with pytest.raises(TypeError, match="surface"):
        swarf.Mesh.stream(stock, tmp_path / "part.stl", surface=1)


def piped(path, write):
    """What ``write()`` puts into a new pipe at ``path``, and what it returns."""
    os.mkfifo(path)
    got = []
    reader = threading.Thread(target=lambda: got.append(path.read_bytes()))
    reader.start()
    made = write()
    reader.join()
    return got[0], made


def test_stream_to_a_pipe(stock, tmp_path):
    """The whole mesh, though there is hardly any memory: a pipe cannot go back to where the count stands."""
    swarf.Mesh.from_stock(stock, ERROR).write(tmp_path / "whole.stl")
    got, made = piped(tmp_path / "pipe.stl",
                      lambda: swarf.Mesh.stream(stock, tmp_path / "pipe.stl", ERROR, memory_limit=1))
    assert got == (tmp_path / "whole.stl").read_bytes() and len(got) == 84 + 50 * made.triangles


def test_simulate_streams(tmp_path):
    """To one .stl file alone, or a pipe of that name; the result says what it came to, as one with a mesh does."""
    program = swarf.Program(start=(-5, 4, 5))
    program.add_operation("slot")
    program.set_section(tool=1)
    program.add_line((-5, 4, -2))
    program.add_line((25, 4, -2))
    job = swarf.Job("part", program, {1: swarf.Cutter("flat:d=4,l=20")},
                    stock={"kind": "box", "lo": (0, 0, -6), "hi": (20, 8, 0)})
    two = [str(tmp_path / "one.stl"), str(tmp_path / "two.stl")]
    kept = swarf.simulate(job, voxel=VOXEL, mesh=False, outputs=two)
    assert kept.mesh is not None and kept.contour == kept.mesh.contour
    got, done = piped(tmp_path / "pipe.stl", lambda: swarf.simulate(
        job, voxel=VOXEL, mesh=False, outputs=[str(tmp_path / "pipe.stl")]))
    assert done.mesh is None and done.contour == kept.contour and done.contour.intersections_left == 0
    assert got == (tmp_path / "one.stl").read_bytes() == (tmp_path / "two.stl").read_bytes()
    told, whole = (report.make(result, "part")["mesh"] for result in (done, kept))
    assert told["triangles"] == kept.contour.triangles and told["intersections_left"] == 0
    assert told.items() <= whole.items()
    none = swarf.simulate(job, voxel=VOXEL, mesh=False)
    assert none.contour is None and report.make(none, "part")["mesh"] is None


def test_command(stock, tmp_path, capsys):
    stock.write(tmp_path / "stock.vdb")
    source = str(tmp_path / "stock.vdb")
    assert main(["mesh", source, "--output", str(tmp_path / "part.3mf"), "--measure"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["pieces"] == 2 and len(found["shells"]) == 2
    assert found["whole"]["volume_mm3"] == pytest.approx(16 * 48, rel=5e-3)
    assert found["contour"]["error_mm"] <= 0.1 * VOXEL * (1 + 1e-6)
    assert zipfile.is_zipfile(tmp_path / "part.3mf")
    assert main(["mesh", source, "--error", "0.05", "--split", "--output", str(tmp_path / "loose.stl")]) == 0
    volumes = [swarf.Mesh.read(tmp_path / f"loose-{i}.stl").volume for i in (1, 2)]
    assert volumes == pytest.approx([9 * 48, 7 * 48], rel=1e-2)
    assert not (tmp_path / "loose-3.stl").exists() and not (tmp_path / "loose.stl").exists()
    loose = str(tmp_path / "loose.step")
    for words, files in ((["--split"], "loose-1.step to {}-2.step: facets"), ([], "loose.step: facets")):
        assert main(["mesh", source, "--error", "0.05", *words, "--output", loose]) == 0
        assert files.format(loose[:-5]) in capsys.readouterr().err
    assert main(["mesh", str(tmp_path / "loose-1.stl"), "--measure"]) == 0
    assert json.loads(capsys.readouterr().out)["contour"] is None
    assert main(["mesh", source, "--error", "0.01", "--budget", "9", "--measure"]) == 1
    assert "more than 9: an error of 0.01 mm leaves no fewer" in capsys.readouterr().err


@pytest.mark.parametrize(
    "words, text",
    [
        ([], "nothing to do"),
        (["--split", "--measure"], "give --output"),
        (["--error", "-1", "--measure"], "error -1"),
        (["--error", "nan", "--measure"], "error nan"),
        (["--error", "1e100", "--measure"], "error 1e+100"),
        (["--budget", "-1", "--measure"], "budget -1"),
        (["--output", "part.iges"], "unknown suffix"),
        (["--output", "part.svg"], "part.svg: a drawing is of a section: give --section PLANE"),
        (["--section", "z=1", "--output", "part.stl"], "--section: no --output is a drawing, which is .svg, .dxf"),
        (["--section", "z=1", "--split", "--output", "part.dxf"], "write meshes: give --output"),
        (["--section", "z=1", "--section", "z=2", "--output", "/none/part.dxf"], "/none/part.dxf: cannot be written"),
        (["--output", "/none/part.stl"], "cannot be written"),
        (["--measure"], "cannot open"),
    ],
)
def test_command_refuses(tmp_path, capsys, words, text):
    assert main(["mesh", str(tmp_path / "none.vdb"), *words]) == 2
    assert text in capsys.readouterr().err


def test_measures_of_a_cut_sphere_like_pocket():
    """A ball-ended hole: the volume left is the block's less a capsule's half."""
    stock = swarf.Stock.box((-5, -5, -8), (5, 5, 0), 0.1)
    program = swarf.Program(start=(0, 0, 1))
    program.add_line((0, 0, -6))
    stock.cut(swarf.Cutter("ball:d=6,l=20"), program)
    shell, = swarf.Mesh.from_stock(stock, 0.005).shells()
    exact = 800 - (math.pi * 9 * 3 + 2 / 3 * math.pi * 27)
    assert shell.volume_mm3 == pytest.approx(exact, rel=1e-3)
    assert shell.genus == 0


def cut_through(stock, tool, start, end):
    """A stock that a tool has gone through on a line, and its Surface."""
    program, tools = swarf.Program(start=start), {1: swarf.Cutter(tool)}
    program.add_operation("slot")
    program.set_section(tool=1)
    program.add_line(end, feed_mm_min=100)
    surface = swarf.Surface(stock, program, tools)
    stock.simulate(program, tools)
    return stock, surface


def test_fine_edges():
    """A slot of a thread mill through a block: the lands of the thread are 0.33 voxels wide, two edges in a cell."""
    stock, surface = cut_through(swarf.Stock.box((0, 0, -6), (20, 8, 0), 0.23), "threadmill:d=4,n=2.4,p=1,k=3,l=5",
                                 (11, -5, -4), (11, 13, -4))
    volume = 20 * 8 * 6 - 8 * 2 * (1.2 * 4 + 3 * 0.8 ** 2 * math.tan(math.pi / 6))
    coarse = swarf.Mesh.from_stock(stock, surface=surface)
    fine = swarf.Mesh.from_stock(stock, surface=surface, fine=True)
    assert coarse.contour.split_edges == 0 and fine.contour.split_edges > 100
    assert fine.closed and fine.contour.intersections_left == 0
    assert abs(fine.volume - volume) < 0.3 * abs(coarse.volume - volume)


def test_volume_is_kept_where_it_is_asked_for(tmp_path):
    """A ball's groove: flat triangles between points of it leave material in."""
    stock, surface = cut_through(swarf.Stock.box((0, 0, -8), (30, 20, 0), 0.15), "ball:d=10,l=20", (-9, 10, -5),
                                 (39, 10, -5))
    volume = 30 * (20 * 8 - math.pi * 5 ** 2 / 2)
    plain = swarf.Mesh.from_stock(stock, 0.015, surface=surface)
    kept = swarf.Mesh.from_stock(stock, 0.015, surface=surface, keep_volume=True)
    assert kept.closed and kept.contour.error_mm <= 0.015 * (1 + 1e-4)
    assert abs(kept.volume - volume) < 1e-5 * volume < 0.1 * abs(plain.volume - volume)
    made = swarf.Mesh.stream(stock, tmp_path / "kept.stl", 0.015, surface=surface, keep_volume=True)
    assert made.triangles == kept.triangle_count
    assert math.isclose(swarf.Mesh.read(tmp_path / "kept.stl").volume, kept.volume, rel_tol=1e-6)


@pytest.mark.parametrize("wall, floor", [(16.6, -6.6), (16.6, -9), (17, -6.6), (17, -9), (16.5, -6.7)])
def test_corners_where_faces_go_through_the_middle_of_voxels(wall, floor):
    """A slot of 10 mm through a block of voxels of 0.4 mm, at round numbers."""
    stock, surface = cut_through(swarf.Stock.box((0, 0, -12), (40, 40, 0), 0.4), "flat:d=10,l=30",
                                 (-10, wall - 5, floor), (50, wall - 5, floor))
    for error in (0, 0.004):
        mesh = swarf.Mesh.from_stock(stock, error, surface=surface)
        assert mesh.closed
        assert mesh.volume == pytest.approx(40 * (40 * 12 + 10 * floor), rel=1e-5)
        for corner in itertools.product((0, 40), (wall - 10, wall), (floor, 0)):
            assert min(math.dist(corner, vertex) for vertex in mesh.vertices.tolist()) < 0.02 * 0.4


def test_exact_surface():
    """A slot of 4 mm through a block: 2 x 8 x 6 mm with the edges where they are, though voxels are 0.23 mm."""
    stock = swarf.Stock.box((0, 0, -6), (20, 8, 0), 0.23)
    program = swarf.Program(start=(11, -5, -2))
    program.add_operation("slot")
    program.set_section(tool=1)
    program.add_line((11, 13, -2), feed_mm_min=100)
    tools = {1: swarf.Cutter("flat:d=4,l=20")}
    surface = swarf.Surface(stock, program, tools)
    with pytest.raises(BufferError):
        program.add_line((0, 0, 0))
    whole = swarf.Mesh.from_stock(stock, 0.001, surface=surface, moves=0)
    stock.simulate(program, tools)
    mesh = swarf.Mesh.from_stock(stock, 0.001, surface=surface)
    assert mesh.volume == pytest.approx(20 * 8 * 6 - 4 * 8 * 2, rel=1e-6)
    assert whole.volume == pytest.approx(20 * 8 * 6, rel=1e-6)
    for got, wanted in zip(mesh.bounding_box, ((0, 0, -6), (20, 8, 0))):
        assert got == pytest.approx(wanted, abs=1e-5)
    assert mesh.triangle_count < 200 and mesh.contour.exact_vertices > 1000
    corners = {(round(x, 4), round(y, 4), round(z, 4)) for x, y, z in mesh.vertices.tolist()}
    assert {(9.0, 0.0, -2.0), (13.0, 8.0, 0.0), (20.0, 8.0, -6.0)} <= corners
    rough = swarf.Mesh.from_stock(stock, 0.001)
    assert 1e-3 < abs(rough.volume - mesh.volume) < 0.05 and rough.contour.exact_vertices == 0
    with pytest.raises(TypeError, match="surface: needs a Surface"):
        swarf.Mesh.from_stock(stock, surface=stock)
    with pytest.raises(ValueError):
        swarf.Mesh.from_stock(stock, surface=surface, moves=2)
    with pytest.raises(ValueError, match="surface"):
        swarf.Mesh.from_stock(stock, moves=1)
    del surface
    program.add_line((0, 0, 0))
