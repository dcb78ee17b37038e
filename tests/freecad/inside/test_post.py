# SPDX-License-Identifier: LGPL-2.1-or-later
"""Real jobs, posted by FreeCAD's linuxcnc post and read back as G-code, against the jobs' own Path commands."""

import importlib
import math
import os
import pathlib
import struct
import tempfile
import unittest

import FreeCAD
from freecad.swarf_cam import native
from freecad.swarf_cam.app import job as jobs

SHARED = pathlib.Path(os.environ.get("SWARF_SHARED", pathlib.Path(__file__).resolve().parents[4] / "shared"))

# The post is told to write six decimals; arcs are written from there with their centres relative to the start.
TOLERANCE = 1e-4


def first_module(*names):
    """The first of these modules that there is: FreeCAD renamed them in 1.0."""
    for name in names:
        try:
            return importlib.import_module(name)
        except ImportError:
            continue
    return None


post = first_module("Path.Post.scripts.linuxcnc_post", "PathScripts.post.linuxcnc_post", "linuxcnc_post")
utility = first_module("Path.Base.Util", "PathScripts.PathUtil")


def output_list(job):
    """The operations with a change of tool before each whose controller differs from the last."""
    result, current = [], None
    for operation in job.Operations.Group:
        if not utility.opProperty(operation, "Active"):
            continue
        controller = utility.toolControllerForOp(operation)
        if controller is not None and controller is not current:
            result.append(controller)
            current = controller
        result.append(operation)
    return result


def cuts(program):
    """[(kind, tool, end, arc)] of what feeds, arc (centre, angle) or None; feeds that stay in place are left out."""
    sections = list(struct.iter_unpack("=iiiidii", bytes(program.sections)))
    arcs = bytes(program.arcs)
    result, here = [], (math.nan,) * 3
    for *end, _, _, arc, section_kind in struct.iter_unpack("=dddfIiI", bytes(program.moves)):
        kind, tool = section_kind & 7, sections[section_kind >> 3][0]
        moved = any(not abs(a - b) <= TOLERANCE for a, b in zip(here, end))
        if kind == 1 and (moved or arc >= 0):
            turn = None
            if arc >= 0:
                *centre, angle, plane, _ = struct.unpack_from("=dddd2i", arcs, 40 * arc)
                turn = (tuple(centre), angle, plane)
            result.append((tool, tuple(here), tuple(end), turn))
        here = end
    return result


@unittest.skipUnless(post and utility, "FreeCAD has no linuxcnc post")
class TestPost(unittest.TestCase):
    def differences(self, posted, own):
        """What of two lists of cuts is not the same; at most some."""
        found = []
        for index, (a, b) in enumerate(zip(posted, own)):
            same = a[0] == b[0] and all(abs(x - y) <= TOLERANCE for x, y in zip(a[2], b[2]))
            # where the first cut begins is known to neither or to one of them
            same = same and all(not abs(x - y) > TOLERANCE for x, y in zip(a[1], b[1]))
            if a[3] or b[3]:
                same = same and bool(a[3]) and bool(b[3]) and a[3][2] == b[3][2]
                # as the midpoints see it: a centre far away says little
                same = same and all(abs(x - y) <= TOLERANCE for x, y in zip(middle(a), middle(b)))
            if not same:
                found.append((index, a, b))
        return found[:3]

    def check(self, name):
        path = SHARED / "freecad" / name
        if not path.exists():
            self.skipTest(f"{path} is not there: set SWARF_SHARED")
        import swarf

        document = FreeCAD.openDocument(str(path))
        self.addCleanup(FreeCAD.closeDocument, document.Name)
        job = jobs.pick_job(document)
        own = native.to_job(jobs.read_job(job)).program
        with tempfile.TemporaryDirectory() as folder:
            target = os.path.join(folder, "job.ngc")
            post.export(output_list(job), target, "--no-show-editor --precision=6")
            posted = swarf.read_gcode(target)
        mine, theirs = cuts(posted), cuts(own)
        self.assertGreater(len(mine), 1000)
        self.assertEqual(self.differences(mine, theirs), [])
        self.assertEqual(len(mine), len(theirs))

    def test_job_of_this_version(self):
        version = FreeCAD.Version()
        self.check({"0": "job-0.20.FCStd"}.get(version[0], f"job-{version[0]}.{version[1]}.FCStd"))

    def test_job_of_the_oldest_version(self):
        self.check("job-0.20.FCStd")


def middle(cut):
    """The point half way along an arc."""
    _, start, end, (centre, angle, plane) = cut
    a, b, n = ((0, 1, 2), (2, 0, 1), (1, 2, 0))[plane]
    u, v = start[a] - centre[a], start[b] - centre[b]
    half = angle / 2
    point = [0.0, 0.0, 0.0]
    point[a] = centre[a] + math.cos(half) * u - math.sin(half) * v
    point[b] = centre[b] + math.sin(half) * u + math.cos(half) * v
    point[n] = (start[n] + end[n]) / 2
    return point
