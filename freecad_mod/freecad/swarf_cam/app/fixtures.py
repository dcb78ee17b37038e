# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fixtures of a job - a vice, clamps, the table: solids and meshes of the document that the job names in a property
which the add-on adds to it. The links say nothing of the order of a recompute, so that a fixture may depend on the
job."""

import array

import FreeCAD

from ..core.errors import JobError
from . import shapes

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

# Saved name: never change it.
FIXTURES, GROUP = "SwarfFixtures", "Swarf"

# Greatest distance of triangles from a curved face, mm: nobody clamps to less.
DEFLECTION_MM = 0.02


def fixtures_of(job):
    """The objects that a job names, in order; those that were deleted are gone."""
    return [obj for obj in getattr(job, FIXTURES, None) or [] if obj is not None]


def is_possible(obj):
    """Whether an object has a solid or a mesh."""
    shape, mesh = getattr(obj, "Shape", None), getattr(obj, "Mesh", None)
    return bool(shape is not None and not shape.isNull() and shape.Solids) or getattr(mesh, "CountFacets", 0) > 0


def keep(job, objects):
    """Name these objects, and no others; in the transaction of the caller, so that it can be undone. JobError for one
    that cannot be a fixture."""
    own = [job, job.Stock, *(getattr(job.Model, "Group", None) or [])]
    for obj in objects:
        if not is_possible(obj):
            raise JobError("'%s' cannot be a fixture: it has no solid and no mesh" % obj.Label)
        if obj in own:
            raise JobError("'%s' cannot be a fixture: it is the job's stock or model" % obj.Label)
    if FIXTURES not in job.PropertiesList:
        job.addProperty("App::PropertyLinkListHidden", FIXTURES, GROUP,
                        QT_TRANSLATE_NOOP("App::Property", "What holds the stock: nothing may touch it"))
    setattr(job, FIXTURES, list(dict.fromkeys(objects)))


def placed(obj):
    """(shape, None) or (None, mesh) of a fixture, in the document's coordinates. JobError when it has neither."""
    if not is_possible(obj):
        raise JobError("the fixture '%s' has no solid and no mesh" % obj.Label)
    shape = getattr(obj, "Shape", None)
    body = shape.copy() if shape is not None and not shape.isNull() and shape.Solids else obj.Mesh.copy()
    if hasattr(obj, "getGlobalPlacement"):
        body.Placement = obj.getGlobalPlacement()
    return (body, None) if hasattr(body, "Solids") else (None, body)


def measures_of(job):
    """What changes when a fixture of a job does, to what survives saving. JobError for a fixture without a body."""
    result = []
    for obj in fixtures_of(job):
        shape, mesh = placed(obj)
        body = shape or mesh
        box = body.BoundBox
        values = [box.XMin, box.YMin, box.ZMin, box.XMax, box.YMax, box.ZMax, body.Volume, body.Area]
        result += [round(value, 5) + 0.0 for value in values]
    return result


def mesh_steps(job):
    """Steps -> (label, (points, triangles)) of each fixture of a job."""
    result = []
    for obj in fixtures_of(job):
        shape, mesh = placed(obj)
        if shape is not None:
            made = yield from shapes.mesh_steps(shape.Solids, DEFLECTION_MM)
        else:
            points, facets = mesh.Topology
            made = (array.array("d", [value for point in points for value in (point.x, point.y, point.z)]),
                    array.array("I", [index for facet in facets for index in facet]))
            yield
        result.append((obj.Label, made))
    return result
