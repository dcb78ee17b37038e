# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is left of the stock split and measured, against closed forms, and what comes of it in the document."""

import math
import os
import tempfile
import unittest

import FreeCAD
import Mesh
import samples
import telling
from freecad.swarf_cam import native
from freecad.swarf_cam.app import model, pieces, simulation
from freecad.swarf_cam.body import Body
from freecad.swarf_cam.core import measures
from freecad.swarf_cam.core.errors import JobError

VOXEL = 0.5
BOX, SLOT = 40 * 20 * 10, 40 * 6 * 2
LEFT = BOX - SLOT


def values_of(table, key, axis=""):
    """Of a row of a table."""
    (row,) = [row for row in table.rows if row[:2] == (key, axis)]
    return row[3]


def row_of_boxes(count):
    """Mesh of boxes beside each other, each a mm higher than the one before."""
    mesh = Mesh.Mesh()
    for number in range(count):
        box = Mesh.createBox(1.0, 1.0, 1.0 + number)
        box.translate(3.0 * number, 0, 0)
        mesh.addMesh(box)
    return mesh


class TestPieces(unittest.TestCase):
    def setUp(self):
        self.document = samples.new_document(self)
        self.job = samples.make_job(self.document)
        self.document.recompute()
        self.obj = simulation.simulate(simulation.make(self.job, VOXEL))
        self.document.clearUndos()

    def test_split(self):
        names = {obj.Name for obj in self.document.Objects}
        for each, volumes in ((False, [40 * 20 * 9 - 40 * 6, 2 * 40 * 7]), (True, [40 * 20 * 9 - 40 * 6, 280, 280])):
            made = pieces.split(self.obj, (0, 0, -1), (0, 0, 1), each)
            self.assertEqual([obj.TypeId for obj in made], ["Mesh::Feature"] * len(volumes))
            for obj, volume in zip(made, volumes):
                self.assertTrue(obj.Mesh.isSolid())
                self.assertAlmostEqual(obj.Mesh.Volume, volume, delta=1e-3 * volume)
            self.assertFalse(self.obj.Visibility)
            self.assertEqual(len({obj.Label for obj in made}), len(made))
            self.assertEqual(self.document.UndoCount, 1)
            self.document.undo()
            self.assertEqual({obj.Name for obj in self.document.Objects}, names)
            self.assertTrue(self.obj.Visibility)
            self.assertTrue(self.obj.UpToDate)

    def test_a_plane_beside_it_splits_nothing(self):
        for place in (0.5, -10.5):
            with self.assertRaisesRegex(JobError, "does not cut"):
                pieces.split(self.obj, (0, 0, place), (0, 0, 1))
        self.assertEqual(self.document.UndoCount, 0)

    def test_who_splits_can_cancel(self):
        told = []
        with self.assertRaises(native.load().Cancelled):
            pieces.split(self.obj, (0, 0, -1), (0, 0, 1), True, lambda done: told.append(done) or len(told) > 1)
        self.assertEqual((len(told), self.document.UndoCount, self.obj.Visibility), (2, 0, True))
        with self.assertRaises(native.load().Cancelled):  # before it is known that the plane misses
            pieces.split(self.obj, (0, 0, 500), (0, 0, 1), False, lambda done: True)

    def test_who_splits_can_cancel_while_pieces_are_made(self):
        body = Body(row_of_boxes(30).write)
        told = []
        with self.assertRaises(native.load().Cancelled):
            body.split((0, 0, 0), (0, 0, 1), True, lambda done: told.append(done) or len(told) > 20)
        self.assertEqual(os.listdir(body._folder.name), ["body.ply"])
        told.clear()
        self.assertEqual(len(body.split((0, 0, 0), (0, 0, 1), True, told.append)), 60)
        self.assertEqual(told, sorted(told))

    def test_measures(self):
        told = []
        with telling.every_piece():
            table = pieces.measure(self.obj, told.append)
        with telling.every_piece(), self.assertRaises(native.load().Cancelled):
            pieces.measure(self.obj, lambda done: True)
        self.assertEqual(table.columns, [(measures.WHOLE, 1), (measures.PIECE, 1)])
        self.assertEqual(told[-1], 1)
        height = (BOX * -5 - SLOT * -1) / LEFT
        along_x = (BOX / 12 * (20 ** 2 + 10 ** 2) + BOX * (-5 - height) ** 2
                   - SLOT / 12 * (6 ** 2 + 2 ** 2) - SLOT * (-1 - height) ** 2)
        for key, axis, wanted in (
                ("volume", "", LEFT), ("area", "", 2 * 800 + 2 * 40 * 2 + 2 * 40 * 10 + 2 * (200 - 12)),
                ("size", "X", 40), ("from", "Z", -10), ("to", "Y", 20), ("centre", "X", 20), ("centre", "Y", 10),
                ("centre", "Z", height), ("inertia", "XX", along_x), ("moment", "1", along_x), ("genus", "", 0)):
            for value in values_of(table, key, axis):
                self.assertAlmostEqual(value, wanted, delta=1e-4 * max(abs(wanted), 1), msg=key)
        for place, axis in enumerate("XYZ", 1):
            self.assertAlmostEqual(abs(values_of(table, "axis", "%d%s" % (place, axis))[0]), 1, places=9)
        zeros = [("inertia", "XY"), ("inertia", "XZ"), ("inertia", "YZ"),
                 ("axis", "1Y"), ("axis", "2X"), ("axis", "3Y")]
        self.assertEqual([values_of(table, *row)[0] for row in zeros], [0.0] * len(zeros))
        wall, beside = values_of(table, "wall")
        self.assertAlmostEqual(wall, 7, delta=1e-3)
        self.assertIsNone(beside)
        self.assertLess(min(abs(values_of(table, "thinnest", "Y")[0] - y) for y in (0, 7, 13, 20)), 1e-3)

    def test_measures_of_hollows_and_open_shells(self):
        mesh = Mesh.createBox(20.0, 20.0, 20.0)
        void = Mesh.createBox(6.0, 6.0, 6.0)
        void.flipNormals()
        ring = Mesh.createTorus(3.0, 1.0, 50)
        ring.translate(50, 0, 0)
        for other in (void, ring):
            mesh.addMesh(other)
        table = Body(mesh.write).measures()
        self.assertEqual(table.columns, [(measures.WHOLE, 1), (measures.PIECE, 1), (measures.HOLLOW, 1),
                                         (measures.PIECE, 2)])
        ring_mm3 = 2 * math.pi ** 2 * 3
        for value, wanted in zip(values_of(table, "volume"), (8000 - 216 + ring_mm3, 8000, -216, ring_mm3)):
            self.assertAlmostEqual(value, wanted, delta=1.0)
        self.assertEqual(values_of(table, "genus"), [1, 0, 0, 1])
        self.assertEqual([pieces.name_of(column) for column in table.columns],
                         ["Whole", "Piece 1", "Hollow 1", "Piece 2"])
        mesh.removeFacets([0])
        self.assertEqual(values_of(Body(mesh.write).measures(), "genus")[:2], [None, None])

    def test_only_the_largest_shells_are_listed(self):
        table = Body(row_of_boxes(measures.MOST_SHELLS + 3).write).measures()
        self.assertEqual((len(table.columns), table.more), (measures.MOST_SHELLS + 1, 3))
        self.assertAlmostEqual(values_of(table, "volume")[1], measures.MOST_SHELLS + 3, places=3)
        self.assertAlmostEqual(values_of(table, "volume")[-1], 4, places=3)

    def test_a_sheet_has_the_measures(self):
        table = pieces.measure(self.obj)
        sheet = pieces.add_sheet(self.obj, table)
        self.document.recompute()
        self.assertEqual(sheet.State, ["Up-to-date"])
        self.assertEqual([sheet.get(cell) for cell in ("C1", "D1", "A2", "B2", "A3", "B3")],
                         ["Whole", "Piece 1", "Volume", "mm³", "Area", "mm²"])
        for number, row in enumerate(table.rows, 2):
            self.assertEqual(sheet.get("A%d" % number), pieces.label_of(row))
            for letter, value in zip("CD", row[3]):
                if value is None:
                    self.assertRaises(ValueError, sheet.get, "%s%d" % (letter, number))
                else:
                    self.assertAlmostEqual(float(sheet.get("%s%d" % (letter, number))), value,
                                           delta=1e-6 * max(abs(value), 1))
        self.assertEqual([pieces._letters(place) for place in (0, 25, 26, 51, 52, 701, 702)],
                         ["A", "Z", "AA", "AZ", "BA", "ZZ", "AAA"])
        self.assertEqual(self.document.UndoCount, 1)
        self.document.undo()
        self.assertIsNone(self.document.getObject("Measures"))

    def test_nothing_left_is_neither_split_nor_measured(self):
        self.obj.Mesh = Mesh.Mesh()
        for call in (lambda: pieces.split(self.obj, (0, 0, -1), (0, 0, 1)), lambda: pieces.measure(self.obj)):
            with self.assertRaisesRegex(JobError, "nothing is left"):
                call()

    def test_a_file_that_cannot_be_handed_over(self):
        def refuse(path):
            raise OSError({"swhat": "No write permission for file"})

        def stop_short(path):
            self.obj.Mesh.write(path)
            os.truncate(path, os.path.getsize(path) // 2)

        for write, told in ((refuse, "cannot be written to"), (stop_short, "may be full")):
            with self.assertRaisesRegex(JobError, "temporary files: it " + told):
                Body(write).measures()
        usual, tempfile.tempdir = tempfile.tempdir, os.path.join(tempfile.gettempdir(), "there", "is", "none")
        try:
            with self.assertRaisesRegex(JobError, "temporary files: No such file"):
                pieces.measure(self.obj)
        finally:
            tempfile.tempdir = usual

    def test_more_pieces_than_asked_for(self):
        body = Body(row_of_boxes(3).write)
        with self.assertRaisesRegex(JobError, "6 pieces, of which at most 5"):
            body.split((0, 0, 0), (0, 0, 1), True, most=5)
        self.assertEqual(len(body.split((0, 0, 0), (0, 0, 1), True, most=6)), 6)

    def test_where_it_lies_in_a_part(self):
        part = self.document.addObject("App::Part", "Part")
        turned = FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), 45)
        part.Placement = FreeCAD.Placement(FreeCAD.Vector(0, 0, 50), turned)
        part.addObject(self.obj)
        self.document.recompute()
        corners = [turned.multVec(FreeCAD.Vector(x, y, 0)) for x in (0, 40) for y in (0, 20)]
        lo, hi = pieces.box_of(self.obj)
        table = pieces.measure(self.obj)
        for axis, low, high in (("X", min(c.x for c in corners), max(c.x for c in corners)),
                                ("Y", min(c.y for c in corners), max(c.y for c in corners)), ("Z", 40, 50)):
            place = "XYZ".index(axis)
            for value, wanted in ((lo[place], low), (hi[place], high), (values_of(table, "from", axis)[0], low),
                                  (values_of(table, "to", axis)[0], high)):
                self.assertAlmostEqual(value, wanted, delta=1e-3, msg=axis)
        made = model.add_section(self.obj, (0, 0, 49), (0, 0, 1))
        self.assertAlmostEqual(made.Shape.BoundBox.ZMin, 49, places=6)
        below, above = pieces.split(self.obj, (0, 0, 48), (0, 0, 1))
        self.assertAlmostEqual(below.Mesh.BoundBox.ZMax, 48, places=4)
        self.assertAlmostEqual(above.Mesh.BoundBox.XMin, lo[0], places=3)

    def test_where_it_lies_in_the_document(self):
        self.obj.Placement = FreeCAD.Placement(FreeCAD.Vector(0, 0, 100), FreeCAD.Rotation(0, 0, 0))
        table = pieces.measure(self.obj)
        self.assertAlmostEqual(values_of(table, "from", "Z")[0], self.obj.Mesh.BoundBox.ZMin, places=4)
        self.assertAlmostEqual(values_of(table, "from", "Z")[0], 90, places=3)
