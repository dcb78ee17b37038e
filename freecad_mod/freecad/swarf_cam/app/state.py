# SPDX-License-Identifier: LGPL-2.1-or-later
"""The state of a job as a signature: cheap enough for every recompute."""

import hashlib

from ..core import steps
from ..core.signature import signature
from . import holders
from . import job as jobs
from . import tools


# Commands that are hashed in one step: some milliseconds.
COMMANDS_PER_STEP = 2000


def _commands(obj, known):
    """Steps -> hash of an object's path, to 5 decimals: a saved document keeps 6. known: name -> hash, added to."""
    if obj.Name in known:
        return known[obj.Name]
    digest = hashlib.sha256()
    for number, command in enumerate(obj.Path.Commands):
        if number % COMMANDS_PER_STEP == 0:
            yield
        words = ["%s%.5f" % (letter, value + 0.0) for letter, value in sorted(command.Parameters.items())]
        digest.update(("%s %s\n" % (command.Name, " ".join(words))).replace("-0.00000", "0.00000").encode())
    known[obj.Name] = digest.hexdigest()
    return known[obj.Name]


def _shape(shape):
    """Measures that no usual change of a shape leaves alone, to what survives saving."""
    if shape is None or shape.isNull():
        return None
    box = shape.BoundBox
    measures = [box.XMin, box.YMin, box.ZMin, box.XMax, box.YMax, box.ZMax, shape.Volume, shape.Area]
    if shape.Solids:
        for solid in shape.Solids:
            measures += list(solid.CenterOfMass)
    return ["%.5f" % (round(value, 5) + 0.0) for value in measures]


def job_signature(job, voxel_mm):
    """Signature of everything that the result of a simulation depends on, which fixtures are not part of; None when
    there is no job to read."""
    return steps.run(signature_steps(job, voxel_mm, {}))


def signature_steps(job, voxel_mm, known, stock=None):
    """Steps -> job_signature(). known: hashes of the paths of objects that have not changed, by name; the others' are
    added. stock: what is known of a stock that is not the job's own."""
    if job is None or not jobs.is_job(job):
        return None
    operations, bits = [], {}
    for obj in jobs.operations_of(job):
        if not jobs.is_active(obj):
            continue
        controller = jobs.property_of(obj, "ToolController")
        placement = jobs.placement_of(obj)
        entry = [obj.Label, (yield from _commands(obj, known)), placement.rotation, placement.base]
        if controller is not None:
            entry += [controller.Name, int(controller.ToolNumber),
                      (yield from _commands(controller, known))]
            tool = getattr(controller, "Tool", None)
            if tool is not None:
                bits[controller.Name] = [tools.shape_type(tool), tools.parameters(tool),
                                         _shape(getattr(tool, "Shape", None))]
                held = holders.holder_of(controller)
                if held:
                    bits[controller.Name].append(held)
        operations.append(entry)
    design = [_shape(getattr(model, "Shape", None)) for model in getattr(job.Model, "Group", None) or []]
    if stock is None:
        stock = _shape(getattr(job.Stock, "Shape", None))
    return signature(operations, bits, stock, design, float(voxel_mm))
