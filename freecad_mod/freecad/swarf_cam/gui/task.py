# SPDX-License-Identifier: LGPL-2.1-or-later
"""The task panel: voxel size with an estimate, then progress; the document changes only at the end, in one step."""

import tempfile

import FreeCAD
import FreeCADGui as Gui

from .. import native
from ..app import setups, simulation
from ..core.errors import JobError
from . import numbers
from .qt import QtWidgets, choice
from .slices import Slices
from .taskpanel import TaskPanel
from .worker import Worker

translate = FreeCAD.Qt.translate

# Largest voxel size that the panel offers, and the digits it shows, mm.
VOXEL_MAX_MM = 1000.0
VOXEL_DECIMALS = 4


def describe_estimate(job, voxel_mm):
    """One sentence on what a voxel size will cost, or why it cannot be."""
    try:
        lo, hi = simulation.job_box(job)
        needed = native.estimate(lo, hi, voxel_mm)
    except (JobError, ValueError, MemoryError, OverflowError) as error:
        return str(error)
    cells = max(b - a for a, b in zip(lo, hi)) / voxel_mm
    return translate("Swarf", "{0} voxels along the longest edge, up to {1}").format(
        numbers.count(round(cells)), numbers.size(needed))


class StockChoice:
    """What the job cuts, its own stock or what another job leaves, and how that lies. The document learns of it when
    the work starts."""

    AS_MODEL, UNCHANGED, KEEP = "model", "unchanged", "keep"

    def __init__(self, job):
        self.job = job
        self.source, self.lie = choice(), choice()
        self.source.setObjectName("SwarfStockFrom")
        self.lie.setObjectName("SwarfStockLie")
        self._possible = simulation.possible_previous(job)
        previous = setups.previous_of(job)
        # one that the job cuts already stays what it cuts, even where it cannot: starting tells why
        kept = [previous] if previous is not None and previous not in self._possible else []
        self._simulations = self._possible + kept
        self.source.addItem(translate("Swarf", "the job's own"))
        for obj in self._simulations:
            self.source.addItem(translate("Swarf", "what is left by '{0}'").format(obj.Label))
        if previous is not None:
            self.source.setCurrentIndex(1 + self._simulations.index(previous))
        self.source.currentIndexChanged.connect(self.show_lies)
        self.show_lies()

    @property
    def chosen(self):
        """The simulation whose result is the stock, None for the job's own stock."""
        index = self.source.currentIndex()
        return self._simulations[index - 1] if index > 0 else None

    def show_lies(self, *_):
        """Offer what is possible."""
        self.lie.clear()
        self.lie.setEnabled(self.chosen is not None)
        if self.chosen is None:
            return
        if setups.previous_of(self.job) is self.chosen:
            self.lie.addItem(translate("Swarf", "as before"), self.KEEP)
        if self.chosen not in self._possible:
            return
        if setups.placement_by_models(self.chosen.Job, self.job) is not None:
            self.lie.addItem(translate("Swarf", "as the model of the job"), self.AS_MODEL)
        for axis in "XYZ":
            self.lie.addItem(translate("Swarf", "turned over about {0}").format(axis), axis)
        self.lie.addItem(translate("Swarf", "where it was"), self.UNCHANGED)

    def apply(self):
        """Into the document, in one undoable step, where it differs. JobError."""
        kind = self.lie.currentData()
        if self.chosen is setups.previous_of(self.job) and kind in (self.KEEP, None):
            return
        placement = None
        if kind == self.AS_MODEL:
            placement = setups.placement_by_models(self.chosen.Job, self.job)
        elif kind in ("X", "Y", "Z"):
            placement = setups.placement_turned(self.chosen.Job, self.job, kind)
        simulation.set_stock(self.job, self.chosen, placement)


class SimulationPanel(TaskPanel):
    """Task panel for a new simulation of a job (obj None) or for an existing one."""

    def __init__(self, job, obj=None):
        super().__init__("SwarfSimulationPanel", translate("Swarf", "Milling simulation"))
        self.job, self.obj = job, obj
        self.prepared = self.folder = None
        layout = QtWidgets.QFormLayout(self.form)
        layout.addRow(translate("Swarf", "Job"), QtWidgets.QLabel(job.Label))
        self.stock = StockChoice(job)
        layout.addRow(translate("Swarf", "Stock"), self.stock.source)
        layout.addRow(translate("Swarf", "It lies"), self.stock.lie)
        self.voxel = QtWidgets.QDoubleSpinBox()
        self.voxel.setDecimals(VOXEL_DECIMALS)
        self.voxel.setRange(10.0 ** -VOXEL_DECIMALS, VOXEL_MAX_MM)
        self.voxel.setSingleStep(0.01)
        self.voxel.setSuffix(" mm")
        self.voxel.setValue(obj.VoxelSize.Value if obj else simulation.default_voxel(job))
        self.stock.source.currentIndexChanged.connect(self.take_voxel)
        layout.addRow(translate("Swarf", "Voxel size"), self.voxel)
        self.estimate = QtWidgets.QLabel()
        self.estimate.setWordWrap(True)
        layout.addRow(self.estimate)
        self.add_progress(layout)
        self.voxel.valueChanged.connect(self.show_estimate)
        self.show_estimate()

    def take_voxel(self, *_):
        """That of the set-up before: its voxels can be kept as they are."""
        if self.stock.chosen is not None:
            self.voxel.setValue(self.stock.chosen.VoxelSize.Value)

    def show_estimate(self, *_):
        """What the chosen size will cost."""
        self.estimate.setText(describe_estimate(self.job, self.voxel.value()))

    def begin(self):
        """Read the job here, between the events, then simulate in a thread."""
        try:
            self.stock.apply()
        except JobError as error:
            self.fail(error)
            return
        self.voxel.setEnabled(False)
        self.message.setText("")
        self.bar.setRange(0, 0)
        self.bar.show()
        self.reading = Slices(simulation.prepare_steps(self.job, self.voxel.value()), self.on_read, self.form)

    def on_read(self, prepared, error):
        """The job is read, or cannot be."""
        self.reading = None
        if error is not None:
            self.fail(error)
            return
        try:
            self.folder = tempfile.TemporaryDirectory(prefix="swarf-")
        except OSError as problem:
            self.fail(problem)
            return
        self.prepared = prepared
        self.bar.setRange(0, 1000)
        folder = self.folder.name
        self.worker = Worker(lambda progress: prepared.run(folder, progress), self.show_progress, self.on_end)
        self.worker.start()

    def end(self, text):
        """Ready to begin again."""
        super().end(text)
        if not self.closed:
            self.voxel.setEnabled(True)

    def on_end(self, result, error):
        """The thread is through, with a result or an error."""
        cancelled = self.worker.cancelled
        self.worker = None
        try:
            if cancelled:  # even where nothing was left to break off
                self.end(translate("Swarf", "Cancelled; nothing was changed."))
            elif error is not None:
                self.fail(error)
            else:
                self.finish(result)
        finally:
            self.folder.cleanup()
            self.folder = None

    def finish(self, result):
        """Put the result into the document, in one transaction."""
        try:
            obj = simulation.add(self.job, self.prepared, result, self.obj)
        except ReferenceError:
            self.fail(translate("Swarf", "The job was deleted meanwhile; its simulation is discarded."))
            return
        except BaseException as error:
            self.fail(error)
            raise
        FreeCAD.Console.PrintMessage(translate("Swarf", "Swarf: {0}: {1} mm^3 removed in {2} s\n").format(
            obj.Label, numbers.text(result.volume_initial - result.volume_final, 1), numbers.text(result.seconds, 1)))
        self.close()


def show_panel(job, obj=None, start=False):
    """Open the panel; start: begin at once. Messages go to the report view when that is impossible."""
    if Gui.Control.activeDialog():
        FreeCAD.Console.PrintError(translate("Swarf", "Swarf: close the open task first\n"))
        return None
    try:
        native.load()
        if job is None:
            raise JobError(translate("Swarf", "the simulation has no job: it was deleted, or never chosen"))
        panel = SimulationPanel(job, obj)
    except JobError as error:
        FreeCAD.Console.PrintError("Swarf: %s\n" % error)
        return None
    Gui.Control.showDialog(panel)
    if start:
        panel.begin()
    return panel
