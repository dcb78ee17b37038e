# SPDX-License-Identifier: LGPL-2.1-or-later
"""STEP files (ISO 10303-21, of AP 214) of solids with analytic faces."""
from __future__ import annotations

import math
from typing import Iterable

from ..files import write_text
from ..progress import Report, share, told
from ..vectors import Vector, add, cross, distance, dot, unit
from .brep import Brep, Edge, Face
from .shapes import CONE, CYLINDER, PLANE, SPHERE


def _number(value: float) -> str:
    """A real as STEP wants it: always with a point."""
    text = repr(float(value))
    mantissa, exponent, power = text.partition("e")
    if "." not in mantissa:
        mantissa += "."
    return mantissa + ("E" + power if exponent else "")


def _list(words: Iterable[str]) -> str:
    return "(" + ",".join(words) + ")"


def _string(text: str) -> str:
    """A string as STEP wants it, without its quotes: printable ASCII, the rest as numbers of characters."""
    def letter(one: str) -> str:
        if " " <= one <= "~":
            return {"'": "''", "\\": "\\\\"}.get(one, one)
        return ("\\X2\\%04X\\X0\\" if ord(one) < 0x10000 else "\\X4\\%08X\\X0\\") % ord(one)

    return "".join(map(letter, text))


def _poles(face: Face, edges: list[Edge], brep: Brep) -> Vector:
    """Axis of a sphere whose poles are far from the edges of a face and, for one smaller than a half, outside of it;
    where one circle alone bounds it, that circle's."""
    first = edges[0]
    if len(edges) == 1 and first.axis is not None:
        return first.axis
    ways = [unit(add(place, face.shape.point, -1)) for edge in edges
            for place, _ in brep.along(edge, 8)]
    middle = unit((sum(way[0] for way in ways), sum(way[1] for way in ways), sum(way[2] for way in ways)))
    across = cross(middle, (1.0, 0.0, 0.0) if abs(middle[0]) < 0.6 else (0.0, 1.0, 0.0))
    u, v = unit(across), cross(middle, unit(across))
    turned = [add(add((0.0, 0.0, 0.0), u, math.cos(math.pi * k / 24)), v, math.sin(math.pi * k / 24))
              for k in range(24)]
    return min(turned, key=lambda axis: max(abs(dot(axis, way)) for way in ways))


class _Writer:
    """Lines of the data section; each method gives the name of what it wrote."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    def put(self, text: str) -> str:
        self.lines.append(text)
        return "#%d" % len(self.lines)

    def point(self, place: Vector) -> str:
        return self.put("CARTESIAN_POINT('',%s)" % _list(map(_number, place)))

    def direction(self, way: Vector) -> str:
        return self.put("DIRECTION('',%s)" % _list(map(_number, unit(way))))

    def placement(self, place: Vector, axis: Vector, towards: Vector) -> str:
        """Of a curve or a surface; `towards`: where its angles begin, as far as that is across the axis."""
        across = add(towards, axis, -dot(towards, axis))
        if math.hypot(*across) < 1e-9:
            across = cross(axis, (1.0, 0.0, 0.0) if abs(axis[0]) < 0.6 else (0.0, 1.0, 0.0))
        return self.put("AXIS2_PLACEMENT_3D('',%s,%s,%s)" % (
            self.point(place), self.direction(axis), self.direction(across)))

    def curve(self, edge: Edge, brep: Brep) -> str:
        start, end = brep.corners[edge.start], brep.corners[edge.end]
        if edge.axis is not None and edge.centre is not None:
            placed = self.placement(edge.centre, edge.axis, add(start, edge.centre, -1))
            return self.put("CIRCLE('',%s,%s)" % (placed, _number(edge.radius)))
        if not edge.points:
            vector = self.put("VECTOR('',%s,1.)" % self.direction(add(end, start, -1)))
            return self.put("LINE('',%s,%s)" % (self.point(start), vector))
        return self.spline(edge)

    def spline(self, edge: Edge) -> str:
        """Cubics from point to point, by lengths of chords: their directions and speeds agree."""
        points, ways = edge.points, edge.directions
        lengths = [distance(a, b) for a, b in zip(points, points[1:])]
        poles, knots = [points[0]], [0.0]
        for k, length in enumerate(lengths):
            poles += [add(points[k], ways[k], length / 3), add(points[k + 1], ways[k + 1], -length / 3)]
            knots.append(knots[-1] + length)
        poles.append(points[-1])
        closed = ".T." if edge.start == edge.end else ".F."
        return self.put("B_SPLINE_CURVE_WITH_KNOTS('',3,%s,.UNSPECIFIED.,%s,.F.,%s,%s,.UNSPECIFIED.)" % (
            _list([self.point(pole) for pole in poles]), closed,
            _list(["4"] + ["2"] * (len(knots) - 2) + ["4"]), _list(map(_number, knots))))

    def surface(self, face: Face, brep: Brep) -> str:
        shape = face.shape
        edges = [brep.edges[number] for loop in face.loops for number, _ in loop]
        corner = brep.corners[edges[0].start]
        towards = add(corner, shape.point, -1)
        if shape.kind == PLANE:
            return self.put("PLANE('',%s)" % self.placement(shape.point, shape.axis, towards))
        if shape.kind == CYLINDER:
            return self.put("CYLINDRICAL_SURFACE('',%s,%s)" % (
                self.placement(shape.point, shape.axis, towards), _number(shape.radius)))
        if shape.kind == CONE:  # STEP's opens along its axis
            farthest = max((brep.corners[edge.start] for edge in edges),
                           key=lambda place: abs(dot(add(place, shape.point, -1), shape.axis)))
            height = dot(add(farthest, shape.point, -1), shape.axis)
            axis = shape.axis if height > 0 else (-shape.axis[0], -shape.axis[1], -shape.axis[2])
            return self.put("CONICAL_SURFACE('',%s,%s,%s)" % (
                self.placement(add(shape.point, shape.axis, height), axis, towards),
                _number(abs(height) * shape.second), _number(math.atan(shape.second))))
        if shape.kind == SPHERE:
            return self.put("SPHERICAL_SURFACE('',%s,%s)" % (
                self.placement(shape.point, _poles(face, edges, brep), towards), _number(shape.radius)))
        spindle = shape.second > shape.radius  # a tube that crosses the axis: what is outside of the crossing
        return self.put("%sTOROIDAL_SURFACE('',%s,%s,%s%s)" % (
            "DEGENERATE_" if spindle else "", self.placement(shape.point, shape.axis, towards), _number(shape.radius),
            _number(shape.second), ",.T." if spindle else ""))

    def shell(self, brep: Brep, faces: list[int], curves: list[str], progress: Report) -> str:
        made = []
        for number in told(faces, len(faces), progress):
            face = brep.faces[number]
            bounds = []
            for place, loop in enumerate(face.loops):
                steps = [self.put("ORIENTED_EDGE('',*,*,%s,%s)" % (curves[edge], ".T." if forwards else ".F."))
                         for edge, forwards in loop]
                bounds.append(self.put("FACE_BOUND('',%s,.T.)" % self.put("EDGE_LOOP('',%s)" % _list(steps))))
            made.append(self.put("ADVANCED_FACE('',%s,%s,%s)" % (
                _list(bounds), self.surface(face, brep), ".T." if face.outwards else ".F.")))
        return self.put("CLOSED_SHELL('',%s)" % _list(made))

    def solid(self, shells: list[str]) -> str:
        """Of its outer shell and those round the hollows in it."""
        if len(shells) == 1:
            return self.put("MANIFOLD_SOLID_BREP('',%s)" % shells[0])
        voids = [self.put("ORIENTED_CLOSED_SHELL('',*,%s,.T.)" % shell) for shell in shells[1:]]
        return self.put("BREP_WITH_VOIDS('',%s,%s)" % (shells[0], _list(voids)))


def text(brep: Brep, name: str = "stock", progress: Report = None) -> str:
    """The file of a Brep, mm. Cancelled."""
    out = _Writer()
    vertices = [out.put("VERTEX_POINT('',%s)" % out.point(corner))
                for corner in told(brep.corners, len(brep.corners), share(progress, 0, 0.1))]
    curves = [out.put("EDGE_CURVE('',%s,%s,%s,.T.)" % (vertices[edge.start], vertices[edge.end], out.curve(edge, brep)))
              for edge in told(brep.edges, len(brep.edges), share(progress, 0.1, 0.5))]
    shells, done = [], 0
    for faces in brep.shells:
        begin, done = done, done + len(faces)
        shells.append(out.shell(brep, faces, curves, share(
            progress, 0.5 + 0.5 * begin / len(brep.faces), 0.5 + 0.5 * done / len(brep.faces))))
    solids = [out.solid([shells[number] for number in solid]) for solid in brep.solids]
    word = _string(name)
    context = out.put("APPLICATION_CONTEXT('automotive design')")
    out.put("APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,%s)" % context)
    product = out.put("PRODUCT('%s','%s','',(%s))" % (
        word, word, out.put("PRODUCT_CONTEXT('',%s,'mechanical')" % context)))
    formation = out.put("PRODUCT_DEFINITION_FORMATION('','',%s)" % product)
    definition = out.put("PRODUCT_DEFINITION('','',%s,%s)" % (
        formation, out.put("PRODUCT_DEFINITION_CONTEXT('part definition',%s,'design')" % context)))
    shape = out.put("PRODUCT_DEFINITION_SHAPE('','',%s)" % definition)
    length = out.put("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))")
    angle = out.put("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))")
    solid_angle = out.put("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())")
    close = out.put("UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(%s),%s,'distance_accuracy_value','')" % (
        _number(max(1e-5, 2 * brep.inexact_mm)), length))
    units = out.put("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((%s))"
                    "GLOBAL_UNIT_ASSIGNED_CONTEXT((%s,%s,%s))REPRESENTATION_CONTEXT('',''))" % (
                        close, length, angle, solid_angle))
    frame = out.placement((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
    model = out.put("ADVANCED_BREP_SHAPE_REPRESENTATION('',%s,%s)" % (_list([frame] + solids), units))
    out.put("SHAPE_DEFINITION_REPRESENTATION(%s,%s)" % (shape, model))
    return "\n".join([
        "ISO-10303-21;", "HEADER;", "FILE_DESCRIPTION(('what is left of the stock'),'2;1');",
        "FILE_NAME('%s','',(''),(''),'Swarf','Swarf','');" % word,
        "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));", "ENDSEC;", "DATA;",
        *("#%d=%s;" % (number, line) for number, line in enumerate(out.lines, 1)), "ENDSEC;", "END-ISO-10303-21;", ""])


def write(brep: Brep, path: str, name: str = "stock", progress: Report = None) -> None:
    """Write a Brep; beside the target and renamed. OSError, Cancelled: then nothing is written."""
    write_text(text(brep, name, progress), path)
