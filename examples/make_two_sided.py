# SPDX-License-Identifier: LGPL-2.1-or-later
"""A part that is milled from both sides, in FreeCAD 0.20 to 1.1:  freecadcmd examples/make_two_sided.py

Two jobs in one document: "Top" faces, pockets and mills the upper half of the outline; the part is turned over;
"Bottom" cuts what "Top" left. Both are simulated, the second on the result of the first. Writes $SWARF_EXAMPLE_OUT
(default: examples/out/two_sided.FCStd), beside it result.stl and a few lines on both simulations, and ends FreeCAD,
with status 0 when the part came out as designed. $SWARF_EXAMPLE_VOXEL: voxel size, mm.
"""

import os
import sys

import FreeCAD
import Part
from FreeCAD import Vector

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
os.environ["SWARF_EXAMPLE_IMPORT"] = "1"

import freecad  # noqa: E402
import make_job  # noqa: E402

ADDON = os.path.join(os.path.dirname(HERE), "freecad_mod", "freecad")

LENGTH, WIDTH, HEIGHT = 60.0, 40.0, 20.0
TOP_DEPTH, BOTTOM_DEPTH = 8.0, 10.0  # of the pockets; a web of 2 mm is left between them
ALLOWANCE = 1.0


def pocket(x, y, length, width, bottom, depth):
    """A pocket with corners that a mill of 5 mm reaches."""
    box = Part.makeBox(length, width, depth, Vector(x, y, bottom))
    upright = [edge for edge in box.Edges if abs(edge.tangentAt(edge.FirstParameter).z) > 0.99]
    return box.makeFillet(4.0, upright)


def part_shape():
    """A block with a wide pocket from above and a narrow one from below."""
    shape = Part.makeBox(LENGTH, WIDTH, HEIGHT)
    shape = shape.cut(pocket(8, 6, 44, 28, HEIGHT - TOP_DEPTH, TOP_DEPTH))
    shape = shape.cut(pocket(16, 11, 22, 18, 0, BOTTOM_DEPTH))
    return shape.removeSplitter()


def add_job(document, part, name, placement):
    """A job on the part, lying as the placement says; the stock reaches to what was faced below."""
    job = make_job.Job.Create(name, [part], None)
    job.Label = name
    job.Model.Group[0].Placement = placement.multiply(job.Model.Group[0].Placement)
    document.recompute()
    replaced = job.Stock
    below = ALLOWANCE if name == "Top" else 0.0
    job.Stock = make_job.Stock.CreateFromBase(job, neg=Vector(2, 2, below), pos=Vector(2, 2, ALLOWANCE))
    document.removeObject(replaced.Name)
    mill = job.Tools.Group[0]  # the default 5 mm end mill
    mill.ToolNumber = 1
    make_job.set_speeds(mill, 12000, 600, 200)
    document.recompute()
    return job, mill


def add_operations(job, mill, pocket_floor, outline_to):
    """Face, pocket, outline."""
    model = job.Model.Group[0]
    shape = model.Shape

    def face(height):
        return [(model, [make_job.plane_at(shape, height)])]

    make_job.add_operation(job, "MillFace", job.Label + " facing", mill, face(HEIGHT), BoundaryShape="Stock",
                           FinalDepth=HEIGHT, StepDown=1.0)
    make_job.add_operation(job, "Pocket", job.Label + " pocket", mill, face(pocket_floor), FinalDepth=pocket_floor,
                           StepDown=4.0, StepOver=50, OffsetPattern="Offset", ClearingPattern="Offset")
    make_job.add_operation(job, "Profile", job.Label + " outline", mill, face(HEIGHT), processHoles=False,
                           processPerimeter=True, FinalDepth=outline_to, StepDown=4.0)


def make():
    """The document with both jobs -> (document, top, bottom)."""
    document = FreeCAD.newDocument("two_sided")
    part = document.addObject("Part::Feature", "Housing")
    part.Shape = part_shape()
    document.recompute()
    top, mill = add_job(document, part, "Top", FreeCAD.Placement())
    add_operations(top, mill, HEIGHT - TOP_DEPTH, 9.0)
    over = FreeCAD.Placement(Vector(0, WIDTH, HEIGHT), FreeCAD.Rotation(Vector(1, 0, 0), 180))
    bottom, mill = add_job(document, part, "Bottom", over)
    add_operations(bottom, mill, HEIGHT - BOTTOM_DEPTH, 10.0)
    document.recompute()
    return document, top, bottom


def describe(obj):
    """What a simulation came to, as a line."""
    return "%-8s %9.1f mm3 removed, %9.1f left, %7.2f too much, %7.2f missing, %d errors%s" % (
        obj.Job.Label, obj.VolumeRemoved.Value, obj.VolumeFinal.Value, obj.Excess.Value, obj.Gouge.Value, obj.Errors,
        "" if obj.UpToDate else " (out of date)")


def main():
    """Make, simulate both, save."""
    if ADDON not in freecad.__path__:
        freecad.__path__.append(ADDON)
    from freecad.swarf_cam.app import setups, simulation

    path = os.path.abspath(os.environ.get("SWARF_EXAMPLE_OUT") or os.path.join(HERE, "out", "two_sided.FCStd"))
    os.makedirs(os.path.dirname(path), exist_ok=True)
    document, top, bottom = make()
    voxel = float(os.environ.get("SWARF_EXAMPLE_VOXEL", "0.2"))
    first = simulation.simulate(simulation.make(top, voxel))
    simulation.set_stock(bottom, first, setups.placement_by_models(top, bottom))
    second = simulation.simulate(simulation.make(bottom, voxel))
    document.recompute()
    for obj in (first, second):
        print(describe(obj))
    if os.path.exists(path):
        os.remove(path)  # or FreeCAD keeps the old one beside it
    document.saveAs(path)
    result = os.path.join(os.path.dirname(path), "result.stl")
    second.Mesh.write(result)
    print("\nwritten:", path, "and", result)
    design = top.Model.Group[0].Shape.Volume
    off = abs(second.Mesh.Volume - design)
    if off > 1e-3 * design or second.Errors or not second.Mesh.isSolid():
        raise RuntimeError("the part is off by %.2f mm3 of %.1f" % (off, design))


if __name__ in ("make_two_sided", "__main__"):
    make_job.run(main)
