# SPDX-License-Identifier: LGPL-2.1-or-later
"""Task panel that writes what is left of a stock into a file: format, error, colours, pieces, with a size estimate."""

import os

import FreeCAD

from .. import native
from ..app import model
from ..core.errors import JobError
from . import numbers, settings, taskpanel
from .qt import QtWidgets, choice
from .slices import Slices
from .worker import Worker

translate = FreeCAD.Qt.translate

ERROR_DECIMALS = 4

# What the spin box holds, which is more triangles than any computer's memory.
BUDGET_MAX = 2 ** 31 - 1


class ExportPanel(taskpanel.TaskPanel):
    """Task panel for one simulation object."""

    def __init__(self, obj):
        super().__init__("SwarfExportPanel", translate("Swarf", "Export stock"))
        self.obj, self.made = obj, None
        layout = QtWidgets.QFormLayout(self.form)
        self.kind = choice()
        for suffix, text in ((".stl", "STL"), (".ply", "PLY"), (".obj", "OBJ"), (".3mf", "3MF"), (".glb", "glTF"),
                             (".vdb", "OpenVDB"), (".step", "STEP"), (".brep", "BREP")):
            self.kind.addItem("%s (*%s)" % (text, suffix), suffix)
        layout.addRow(translate("Swarf", "Format"), self.kind)
        self.error = QtWidgets.QDoubleSpinBox()
        self.error.setDecimals(ERROR_DECIMALS)
        self.error.setRange(0, 10)
        self.error.setSingleStep(0.005)
        self.error.setSuffix(" mm")
        self.error.setValue(model.default_error(obj))
        layout.addRow(translate("Swarf", "Error"), self.error)
        self.budget = QtWidgets.QSpinBox()
        self.budget.setRange(0, BUDGET_MAX)
        self.budget.setSingleStep(1000)
        self.budget.setSpecialValueText(translate("Swarf", "any number"))
        self.budget.setToolTip(translate(
            "Swarf", "The most triangles that the mesh may have: it is made with the least error that they suffice "
            "for; where that would be more than the error above, no file is written"))
        layout.addRow(translate("Swarf", "Triangles"), self.budget)
        self.colour = choice()
        for kind, text in ((None, translate("Swarf", "none")), ("operation", translate("Swarf", "by operation")),
                           ("deviation", translate("Swarf", "by deviation from the model")),
                           ("thickness", translate("Swarf", "by wall thickness"))):
            if kind != "deviation" or obj.HasDesign:
                self.colour.addItem(text, kind)
        layout.addRow(translate("Swarf", "Colours"), self.colour)
        self.allowance = QtWidgets.QDoubleSpinBox()
        self.allowance.setDecimals(3)
        self.allowance.setRange(0, settings.ALLOWANCE_MAX_MM)
        self.allowance.setSingleStep(0.05)
        self.allowance.setSuffix(" mm")
        self.allowance.setToolTip(
            translate("Swarf", "What is meant to be left on the model: it counts as no deviation"))
        self.allowance.setValue(settings.allowance())
        layout.addRow(translate("Swarf", "Allowance"), self.allowance)
        self.largest = QtWidgets.QCheckBox(translate("Swarf", "leave loose pieces out"))
        layout.addRow(self.largest)
        self.fine = QtWidgets.QCheckBox(translate("Swarf", "follow edges closer than a voxel"))
        self.fine.setToolTip(translate("Swarf", "As those of threads and narrow grooves; takes longer"))
        layout.addRow(self.fine)
        self.keep_volume = QtWidgets.QCheckBox(translate("Swarf", "keep the volume"))
        self.keep_volume.setToolTip(translate(
            "Swarf", "Flat triangles between points of a curved face change its volume: shift the points by a fifth of "
            "the error at most, so that they do not. What is thinner than a voxel is in no mesh, and is not made up "
            "for"))
        layout.addRow(self.keep_volume)
        self.estimate = QtWidgets.QLabel()
        self.estimate.setWordWrap(True)
        layout.addRow(self.estimate)
        self.add_progress(layout)
        for signal in (self.kind.currentIndexChanged, self.colour.currentIndexChanged, self.error.valueChanged,
                       self.budget.valueChanged):
            signal.connect(self.show_estimate)
        self.show_estimate()

    @property
    def suffix(self):
        """Of the chosen format."""
        return self.kind.currentData()

    def show_estimate(self, *_):
        """How large the file becomes, and what the format has a place for."""
        mesh = self.suffix not in model.STOCK_SUFFIXES
        self.error.setEnabled(mesh)
        self.budget.setEnabled(mesh and self.error.value() > 0)  # else no triangle can be left out
        self.largest.setEnabled(mesh)
        self.fine.setEnabled(mesh)
        self.keep_volume.setEnabled(mesh)
        self.colour.setEnabled(self.suffix in model.MESH_SUFFIXES and self.suffix != ".stl")
        self.allowance.setEnabled(self.chosen_colour == "deviation")
        triangles, size = model.estimate(self.obj, self.suffix, self.error.value(), self.chosen_colour is not None,
                                         self.chosen_budget)
        form = translate("Swarf", "at most {0} triangles, {1}") if self.chosen_budget else \
            translate("Swarf", "about {0} triangles, {1}")
        text = form.format(numbers.count(triangles), numbers.size(size)) if mesh else numbers.size(size)
        if self.suffix in model.SHAPE_SUFFIXES:
            text = translate("Swarf", "faces as they were cut, exactly; where that cannot be, flat facets as asked for "
                             "above: {0}").format(text)
        if self.suffix in model.SHAPE_SUFFIXES and triangles > model.SHAPE_TRIANGLES_MAX:
            text += translate("Swarf", "; too many for flat facets: a shape only if all its faces are planes, "
                              "cylinders, cones, spheres and tori")
        self.estimate.setText(text)

    @property
    def chosen_colour(self):
        """What the file is coloured by, None for nothing."""
        return self.colour.currentData() if self.colour.isEnabled() else None

    @property
    def chosen_budget(self):
        """The most triangles, 0 for any number."""
        return self.budget.value() if self.budget.isEnabled() else 0

    def begin(self):
        """Ask for the file, then start."""
        name = "".join(letter if letter.isalnum() or letter in " -_" else "_" for letter in self.obj.Label)
        path, _ = QtWidgets.QFileDialog.getSaveFileName(
            self.form, translate("Swarf", "Export stock"), name + self.suffix, "*" + self.suffix)
        if path:
            self.start(path if os.path.splitext(path)[1] else path + self.suffix)

    def start(self, path):
        """Read the job here, between the events, then mesh and write in a thread."""
        settings.set_allowance(self.allowance.value())
        self.message.setText("")
        self.bar.setRange(0, 1000)
        self.bar.show()
        self.reading = Slices(
            model.export_steps(self.obj, path, error_mm=self.error.value(), budget=self.chosen_budget,
                               colour=self.chosen_colour, tolerance_mm=settings.tolerance(),
                               allowance_mm=self.allowance.value(), largest=self.largest.isChecked(),
                               fine=self.fine.isChecked(), keep_volume=self.keep_volume.isChecked()),
            self.on_read, self.form)

    def on_read(self, made, error):
        """The job is read, or cannot be."""
        self.reading = None
        if error is not None:
            self.fail(error)
            return
        self.made = made
        self.worker = Worker(made.run, self.show_progress, self.on_end)
        self.worker.start()

    def on_end(self, count, error):
        """The thread is through, with a number of triangles or an error."""
        cancelled = self.worker.cancelled
        self.worker = None
        if cancelled and (error is not None or self.made.unfinished):  # else the file is there
            self.made.discard()
            self.end(translate("Swarf", "Cancelled; nothing was changed."))
            return
        try:
            if error is not None:
                raise error
            if self.made.unfinished:  # FreeCAD's part, here: nothing else is painted meanwhile
                self.message.setText(translate("Swarf", "Making the shape ..."))
                self.message.repaint()
            self.made.finish()
        except (JobError, OSError, RuntimeError, ValueError, MemoryError, native.load().Error) as problem:
            self.fail(problem)
            return
        FreeCAD.Console.PrintMessage(translate("Swarf", "Swarf: written: {0}, {1}\n").format(
            self.made.path, numbers.size(os.path.getsize(self.made.path))))
        self.close()


def show_panel(obj):
    """Open the panel, None when another task is open."""
    return taskpanel.show(lambda: ExportPanel(obj))
