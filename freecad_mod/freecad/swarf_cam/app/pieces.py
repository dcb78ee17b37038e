# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is left of the stock taken apart and measured, in the document: meshes of its parts, sheets of its measures."""

import FreeCAD
import Mesh

from ..body import Body
from ..core import measures
from ..core.errors import JobError

translate = FreeCAD.Qt.translate


def mesh_of(obj):
    """Mesh of a simulation as it lies in the document, whatever part it is in."""
    placement = obj.getGlobalPlacement()
    if placement.isIdentity():
        return obj.Mesh
    mesh = obj.Mesh.copy()
    mesh.Placement = FreeCAD.Placement()
    mesh.transform(placement.toMatrix())
    return mesh


def body_of(obj):
    """Body of the mesh of a simulation as it lies in the document: cheap, its work is for any thread. JobError where
    nothing is left, or it cannot be written among temporary files."""
    mesh = mesh_of(obj)
    if not mesh.CountFacets:
        raise JobError("nothing is left of the stock in '%s'" % obj.Label)
    return Body(mesh.write)


def box_of(obj):
    """(lo, hi) of the mesh of a simulation as it lies in the document, mm."""
    box = mesh_of(obj).BoundBox
    return (box.XMin, box.YMin, box.ZMin), (box.XMax, box.YMax, box.ZMax)


def in_one_step(document, name, make):
    """What make() puts into a document, in one undoable step, which leaves it as it was when it fails."""
    document.openTransaction(name)
    try:
        made = make()
    except BaseException:
        document.abortTransaction()
        raise
    document.commitTransaction()
    return made


def add_parts(obj, files):
    """Mesh objects of the files of Body.split() beside a simulation, which they would be hidden in, in one undoable
    step -> them."""
    meshes = [Mesh.Mesh(path) for path in files]

    def make():
        made = []
        for number, mesh in enumerate(meshes, 1):
            part = obj.Document.addObject("Mesh::Feature", "Part")
            part.Label = "%s: %s" % (translate("Swarf", "Part {0}").format(number), obj.Label)
            part.Mesh = mesh
            made.append(part)
        obj.Visibility = False
        return made

    return in_one_step(obj.Document, "Split", make)


def split(obj, point, normal, each=False, progress=None):
    """Mesh objects with what is left of the stock of a simulation on both sides of a plane, each closed, first what
    lies against the normal; or with each piece of it -> them. JobError where the plane misses it, swarf.Cancelled."""
    body = body_of(obj)
    return add_parts(obj, body.split(point, normal, each, progress))


def measure(obj, progress=None):
    """core.measures.Table of what is left of the stock of a simulation. swarf.Cancelled."""
    return body_of(obj).measures(progress)


def name_of(column):
    """Of a column of a table of measures."""
    kind, number = column
    if kind == measures.WHOLE:
        return translate("Swarf", "Whole")
    form = translate("Swarf", "Piece {0}") if kind == measures.PIECE else translate("Swarf", "Hollow {0}")
    return form.format(number)


def text_of(key):
    """What a row of a table of measures tells, without its axis and its unit."""
    return {
        "volume": translate("Swarf", "Volume"),
        "area": translate("Swarf", "Area"),
        "size": translate("Swarf", "Size"),
        "from": translate("Swarf", "Box from"),
        "to": translate("Swarf", "Box to"),
        "centre": translate("Swarf", "Centre of mass"),
        "wall": translate("Swarf", "Thinnest wall"),
        "thinnest": translate("Swarf", "Thinnest at"),
        "genus": translate("Swarf", "Holes through it"),
        "inertia": translate("Swarf", "Inertia"),
        "moment": translate("Swarf", "Principal moment"),
        "axis": translate("Swarf", "Principal axis"),
        "triangles": translate("Swarf", "Triangles"),
    }[key]


def label_of(row):
    """Of a row of a table of measures, without its unit."""
    return ("%s %s" % (text_of(row[0]), row[1])).strip()


def _letters(column):
    """Of a column of a sheet, from 0 on: A .. Z, AA ..."""
    return ("" if column < 26 else _letters(column // 26 - 1)) + chr(ord("A") + column % 26)


def add_sheet(obj, table):
    """A spreadsheet with a table of measures in the document of a simulation, in one undoable step -> it."""
    def make():
        sheet = obj.Document.addObject("Spreadsheet::Sheet", "Measures")
        sheet.Label = "%s: %s" % (translate("Swarf", "Measures"), obj.Label)
        for place, column in enumerate(table.columns):
            sheet.set(_letters(2 + place) + "1", "'" + name_of(column))
        for number, row in enumerate(table.rows, 2):
            sheet.set("A%d" % number, "'" + label_of(row))
            sheet.set("B%d" % number, "'" + row[2])
            for place, value in enumerate(row[3]):
                if value is not None:
                    sheet.set("%s%d" % (_letters(2 + place), number), "%.7g" % (value + 0.0))
        sheet.setColumnWidth("A", 160)
        sheet.setStyle("A1:%s1" % _letters(1 + len(table.columns)), "bold")
        sheet.recompute()
        return sheet

    return in_one_step(obj.Document, "Measures", make)
