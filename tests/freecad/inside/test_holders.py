# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a document keeps for verification: holders with their stickout, fixtures, accepted findings; designs in CAD
files."""

import os
import tempfile
import unittest

import FreeCAD
import Mesh
import Part
import samples
from freecad.swarf_cam import native
from freecad.swarf_cam.app import accepted, fixtures, holders, shapes, state
from freecad.swarf_cam.app import job as jobs
from freecad.swarf_cam.core import exchange
from freecad.swarf_cam.core.errors import JobError


class TestHolders(unittest.TestCase):
    def setUp(self):
        self.document = samples.new_document(self)
        self.document.UndoMode = 1
        self.job = samples.make_job(self.document)
        self.document.recompute()
        self.controller = self.job.Tools.Group[0]

    def assign(self, name, stickout):
        self.document.openTransaction("holder")
        holders.assign(self.controller, name, stickout)
        self.document.commitTransaction()

    def test_assigned_and_undone(self):
        before = state.job_signature(self.job, 0.5)
        self.assertIsNone(holders.holder_of(self.controller))
        self.assign("SK40-ER16", 35.0)
        self.assertEqual(holders.holder_of(self.controller), ("SK40-ER16", 35.0))
        self.assertEqual(jobs.read_job(self.job).holders, {1: ("SK40-ER16", 35.0)})
        self.assertNotEqual(state.job_signature(self.job, 0.5), before)
        self.document.undo()
        self.assertIsNone(holders.holder_of(self.controller))
        self.assertEqual(state.job_signature(self.job, 0.5), before)
        self.document.redo()
        self.assertEqual(holders.holder_of(self.controller), ("SK40-ER16", 35.0))
        self.assign("", 0.0)
        self.assertIsNone(holders.holder_of(self.controller))

    def test_stickout_is_needed(self):
        for stickout in (0.0, -1.0):
            with self.assertRaisesRegex(JobError, "needs its stickout"):
                holders.assign(self.controller, "ER16", stickout)
        self.assertIsNone(holders.holder_of(self.controller))

    def test_the_cutter_has_it(self):
        self.assign("ER16", 35.0)
        job = native.to_job(jobs.read_job(self.job))
        self.assertEqual(job.tools[1].extent("holder")[0], 35.0)
        self.assertEqual(job.holders, {1: "ER16, stickout 35 mm"})
        self.assign("ER16", 15.0)
        self.assertTrue(any("would be clamped" in note for note in native.to_job(jobs.read_job(self.job)).notes))
        self.controller.SwarfStickout = 0.0
        with self.assertRaisesRegex(JobError, "T1.*needs its stickout"):
            native.to_job(jobs.read_job(self.job))
        self.controller.SwarfHolder, self.controller.SwarfStickout = "ER17", 20.0
        with self.assertRaisesRegex(JobError, "ER17.*not known"):
            native.to_job(jobs.read_job(self.job))

    def test_kept_in_the_file(self):
        self.assign("ER16", 35.0)
        accepted.accept(self.job, {"reason": "sanded", "kind": "excess"})
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "kept.FCStd")
            self.document.saveAs(path)
            FreeCAD.closeDocument(self.document.Name)
            document = FreeCAD.openDocument(path)
            self.addCleanup(FreeCAD.closeDocument, document.Name)
            job = jobs.pick_job(document)
            self.assertEqual(holders.holder_of(job.Tools.Group[0]), ("ER16", 35.0))
            self.assertEqual(accepted.accepted_of(job), [{"reason": "sanded", "kind": "excess"}])

    def test_accepted_findings(self):
        self.assertEqual(accepted.accepted_of(self.job), [])
        self.document.openTransaction("accept")
        accepted.accept(self.job, {"reason": "sanded", "kind": "excess", "place": [1, 2, 3]})
        accepted.accept(self.job, {"reason": "moved", "line": 3})
        self.document.commitTransaction()
        self.assertEqual([entry["reason"] for entry in jobs.read_job(self.job).accepted], ["sanded", "moved"])
        self.assertEqual(native.to_job(jobs.read_job(self.job)).accepted[1].line, 3)
        self.document.undo()
        self.assertEqual(accepted.accepted_of(self.job), [])
        with self.assertRaisesRegex(JobError, "reason"):
            accepted.accept(self.job, {"kind": "excess"})
        accepted.keep(self.job, [])
        self.job.SwarfAccepted = ["{"]
        with self.assertRaisesRegex(JobError, "acceptance 1"):
            accepted.accepted_of(self.job)


class TestDesigns(unittest.TestCase):
    def volume(self, mesh):
        points, triangles = mesh
        corner = [FreeCAD.Vector(*points[3 * index:3 * index + 3]) for index in triangles]
        return sum(a.dot(b.cross(c)) for a, b, c in zip(corner[::3], corner[1::3], corner[2::3])) / 6

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            solid = Part.makeBox(40, 20, 10).cut(Part.makeCylinder(6, 30, FreeCAD.Vector(20, 10, -5)))
            for suffix, write in ((".step", solid.exportStep), (".brep", solid.exportBrep),
                                  (".iges", solid.exportIges)):
                path = os.path.join(folder, "part" + suffix)
                write(path)
                if suffix == ".iges":  # holds faces only
                    with self.assertRaisesRegex(JobError, "no solid"):
                        shapes.read_design(path, 0.01)
                    continue
                coarse, fine = shapes.read_design(path, 0.5), shapes.read_design(path, 0.002)
                self.assertLess(len(coarse[1]), len(fine[1]))
                # chords lie inside the hole, each by at most the deflection
                self.assertLess(abs(self.volume(fine) - solid.Volume), 0.002 * 2 * 3.1416 * 6 * 10)

    def test_documents(self):
        document = samples.new_document(self)
        samples.make_job(document)
        document.recompute()
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "job.FCStd")
            document.saveAs(path)
            self.assertAlmostEqual(self.volume(shapes.read_design(path, 0.01)), 8000 - 480, delta=0.01)


class TestFixtures(unittest.TestCase):
    def setUp(self):
        self.document = samples.new_document(self)
        self.job = samples.make_job(self.document)
        self.clamp = self.document.addObject("Part::Feature", "Clamp")
        self.clamp.Shape = Part.makeBox(5, 5, 20, FreeCAD.Vector(40, 0, -10))
        self.document.recompute()

    def keep(self, *objects):
        self.document.openTransaction("fixtures")
        fixtures.keep(self.job, list(objects))
        self.document.commitTransaction()

    def test_kept_read_and_undone(self):
        before = state.job_signature(self.job, 0.5)
        self.assertEqual(fixtures.fixtures_of(self.job), [])
        self.keep(self.clamp, self.clamp)
        self.assertEqual(fixtures.fixtures_of(self.job), [self.clamp])
        self.assertEqual(state.job_signature(self.job, 0.5), before, "the stock knows nothing of it")
        after = fixtures.measures_of(self.job)
        (name, (points, triangles)), = jobs.read_job(self.job).fixtures
        self.assertEqual((name, len(triangles)), ("Clamp", 36))
        self.assertEqual((min(points[0::3]), max(points[2::3])), (40.0, 10.0))
        self.clamp.Placement.Base.x = 1.0
        self.assertNotEqual(fixtures.measures_of(self.job), after)
        self.document.undo()
        self.document.undo()
        self.assertEqual(fixtures.fixtures_of(self.job), [])

    def test_a_mesh_in_a_part_that_is_moved(self):
        part = self.document.addObject("App::Part", "Vice")
        jaw = self.document.addObject("Mesh::Feature", "Jaw")
        jaw.Mesh = Mesh.createBox(2.0, 4.0, 6.0)
        part.addObject(jaw)
        part.Placement.Base = FreeCAD.Vector(100, 0, 0)
        self.document.recompute()
        self.keep(jaw)
        (_, (points, triangles)), = jobs.read_job(self.job).fixtures
        self.assertEqual((min(points[0::3]), max(points[0::3]), len(triangles)), (99.0, 101.0, 36))

    def test_what_cannot_be_one(self):
        for obj, text in ((self.job.Stock, "stock or model"), (self.job.Model.Group[0], "stock or model"),
                          (self.job, "no solid"), (self.job.Operations.Group[0], "no solid")):
            with self.assertRaisesRegex(JobError, text):
                fixtures.keep(self.job, [obj])
        self.keep(self.clamp)
        self.clamp.Shape = Part.Shape()
        with self.assertRaisesRegex(JobError, "'Clamp' has no solid"):
            jobs.read_job(self.job)
        self.document.removeObject("Clamp")
        self.assertEqual(jobs.read_job(self.job).fixtures, [])

    def test_an_open_mesh_is_named(self):
        sheet = self.document.addObject("Mesh::Feature", "Sheet")
        sheet.Mesh = Mesh.Mesh([[[0, 0, 0], [9, 0, 0], [0, 9, 0]]])
        self.keep(sheet)
        with self.assertRaisesRegex(JobError, "the fixture 'Sheet'"):
            native.to_job(jobs.read_job(self.job))

    def test_through_the_file_and_the_exchange(self):
        self.keep(self.clamp)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "clamped.FCStd")
            self.document.saveAs(path)
            FreeCAD.closeDocument(self.document.Name)
            document = FreeCAD.openDocument(path)
            self.addCleanup(FreeCAD.closeDocument, document.Name)
            data = jobs.read_job(jobs.pick_job(document))
            exchange.write(folder, data)
            self.assertEqual(exchange.read(folder).fixtures, data.fixtures)
            self.assertEqual([name for name, _ in data.fixtures], ["Clamp"])
