# SPDX-License-Identifier: LGPL-2.1-or-later
"""Set-ups in a row: a job whose stock is what the simulation of another job left, turned and moved. Kept with the job
as properties that the add-on adds to it, so that all who simulate it know."""

import os

import FreeCAD

from ..core import steps
from ..core.errors import JobError
from . import job as jobs
from . import state

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

# Saved names: never change them.
STOCK_FROM, PLACEMENT, GROUP = "SwarfStockFrom", "SwarfStockPlacement", "Swarf"


def previous_of(job):
    """The simulation whose result is the stock of a job; None: the job's own stock is."""
    return getattr(job, STOCK_FROM, None)


def chain_of(job):
    """The jobs before a job, the latest first. JobError when they go round, or a simulation has lost its job."""
    chain, seen = [], {job.Name}
    while previous_of(job) is not None:
        previous = previous_of(job)
        before = getattr(previous, "Job", None)
        if before is None or not jobs.is_job(before):
            raise JobError("the stock of the job '%s' is the result of '%s', which has no job any more"
                           % (job.Label, previous.Label))
        if before.Name in seen:
            raise JobError("the set-ups go round: the job '%s' would cut its own result" % before.Label)
        seen.add(before.Name)
        chain.append(before)
        job = before
    return chain


def add_properties(job):
    """Give a job the properties, in no transaction; one that is open is committed. An undo that took away a link that
    is set would leave the job among the users of what it linked, in every FreeCAD so far, and FreeCAD would die of that
    once the job is gone. Locked for the same reason."""
    FreeCAD.closeActiveTransaction()
    for kind, name, text in (
            ("App::PropertyLink", STOCK_FROM,
             QT_TRANSLATE_NOOP("App::Property", "Simulation whose result is the stock; none: the job's own stock")),
            ("App::PropertyPlacement", PLACEMENT,
             QT_TRANSLATE_NOOP("App::Property", "How that result lies here: from its job's coordinates to these"))):
        if name not in job.PropertiesList:
            job.addProperty(kind, name, GROUP, text)
        job.setPropertyStatus(name, "LockDynamic")


def assign(job, simulation, placement=None):
    """Let a job that has the properties cut what a simulation leaves, None: its own stock; in the transaction of the
    caller, so that it can be undone. placement: FreeCAD.Placement from the other job's coordinates to this one's (None:
    unchanged). JobError when that would go round."""
    if simulation is not None and simulation.Job is not None:
        if job in [simulation.Job, *chain_of(simulation.Job)]:
            raise JobError("the set-ups would go round: '%s' depends on the job '%s'" % (simulation.Label, job.Label))
    setattr(job, STOCK_FROM, simulation)
    setattr(job, PLACEMENT, placement or FreeCAD.Placement())


def _rows(placement):
    """Three rows of rotation and shift."""
    matrix = placement.toMatrix()
    return [[matrix.A11, matrix.A12, matrix.A13, matrix.A14], [matrix.A21, matrix.A22, matrix.A23, matrix.A24],
            [matrix.A31, matrix.A32, matrix.A33, matrix.A34]]


def placement_by_models(before, job):
    """FreeCAD.Placement that takes the model of one job to that of another, None when they have none in common: where
    both are clones of one object, or the object itself."""
    def origins(of):
        found = {}
        for model in getattr(of.Model, "Group", None) or []:
            sources = getattr(model, "Objects", None) or [model]
            found[sources[0].Name] = model
        return found

    mine, theirs = origins(job), origins(before)
    for name, model in mine.items():
        if name in theirs:
            return model.Placement.multiply(theirs[name].Placement.inverse())
    return None


def placement_turned(before, job, axis):
    """FreeCAD.Placement that turns by 180 degrees about a coordinate axis ("X", "Y", "Z") and brings the middle of one
    job's stock to the middle of the other's. JobError when one has none."""
    middles = []
    for each in (before, job):
        shape = getattr(each.Stock, "Shape", None)
        if shape is None or shape.isNull():
            raise JobError("the job '%s' has no stock" % each.Label)
        middles.append(shape.BoundBox.Center)
    direction = {"X": FreeCAD.Vector(1, 0, 0), "Y": FreeCAD.Vector(0, 1, 0), "Z": FreeCAD.Vector(0, 0, 1)}[axis]
    rotation = FreeCAD.Rotation(direction, 180)
    return FreeCAD.Placement(middles[1] - rotation.multVec(middles[0]), rotation)


def signature_steps(job, voxel_mm, known):
    """Steps -> state.signature_steps() with the set-ups before in it."""
    stock = None
    if job is not None and previous_of(job) is not None:
        chain_of(job)  # it ends
        previous = previous_of(job)
        before = yield from signature_steps(previous.Job, previous.VoxelSize.Value, {})
        stock = [before, _rows(getattr(job, PLACEMENT))]
    return (yield from state.signature_steps(job, voxel_mm, known, stock))


def job_signature(job, voxel_mm):
    """Signature of everything that a simulation of the job reads, set-ups before included; None without a job."""
    return steps.run(signature_steps(job, voxel_mm, {}))


def gather(job):
    """Steps -> jobs.gather() with the stock that the set-ups before leave."""
    previous = previous_of(job)
    if previous is None:
        return (yield from jobs.gather(job))
    chain_of(job)
    data = yield from jobs.gather(job, own_stock=False)
    stock = {"kind": "result", "job": (yield from gather(previous.Job)), "placement": _rows(getattr(job, PLACEMENT))}
    current = yield from signature_steps(previous.Job, previous.VoxelSize.Value, {})
    if current == previous.Signature and previous.Stock and os.path.exists(previous.Stock):
        stock["path"] = previous.Stock  # else its job is played
    data.stock = stock
    return data


def read_job(job):
    """The JobData of a job with the stock that the set-ups before leave. JobError says what stands in the way."""
    return jobs.finish(steps.run(gather(job)))
