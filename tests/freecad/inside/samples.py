# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs made of plain features: all that the add-on asks of a job is its form."""

import FreeCAD
import Part
import Path
from FreeCAD import Vector


def feature(document, kind, name, **properties):
    """An object with added properties, each (type, value)."""
    obj = document.addObject(kind, name)
    for key, (property_type, value) in properties.items():
        obj.addProperty(property_type, key, "Shape" if property_type == "App::PropertyLength" else "Base")
        setattr(obj, key, value)
    return obj


def group(document, name, members):
    """A group like job.Operations."""
    obj = document.addObject("App::DocumentObjectGroup", name)
    obj.Group = members
    return obj


def path_of(*lines):
    """A Path of G-code lines; feeds in mm/s."""
    return Path.Path([Path.Command(line) for line in lines])


def add_controller(document, number, shape, name="TC", **parameters):
    """A tool controller with a tool of a given solid."""
    lengths = {key: ("App::PropertyLength", value) for key, value in parameters.items() if key != "ShapeName"}
    tool = feature(document, "Part::Feature", "Tool", **lengths)
    if "ShapeName" in parameters:
        tool.addProperty("App::PropertyString", "ShapeName", "Base")
        tool.ShapeName = parameters["ShapeName"]
    tool.Shape = shape
    controller = feature(document, "Path::Feature", name, ToolNumber=("App::PropertyInteger", number),
                         Tool=("App::PropertyLink", tool))
    controller.Path = path_of("(tool)", "M6 T%d" % number, "M3 S1000")
    return controller


def add_operation(document, name, controller, *lines, **properties):
    """An operation with a path."""
    obj = feature(document, "Path::Feature", name, Active=("App::PropertyBool", True), **properties)
    if controller is not None:
        obj.addProperty("App::PropertyLink", "ToolController", "Base")
        obj.ToolController = controller
    obj.Path = path_of(*lines)
    return obj


def end_mill(diameter=6.0, length=20.0, shank=10.0):
    """A cylinder, tip at the origin."""
    return Part.makeCylinder(diameter / 2, length + shank)


def make_job(document, operations=None, controllers=None, stock=None, design=True):
    """A job in a block of 40 x 20 x 10 mm with a slot 6 mm wide and 2 mm deep along its middle."""
    if controllers is None:
        controllers = [add_controller(document, 1, end_mill(), CuttingEdgeHeight=20.0)]
    if operations is None:
        operations = [add_operation(document, "Slot", controllers[0], "G0 Z5", "G0 X-5 Y10", "G0 Z-2", "G1 X45 F10",
                                    "G0 Z5")]
    block = document.addObject("Part::Feature", "Stock")
    block.Shape = Part.makeBox(40, 20, 10, Vector(0, 0, -10)) if stock is None else stock
    model = document.addObject("Part::Feature", "Part")
    model.Shape = Part.makeBox(40, 20, 10, Vector(0, 0, -10)).cut(Part.makeBox(40, 6, 2, Vector(0, 7, -2)))
    return feature(document, "App::FeaturePython", "Job",
                   Operations=("App::PropertyLink", group(document, "Ops", operations)),
                   Tools=("App::PropertyLink", group(document, "Tools", controllers)),
                   Stock=("App::PropertyLink", block),
                   Model=("App::PropertyLink", group(document, "Model", [model] if design else [])))


def new_document(test, name="swarf_test"):
    """A document that the test closes."""
    document = FreeCAD.newDocument(name)
    document.UndoMode = 1
    test.addCleanup(lambda: document_is_open(document) and FreeCAD.closeDocument(document.Name))
    return document


def document_is_open(document):
    """Whether it was closed already."""
    try:
        return document.Name in FreeCAD.listDocuments()
    except ReferenceError:
        return False
