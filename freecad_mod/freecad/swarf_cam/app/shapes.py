# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes of a job as a box or triangles, in the document's coordinates."""

import array

import FreeCAD
import Part

from ..core.errors import JobError

# Greatest distance of triangles from a curved face, mm: a quarter of a usual tolerance of 0.02.
DEFLECTION_MM = 0.005

# A shape is taken for its bounding box when their volumes and corners agree to this, relative and in mm.
BOX_TOLERANCE = 1e-7


def as_box(shape):
    """(lo, hi) of a shape that is a block along the axes, else None."""
    if len(shape.Faces) != 6 or len(shape.Vertexes) != 8:
        return None
    columns = [[getattr(vertex, axis) for vertex in shape.Vertexes] for axis in "XYZ"]
    lo, hi = tuple(map(min, columns)), tuple(map(max, columns))
    volume = (hi[0] - lo[0]) * (hi[1] - lo[1]) * (hi[2] - lo[2])
    if volume <= 0 or abs(shape.Volume - volume) > BOX_TOLERANCE * volume:
        return None
    if any(min(abs(value - low), abs(value - high)) > BOX_TOLERANCE
           for column, low, high in zip(columns, lo, hi) for value in column):
        return None
    return tuple(round(value, 9) for value in lo), tuple(round(value, 9) for value in hi)


def as_mesh(found, deflection_mm=DEFLECTION_MM):
    """(points, triangles) of shapes, one after the other."""
    points, triangles = array.array("d"), array.array("I")
    for shape in found:
        base = len(points) // 3
        vertices, facets = shape.tessellate(deflection_mm)
        for vertex in vertices:
            points.extend((vertex.x, vertex.y, vertex.z))
        for facet in facets:
            if len(set(facet)) == 3:
                triangles.extend(base + index for index in facet)
    return points, triangles


def read_design(path, deflection_mm):
    """The solids of a CAD file or a FreeCAD document as one mesh: of a document with one job its model, else every
    solid that no other object is made from. JobError where there is none."""
    if not path.lower().endswith(".fcstd"):
        shape = Part.Shape()
        shape.read(path)
        solids = shape.Solids
    else:
        solids = _solids_of(FreeCAD.openDocument(path))
    if not solids:
        raise JobError("there is no solid in it")
    return as_mesh(solids, deflection_mm)


def _solids_of(document):
    groups = [obj.Model.Group for obj in document.Objects if hasattr(obj, "Model") and hasattr(obj, "Operations")]
    if len(groups) == 1:
        objects = groups[0]
    else:
        objects = [obj for obj in document.Objects
                   if not any(getattr(user, "Shape", None) is not None for user in obj.InList)]
    shapes = [getattr(obj, "Shape", None) for obj in objects]
    return [solid for shape in shapes if shape is not None and not shape.isNull() for solid in shape.Solids]


def stock_of(job):
    """The stock as a dict of kind "box" or "mesh". JobError when there is none."""
    shape = getattr(job.Stock, "Shape", None)
    if shape is None or shape.isNull() or not shape.Solids:
        raise JobError("the job '%s' has no stock, or it is not a solid: set it up in the job's Setup page" % job.Label)
    box = as_box(shape)
    if box:
        return {"kind": "box", "lo": box[0], "hi": box[1]}
    return {"kind": "mesh", "mesh": as_mesh(shape.Solids)}


def mesh_steps(found, deflection_mm=DEFLECTION_MM):
    """Steps -> as_mesh(): face by face, which leaves the triangles in the shapes, to be gathered at the end."""
    for shape in found:
        for face in shape.Faces:
            face.tessellate(deflection_mm)
            yield
    return as_mesh(found, deflection_mm)


def design_steps(job):
    """Steps -> the model as one mesh, None when it has no solid."""
    solids = []
    for model in getattr(job.Model, "Group", None) or []:
        shape = getattr(model, "Shape", None)
        if shape is not None and not shape.isNull():
            solids.extend(shape.Solids)
    return (yield from mesh_steps(solids)) if solids else None
