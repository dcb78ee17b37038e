# SPDX-License-Identifier: LGPL-2.1-or-later
"""Make a milling job without a GUI, in FreeCAD 0.20 to 1.1:  freecadcmd examples/make_job.py

A clamping bracket, 80 x 60 x 15 mm, from a block with allowance: faced, pocket and step cleared, outline milled, holes
drilled and peck drilled, and a cylindrical trough finished by 3D Surface where opencamlib is there. Writes the file
$SWARF_EXAMPLE_OUT (default: examples/out/job.FCStd) and ends FreeCAD, with status 0 when it is written.
"""

import importlib
import os
import sys
import traceback

import FreeCAD
import Part
from FreeCAD import Vector

HERE = os.path.dirname(os.path.abspath(__file__))

LENGTH, WIDTH, HEIGHT = 80.0, 60.0, 15.0
POCKET_DEPTH, STEP_DEPTH, TROUGH_DEPTH = 6.0, 5.0, 3.0
HOLES = ((6, 6), (74, 6), (6, 54))  # of 5 mm, through


def module(*names):
    """The first of these modules that exists: 1.x moved what 0.20 has in PathScripts."""
    for name in names:
        try:
            return importlib.import_module(name)
        except ImportError:
            continue
    raise ImportError("none of the modules %s exists" % ", ".join(names))


Job = module("Path.Main.Job", "PathScripts.PathJob")
Stock = module("Path.Main.Stock", "PathScripts.PathStock")
Controller = module("Path.Tool.Controller", "PathScripts.PathToolController")
PathUtils = module("PathScripts.PathUtils")

OPERATIONS = {
    "MillFace": ("Path.Op.MillFace", "PathScripts.PathMillFace"),
    "Profile": ("Path.Op.Profile", "PathScripts.PathProfile"),
    "Pocket": ("Path.Op.PocketShape", "PathScripts.PathPocketShape"),
    "Adaptive": ("Path.Op.Adaptive", "PathScripts.PathAdaptive"),
    "Drilling": ("Path.Op.Drilling", "PathScripts.PathDrilling"),
    "Surface": ("Path.Op.Surface", "PathScripts.PathSurface"),
}


class FirstChoice:
    """Answers what FreeCAD would ask its user: operations of a job with several tools want to know which."""

    def selectedToolController(self):
        return None

    def chooseToolController(self, controllers):
        return controllers[0]

    def chooseJob(self, jobs):
        return jobs[0]

    def createJob(self):
        return None


def bracket():
    """The part: a rounded pocket, an open step, a trough along x, three holes; origin at a lower corner."""
    shape = Part.makeBox(LENGTH, WIDTH, HEIGHT)
    pocket = Part.makeBox(30, 22, POCKET_DEPTH, Vector(12, 30, HEIGHT - POCKET_DEPTH))
    upright = [edge for edge in pocket.Edges if abs(edge.tangentAt(edge.FirstParameter).z) > 0.99]
    shape = shape.cut(pocket.makeFillet(5.0, upright))
    shape = shape.cut(Part.makeBox(26, 26, STEP_DEPTH, Vector(LENGTH - 26, WIDTH - 26, HEIGHT - STEP_DEPTH)))
    radius = 20.0
    shape = shape.cut(Part.makeCylinder(radius, 40, Vector(20, 15, HEIGHT + radius - TROUGH_DEPTH), Vector(1, 0, 0)))
    for x, y in HOLES:
        shape = shape.cut(Part.makeCylinder(2.5, HEIGHT, Vector(x, y, 0)))
    return shape.removeSplitter()


def plane_at(shape, height):
    """Name of the horizontal plane face at a height; the largest one."""
    faces = [(face.Area, "Face%d" % number) for number, face in enumerate(shape.Faces, 1)
             if face.BoundBox.ZLength < 1e-6 and abs(face.BoundBox.ZMin - height) < 1e-6]
    return max(faces)[1]


def open_edges(shape, name):
    """The edges of a face that lie on the part's outside, as features that an operation extends the face over."""
    numbers = ["%d" % number for number, edge in enumerate(shape.Edges, 1)
               if any(edge.isSame(other) for other in shape.getElement(name).Edges)
               and (edge.BoundBox.XMin > LENGTH - 1e-6 or edge.BoundBox.YMin > WIDTH - 1e-6)]
    return ["%s:Wire(%s)" % (name, ",".join(numbers))]


def hole_at(shape, x, y):
    """Names of the faces of the hole at a place."""
    return ["Face%d" % number for number, face in enumerate(shape.Faces, 1)
            if isinstance(face.Surface, Part.Cylinder) and face.Surface.Radius < 3
            and abs(face.Surface.Center.x - x) + abs(face.Surface.Center.y - y) < 1e-6]


def tool_bit(file):
    """A tool bit of those that come with FreeCAD."""
    for folder in ("Mod/CAM/Tools/Bit", "Mod/Path/Tools/Bit"):
        path = os.path.join(FreeCAD.getHomePath(), folder, file)
        if os.path.exists(path):
            break
    try:
        factory = module("Path.Tool.Bit", "PathScripts.PathToolBit").Factory
    except AttributeError:  # 1.1
        return module("Path.Tool.toolbit").ToolBit.from_file(path).attach_to_doc(doc=FreeCAD.ActiveDocument)
    return factory.CreateFrom(path, os.path.splitext(file)[0])


def set_speeds(controller, rpm, feed, plunge):
    """Speeds of a tool controller, mm/min."""
    controller.SpindleSpeed = rpm
    controller.SpindleDir = "Forward"
    controller.HorizFeed = "%g mm/min" % feed
    controller.VertFeed = "%g mm/min" % plunge


def add_tool(job, number, file, rpm, feed, plunge):
    """A tool controller of the job."""
    name = os.path.splitext(file)[0]
    controller = Controller.Create("TC_" + name, tool=tool_bit(file), toolNumber=number)
    set_speeds(controller, rpm, feed, plunge)
    job.Proxy.addToolController(controller)
    return controller


def add_operation(job, kind, name, controller, base=None, **properties):
    """An operation of the job, computed."""
    PathUtils.UserInput = FirstChoice()
    creator = module(*OPERATIONS[kind])
    # Drilling looks for holes before it knows its job when it is given one; it finds the only job by itself.
    operation = creator.Create(name) if kind == "Drilling" else creator.Create(name, parentJob=job)
    operation.ToolController = controller
    if base:
        operation.Base = base
    for key, value in properties.items():
        if hasattr(operation, key):
            operation.setExpression(key, None)  # defaults are expressions and would win
            setattr(operation, key, value)
    FreeCAD.ActiveDocument.recompute()
    print("%-10s %5d commands" % (name, len(operation.Path.Commands)))
    return operation


def make():
    """The document with the job."""
    document = FreeCAD.newDocument("bracket")
    part = document.addObject("Part::Feature", "Bracket")
    part.Shape = bracket()
    document.recompute()
    job = Job.Create("Job", [part], None)
    allowance = Vector(3, 3, 0)
    replaced = job.Stock
    job.Stock = Stock.CreateFromBase(job, neg=allowance, pos=allowance + Vector(0, 0, 1))
    document.removeObject(replaced.Name)
    mill = job.Tools.Group[0]  # the default 5 mm end mill
    mill.ToolNumber = 1
    set_speeds(mill, 12000, 600, 200)
    drill = add_tool(job, 2, "5mm_Drill.fctb", 3000, 120, 120)
    ball = add_tool(job, 3, "6mm_Ball_End.fctb", 15000, 900, 300)
    document.recompute()

    model = job.Model.Group[0]
    shape = model.Shape

    def face(height):
        return [(model, [plane_at(shape, height)])]

    def holes(first, last=None):
        names = [name for x, y in HOLES[first:last] for name in hole_at(shape, x, y)]
        return [(model, names)]

    trough = ["Face%d" % number for number, item in enumerate(shape.Faces, 1)
              if isinstance(item.Surface, Part.Cylinder) and item.Surface.Radius > 15]
    add_operation(job, "MillFace", "Facing", mill, face(HEIGHT), BoundaryShape="Stock", FinalDepth=HEIGHT, StepDown=1.0)
    add_operation(job, "Adaptive", "Pocket", mill, face(HEIGHT - POCKET_DEPTH), StepDown=5.0, StepOver=25,
                  HelixAngle=5.0)
    step = plane_at(shape, HEIGHT - STEP_DEPTH)
    # beyond the open sides, or a spike is left of the stock's corner
    add_operation(job, "Pocket", "Step", mill, [(model, [step])], StepDown=3.0, StepOver=50, OffsetPattern="Offset",
                  ClearingPattern="Offset", ExtensionLengthDefault=6.0, ExtensionCorners=True,
                  ExtensionFeature=[(model, open_edges(shape, step))])
    add_operation(job, "Profile", "Outline", mill, face(0), processHoles=False, processPerimeter=True, FinalDepth=0.0,
                  StepDown=3.0)
    add_operation(job, "Drilling", "Drilling", drill, holes(2), FinalDepth=-2.0)
    add_operation(job, "Drilling", "PeckDrilling", drill, holes(0, 2), FinalDepth=-2.0, PeckEnabled=True, PeckDepth=4.0)
    try:
        module("opencamlib", "ocl")
    except ImportError:
        print("Surface    left out: opencamlib is not installed")
    else:
        add_operation(job, "Surface", "Trough", ball, [(model, trough)], StepOver=15, SampleInterval=0.5,
                      CutPattern="ZigZag", BoundBox="BaseBoundBox")
    document.recompute()
    return document, job


def main():
    """Make and save."""
    path = os.path.abspath(os.environ.get("SWARF_EXAMPLE_OUT") or os.path.join(HERE, "out", "job.FCStd"))
    os.makedirs(os.path.dirname(path), exist_ok=True)
    document, _ = make()
    if os.path.exists(path):
        os.remove(path)  # or FreeCAD keeps the old one beside it as job.FCStd1
    document.saveAs(path)
    print("\nwritten:", path)


def run(work):
    """Do the work of a script that freecadcmd runs, and end the process as it came out."""
    status = 1
    try:
        work()
        status = 0
    except BaseException:  # left to freecadcmd, it would run the file a second time, and exit with 0
        traceback.print_exc()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)  # freecadcmd would go on to wait for input


if __name__ in ("make_job", "__main__") and not os.environ.get("SWARF_EXAMPLE_IMPORT"):
    run(main)
