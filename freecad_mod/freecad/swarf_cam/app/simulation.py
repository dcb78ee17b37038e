# SPDX-License-Identifier: LGPL-2.1-or-later
"""The document object of a simulation: which job, how fine, and what came out.

The work is too long for a recompute, so a recompute only finds out whether the results still belong to the inputs;
simulate() does the work. Its three steps are apart because only the first and the last may touch the document:
prepare() reads the job, native.simulate() runs in any thread, store() writes the results in one transaction.
"""

import os
import shutil
import tempfile

import FreeCAD
import Mesh

from .. import native
from ..core import steps
from ..core.errors import JobError
from . import job as jobs
from . import setups, wording

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

# Saved in documents; raise it when a property changes its meaning, with a step in onDocumentRestored().
SCHEMA = 1

EDITABLE, READ_ONLY, HIDDEN = 0, 1, 2

# Name, type, group, description, editor mode. Saved names: never change them.
PROPERTIES = (
    ("Job", "App::PropertyLink", "Simulation",
     QT_TRANSLATE_NOOP("App::Property", "The job that is simulated"), EDITABLE),
    ("VoxelSize", "App::PropertyLength", "Simulation",
     QT_TRANSLATE_NOOP("App::Property", "Edge of a voxel: the finer, the more exact, the slower"), EDITABLE),
    ("UpToDate", "App::PropertyBool", "Simulation",
     QT_TRANSLATE_NOOP("App::Property", "Whether the results belong to the job as it is now"), READ_ONLY),
    ("Stock", "App::PropertyFileIncluded", "Results",
     QT_TRANSLATE_NOOP("App::Property", "What is left of the stock, an OpenVDB level set"), HIDDEN),
    ("FaceColours", "App::PropertyColorList", "Results",
     QT_TRANSLATE_NOOP("App::Property", "Colours of the triangles, by operation"), HIDDEN),
    ("VolumeInitial", "App::PropertyVolume", "Results",
     QT_TRANSLATE_NOOP("App::Property", "Volume of the stock before"), READ_ONLY),
    ("VolumeRemoved", "App::PropertyVolume", "Results",
     QT_TRANSLATE_NOOP("App::Property", "Volume removed by all operations"), READ_ONLY),
    ("VolumeFinal", "App::PropertyVolume", "Results",
     QT_TRANSLATE_NOOP("App::Property", "Volume of the stock after"), READ_ONLY),
    ("Excess", "App::PropertyVolume", "Results",
     QT_TRANSLATE_NOOP("App::Property", "Material left outside the model"), READ_ONLY),
    ("Gouge", "App::PropertyVolume", "Results",
     QT_TRANSLATE_NOOP("App::Property", "Material missing inside the model"), READ_ONLY),
    ("HasDesign", "App::PropertyBool", "Results",
     QT_TRANSLATE_NOOP("App::Property", "Whether the job's model could be compared"), HIDDEN),
    ("Operations", "App::PropertyStringList", "Results",
     QT_TRANSLATE_NOOP("App::Property", "Names of the operations that were simulated"), READ_ONLY),
    ("RemovedByOperation", "App::PropertyFloatList", "Results",
     QT_TRANSLATE_NOOP("App::Property", "Volume removed by each operation, mm^3"), READ_ONLY),
    ("Findings", "App::PropertyStringList", "Results",
     QT_TRANSLATE_NOOP("App::Property", "What the simulation noticed"), READ_ONLY),
    ("Errors", "App::PropertyInteger", "Results",
     QT_TRANSLATE_NOOP("App::Property", "Number of findings of class error"), READ_ONLY),
    ("Moves", "App::PropertyInteger", "Results",
     QT_TRANSLATE_NOOP("App::Property", "Number of moves"), READ_ONLY),
    ("Seconds", "App::PropertyFloat", "Results",
     QT_TRANSLATE_NOOP("App::Property", "How long the simulation took"), READ_ONLY),
    ("Signature", "App::PropertyString", "Internal",
     QT_TRANSLATE_NOOP("App::Property", "Hash of the inputs of the results"), HIDDEN),
    ("Schema", "App::PropertyInteger", "Internal",
     QT_TRANSLATE_NOOP("App::Property", "Version of these properties"), HIDDEN),
)


def is_simulation(obj):
    """True for a simulation object, also in a FreeCAD that could not load its class."""
    return all(hasattr(obj, name) for name in ("Job", "VoxelSize", "UpToDate", "Stock", "Signature"))


class Simulation:
    """Proxy of the document object; keeps nothing that is not a property."""

    Type = "Swarf::Simulation"

    def __init__(self, obj):
        obj.Proxy = self
        self._set_up(obj)
        obj.Schema = SCHEMA

    @staticmethod
    def _set_up(obj):
        """Add what is missing (older documents) and the editor modes, which are not saved."""
        for name, kind, group, text, mode in PROPERTIES:
            if name not in obj.PropertiesList:
                obj.addProperty(kind, name, group, text)
            obj.setPropertyStatus(name, "LockDynamic")  # as in setups.add_properties(); not ours without them either
            obj.setEditorMode(name, mode)

    def execute(self, obj):
        """A recompute: compare, do not simulate."""
        refresh(obj)

    def onChanged(self, obj, name):
        """The mark follows the inputs at once; what the job itself changes arrives by recompute."""
        if name in ("Job", "VoxelSize") and "Restore" not in obj.State and "Signature" in obj.PropertiesList:
            refresh(obj)

    def onDocumentRestored(self, obj):
        """Bring objects of older versions up to date, and give back the look that a headless session left out."""
        self._set_up(obj)
        if obj.Schema < SCHEMA:
            obj.Schema = SCHEMA
        attach_view(obj)

    def dumps(self):
        """Nothing of the proxy is saved."""
        return None

    def loads(self, state):
        """Nothing of the proxy is saved."""
        return None

    # FreeCAD before 1.0 calls them so
    __getstate__ = dumps
    __setstate__ = loads


def attach_view(obj):
    """Give the object its view provider when there is a GUI and it has none, and its colours, over which a document
    that is opened puts ShapeColor."""
    if FreeCAD.GuiUp and obj.ViewObject is not None:
        from ..gui import view  # the GUI's packages do not exist without it

        if not getattr(obj.ViewObject, "Proxy", None):
            view.SimulationView(obj.ViewObject)
        view.show_colours(obj.ViewObject)


def refresh(obj):
    """Set UpToDate by comparing the inputs with those of the results. Never raises: it runs in recomputes."""
    try:
        current = setups.job_signature(obj.Job, obj.VoxelSize.Value)
    except (JobError, AttributeError, RuntimeError, ValueError) as error:
        FreeCAD.Console.PrintLog("Swarf: %s: %s\n" % (obj.Label, error))
        current = None
    up_to_date = bool(current) and current == obj.Signature
    if obj.UpToDate != up_to_date:  # a property that is set is a change, even to the same value
        obj.UpToDate = up_to_date
    for job in obj.InList:  # set-ups that cut this result
        if setups.previous_of(job) is obj:
            for other in job.InList:
                if other is not obj and is_simulation(other) and other.Job is job:
                    refresh(other)


def make(job, voxel_mm=None):
    """A new simulation of a job in its document, not yet run. The caller holds the transaction."""
    if voxel_mm is None:
        voxel_mm = default_voxel(job)
    obj = job.Document.addObject("Mesh::FeaturePython", "Simulation")
    Simulation(obj)
    obj.Label = "%s: %s" % (FreeCAD.Qt.translate("Swarf", "Simulation"), job.Label)
    obj.VoxelSize = voxel_mm
    obj.Job = job
    attach_view(obj)
    return obj


def default_voxel(job):
    """Voxel size that a job is simulated with where nobody says, mm: that of the set-up before, whose voxels can be
    kept as they are. JobError when there is no stock."""
    previous = setups.previous_of(job)
    if previous is not None and previous.VoxelSize.Value > 0:
        return previous.VoxelSize.Value
    return native.default_voxel(*job_box(job))


def job_box(job):
    """(lo, hi) of a job's stock, mm. JobError when there is none."""
    shape = getattr(job.Stock, "Shape", None)
    if shape is None or shape.isNull():
        raise JobError("the job '%s' has no stock" % job.Label)
    box = shape.BoundBox
    return (box.XMin, box.YMin, box.ZMin), (box.XMax, box.YMax, box.ZMax)


class Prepared:
    """Everything that the simulation of an object needs, taken out of the document. data: as jobs.gather() gives it, or
    a whole JobData."""

    def __init__(self, data, voxel_mm, signature):
        self.data, self.voxel_mm, self.signature = data, voxel_mm, signature

    def run(self, folder, progress=None):
        """native.Result; any thread."""
        if self.data.moves is None:
            jobs.finish(self.data)
        return native.simulate(self.data, self.voxel_mm, folder, progress)


def prepare_steps(job, voxel_mm, data=None, known=None):
    """Steps -> Prepared of a job. data: its JobData where it has not changed since it was read, known: hashes of its
    paths that are known, as state.signature_steps() takes them. JobError says what stands in the way."""
    if not voxel_mm > 0:
        raise JobError("the voxel size must be greater than 0")
    signature = yield from setups.signature_steps(job, voxel_mm, {} if known is None else known)
    if data is None:
        data = yield from setups.gather(job)
    return Prepared(data, voxel_mm, signature)


def prepare(obj):
    """Prepared of a simulation object. JobError says what stands in the way."""
    if obj.Job is None:
        raise JobError("'%s' has no job: it was deleted, or never chosen" % obj.Label)
    if not jobs.is_job(obj.Job):
        raise JobError("'%s' is not a Path/CAM job" % obj.Job.Label)
    return steps.run(prepare_steps(obj.Job, obj.VoxelSize.Value))


def possible_previous(job):
    """Simulations of the document whose result the job could cut without cutting its own."""
    found = []
    for obj in job.Document.Objects:
        if is_simulation(obj) and obj.Job is not None and jobs.is_job(obj.Job):
            try:
                if job not in [obj.Job, *setups.chain_of(obj.Job)]:
                    found.append(obj)
            except JobError:
                pass
    return found


def set_stock(job, previous, placement=None):
    """setups.assign() in one undoable step; the marks of the job's simulations follow."""
    document = job.Document
    setups.add_properties(job)
    document.openTransaction("Stock")
    try:
        setups.assign(job, previous, placement)
        for obj in job.InList:
            if is_simulation(obj):
                refresh(obj)
    except BaseException:
        document.abortTransaction()
        raise
    document.commitTransaction()


def _give_copies_their_own_file(obj):
    """doc.copyObject() leaves original and copy on one file until the document is opened again, and the next result
    would take it away from the other."""
    for other in obj.Document.Objects:
        if other is not obj and is_simulation(other) and other.Stock and other.Stock == obj.Stock:
            with tempfile.TemporaryDirectory(prefix="swarf-") as folder:
                copy = os.path.join(folder, "stock.vdb")
                shutil.copyfile(obj.Stock, copy)
                other.Stock = (copy, other.Name + ".vdb")


def store(obj, prepared, result):
    """Write a result into the object. The caller holds the transaction."""
    _give_copies_their_own_file(obj)
    obj.Stock = (result.stock_file, obj.Name + ".vdb")
    obj.Mesh = Mesh.Mesh(result.mesh_file)
    # a mesh that FreeCAD mended has other triangles
    whole = len(result.colours) == obj.Mesh.CountFacets
    obj.FaceColours = result.colours if whole else []
    obj.VolumeInitial = result.volume_initial
    obj.VolumeFinal = result.volume_final
    obj.VolumeRemoved = result.volume_initial - result.volume_final
    obj.HasDesign = result.excess is not None
    obj.Excess = result.excess or 0.0
    obj.Gouge = result.gouge or 0.0
    obj.Operations = result.operations
    obj.RemovedByOperation = result.removed
    obj.Findings = prepared.data.notes + [wording.line(*finding) for finding in result.findings]
    obj.Errors = result.errors
    obj.Moves = result.moves
    obj.Seconds = result.seconds
    obj.Signature = prepared.signature
    refresh(obj)
    obj.purgeTouched()


def add(job, prepared, result, obj=None):
    """Put a result into the job's document in one undoable step: into a simulation object, or a new one -> it.

    ReferenceError when the job or its document is gone; any error leaves the document as it was.
    """
    document = job.Document
    job.Name, document.Name
    document.openTransaction("Simulate")
    try:
        obj = obj or make(job, prepared.voxel_mm)
        obj.VoxelSize = prepared.voxel_mm
        store(obj, prepared, result)
    except BaseException:
        document.abortTransaction()
        raise
    document.commitTransaction()
    return obj


def simulate(obj, progress=None):
    """Run a simulation object to its end in this thread, in one undoable step.

    progress: called with the fraction done; a true answer cancels. JobError, MemoryError, swarf.Error or
    swarf.Cancelled leave the object as it was.
    """
    prepared = prepare(obj)
    with tempfile.TemporaryDirectory(prefix="swarf-") as folder:
        result = prepared.run(folder, progress)
        add(obj.Job, prepared, result, obj)
    return obj
