# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is left of the stock as a model: mesh files on the exact surface, solids for CAD, section wires."""

import collections
import math
import os
import shutil
import tempfile

import FreeCAD
import Mesh
import Part

from .. import native
from ..core import steps
from ..core.errors import JobError
from . import job as jobs
from . import pieces, setups, wording

translate = FreeCAD.Qt.translate

MESH_SUFFIXES = (".stl", ".ply", ".obj", ".3mf", ".glb")
STOCK_SUFFIXES = (".vdb",)
SHAPE_SUFFIXES = (".step", ".stp", ".brep", ".brp")

# A shape has a face per flat piece of the mesh; beyond this FreeCAD takes minutes, and what it gives is of no use.
SHAPE_TRIANGLES_MAX = 20000

# Bytes of a file per triangle, about, without and with colours; a mesh has half as many vertices.
BYTES = {".stl": (50, 50), ".ply": (19, 22), ".obj": (33, 42), ".3mf": (15, 18), ".glb": (18, 30), ".step": (900, 900),
         ".stp": (900, 900), ".brep": (450, 450), ".brp": (450, 450)}


def suffix_of(path):
    """Suffix in lower case. JobError unless a stock can be written as that."""
    suffix = os.path.splitext(path)[1].lower()
    known = MESH_SUFFIXES + STOCK_SUFFIXES + SHAPE_SUFFIXES
    if suffix not in known:
        raise JobError("%s: a stock is written as %s" % (path, ", ".join(known)))
    return suffix


def default_error(obj):
    """Error of a mesh where nobody says, mm: that of the mesh in the document."""
    return native.MESH_ERROR_VOXELS * obj.VoxelSize.Value


def estimate(obj, suffix, error_mm, coloured=False, budget=0):
    """(triangles, bytes) of a file, about: from the mesh in the document, whose triangles on curved faces grow as the
    root of the error falls; with a budget at most, as many of them are used as the mesh has a use for."""
    if suffix in STOCK_SUFFIXES:
        return 0, os.path.getsize(obj.Stock) if obj.Stock else 0
    most = 3 * obj.Mesh.Area / obj.VoxelSize.Value ** 2  # every crossing of the lattice has a quadrilateral
    count = obj.Mesh.CountFacets * math.sqrt(default_error(obj) / error_mm) if error_mm > 0 else most
    count = max(4, min(budget or count, most))
    return int(count), int(count * BYTES[suffix][bool(coloured)])


def put(path, write):
    """Write a file by write(its path) beside its place and put it there: a failure leaves what is there. JobError."""
    place = os.path.realpath(path)
    if os.path.exists(place) and not os.path.isfile(place):
        raise JobError("%s: cannot be written: it is not a regular file" % path)
    try:
        with tempfile.TemporaryDirectory(prefix=".swarf-", dir=os.path.dirname(place)) as folder:
            made = os.path.join(folder, "stock" + suffix_of(path))
            write(made)
            os.replace(made, place)
    except OSError as error:
        raise JobError("%s: cannot write: %s" % (path, error.strerror or error)) from error
    except (Part.OCCError, RuntimeError) as error:  # FreeCAD's own name no file
        raise JobError("%s: cannot write: %s" % (path, error)) from error


class Export:
    """One export: prepared here, run() in any thread, finish() here again."""

    def __init__(self, obj, path, data, options):
        self.path, self.data, self.options = path, data, options
        self.suffix = suffix_of(path)
        self.stock_file, self.up_to_date = obj.Stock, obj.UpToDate
        self._folder = None
        error = options.get("error_mm")  # as fine as the mesh in the document: no fewer triangles, and known before
        self._least = obj.Mesh.CountFacets if error is None or error <= default_error(obj) else 0
        self.analytic = None  # native.Analytic of a shape: what share of its faces is as they were cut

    def run(self, progress=None):
        """Number of triangles written (0: none). JobError, OSError, swarf.Error, swarf.Cancelled."""
        if self.suffix in STOCK_SUFFIXES:
            put(self.path, lambda made: shutil.copyfile(self.stock_file, made))
            return 0
        if self.data.moves is None:
            jobs.finish(self.data)
        if self.suffix in SHAPE_SUFFIXES:
            return self._run_shape(progress)
        return native.export(self.data, self.stock_file, self.path, progress=progress, **self.options)

    def _run_shape(self, progress):
        """The shape with faces as they were cut where that can be, else its mesh."""
        self._folder = tempfile.TemporaryDirectory(prefix="swarf-")
        half = [progress and (lambda done, begin=begin: progress(begin + 0.5 * done)) for begin in (0, 0.5)]
        self.analytic = native.export_analytic(self.data, self.stock_file, self._file("stock.step"),
                                               self.options.get("largest", False), half[0])
        return 0 if self.analytic.reason is None else self._run_facets(half[1])

    def _run_facets(self, progress=None):
        """The mesh that a shape is made of; JobError where that is too large, told before it is made where it is
        known."""
        if not self.options.get("largest") and not self.options.get("budget"):
            _check_count(self._least)
        count = native.export(self.data, self.stock_file, self._file("stock.stl"), progress=progress, **self.options)
        _check_count(count)  # here nobody waits for it
        return count

    def _file(self, name):
        return os.path.join(self._folder.name, name)

    @property
    def unfinished(self):
        """Whether the file is still to be written by finish()."""
        return self._folder is not None

    def discard(self):
        """Forget what finish() would write."""
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None

    def finish(self):
        """What only FreeCAD can do: shapes."""
        if self._folder is None:
            return
        try:
            shape = self._shape()
            put(self.path, shape.exportBrep if self.suffix in (".brep", ".brp") else shape.exportStep)
        finally:
            self.discard()

    def _shape(self):
        """The analytic shape where it is sound, else that of the mesh; says which, and how much could have been
        analytic."""
        if self.analytic.reason is None:
            shape = Part.Shape()
            shape.read(self._file("stock.step"))
            self.analytic.reason = _doubt(shape, self.analytic)
            if self.analytic.reason is None:
                FreeCAD.Console.PrintMessage(translate(
                    "Swarf",
                    "Swarf: the shape has {0} faces as they were cut: planes, cylinders, cones, spheres, tori\n"
                ).format(self.analytic.faces))
                if self.analytic.note:
                    FreeCAD.Console.PrintWarning("Swarf: %s\n" % wording.say(self.analytic.note))
                return shape
            self._run_facets()  # a rare one, and known only here
        share, reason = self.analytic.share, wording.say(self.analytic.reason)
        if share is None or share >= 1:
            text = translate("Swarf", "Swarf: the shape is made of flat facets: {0}\n")
            FreeCAD.Console.PrintWarning(text.format(reason))
        else:
            FreeCAD.Console.PrintWarning(translate(
                "Swarf",
                "Swarf: the shape is made of flat facets; {0:.1f} % of its surface is planes, cylinders, cones, spheres"
                " and tori. Not all of it: {1}\n").format(math.floor(1000 * share) / 10, reason))
        return shape_of(Mesh.Mesh(self._file("stock.stl")))


def _doubt(shape, analytic):
    """What is wrong with a shape made of analytic faces; None when nothing is."""
    if not shape.Solids or not all(solid.isValid() and solid.isClosed() for solid in shape.Solids):
        return native.said("solid unsound")
    off = abs(sum(solid.Volume for solid in shape.Solids) - analytic.volume_mm3)
    if off > analytic.error_mm * analytic.area_mm2:
        return native.said("volume off", off=off)
    return None


def export_steps(obj, path, **options):
    """Steps -> Export of a simulation object. options: those of native.export(). JobError without a result, and where
    the result is not of the job as it is now."""
    suffix_of(path)
    if not obj.Stock or not os.path.exists(obj.Stock):
        raise JobError("'%s' has no result yet: simulate it first" % obj.Label)
    if (yield from setups.signature_steps(obj.Job, obj.VoxelSize.Value, {})) != obj.Signature:
        raise JobError("'%s' is out of date: update it first" % obj.Label)
    return Export(obj, path, (yield from setups.gather(obj.Job)), options)


def export(obj, path, progress=None, **options):
    """Write what is left of the stock into a file by its suffix -> number of triangles. options: error_mm, budget,
    colour ("operation", "deviation" or "thickness"), tolerance_mm and allowance_mm (of the deviation's colours),
    largest (the largest piece alone), fine (edges closer to each other than a voxel are followed),
    keep_volume (vertices are shifted until the volume is that of the surface that the mesh stands for)."""
    made = steps.run(export_steps(obj, path, **options))
    count = made.run(progress)
    made.finish()
    return count


def _check_count(triangles):
    if triangles > SHAPE_TRIANGLES_MAX:
        raise JobError("%d triangles are too many for a shape, %d are possible: allow a greater error, or write a mesh"
                       % (triangles, SHAPE_TRIANGLES_MAX))


# What native.pieces() asks of a shell.
_Measures = collections.namedtuple("_Measures", "volume_mm3 bounding_box")


def _measures(shell):
    box = shell.BoundBox
    return _Measures(shell.Volume, ((box.XMin, box.YMin, box.ZMin), (box.XMax, box.YMax, box.ZMax)))


def _triangles(shell):
    points, facets = shell.tessellate(1.0)  # of flat faces: exact
    return [tuple(point) for point in points], facets


def shape_of(mesh):
    """Solid of a closed mesh, flat pieces as one face, cavities left hollow; a compound where there are several.
    JobError for more triangles than that is good for."""
    _check_count(mesh.CountFacets)
    if not mesh.CountFacets:
        raise JobError("nothing is left of the stock")
    shape = Part.Shape()
    shape.makeShapeFromMesh(mesh.Topology, 1e-4)
    shells = shape.Shells
    pieces = native.pieces([_measures(shell) for shell in shells],  # a cavity's volume is negative
                           lambda place: _triangles(shells[place]))
    if not pieces or not all(shell.isClosed() for shell in shells):
        raise JobError("the mesh does not close to a solid")
    solids = [Part.makeSolid(Part.makeCompound([shells[place] for place in piece])).removeSplitter()
              for piece in pieces]
    return solids[0] if len(solids) == 1 else Part.makeCompound(solids)


def add_shape(obj):
    """A Part object with what is left of the stock of a simulation as a solid, in one undoable step -> it: what Path
    can take as the stock of a job. Its faces are as they were cut where that can be, and the job is as it was. JobError
    as shape_of()."""
    return _add(obj, _made_shape(obj) or shape_of(obj.Mesh), "Shape", "Stock", translate("Swarf", "Stock"))


def _made_shape(obj):
    """The shape of an export; None where there can be none: the job has changed since, or its mesh is too large."""
    with tempfile.TemporaryDirectory(prefix="swarf-") as folder:
        path = os.path.join(folder, "stock.brep")
        try:
            export(obj, path)
        except JobError:
            return None
        shape = Part.Shape()
        shape.read(path)
        return shape


def _add(obj, shape, transaction, name, label):
    """A Part object beside a simulation."""
    def make():
        made = obj.Document.addObject("Part::Feature", name)
        made.Label = "%s: %s" % (label, obj.Label)
        made.Shape = shape
        return made

    return pieces.in_one_step(obj.Document, transaction, make)


def section(obj, point, normal, curves=None):
    """Compound of the wires along which a plane cuts the mesh of a simulation; FreeCAD's exporters write it as DXF and
    SVG. curves: what Body.section() says of that plane, where it has been asked. JobError where it cuts nothing."""
    wires = []
    for line in pieces.body_of(obj).section(point, normal) if curves is None else curves:
        corners = [FreeCAD.Vector(*corner) for corner in line]
        wires.append(Part.makePolygon(corners + corners[:1]))
    if not wires:
        raise JobError("the plane does not cut what is left in '%s'" % obj.Label)
    return Part.makeCompound(wires)


def add_section(obj, point, normal, curves=None):
    """A Part object with section() in the document, in one undoable step -> it."""
    return _add(obj, section(obj, point, normal, curves), "Section", "Section", translate("Swarf", "Section"))
