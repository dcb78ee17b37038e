# SPDX-License-Identifier: LGPL-2.1-or-later
"""The document object: simulate, out-of-date mark, save and reopen, undo, copy, deletion of the job."""

import math
import os
import tempfile
import unittest
import unittest.mock

import FreeCAD
import samples
import telling
from freecad.swarf_cam import native
from freecad.swarf_cam.app import job as jobs
from freecad.swarf_cam.app import simulation, wording
from freecad.swarf_cam.core.errors import JobError

VOXEL = 0.5
SLOT = 40 * 6 * 2.0


class TestSimulation(unittest.TestCase):
    def setUp(self):
        self.document = samples.new_document(self)
        self.job = samples.make_job(self.document)
        self.document.recompute()

    def make(self):
        self.document.openTransaction("make")
        obj = simulation.make(self.job, VOXEL)
        self.document.commitTransaction()
        self.document.recompute()
        return obj

    def operation(self):
        return self.job.Operations.Group[0]

    def reopen(self):
        path = os.path.join(self.folder(), "t.FCStd")
        self.document.saveAs(path)
        FreeCAD.closeDocument(self.document.Name)
        self.document = FreeCAD.openDocument(path)
        self.document.UndoMode = 1
        self.addCleanup(lambda: samples.document_is_open(self.document) and FreeCAD.closeDocument(self.document.Name))
        self.job = jobs.pick_job(self.document)
        return [obj for obj in self.document.Objects if simulation.is_simulation(obj)]

    def folder(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        return folder.name

    def test_results(self):
        obj = self.make()
        self.assertFalse(obj.UpToDate)
        self.assertEqual(obj.Mesh.CountFacets, 0)
        simulation.simulate(obj)
        self.assertTrue(obj.UpToDate)
        self.assertAlmostEqual(obj.VolumeInitial.Value, 8000, delta=1)
        self.assertAlmostEqual(obj.VolumeRemoved.Value, SLOT, delta=SLOT * 0.01)
        self.assertAlmostEqual(obj.VolumeFinal.Value, 8000 - SLOT, delta=SLOT * 0.01)
        self.assertTrue(obj.HasDesign)
        self.assertLess(max(obj.Excess.Value, obj.Gouge.Value), SLOT * 0.1)  # half-millimetre voxels round edges
        self.assertEqual(obj.Operations, ["Slot"])
        self.assertAlmostEqual(obj.RemovedByOperation[0], SLOT, delta=SLOT * 0.01)
        self.assertEqual((obj.Errors, obj.Findings), (0, []))
        self.assertTrue(obj.Mesh.isSolid())
        self.assertAlmostEqual(obj.Mesh.Volume, 8000 - SLOT, delta=20)
        self.assertGreater(os.path.getsize(obj.Stock), 1000)

    def test_findings_are_kept_in_english(self):
        obj = self.make()
        self.operation().Path = samples.path_of("G0 X-5 Y10 Z5", "G1 X45 F10")
        self.document.recompute()
        with unittest.mock.patch.object(wording, "translate", lambda context, text: text.upper()):
            simulation.simulate(obj)
        self.assertEqual(len(obj.Findings), 1)
        self.assertRegex(obj.Findings[0], "^note: operation 'Slot', command .*: operation 'Slot' removes nothing")

    def test_units_are_written_out_and_names_are_left_alone(self):
        amount = native.said("amount", value=0.125, area=2.5, volume=0.25)
        self.assertEqual(wording.say(native.said("gouge", amount=amount)), "gouge: 0.125 mm, 2.5 mm², 0.25 mm³ missing")
        kept = native.said("set-up kept", job="30 mm3", path="/tmp/30 mm2.vdb")
        self.assertEqual(wording.say(kept), str(kept))
        load = native.said("load", load=native.said("removal rate"), value=9.5, unit=native.said("mm3/s"), most=9)
        self.assertEqual(wording.say(load, ","), "removal rate 9,5 mm³/s exceeds the limit of 9 mm³/s")

    def test_progress_and_cancel_leave_the_object_as_it_was(self):
        obj = self.make()
        simulation.simulate(obj)
        removed, undo = obj.VolumeRemoved.Value, self.document.UndoCount
        self.operation().Path = samples.path_of("G0 X-5 Y10 Z-4", "G1 X45 F10")
        self.document.recompute()
        seen = []
        with telling.every_piece(), self.assertRaises(native.load().Cancelled):
            simulation.simulate(obj, progress=lambda fraction: seen.append(fraction) or True)
        self.assertEqual(len(seen), 1)
        self.assertEqual((obj.VolumeRemoved.Value, obj.UpToDate), (removed, False))
        self.assertEqual(self.document.UndoCount, undo)
        seen.clear()
        with telling.every_piece():
            simulation.simulate(obj, progress=seen.append)
        self.assertEqual(seen, sorted(seen))
        self.assertTrue(obj.UpToDate)

    def check_mark(self, change):
        obj = self.make()
        simulation.simulate(obj)
        self.document.recompute()
        self.assertTrue(obj.UpToDate, "a recompute alone must not change the mark")
        change(obj)
        self.document.recompute()
        self.assertFalse(obj.UpToDate)
        simulation.simulate(obj)
        self.assertTrue(obj.UpToDate)

    def test_mark_path(self):
        self.check_mark(lambda obj: setattr(self.operation(), "Path", samples.path_of("G0 X0 Y0 Z0", "G1 X4 F1")))

    def test_mark_active(self):
        second = samples.add_operation(self.document, "Two", self.job.Tools.Group[0], "G0 X0 Y0 Z0", "G1 X4 F1")
        self.job.Operations.Group = [self.operation(), second]
        self.document.recompute()
        self.check_mark(lambda obj: setattr(second, "Active", False))

    def test_mark_stock(self):
        import Part

        self.check_mark(lambda obj: setattr(self.job.Stock, "Shape", Part.makeBox(40, 20, 30)))

    def test_mark_tool(self):
        def change(obj):
            self.job.Tools.Group[0].Tool.Shape = samples.end_mill(5.0)

        self.check_mark(change)

    def test_mark_flute_length(self):
        self.check_mark(lambda obj: setattr(self.job.Tools.Group[0].Tool, "CuttingEdgeHeight", 5.0))

    def test_mark_voxel_size_at_once(self):
        obj = self.make()
        simulation.simulate(obj)
        obj.VoxelSize = 2 * VOXEL
        self.assertFalse(obj.UpToDate)
        obj.VoxelSize = VOXEL
        self.assertTrue(obj.UpToDate)

    def test_save_and_reopen(self):
        obj = self.make()
        simulation.simulate(obj)
        with open(obj.Stock, "rb") as file:
            stock = file.read()
        facets, removed = obj.Mesh.CountFacets, list(obj.RemovedByOperation)
        obj, = self.reopen()
        self.assertEqual(type(obj.Proxy).__name__, "Simulation")
        self.assertTrue(obj.UpToDate)
        self.document.recompute(None, True)
        self.assertTrue(obj.UpToDate, "opening and recomputing must not outdate a result")
        with open(obj.Stock, "rb") as file:
            self.assertEqual(file.read(), stock)
        self.assertEqual(obj.Mesh.CountFacets, facets)
        self.assertEqual(list(obj.RemovedByOperation), removed)
        self.assertEqual(obj.Job, self.job)
        read = native.load().Stock.read(obj.Stock)
        self.assertTrue(math.isclose(read.volume(), obj.VolumeFinal.Value, rel_tol=1e-6))
        simulation.simulate(obj)

    def test_undo_and_redo(self):
        obj = self.make()
        simulation.simulate(obj)
        name = obj.Name
        with open(obj.Stock, "rb") as file:
            stock = file.read()
        self.document.undo()
        self.assertFalse(obj.UpToDate)
        self.assertEqual((obj.VolumeRemoved.Value, obj.Mesh.CountFacets), (0, 0))
        self.document.redo()
        self.assertTrue(obj.UpToDate)
        self.assertGreater(obj.Mesh.CountFacets, 0)
        with open(obj.Stock, "rb") as file:
            self.assertEqual(file.read(), stock)
        self.document.undo()
        self.document.undo()
        self.assertIsNone(self.document.getObject(name))

    def test_second_result_undone_gives_the_first(self):
        obj = self.make()
        simulation.simulate(obj)
        with open(obj.Stock, "rb") as file:
            stock = file.read()
        obj.VoxelSize = 1.0
        simulation.simulate(obj)
        self.document.undo()
        with open(obj.Stock, "rb") as file:
            self.assertEqual(file.read(), stock)

    def test_copy_keeps_its_own_stock(self):
        obj = self.make()
        simulation.simulate(obj)
        with open(obj.Stock, "rb") as file:
            stock = file.read()
        copy = self.document.copyObject(obj, False)
        obj.VoxelSize = 1.0
        simulation.simulate(obj)
        with open(copy.Stock, "rb") as file:
            self.assertEqual(file.read(), stock)
        with open(obj.Stock, "rb") as file:
            self.assertNotEqual(file.read(), stock)
        self.assertEqual(copy.Mesh.CountFacets > 0, True)

    def test_deleting_the_job(self):
        obj = self.make()
        simulation.simulate(obj)
        self.document.removeObject(self.job.Name)
        self.document.recompute()
        self.assertIsNone(obj.Job)
        self.assertFalse(obj.UpToDate)
        self.assertGreater(obj.Mesh.CountFacets, 0, "the result itself stays")
        with self.assertRaisesRegex(JobError, "has no job"):
            simulation.simulate(obj)
        FreeCAD.ActiveDocument.removeObject(obj.Name)

    def test_refused(self):
        obj = self.make()
        obj.VoxelSize = 0
        with self.assertRaisesRegex(JobError, "greater than 0"):
            simulation.simulate(obj)
        obj.VoxelSize = 1e-6
        with self.assertRaises(MemoryError):
            simulation.simulate(obj)
        obj.VoxelSize = VOXEL
        obj.Job = self.job.Stock
        with self.assertRaisesRegex(JobError, "not a Path/CAM job"):
            simulation.simulate(obj)

    def test_document_of_an_older_version_gets_what_it_lacks(self):
        obj = self.make()
        obj.removeProperty("Errors")
        obj.Schema = 0
        obj, = self.reopen()
        self.assertEqual((obj.Errors, obj.Schema), (0, simulation.SCHEMA))

    def test_default_voxel_size(self):
        self.assertEqual(native.default_voxel((0, 0, 0), (100, 80, 25)), 0.2)
        self.assertEqual(native.default_voxel((0, 0, 0), (40, 20, 10)), 0.1)
