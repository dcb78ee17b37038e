# SPDX-License-Identifier: LGPL-2.1-or-later
"""The buffer protocol: tables in, views out."""
import array
import ctypes
import gc
import struct

import pytest
from hypothesis import given, strategies

import swarf
from conftest import HI, LO, VOXEL

#: A tetrahedron.
VERTICES = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]
TRIANGLES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]


def table(values, letter, columns=3):
    """A two-dimensional memoryview."""
    flat = [value for row in values for value in row]
    return memoryview(array.array(letter, flat)).cast("B").cast(letter, (len(flat) // columns, columns))


@pytest.mark.parametrize("letter", "df")
@pytest.mark.parametrize("whole", "bBhHiIlLqQ")
def test_every_native_number_format(letter, whole):
    mesh = swarf.Mesh(table(VERTICES, letter), table(TRIANGLES, whole))
    assert mesh.vertices.tolist() == [list(row) for row in VERTICES]
    assert mesh.triangles.tolist() == [list(row) for row in TRIANGLES]
    assert mesh.volume == pytest.approx(1 / 6)


def test_rows_and_whole_number_coordinates():
    assert swarf.Mesh(VERTICES, TRIANGLES).closed
    signed = swarf.Mesh(table([(0, 0, 0), (-2, 0, 0), (0, -2, 0), (0, 0, -2)], "b"), TRIANGLES)
    assert signed.vertices.tolist()[1] == [-2, 0, 0]


def test_strided_and_read_only_inputs():
    numpy = pytest.importorskip("numpy")
    wide = numpy.full((8, 6), numpy.nan)
    wide[::2, ::-2] = VERTICES
    index = numpy.asfortranarray(TRIANGLES)
    index.setflags(write=False)
    mesh = swarf.Mesh(wide[::2, ::-2], index)
    assert mesh.vertices.tolist() == [list(row) for row in VERTICES]
    assert mesh.triangles.tolist() == [list(row) for row in TRIANGLES]
    with pytest.raises(ValueError, match="format '>d'"):
        swarf.Mesh(numpy.array(VERTICES, dtype=">f8"), TRIANGLES)


@pytest.mark.parametrize(
    "vertices, triangles, error, text",
    [
        (array.array("d", [0, 0, 0]), TRIANGLES, ValueError, "vertices: 1 dimensions"),
        (table(VERTICES, "d", 2), TRIANGLES, ValueError, "vertices: 2 columns where 3"),
        (table(VERTICES, "d"), table(TRIANGLES, "I", 2), ValueError, "triangles: 2 columns"),
        (table(VERTICES, "d"), table(VERTICES, "d"), ValueError, "triangles: elements of format 'd'"),
        (b"abc", TRIANGLES, ValueError, "vertices: 1 dimensions"),
        (memoryview((ctypes.c_bool * 3 * 4)()), TRIANGLES, ValueError, r"elements of format '.?\?'"),
        ([(0, 0)], TRIANGLES, ValueError, r"vertices\[0\]: 2 numbers"),
        ([(0, 0, float("nan"))], TRIANGLES, ValueError, r"vertices\[0, 2\]: not a finite"),
        (table([(0, 0, 0), (0, float("inf"), 0)], "f"), TRIANGLES, ValueError, r"vertices\[1, 1\]: not a finite"),
        (VERTICES, [(0, 1, -1)], ValueError, r"triangles\[0, 2\]"),
        (VERTICES, [(0, 1, 2**32)], ValueError, r"triangles\[0, 2\]"),
        (VERTICES, [(0, 1, 2**80)], ValueError, r"triangles\[0, 2\]"),
        (VERTICES, table([(0, -1, 2)], "h"), ValueError, r"triangles\[0, 1\]"),
        (VERTICES, table([(0, 1, 2**40)], "q"), ValueError, r"triangles\[0, 2\]"),
        (VERTICES, [(0, 1, 1.0)], TypeError, "float"),
        (VERTICES, [(0, 1, 4)], ValueError, "4"),
        ("abc", TRIANGLES, TypeError, "vertices"),
        (5, TRIANGLES, TypeError, "vertices"),
        ([("a", 0, 0)], TRIANGLES, TypeError, "number"),
        ([1, 2, 3], TRIANGLES, TypeError, "iterable"),
    ],
)
def test_wrong_tables(vertices, triangles, error, text):
    with pytest.raises(error, match=text):
        swarf.Mesh(vertices, triangles)


@pytest.mark.parametrize("point", [(0, 0), (0, 0, 0, 0), "abc", 5, (0, 0, float("nan")), (0, float("inf"), 0), None])
def test_wrong_points(point):
    with pytest.raises((ValueError, TypeError), match="lo"):
        swarf.Stock.box(point, HI, VOXEL)


def test_empty_tables(stock):
    assert swarf.Mesh([], []).triangle_count == 0
    assert stock.sample([]).tolist() == []
    assert len(swarf.Program().moves) == 0


@given(strategies.lists(strategies.tuples(*[strategies.floats(-1e6, 1e6, width=32)] * 3), max_size=20))
def test_vertices_come_back(rows):
    mesh = swarf.Mesh(table(rows, "d") if rows else rows, [])
    assert mesh.vertices.tolist() == [list(row) for row in rows]


def test_views_are_read_only():
    view = swarf.Mesh(VERTICES, TRIANGLES).vertices
    assert view.readonly
    with pytest.raises(TypeError):
        view[0, 0] = 1.0
    with pytest.raises((BufferError, TypeError)):
        (ctypes.c_char * view.nbytes).from_buffer(view)


def test_views_outlive_their_owner():
    mesh = swarf.Mesh(VERTICES, TRIANGLES)
    vertices, triangles = mesh.vertices, mesh.triangles
    parts = swarf.Cutter("flat:d=6,l=20").parts
    sample = swarf.Stock.box(LO, HI, VOXEL).sample([(30, 20, -5)])
    del mesh
    gc.collect()
    _ = [bytearray(1 << 16) for _ in range(64)]  # something else where freed memory would be
    assert vertices.tolist() == [list(row) for row in VERTICES]
    assert triangles.tolist() == [list(row) for row in TRIANGLES]
    assert parts[0][1].tolist()[1][0] == 3
    assert sample[0] < 0


def test_a_program_with_views_cannot_grow(slot):
    moves = slot.moves
    with pytest.raises(BufferError):
        slot.add_line((0, 0, 0))
    with pytest.raises(BufferError):
        slot.add_operation("next")
    first = struct.unpack_from("=3d", moves)
    moves.release()
    for _ in range(1000):
        slot.add_line((0, 0, 0))
    assert len(slot) == 1002 and first == (10, 20, -4)
