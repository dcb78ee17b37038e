# SPDX-License-Identifier: LGPL-2.1-or-later
"""The stock as a model: files by suffix, shapes, sections, estimates, and what cannot be."""

import importlib
import math
import os
import tempfile
import unittest
from unittest import mock

import FreeCAD
import Mesh
import Part
import samples
import telling
from freecad.swarf_cam import native
from freecad.swarf_cam.app import fixtures, model, pieces, simulation
from freecad.swarf_cam.core import steps
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

    def test_a_slope_by_an_end_mill_is_facets(self):
        self.job.Operations.Group[0].Path = samples.path_of("G0 X8 Y10 Z5", "G0 Z0", "G1 X32 Z-4 F10", "G0 Z5")
        self.document.recompute()
        simulation.simulate(self.obj)
        made = steps.run(model.export_steps(self.obj, self.path("part.step")))
        made.run()
        made.finish()
        self.assertTrue(0.8 < made.analytic.share < 1, made.analytic)
        self.assertIn("planes, cylinders", made.analytic.reason)
        shape = Part.Shape()
        shape.read(self.path("part.step"))
        self.assertTrue(shape.isValid() and all(isinstance(face.Surface, Part.Plane) for face in shape.Faces))
        self.assertAlmostEqual(shape.Volume, self.obj.Mesh.Volume, delta=0.2)
        limit, model.SHAPE_TRIANGLES_MAX = model.SHAPE_TRIANGLES_MAX, 10
        try:
            with self.assertRaisesRegex(JobError, "too many for a shape"):
                model.export(self.obj, self.path("many.step"))
        finally:
            model.SHAPE_TRIANGLES_MAX = limit

    def test_facets_are_made_where_they_are_needed(self):
        """What is analytic has no second mesh, and what was not measured has no share."""
        counts, export = [], native.export
        solids = importlib.import_module(native.load().__name__ + ".solids.export")

        def counted(*args, **words):
            counts.append(export(*args, **words))
            return counts[-1]

        with mock.patch.object(native, "export", counted), \
                mock.patch.object(model.FreeCAD, "Console", mock.Mock(wraps=FreeCAD.Console)) as console:
            model.export(self.obj, self.path("part.step"))
            self.assertEqual(counts, [])
            with mock.patch.object(solids, "TRIANGLES_MAX", 4):
                model.export(self.obj, self.path("part.step"))
            self.assertEqual(counts, [self.obj.Mesh.CountFacets])
            with mock.patch.object(model, "_doubt", lambda *_: "in doubt"):  # told in the end: its mesh is made then
                model.export(self.obj, self.path("doubt.step"))
            self.assertEqual(counts, 2 * [self.obj.Mesh.CountFacets])
            told = [call.args[0] for call in console.PrintWarning.call_args_list]
        self.assertEqual(told, ["Swarf: the shape is made of flat facets: its mesh has 28 triangles, and faces are "
                                "told of 4 at most\n", "Swarf: the shape is made of flat facets: in doubt\n"])

    def test_what_freecad_doubts_is_not_taken(self):
        made = native.Analytic(1.0, None, 8.0, 24.0, 0.01, 6)
        self.assertIsNone(model._doubt(Part.makeBox(2, 2, 2), made))
        self.assertIn("volume", model._doubt(Part.makeBox(2, 2, 2.1), made))
        self.assertIn("not valid", model._doubt(Part.makeBox(2, 2, 2).Faces[0], made))

    def test_analytic_faces(self):
        """A profile with round corners, a pocket, a slot with round ends, a drilled hole: faces as they were cut."""
        cone = 2.5 / math.tan(math.radians(59))
        shank = Part.makeCylinder(2.5, 30, FreeCAD.Vector(0, 0, cone))
        drill = Part.makeCone(0, 2.5, cone).fuse(shank).removeSplitter()
        tools = [samples.add_controller(self.document, 1, samples.end_mill(10), CuttingEdgeHeight=20.0),
                 samples.add_controller(self.document, 2, samples.end_mill(6), CuttingEdgeHeight=20.0),
                 samples.add_controller(self.document, 3, drill, CuttingEdgeHeight=20.0)]
        operations = [
            samples.add_operation(self.document, "Profile", tools[0], "G0 Z5", "G0 X0 Y10", "G0 Z-6", "G1 Y30 F10",
                                  "G2 X10 Y40 I10 J0", "G1 X50", "G2 X60 Y30 I0 J-10", "G1 Y10", "G2 X50 Y0 I-10 J0",
                                  "G1 X10", "G2 X0 Y10 I0 J10", "G0 Z5"),
            samples.add_operation(self.document, "Pocket", tools[1], "G0 X13 Y13 Z5", "G1 Z-4 F10", "G1 X27", "G1 Y21",
                                  "G1 X13", "G1 Y13", "G1 Y17", "G1 X27", "G0 Z5"),
            samples.add_operation(self.document, "Slot", tools[1], "G0 X38 Y12 Z5", "G1 Z-3 F10", "G1 X48", "G0 Z5"),
            samples.add_operation(self.document, "Hole", tools[2], "G0 X42 Y26 Z5", "G1 Z-8 F10", "G0 Z5")]
        job = samples.make_job(self.document, operations, tools, design=False,
                               stock=Part.makeBox(60, 40, 10, FreeCAD.Vector(0, 0, -10)))
        self.document.recompute()
        found = simulation.simulate(simulation.make(job, 0.25))
        corners = 4 - math.pi
        volume = 24000 - (2400 - 1500 + corners * 25) * 6 - (20 * 14 - corners * 9) * 4 - (60 + math.pi * 9) * 3 \
            - math.pi * 6.25 * (8 - cone + cone / 3)
        shapes = [model.add_shape(found).Shape]
        for name in ("part.step", "part.brep"):
            model.export(found, self.path(name))
            shapes.append(Part.Shape())
            shapes[-1].read(self.path(name))
        for shape in shapes:
            self.assertTrue(shape.isValid() and len(shape.Solids) == 1 and shape.Solids[0].isClosed())
            self.assertEqual(sorted(type(face.Surface).__name__ for face in shape.Faces),
                             ["Cone"] + ["Cylinder"] * 11 + ["Plane"] * 19)
            self.assertAlmostEqual(shape.Volume / volume, 1, delta=1e-9)
            self.assertEqual(sorted(round(face.Surface.Radius, 6) for face in shape.Faces
                                    if isinstance(face.Surface, Part.Cylinder)), [2.5] + [3.0] * 6 + [5.0] * 4)
            curves = [type(edge.Curve).__name__ for edge in shape.Edges]
            self.assertLessEqual(curves.count("BSplineCurve"), 2)  # FreeCAD's own seams of the hole and its cone
            self.assertEqual(set(curves) - {"BSplineCurve"}, {"Line", "Circle"})

    def test_slots_with_rounded_edges(self):
        """A tool with rounded corners: FreeCAD reads tori and the quarters of circles beside them as sound solids."""
        swarf = native.load()
        brep, step = (importlib.import_module("%s.solids.%s" % (swarf.__name__, name)) for name in ("brep", "step"))
        cross = 6 * 4 - 2 * (1 - math.pi / 4)
        first = math.pi * 9 * 3 + math.pi * (4 + math.pi + 2 / 3)
        for places, removed in (((10, 10), (40, 10)), first + 30 * cross), (((10, 10), (40, 10), (40, 30)), None), \
                (((10, 10), (40, 10), (40, 14), (10, 14), (10, 18), (40, 18)), None), \
                (((10, 20), (30, 20), (35, 25), (35, 35)), first + (30 + 2.5 * math.pi) * cross):
            program = swarf.Program(start=(*places[0], 5))
            program.add_operation("cut")
            program.set_section(tool=1)
            for place in ((x, y, -4) for x, y in places):
                if place[:2] == (35, 25):
                    program.add_arc(place, (30, 25, -4), ccw=True, feed_mm_min=100)
                else:
                    program.add_line(place, feed_mm_min=100)
            job = swarf.Job(name="cut", program=program, tools={1: swarf.Cutter("bull:d=6,r=1,l=20")},
                            stock={"kind": "box", "lo": (0, 0, -10), "hi": (60, 40, 0)})
            made = swarf.simulate(job, voxel=0.4, compare=False)
            mesh = swarf.Mesh.from_stock(made.stock, 0.008, surface=made.surface)
            step.write(brep.make(mesh, made.surface, 0.4), self.path("slot.step"))
            shape = Part.Shape()
            shape.read(self.path("slot.step"))
            self.assertTrue(shape.isValid() and len(shape.Solids) == 1 and shape.Solids[0].isClosed())
            self.assertAlmostEqual(shape.Volume, mesh.volume, delta=0.008 * mesh.area)
            if removed is not None:
                self.assertAlmostEqual(shape.Volume, 24000 - removed, delta=1e-3)

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
        floor = []  # 0.1 mm is left there: too much, or what is meant to be left
        for allowance in (0.0, 0.1):
            model.export(self.obj, self.path("part.obj"), colour="deviation", tolerance_mm=0.02, allowance_mm=allowance)
            with open(self.path("part.obj"), encoding="ascii") as file:
                corners = [tuple(map(float, line.split()[1:])) for line in file if line.startswith("v ")]
            floor.append([corner[3:] for corner in corners if abs(corner[2] + 1.9) < 1e-3])
        red = [[colour for colour in colours if colour[0] > 3 * colour[1]] for colours in floor]
        self.assertTrue(red[0] and floor[1] and not red[1], floor)  # and all others are now 0.1 mm short

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

    def test_section_as_dxf(self):
        import Import
        import importDXF

        made = model.add_section(self.obj, (0, 0, -1), (0, 0, 1))
        importDXF.export([made], self.path("section.dxf"))
        other = samples.new_document(self, "dxf")
        Import.readDXF(self.path("section.dxf"), other.Name)
        other.recompute()
        # FreeCAD 1.0 puts layers beside the lines
        read = Part.makeCompound([obj.Shape for obj in other.Objects if hasattr(obj, "Shape")])
        self.assertAlmostEqual(sum(edge.Length for edge in read.Edges), 4 * 40 + 4 * 7, delta=0.01)
        self.assertEqual([round(getattr(read.BoundBox, name), 3) for name in ("XMin", "XMax", "YMin", "YMax")],
                         [0, 40, 0, 20])

    def test_drawing_of_two_curves(self):
        """What `swarf mesh --section` writes, read by FreeCAD: all curves, closed."""
        import Import

        plane = ((0, 0, -1), (0, 0, 1))
        curves = pieces.body_of(self.obj).section(*plane)
        drawing = importlib.import_module("swarf.drawing")
        drawing.write(drawing.flat(curves, *plane), self.path("two.dxf"))
        other = samples.new_document(self, "two")
        Import.readDXF(self.path("two.dxf"), other.Name)
        other.recompute()
        read = Part.makeCompound([obj.Shape for obj in other.Objects if hasattr(obj, "Shape")])
        wires = [Part.Wire(edges) for edges in Part.sortEdges(read.Edges)]
        self.assertEqual([wire.isClosed() for wire in wires], [True, True])
        self.assertAlmostEqual(sum(Part.Face(wire).Area for wire in wires), 2 * 40 * 7, delta=0.01)

    def test_estimates(self):
        for suffix in (".stl", ".ply", ".glb"):
            triangles, size = model.estimate(self.obj, suffix, model.default_error(self.obj))
            model.export(self.obj, self.path("part" + suffix))
            self.assertEqual(triangles, self.obj.Mesh.CountFacets)
            self.assertLess(abs(size - os.path.getsize(self.path("part" + suffix))), 1500)
        full, _ = model.estimate(self.obj, ".stl", 0)
        self.assertLess(full / 2, model.export(self.obj, self.path("full.stl"), error_mm=0))
        self.assertEqual(model.estimate(self.obj, ".stl", 0.01, budget=1000)[0], 1000)
        self.assertEqual(model.estimate(self.obj, ".stl", 0.01, budget=10 ** 9)[0], full)
        self.assertEqual(model.estimate(self.obj, ".vdb", 0)[1], os.path.getsize(self.obj.Stock))

    def test_cancelled_at_any_time(self):
        told = []
        with telling.every_piece():
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

    def test_what_cannot_be_written_leaves_what_was_there(self):
        """Each suffix: onto a folder, into none, and a disk that is full half way."""
        def fill(path):
            with open(path, "w", encoding="utf-8") as file:
                file.write("half")
            raise OSError(28, "No space left on device")

        with open(self.path("good.step"), "w", encoding="utf-8") as file:
            file.write("good")
        with self.assertRaisesRegex(JobError, "good.step: cannot write: No space left"):
            model.put(self.path("good.step"), fill)
        with open(self.path("good.step"), encoding="utf-8") as file:
            self.assertEqual(file.read(), "good")
        self.assertEqual(os.listdir(self.folder), ["good.step"])
        for suffix in (".vdb", ".step", ".brep"):
            os.mkdir(self.path("folder" + suffix))
            for name, why in (("folder" + suffix, "it is not a regular file"), ("none/a" + suffix, "No such file")):
                with self.assertRaisesRegex(JobError, "%s: cannot .*%s" % (name, why)):
                    model.export(self.obj, self.path(name))

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
