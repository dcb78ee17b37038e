# SPDX-License-Identifier: LGPL-2.1-or-later
"""The stock as a model: files by suffix, shapes, sections, estimates, and what cannot be."""

import os
import tempfile
import unittest

import FreeCAD
import Mesh
import Part
import samples
from freecad.swarf_cam import native
from freecad.swarf_cam.app import fixtures, model, simulation
from freecad.swarf_cam.core.errors import JobError

VOXEL = 0.5
LEFT = 40 * 20 * 10 - 40 * 6 * 2


class TestModel(unittest.TestCase):
    def setUp(self):
        self.document = samples.new_document(self)
        self.job = samples.make_job(self.document)
        self.document.recompute()
        self.obj = simulation.simulate(simulation.make(self.job, VOXEL))
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def test_meshes(self):
        for suffix in model.MESH_SUFFIXES:
            for colour in (None, "operation", "deviation", "thickness"):
                count = model.export(self.obj, self.path("part" + suffix), colour=colour)
                self.assertEqual(count, self.obj.Mesh.CountFacets)
                self.assertGreater(os.path.getsize(self.path("part" + suffix)), 300)
        self.assertAlmostEqual(Mesh.Mesh(self.path("part.stl")).Volume, LEFT, delta=0.1)
        self.assertEqual(model.export(self.obj, self.path("stock.vdb")), 0)
        self.assertEqual(os.path.getsize(self.path("stock.vdb")), os.path.getsize(self.obj.Stock))

    def test_shapes(self):
        for name in ("part.step", "part.brep"):
            model.export(self.obj, self.path(name))
            shape = Part.Shape()
            shape.read(self.path(name))
            self.assertAlmostEqual(shape.Volume, LEFT, delta=0.1)
            self.assertTrue(shape.isValid())
            self.assertEqual(len(shape.Faces), 10)  # a slotted block
        limit, model.SHAPE_TRIANGLES_MAX = model.SHAPE_TRIANGLES_MAX, 10
        try:
            with self.assertRaisesRegex(JobError, "too many for a shape"):
                model.export(self.obj, self.path("many.step"))
        finally:
            model.SHAPE_TRIANGLES_MAX = limit

    def test_a_void_stays_one(self):
        mesh = Mesh.createBox(20.0, 20.0, 20.0)
        void = Mesh.createBox(6.0, 6.0, 6.0)
        void.flipNormals()
        beside = Mesh.createBox(2.0, 2.0, 2.0)
        beside.translate(50, 0, 0)
        for other in (void, beside):
            mesh.addMesh(other)
        shape = model.shape_of(mesh)
        self.assertTrue(shape.isValid())
        self.assertEqual([(round(solid.Volume, 6), len(solid.Shells), len(solid.Faces)) for solid in shape.Solids],
                         [(20 ** 3 - 6 ** 3, 2, 12), (8, 1, 6)])
        with self.assertRaisesRegex(JobError, "does not close"):
            model.shape_of(void)

    def test_what_cannot_be_added_leaves_nothing(self):
        names = [obj.Name for obj in self.document.Objects]
        with self.assertRaises(TypeError):
            model._add(self.obj, "no shape", "Shape", "Stock", "Stock")
        self.assertFalse(self.document.HasPendingTransaction)
        self.assertEqual([obj.Name for obj in self.document.Objects], names)

    def test_the_tolerance_colours(self):
        self.job.Operations.Group[0].Path = samples.path_of("G0 X-5 Y10 Z5", "G0 Z-1.9", "G1 X45 F10", "G0 Z5")
        self.document.recompute()
        simulation.simulate(self.obj)
        found = []
        for tolerance in (0.05, 0.5):
            model.export(self.obj, self.path("part.ply"), colour="deviation", tolerance_mm=tolerance)
            with open(self.path("part.ply"), "rb") as file:
                found.append(file.read())
        self.assertNotEqual(*found)

    def test_a_solid_of_the_result_is_a_stock(self):
        solid = model.add_shape(self.obj)
        across = samples.add_operation(self.document, "Across", samples.add_controller(
            self.document, 1, samples.end_mill(), CuttingEdgeHeight=20.0), "G0 X15 Y-5 Z-5", "G1 Y25 F10")
        job = samples.make_job(self.document, [across], [across.ToolController], stock=solid.Shape, design=False)
        self.document.recompute()
        found = simulation.simulate(simulation.make(job, VOXEL))
        self.assertAlmostEqual(found.VolumeInitial.Value, LEFT, delta=8)
        self.assertAlmostEqual(found.Mesh.Volume, LEFT - 6 * (20 * 5 - 6 * 2), delta=20)

    def test_section(self):
        self.document.openTransaction("before")
        self.document.commitTransaction()
        made = model.add_section(self.obj, (20, 0, 0), (1, 0, 0))
        self.assertEqual(len(made.Shape.Wires), 1)
        self.assertTrue(made.Shape.Wires[0].isClosed())
        self.assertAlmostEqual(Part.Face(made.Shape.Wires[0]).Area, 20 * 10 - 6 * 2, delta=0.01)
        with self.assertRaisesRegex(JobError, "does not cut"):
            model.section(self.obj, (0, 0, 50), (0, 0, 1))
        self.document.undo()
        self.assertIsNone(self.document.getObject("Section"))

    def test_section_as_svg(self):
        import importSVG

        made = model.add_section(self.obj, (0, 0, -1), (0, 0, 1))
        importSVG.export([made], self.path("section.svg"))
        with open(self.path("section.svg"), encoding="utf-8") as file:
            self.assertIn("<path", file.read())

    def test_estimates(self):
        for suffix in (".stl", ".ply", ".glb"):
            triangles, size = model.estimate(self.obj, suffix, model.default_error(self.obj))
            model.export(self.obj, self.path("part" + suffix))
            self.assertEqual(triangles, self.obj.Mesh.CountFacets)
            self.assertLess(abs(size - os.path.getsize(self.path("part" + suffix))), 1500)
        full, _ = model.estimate(self.obj, ".stl", 0)
        self.assertLess(full / 2, model.export(self.obj, self.path("full.stl"), error_mm=0))
        self.assertEqual(model.estimate(self.obj, ".vdb", 0)[1], os.path.getsize(self.obj.Stock))

    def test_cancelled_at_any_time(self):
        told = []
        model.export(self.obj, self.path("whole.ply"), told.append, colour="operation")
        self.assertEqual(told, sorted(told))
        self.assertTrue(0 <= told[0] and told[-1] <= 1)
        for wanted in (0.0, 0.15, 0.35, 0.6, 0.85, told[-1]):
            with self.assertRaises(native.load().Cancelled):
                model.export(self.obj, self.path("part.ply"), lambda done: done >= wanted, colour="operation")
            self.assertFalse(os.path.exists(self.path("part.ply")))

    def test_fixtures_leave_the_result_alone(self):
        clamp = self.document.addObject("Part::Feature", "Clamp")
        clamp.Shape = Part.makeBox(5, 5, 20, FreeCAD.Vector(40, 0, -10))
        fixtures.keep(self.job, [clamp])
        clamp.Placement.Base.x = 1.0
        self.document.recompute()
        self.assertTrue(self.obj.UpToDate)
        self.assertGreater(model.export(self.obj, self.path("part.stl")), 0)

    def test_colours_of_the_object(self):
        self.assertEqual(len(self.obj.FaceColours), self.obj.Mesh.CountFacets)
        self.assertEqual(len(set(self.obj.FaceColours)), 2)

    def test_what_cannot_be(self):
        with self.assertRaisesRegex(JobError, "written as"):
            model.export(self.obj, self.path("part.dwg"))
        with self.assertRaisesRegex(JobError, "fewest within this error"):
            model.export(self.obj, self.path("part.stl"), budget=4)
        with self.assertRaises(OSError):
            model.export(self.obj, os.path.join(self.folder, "no", "such", "folder.stl"))
        self.obj.VoxelSize = 0.4
        with self.assertRaisesRegex(JobError, "out of date"):
            model.export(self.obj, self.path("part.stl"))
        with self.assertRaisesRegex(JobError, "no result yet"):
            model.export(simulation.make(self.job, 1), self.path("part.stl"))
        self.job.Operations.Group[0].Path = samples.path_of(
            *("G1 X%d Y%d Z-11 F10" % (x, y) for y in range(-2, 24, 2) for x in (-5, 45)))
        self.document.recompute()
        nothing = simulation.simulate(simulation.make(self.job, VOXEL))
        with self.assertRaisesRegex(JobError, "nothing is left"):
            model.export(nothing, self.path("part.stl"))
        self.assertEqual(FreeCAD.ActiveDocument.Name, self.document.Name)
        self.assertEqual([name for name in os.listdir(self.folder) if name.startswith("part.")], [])


if __name__ == "__main__":
    unittest.main()
