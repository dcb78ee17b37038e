# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every tool that comes with FreeCAD, sectioned and compared with its solid."""

import glob
import math
import os
import unittest

import FreeCAD
import Part
import samples
from FreeCAD import Vector
from freecad.swarf_cam.app import tools
from freecad.swarf_cam.core import cutter
from freecad.swarf_cam.core.errors import JobError

TOLERANCE = 1e-3


def stock_tools():
    """Files of the tool bits that come with FreeCAD."""
    return sorted(path for folder in ("Mod/Path/Tools/Bit", "Mod/CAM/Tools/Bit")
                  for path in glob.glob(os.path.join(FreeCAD.getHomePath(), folder, "*.fctb")))


def load(path):
    """A tool bit object of a file, in FreeCAD 0.20 to 1.1."""
    try:
        from Path.Tool.toolbit import ToolBit
    except ImportError:
        try:
            from Path.Tool.Bit import Factory
        except ImportError:
            from PathScripts.PathToolBit import Factory
        return Factory.CreateFrom(path, "Tool")
    return ToolBit.from_file(path).attach_to_doc(doc=FreeCAD.ActiveDocument)


class TestTools(unittest.TestCase):
    def setUp(self):
        self.document = samples.new_document(self)

    def test_every_shape_of_freecad(self):
        files = stock_tools()
        self.assertGreaterEqual(len(files), 9, "FreeCAD's own tool bits were not found")
        cutting = {}
        for path in files:
            with self.subTest(os.path.basename(path)):
                tool = load(path)
                self.document.recompute()
                nodes = tools.profile(tool.Shape)
                self.assertEqual((nodes[0][:2], nodes[-1][0]), ((0, 0), 0))
                self.assertAlmostEqual(cutter.volume(nodes) / tool.Shape.Volume, 1, delta=TOLERANCE)
                box = tool.Shape.BoundBox
                if not any(node[2] for node in nodes):  # an arc may reach beyond its ends
                    self.assertAlmostEqual(max(node[0] for node in nodes), box.XMax, delta=1e-4)
                self.assertAlmostEqual(nodes[-1][1], box.ZLength, delta=1e-4)
                heights = [node[1] for node in nodes]
                self.assertEqual(heights, sorted(heights))
                parts = cutter.parts(nodes, tools.shape_type(tool), tools.parameters(tool))
                cutting[os.path.basename(path).lower()] = [
                    part[-1][1] - part[0][1] for kind, part in parts if kind == cutter.FLUTES]
                if "60degree_vbit" in path.lower():
                    vbit = tools.parameters(tool)
                total = sum(cutter.volume(part) for _, part in parts)
                self.assertAlmostEqual(total / tool.Shape.Volume, 1, delta=TOLERANCE)
        self.assertEqual(cutting["probe.fctb"], [])
        # a cone from the tip's diameter, which differs between versions, to the bit's, and 1 mm
        tip = vbit["TipDiameter"]
        self.assertAlmostEqual(cutting["60degree_vbit.fctb"][0], (10 - tip) / 2 / math.tan(math.pi / 6) + 1, places=4)
        self.assertAlmostEqual(cutting["45degree_chamfer.fctb"][0], 6.35, places=4)
        self.assertAlmostEqual(cutting["slittingsaw.fctb"][0], 3.0, places=4)

    def test_native_cutters(self):
        from freecad.swarf_cam import native

        if not native.is_available():
            self.skipTest("the native module is not installed")
        for path in stock_tools():
            with self.subTest(os.path.basename(path)):
                tool = load(path)
                self.document.recompute()
                parts = cutter.parts(tools.profile(tool.Shape), tools.shape_type(tool), tools.parameters(tool))
                native_cutter = native.to_cutters({1: ("tool", parts)})[1]
                total = sum(native_cutter.volume(kind) for kind in {kind for kind, _ in parts})
                self.assertAlmostEqual(total / tool.Shape.Volume, 1, delta=TOLERANCE)

    def test_ball_and_torus_become_arcs(self):
        ball = Part.makeSphere(4, Vector(0, 0, 4)).fuse(Part.makeCylinder(2, 20, Vector(0, 0, 4))).removeSplitter()
        nodes = tools.profile(ball)
        self.assertEqual(sum(node[2] > 0 for node in nodes), 1)
        self.assertAlmostEqual(cutter.volume(nodes) / ball.Volume, 1, delta=1e-6)
        bull = Part.makeCylinder(5, 20)
        rim = [edge for edge in bull.Edges if isinstance(edge.Curve, Part.Circle) and edge.BoundBox.ZMax < 0.1]
        bull = bull.makeFillet(1.5, rim)
        nodes = tools.profile(bull)
        self.assertEqual([round(node[2], 6) for node in nodes[:3]], [0, round(math.tan(math.pi / 8), 6), 0])
        self.assertAlmostEqual(cutter.volume(nodes) / bull.Volume, 1, delta=1e-6)

    def test_solid_below_the_origin(self):
        nodes = tools.profile(Part.makeCylinder(3, 10, Vector(0, 0, -10)))
        self.assertEqual([node[1] for node in nodes], [0, 0, 10, 10])

    def test_head_and_shank_as_two_bodies(self):
        body = Part.makeCompound([Part.makeCylinder(3, 10), Part.makeCylinder(2, 10, Vector(0, 0, 10))])
        self.assertAlmostEqual(cutter.volume(tools.profile(body)), math.pi * 130, places=3)

    def test_refused(self):
        ring = Part.makeCylinder(5, 5).cut(Part.makeCylinder(2, 5))
        for shape, text in ((Part.makeBox(5, 5, 5, Vector(-2.5, -2.5, 0)), "body of revolution"),
                            (Part.makeCylinder(5, 5, Vector(1, 0, 0)), "body of revolution"),
                            (ring, "hole along its axis"), (Part.Shape(), "no solid"),
                            (Part.makePlane(1, 1), "no solid")):
            with self.subTest(text):
                controller = samples.add_controller(self.document, 7, shape, "TC_Odd")
                with self.assertRaisesRegex(JobError, r"controller 'TC_Odd\d*' \(T7\): it .*" + text):
                    tools.describe(controller)
