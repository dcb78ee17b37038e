# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD's Path/CAM jobs, known by what they have: a job of 0.20 opened in 1.x has no Proxy any more."""

from ..core import cutter, program, steps
from ..core.errors import JobError
from ..core.job import JobData
from ..core.placement import Placement
from . import accepted, fixtures, holders, shapes, tools

# Commands that are copied in one step: some milliseconds.
COMMANDS_PER_STEP = 5000

MARKS = ("Operations", "Tools", "Stock", "Model")


def is_job(obj):
    """True for a Path/CAM job."""
    return all(hasattr(obj, mark) for mark in MARKS) and hasattr(obj.Operations, "Group")


def find_jobs(document):
    """All jobs of a document, in its order."""
    return [obj for obj in document.Objects if is_job(obj)]


def pick_job(document, name=None):
    """The job with this name or label, or the only one. JobError that lists the jobs otherwise."""
    jobs = find_jobs(document)
    if not jobs:
        raise JobError("there is no Path/CAM job in the document")
    names = ", ".join("'%s'" % job.Label for job in jobs)
    if name is None:
        if len(jobs) > 1:
            raise JobError("the document holds several jobs, name one of them: %s" % names)
        return jobs[0]
    for job in jobs:
        if name in (job.Name, job.Label):
            return job
    raise JobError("there is no job '%s'; the document holds %s" % (name, names))


def property_of(operation, name):
    """A property of an operation, or of what it dresses up; None when neither has it."""
    for _ in range(100):  # dressups over dressups; a document cannot have a cycle, a broken one may
        if operation is None:
            return None
        if name in getattr(operation, "PropertiesList", ()):
            return getattr(operation, name)
        operation = getattr(operation, "Base", None)
        if isinstance(operation, (list, tuple)):
            operation = operation[0] if operation else None
            if isinstance(operation, (list, tuple)):
                return None
    return None


def is_active(operation):
    """Whether an operation takes part."""
    return property_of(operation, "Active") is not False


def operations_of(job):
    """Objects with a path among the job's operations, in order."""
    group = getattr(job.Operations, "Group", None) or []
    return [operation for operation in group if hasattr(operation, "Path")]


def placement_of(operation):
    """core Placement of an operation."""
    placement = getattr(operation, "Placement", None)
    if placement is None or placement.isIdentity():
        return Placement()
    matrix = placement.toMatrix()
    return Placement(((matrix.A11, matrix.A12, matrix.A13), (matrix.A21, matrix.A22, matrix.A23),
                      (matrix.A31, matrix.A32, matrix.A33)), (matrix.A14, matrix.A24, matrix.A34))


def _moves(commands):
    """Whether any command may move the tool."""
    return any(program.canonical(command.Name)[:1] == "G" and any(axis in command.Parameters for axis in "XYZ")
               for command in commands if not program.is_comment(command.Name))


def _plain(commands):
    """Steps that copy Path commands -> list of core Commands."""
    result = []
    for begin in range(0, len(commands), COMMANDS_PER_STEP):
        result += [program.Command(command.Name, command.Parameters)
                   for command in commands[begin:begin + COMMANDS_PER_STEP]]
        yield
    return result


def _operations(job, notes):
    """Steps -> core Operations of the active ones, and the tool controllers they use."""
    result, controllers = [], {}
    for obj in operations_of(job):
        if not is_active(obj):
            notes.append("The operation '%s' is not active and was left out." % obj.Label)
            continue
        commands = yield from _plain(obj.Path.Commands)
        controller = property_of(obj, "ToolController")
        if controller is None:
            if _moves(commands):
                raise JobError("the operation '%s' has no tool controller" % obj.Label)
            if not result:
                continue
            name, number, tool_commands = result[-1].controller, result[-1].tool, ()
        else:
            name, number = controller.Name, int(controller.ToolNumber)
            tool_commands = yield from _plain(controller.Path.Commands)
            controllers[name] = controller
        result.append(program.Operation(obj.Label, commands, number, name, tool_commands, placement_of(obj),
                                        obj.Name))
    return result, list(controllers.values())


def _tools(controllers):
    """Steps -> tool number -> (name, parts)."""
    result, owners = {}, {}
    for controller in controllers:
        number = int(controller.ToolNumber)
        entry = tools.describe(controller)
        if number in result and result[number][1] != entry[1]:
            raise JobError("the tool controllers '%s' and '%s' both have the tool number %d, with different tools"
                           % (owners[number], controller.Label, number))
        result[number], owners[number] = entry, controller.Label
        yield
    return result


def gather(job, own_stock=True):
    """Steps of a fraction of a second each, so that a GUI lives between them -> what finish() makes a JobData of. Reads
    only; the next step must not be taken when the job is gone. own_stock: its stock is read too. JobError says what
    stands in the way."""
    notes = []
    operations, controllers = yield from _operations(job, notes)
    if not operations:
        raise JobError("the job '%s' has no active operation" % job.Label)
    described = yield from _tools(controllers)
    held = {int(controller.ToolNumber): holders.holder_of(controller) for controller in controllers}
    held = {number: entry for number, entry in held.items() if entry}
    teeth = {int(controller.ToolNumber): tools.teeth(controller.Tool) for controller in controllers}
    stock = shapes.stock_of(job) if own_stock else None
    yield
    design = yield from shapes.design_steps(job)
    clamps = yield from fixtures.mesh_steps(job)
    return JobData(job.Label, None, described, stock, design, notes, operations,
                   {number: count for number, count in teeth.items() if count}, held, accepted.accepted_of(job),
                   clamps)


def finish(data):
    """The JobData with its moves, and those of the set-ups before; any thread. JobError as gather()."""
    if data.stock["kind"] == "result":
        finish(data.stock["job"])
    data.moves = program.build(data.operations)
    if not len(data.moves):
        raise JobError("the operations of the job '%s' hold no moves: recompute it" % data.name)
    for number, (name, parts) in data.tools.items():
        if data.moves.feeds_with(number) and not any(kind == cutter.FLUTES for kind, _ in parts):
            raise JobError("the tool '%s' (T%d) has no flutes and cannot cut" % (name, number))
    return data


def read_job(job):
    """The JobData of a job. JobError says what stands in the way. Reads only."""
    return finish(steps.run(gather(job)))
