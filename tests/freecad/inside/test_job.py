# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs -> JobData inside FreeCAD."""

import unittest

import FreeCAD
import Part
import samples
from FreeCAD import Rotation, Vector
from freecad.swarf_cam.app import job as jobs
from freecad.swarf_cam.core import moves
from freecad.swarf_cam.core.errors import JobError


class TestJob(unittest.TestCase):
    def setUp(self):
        self.document = samples.new_document(self)

    def ends(self, data):
        return [tuple(round(value, 6) for value in data.moves.row(i)[5:8]) for i in range(len(data.moves))
                if data.moves.row(i)[0] == moves.LINE]

    def test_plain(self):
        job = samples.make_job(self.document)
        data = jobs.read_job(jobs.pick_job(self.document))
        self.assertEqual(data.name, job.Label)
        self.assertEqual(data.stock, {"kind": "box", "lo": (0, 0, -10), "hi": (40, 20, 0)})
        self.assertEqual(self.ends(data), [(-5, 10, 5), (-5, 10, -2), (45, 10, -2), (45, 10, 5)])
        self.assertEqual([kind for kind, _ in data.tools[1][1]], ["flutes", "shank"])
        points = data.design[0]
        self.assertEqual((min(points[2::3]), max(points[1::3])), (-10, 20))

    def test_feed_is_per_minute(self):
        samples.make_job(self.document)
        data = jobs.read_job(jobs.pick_job(self.document))
        self.assertIn(600.0, [data.moves.row(i)[4] for i in range(len(data.moves))])

    def test_placement_and_dressup(self):
        controller = samples.add_controller(self.document, 4, samples.end_mill())
        base = samples.add_operation(self.document, "Base", controller)
        dressup = samples.feature(self.document, "Path::Feature", "Dressup", Base=("App::PropertyLink", base))
        dressup.Path = samples.path_of("G0 X1 Y2 Z3", "G1 X2 F1")
        dressup.Placement = FreeCAD.Placement(Vector(10, 0, 0), Rotation(Vector(0, 0, 1), 90))
        samples.make_job(self.document, [dressup], [controller])
        job = jobs.pick_job(self.document)
        data = jobs.read_job(job)
        self.assertEqual(self.ends(data), [(8, 1, 3), (8, 2, 3)])
        self.assertEqual(list(data.tools), [4])
        base.Active = False
        with self.assertRaisesRegex(JobError, "no active operation"):
            jobs.read_job(job)

    def test_several_jobs(self):
        samples.make_job(self.document)
        samples.make_job(self.document).Label = "Second"
        with self.assertRaisesRegex(JobError, "several jobs.*'Second'"):
            jobs.pick_job(self.document)
        self.assertEqual(jobs.pick_job(self.document, "Second").Label, "Second")
        with self.assertRaisesRegex(JobError, "no job 'x'"):
            jobs.pick_job(self.document, "x")

    def test_no_job(self):
        with self.assertRaisesRegex(JobError, "no Path/CAM job"):
            jobs.pick_job(self.document)

    def check_refused(self, text, **options):
        samples.make_job(self.document, **options)
        with self.assertRaisesRegex(JobError, text):
            jobs.read_job(jobs.pick_job(self.document))

    def test_empty_job(self):
        self.check_refused("no active operation", operations=[])

    def test_operation_without_tool(self):
        self.check_refused("operation 'Bare' has no tool controller",
                           operations=[samples.add_operation(self.document, "Bare", None, "G0 X1 Y1 Z1")])

    def test_tool_without_flutes(self):
        probe = samples.add_controller(self.document, 1, samples.end_mill(), ShapeName="probe")
        self.check_refused("no flutes", controllers=[probe])

    def test_same_number_different_tools(self):
        controllers = [samples.add_controller(self.document, 1, samples.end_mill(size)) for size in (4, 6)]
        operations = [samples.add_operation(self.document, "Op", controller, "G0 X1 Y1 Z1", "G1 X2 F1")
                      for controller in controllers]
        self.check_refused("both have the tool number 1", controllers=controllers, operations=operations)

    def test_no_stock(self):
        self.check_refused("no stock", stock=Part.Shape())

    def test_stock_that_is_no_block_becomes_a_mesh(self):
        samples.make_job(self.document, stock=Part.makeCylinder(20, 30))
        data = jobs.read_job(jobs.pick_job(self.document))
        points, triangles = data.stock["mesh"]
        self.assertEqual(data.stock["kind"], "mesh")
        edges = {}
        for i in range(0, len(triangles), 3):
            corner = triangles[i:i + 3]
            for a, b in zip(corner, (corner[1], corner[2], corner[0])):
                edges[a, b] = edges.get((a, b), 0) + 1
        self.assertTrue(all(edges.get((b, a)) == count for (a, b), count in edges.items()), "open mesh")
        self.assertAlmostEqual(max(points[0::3]), 20, places=2)

    def test_rotated_block_is_a_mesh(self):
        block = Part.makeBox(10, 10, 10)
        block.rotate(Vector(0, 0, 0), Vector(0, 0, 1), 30)
        samples.make_job(self.document, stock=block)
        self.assertEqual(jobs.read_job(jobs.pick_job(self.document)).stock["kind"], "mesh")

    def test_command_that_cannot_be_simulated(self):
        controller = samples.add_controller(self.document, 1, samples.end_mill())
        operation = samples.add_operation(self.document, "Odd", controller, "G0 X0 Y0 Z0", "G10 L2")
        self.check_refused("operation 'Odd', command 2, 'G10'", operations=[operation], controllers=[controller])
