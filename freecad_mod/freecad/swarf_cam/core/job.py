# SPDX-License-Identifier: LGPL-2.1-or-later
"""A milling job as plain data: what is read from a FreeCAD document and handed to the simulation."""

from dataclasses import dataclass, field
from typing import Any


@dataclass
class JobData:
    """Lengths in mm, in the document's coordinates.

    moves: moves.MoveTable, None until app.job.finish() made it. tools: number -> (name, parts as core.cutter.parts
    gives them). stock: a dict with "kind" "box" and "lo", "hi"; or "kind" "mesh" and "mesh"; or "kind" "result" and
    "job", the JobData of the set-up before, "placement", three rows of rotation and shift, and "path" where a .vdb file
    holds that result. Meshes, also design (None: no model), are pairs
    (points, triangles): array('d') of x y z and array('I') of three indices each.
    notes: what the reader left out or assumed, one sentence each. operations: program.Operation of each name in
    moves.operations; empty where the job came through a file. teeth: cutting edges around each tool, where known.
    holders: number -> (name as swarf.holders takes it, stickout in mm or None). accepted: entries of swarf.accept.
    fixtures: (name, mesh) each.
    """

    name: str
    moves: Any
    tools: dict
    stock: dict
    design: Any = None
    notes: list = field(default_factory=list)
    operations: list = field(default_factory=list)
    teeth: dict = field(default_factory=dict)
    holders: dict = field(default_factory=dict)
    accepted: list = field(default_factory=list)
    fixtures: list = field(default_factory=list)
