# SPDX-License-Identifier: LGPL-2.1-or-later
"""The folder through which FreeCAD's Python hands a job to another one.

    job.json      version, name, operations, sections, tools, stock, notes, teeth, holders,
                  accepted, fixtures (names); written last
    moves.bin     the rows of the MoveTable, little-endian doubles
    stock.points, stock.triangles, design.points, design.triangles, fixture0.points ...
                  little-endian doubles (x y z) and 32-bit indices, where there is such a mesh
    before/       such a folder of the set-up before, where the stock is what it leaves
    error.json    instead of all that, when the job cannot be read: {"error": text}
"""

import array
import json
import os
import sys

from .errors import JobError
from .job import JobData
from .moves import MoveTable

VERSION = 3

BEFORE = "before"


def _write(folder, name, data):
    with open(os.path.join(folder, name), "wb") as file:
        file.write(data)


def _read(folder, name):
    with open(os.path.join(folder, name), "rb") as file:
        return file.read()


def _little(values):
    if sys.byteorder != "little":
        values = array.array(values.typecode, values)
        values.byteswap()
    return values


def _write_mesh(folder, name, mesh):
    points, triangles = mesh
    _write(folder, name + ".points", _little(points).tobytes())
    _write(folder, name + ".triangles", _little(triangles).tobytes())


def _read_mesh(folder, name):
    points, triangles = array.array("d"), array.array("I")
    points.frombytes(_read(folder, name + ".points"))
    triangles.frombytes(_read(folder, name + ".triangles"))
    return _little(points), _little(triangles)


def write(folder, job):
    """Write a JobData into an existing folder."""
    _write(folder, "moves.bin", job.moves.to_bytes())
    stock = dict(job.stock)
    if stock["kind"] == "mesh":
        _write_mesh(folder, "stock", stock.pop("mesh"))
    elif stock["kind"] == "result":
        os.mkdir(os.path.join(folder, BEFORE))
        write(os.path.join(folder, BEFORE), stock.pop("job"))
        stock.pop("path", None)  # it is gone when FreeCAD ends
    if job.design is not None:
        _write_mesh(folder, "design", job.design)
    for number, (_, mesh) in enumerate(job.fixtures):
        _write_mesh(folder, "fixture%d" % number, mesh)
    document = {
        "version": VERSION, "name": job.name, "operations": job.moves.operations, "sections": job.moves.sections,
        "tools": [{"number": number, "name": name, "parts": parts} for number, (name, parts) in job.tools.items()],
        "stock": stock, "design": job.design is not None, "notes": job.notes,
        "teeth": sorted(job.teeth.items()), "holders": sorted(job.holders.items()), "accepted": job.accepted,
        "fixtures": [name for name, _ in job.fixtures],
    }
    _write(folder, "job.json", json.dumps(document).encode())


def write_design(folder, mesh):
    """Write a mesh alone: a design."""
    _write_mesh(folder, "design", mesh)
    _write(folder, "design.json", json.dumps({"version": VERSION}).encode())


def read_design(folder):
    """The mesh of such a folder. JobError as read()."""
    if os.path.exists(os.path.join(folder, "error.json")):
        raise JobError(json.loads(_read(folder, "error.json"))["error"])
    if not os.path.exists(os.path.join(folder, "design.json")):
        raise JobError("FreeCAD ended without an answer")
    return _read_mesh(folder, "design")


def write_error(folder, text):
    """Tell the other side why there is no job."""
    _write(folder, "error.json", json.dumps({"error": text}).encode())


def read(folder):
    """The JobData of a folder. JobError with the other side's text, or when the folder is not complete."""
    if os.path.exists(os.path.join(folder, "error.json")):
        raise JobError(json.loads(_read(folder, "error.json"))["error"])
    if not os.path.exists(os.path.join(folder, "job.json")):
        raise JobError("FreeCAD ended without an answer")
    document = json.loads(_read(folder, "job.json"))
    if document.get("version") != VERSION:
        raise JobError("FreeCAD's side speaks version %s of the exchange, this side %d: both must come from the same "
                       "installation" % (document.get("version"), VERSION))
    stock = document["stock"]
    if stock["kind"] == "mesh":
        stock["mesh"] = _read_mesh(folder, "stock")
    elif stock["kind"] == "result":
        stock["job"] = read(os.path.join(folder, BEFORE))
    tools = {tool["number"]: (tool["name"], [(kind, [tuple(node) for node in nodes]) for kind, nodes in tool["parts"]])
             for tool in document["tools"]}
    moves = MoveTable.from_bytes(_read(folder, "moves.bin"), document["sections"], document["operations"])
    design = _read_mesh(folder, "design") if document["design"] else None
    return JobData(document["name"], moves, tools, stock, design, document["notes"], teeth=dict(document["teeth"]),
                   holders={number: tuple(entry) for number, entry in document["holders"]},
                   accepted=document["accepted"],
                   fixtures=[(name, _read_mesh(folder, "fixture%d" % number))
                             for number, name in enumerate(document["fixtures"])])
