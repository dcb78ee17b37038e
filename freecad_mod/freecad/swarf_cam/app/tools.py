# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool bits -> profiles: the solid gives the geometry, its parameters say what cuts.

The stock parameters of some bits contradict their solids, so no dimension is taken from them but heights at which
the cutting part ends.
"""

import math

import FreeCAD
import Part

from ..core import cutter
from ..core.errors import JobError

# The section plane is turned away from the seam that revolved solids have in the plane y = 0: a section along an
# edge of the solid is where CAD kernels fail. Any angle that no drawing uses will do.
SECTION_ANGLE_DEG = 31.1

# A solid whose volume differs more than this from that of its section turned round is not a body of revolution.
REVOLUTION_TOLERANCE = 1e-3


def _half_plane(box):
    reach, low, high = box.DiagonalLength + 1.0, box.ZMin - 1.0, box.ZMax + 1.0
    corners = [FreeCAD.Vector(x, 0, z) for x, z in ((0, low), (reach, low), (reach, high), (0, high), (0, low))]
    return Part.Face(Part.makePolygon(corners))


def _segments(edge):
    """An edge of the section as segments in (r, z)."""
    first, last = edge.FirstParameter, edge.LastParameter
    if isinstance(edge.Curve, (Part.Line, Part.LineSegment)):
        a, b = edge.valueAt(first), edge.valueAt(last)
        return [((a.x, a.z), (b.x, b.z), 0.0)]

    def point_at(t):
        point = edge.valueAt(first + (last - first) * t)
        return point.x, point.z
    return cutter.fit(point_at)


def profile(shape):
    """Chain of nodes of a solid of revolution about z, its lowest point moved to z = 0. JobError says what is wrong
    with the solid."""
    if shape.isNull() or not shape.Solids:
        raise JobError("it has no solid")
    body = shape.copy()
    box = body.BoundBox
    body.rotate(FreeCAD.Vector(0, 0, 0), FreeCAD.Vector(0, 0, 1), -SECTION_ANGLE_DEG)
    try:
        if len(body.Solids) > 1:  # shank and head as bodies of their own
            body = body.Solids[0].multiFuse(body.Solids[1:]).removeSplitter()
        faces = _half_plane(box).common(body).removeSplitter().Faces
    except (Part.OCCError, RuntimeError, ValueError) as error:
        raise JobError("it cannot be sectioned: %s" % error) from error
    if len(faces) != 1:
        raise JobError("its section is not one outline but %d" % len(faces))
    nodes = cutter.chain([_segments(edge) for edge in faces[0].OuterWire.OrderedEdges])
    turned = 2 * math.pi * faces[0].CenterOfMass.x * faces[0].Area
    if abs(turned - body.Volume) > REVOLUTION_TOLERANCE * body.Volume:
        raise JobError("it is not a body of revolution about its axis z")
    return nodes


def parameters(tool):
    """Numbers among the tool's shape parameters: name -> mm or degrees."""
    result = {}
    for name in tool.PropertiesList:
        if tool.getGroupOfProperty(name) != "Shape" and name != "CuttingEdgeHeight":
            continue
        value = getattr(tool, name)
        value = getattr(value, "Value", value)
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            result[name] = float(value)
    return result


def shape_type(tool):
    """What kind of tool it says it is: ShapeName up to 1.0, ShapeType or ShapeID from 1.1."""
    for name in ("ShapeType", "ShapeName", "ShapeID"):
        value = getattr(tool, name, "")
        if value:
            return str(value)
    return ""


def describe(controller):
    """(name, parts) of a tool controller's tool. JobError names the controller."""
    tool = getattr(controller, "Tool", None)
    try:
        if tool is None:
            raise JobError("it has no tool")
        if getattr(tool, "Shape", None) is None:
            raise JobError("its tool is of the old kind without a solid; replace it by a tool bit")
        parts = cutter.parts(profile(tool.Shape), shape_type(tool), parameters(tool))
    except JobError as error:
        raise JobError("the tool of the tool controller '%s' (T%d): %s"
                       % (controller.Label, controller.ToolNumber, error)) from error
    return tool.Label, parts


def teeth(tool):
    """Number of cutting edges around a tool, 0 where it does not tell: its property Flutes."""
    count = getattr(tool, "Flutes", 0)
    return count if isinstance(count, int) and not isinstance(count, bool) and 0 < count <= 1000 else 0
