# SPDX-License-Identifier: LGPL-2.1-or-later
"""Set-ups in a row: a job cuts what another one left, turned over; marks along the chain, undo, save and reopen."""

import math
import os
import tempfile
import unittest

import FreeCAD
import samples
from FreeCAD import Vector
from freecad.swarf_cam import checks, native
from freecad.swarf_cam.app import setups, simulation
from freecad.swarf_cam.core import exchange
from freecad.swarf_cam.core.errors import JobError

VOXEL = 0.5

# The slot of samples.make_job() along X, 6 wide and 2 deep, and one across from the other side, 9 deep of 10.
FIRST, SECOND = 40 * 6 * 2.0, 20 * 6 * 9.0
BOTH = FIRST + SECOND - 6 * 6 * 1


class TestSetUps(unittest.TestCase):
    def setUp(self):
        self.document = samples.new_document(self)
        self.top = samples.make_job(self.document)
        controller = samples.add_controller(self.document, 1, samples.end_mill(), CuttingEdgeHeight=20.0)
        across = samples.add_operation(self.document, "Across", controller, "G0 Z5", "G0 X15 Y-5", "G0 Z-9",
                                       "G1 Y25 F10", "G0 Z5")
        self.bottom = samples.make_job(self.document, [across], [controller], design=False)
        self.document.recompute()
        self.part = self.top.Model.Group[0]
        self.over = setups.placement_turned(self.top, self.bottom, "X")

    def simulate(self, job):
        self.document.openTransaction("make")
        obj = simulation.make(job, VOXEL)
        self.document.commitTransaction()
        simulation.simulate(obj)
        self.document.recompute()
        return obj

    def chain(self):
        first = self.simulate(self.top)
        simulation.set_stock(self.bottom, first, self.over)
        self.assertEqual(simulation.default_voxel(self.bottom), VOXEL)
        return first, self.simulate(self.bottom)

    def test_the_second_cuts_what_the_first_left(self):
        first, second = self.chain()
        self.assertTrue(first.UpToDate and second.UpToDate)
        self.assertAlmostEqual(second.VolumeInitial.Value, first.VolumeFinal.Value, delta=1e-3)  # no voxel is lost
        self.assertAlmostEqual(second.VolumeFinal.Value, 8000 - BOTH, delta=12)
        self.assertAlmostEqual(second.Mesh.Volume, 8000 - BOTH, delta=0.2)  # exact in both set-ups
        self.assertTrue(second.Mesh.isSolid())
        # the slot of the first set-up is below now
        self.assertTrue(any(abs(point.z + 8) < 1e-3 for point in second.Mesh.Points))

    def test_the_placement_of_the_models(self):
        self.assertIsNone(setups.placement_by_models(self.top, self.bottom))
        clones = []
        for job in (self.top, self.bottom):
            clone = samples.feature(self.document, "Part::Feature", "Clone",
                                    Objects=("App::PropertyLinkList", [self.part]))
            clone.Shape = self.part.Shape
            job.Model.Group = [clone]
            clones.append(clone)
        clones[0].Placement = FreeCAD.Placement(Vector(1, 2, 3), FreeCAD.Rotation(Vector(0, 0, 1), 90))
        clones[1].Placement = FreeCAD.Placement(Vector(0, 20, -10), FreeCAD.Rotation(Vector(1, 0, 0), 180))
        found = setups.placement_by_models(self.top, self.bottom)
        for corner in (Vector(0, 0, 0), Vector(7, -3, 2)):
            there, here = (clone.Placement.multVec(corner) for clone in clones)
            self.assertLess((found.multVec(there) - here).Length, 1e-9)

    def test_any_turn_and_another_voxel(self):
        first = self.simulate(self.top)
        turn = FreeCAD.Placement(Vector(5, 3, 1), FreeCAD.Rotation(Vector(0.2, -0.5, 1), 33))
        simulation.set_stock(self.bottom, first, turn)
        self.document.openTransaction("make")
        obj = simulation.make(self.bottom, 0.4)
        self.document.commitTransaction()
        simulation.simulate(obj)
        self.assertAlmostEqual(obj.VolumeInitial.Value, 8000 - FIRST, delta=8)

    def test_marks_go_along_the_chain(self):
        first, second = self.chain()
        self.top.Operations.Group[0].Path = samples.path_of("G0 X-5 Y10 Z-3", "G1 X45 F10")
        self.document.recompute()
        self.assertFalse(first.UpToDate)
        self.assertFalse(second.UpToDate, "the second job cuts what the first leaves")
        # the first is out of date: the second plays its job as it is now
        simulation.simulate(second)
        self.assertTrue(second.UpToDate)
        self.assertAlmostEqual(second.VolumeInitial.Value, 8000 - 1.5 * FIRST, delta=12)
        simulation.simulate(first)
        self.assertTrue(first.UpToDate and second.UpToDate)
        first.VoxelSize = 0.8
        self.assertFalse(first.UpToDate or second.UpToDate, "at once, without a recompute")
        first.VoxelSize = VOXEL
        self.assertTrue(first.UpToDate and second.UpToDate)
        self.bottom.SwarfStockPlacement = FreeCAD.Placement()
        self.document.recompute()
        self.assertEqual((first.UpToDate, second.UpToDate), (True, False))

    def test_what_the_first_does_not_do_is_told_when_it_is_played(self):
        _, second = self.chain()
        self.assertEqual((second.Errors, second.Findings), (0, []))
        self.top.Operations.Group[0].Path = samples.path_of("G0 X-5 Y10 Z5", "G1 X45 F10")
        self.document.recompute()
        simulation.simulate(second)
        (line,) = second.Findings
        self.assertRegex(line, "^note: job '%s', operation 'Slot', command .*removes nothing" % self.top.Label)
        job = native.to_job(setups.read_job(self.bottom))
        outcome = checks.run(job, VOXEL, 0.05, lambda done: False)
        (found,) = (verdict for verdict in outcome.verdicts if verdict.kind == "uncut")
        self.assertRegex(found.text, "^set-up '%s'.*removes nothing" % self.top.Label)

    def test_undo(self):
        first = self.simulate(self.top)
        second = self.simulate(self.bottom)
        own = second.VolumeInitial.Value
        simulation.set_stock(self.bottom, first, self.over)
        self.assertFalse(second.UpToDate)
        simulation.simulate(second)
        self.assertLess(second.VolumeInitial.Value, own - 100)
        self.document.undo()
        self.document.undo()
        self.document.recompute()
        self.assertIsNone(setups.previous_of(self.bottom))
        self.assertTrue(second.UpToDate)
        self.assertAlmostEqual(second.VolumeInitial.Value, own, delta=1e-6)

    def test_undo_leaves_no_trace_in_the_links(self):
        first = self.simulate(self.top)
        self.document.openTransaction("of someone else")
        self.top.Label = "Upper"
        undo = self.document.UndoCount
        simulation.set_stock(self.bottom, first, self.over)
        self.assertEqual(self.document.UndoCount, undo + 1)
        for step, users in ((None, 1), ("undo", 0), ("redo", 1), ("undo", 0)):
            if step is not None:
                getattr(self.document, step)()
            # a user too many is a pointer to nowhere once the job is gone
            self.assertEqual(first.InList.count(self.bottom), users, step)
        self.assertEqual(self.top.Label, "Upper")
        simulation.set_stock(self.bottom, first, self.over)
        second = self.simulate(self.bottom)
        for obj, name in ((self.bottom, setups.STOCK_FROM), (second, "Job")):
            obj.removeProperty(name)  # as the property editor does
            self.assertIn(name, obj.PropertiesList)
        self.document.undo()
        self.document.undo()
        self.assertEqual(self.bottom.InList, [])
        self.document.redo()
        self.assertEqual(len(self.bottom.InList), 1)

    def test_save_and_reopen(self):
        first, second = self.chain()
        names = [obj.Name for obj in (self.top, self.bottom, first, second)]
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "t.FCStd")
            self.document.saveAs(path)
            FreeCAD.closeDocument(self.document.Name)
            self.document = FreeCAD.openDocument(path)
            self.addCleanup(FreeCAD.closeDocument, self.document.Name)
            top, bottom, first, second = (self.document.getObject(name) for name in names)
            self.document.recompute()
            self.assertTrue(first.UpToDate and second.UpToDate)
            self.assertIs(setups.previous_of(bottom), first)
            data = setups.read_job(bottom)
            self.assertEqual(data.stock["path"], first.Stock)
            removed = second.VolumeRemoved.Value
            simulation.simulate(second)
            self.assertAlmostEqual(second.VolumeRemoved.Value, removed, delta=1e-6)

    def test_the_command_line_reads_the_chain(self):
        self.chain()
        data = setups.read_job(self.bottom)
        with tempfile.TemporaryDirectory() as folder:
            exchange.write(folder, data)
            read = exchange.read(folder)
        self.assertEqual(read.stock["job"].name, self.top.Label)
        self.assertNotIn("path", read.stock)
        done = native.load().simulate(native.to_job(read), voxel=VOXEL)
        self.assertTrue(math.isclose(done.mesh.volume, 8000 - BOTH, abs_tol=0.2), done.mesh.volume)
        self.assertEqual(len(done.before), 1)

    def test_chains_that_cannot_be(self):
        first, second = self.chain()
        with self.assertRaisesRegex(JobError, "go round"):
            setups.assign(self.top, second, None)
        with self.assertRaisesRegex(JobError, "go round"):
            setups.assign(self.top, first, None)
        self.assertEqual(simulation.possible_previous(self.top), [])
        self.assertEqual(simulation.possible_previous(self.bottom), [first])
        first.Job = None
        self.document.recompute()
        self.assertFalse(second.UpToDate)
        with self.assertRaisesRegex(JobError, "has no job any more"):
            setups.read_job(self.bottom)
        self.document.removeObject(first.Name)
        self.document.recompute()
        self.assertFalse(second.UpToDate)  # the job's own stock is cut again
        self.assertEqual(setups.read_job(self.bottom).stock["kind"], "box")

    def test_nothing_left(self):
        self.top.Operations.Group[0].Path = samples.path_of(
            *("G1 X%d Y%d Z-11 F10" % (x, y) for y in range(-2, 24, 2) for x in (-5, 45)))
        self.document.recompute()
        first = self.simulate(self.top)
        self.assertEqual(first.Mesh.CountFacets, 0)
        simulation.set_stock(self.bottom, first, FreeCAD.Placement(Vector(0, 0, 0), FreeCAD.Rotation(10, 0, 0)))
        with self.assertRaisesRegex(native.load().GeometryError, "nothing is left"):
            self.simulate(self.bottom)


if __name__ == "__main__":
    unittest.main()
