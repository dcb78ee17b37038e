# SPDX-License-Identifier: LGPL-2.1-or-later
"""Task panel with the measures of what is left of a stock, of the whole and of each shell, and a way into a
spreadsheet."""

import FreeCAD

from ..app import pieces
from . import numbers, taskpanel
from .bodypanel import BodyPanel
from .qt import QtCore, QtWidgets, choice, flags
from .worker import Worker

translate = FreeCAD.Qt.translate

# Rows of the table that are seen at once: few enough for the panel to need no scrolling of its own.
ROWS_SEEN = 15


class MeasurePanel(BodyPanel):
    """Task panel for one simulation object. measured: core.measures.Table, None before it is known."""

    def __init__(self, obj):
        super().__init__("SwarfMeasurePanel", translate("Swarf", "Measures of the stock"), obj)
        self.measured = self._measuring = None
        layout = QtWidgets.QFormLayout(self.form)
        self.shell = choice()
        self.shell.setEnabled(False)
        self.shell.setToolTip(translate("Swarf", "What is measured: all of it, or a shell that hangs together"))
        self.shell.currentIndexChanged.connect(self._fill)
        layout.addRow(self.shell)
        self.table = QtWidgets.QTableWidget(0, 2)
        self.table.setEditTriggers(QtWidgets.QAbstractItemView.NoEditTriggers)
        self.table.setMinimumHeight(ROWS_SEEN * self.table.fontMetrics().height() * 4 // 3)
        self.table.setShowGrid(False)
        self.table.setWordWrap(False)
        self.table.setAlternatingRowColors(True)
        self.table.verticalHeader().hide()
        self.table.horizontalHeader().hide()
        self.table.horizontalHeader().setSectionResizeMode(0, QtWidgets.QHeaderView.Stretch)
        self.table.horizontalHeader().setSectionResizeMode(1, QtWidgets.QHeaderView.ResizeToContents)
        layout.addRow(self.table)
        self.note = QtWidgets.QLabel(translate(
            "Swarf", "Inertia is about the centre of mass and of density 1: times kg/mm³ it is kg mm²"))
        self.note.setWordWrap(True)
        layout.addRow(self.note)
        self.put = QtWidgets.QPushButton(translate("Swarf", "Put into a spreadsheet"))
        self.put.setEnabled(False)
        self.put.clicked.connect(self.add_sheet)
        layout.addRow(self.put)
        self.add_progress(layout)
        self.begin()

    def getStandardButtons(self):
        """Close: there is nothing to agree to."""
        return flags(QtWidgets.QDialogButtonBox.Close)

    def reject(self):
        """Close at once; the thread ends by itself."""
        if self.worker is not None:
            self.worker.cancel()
        self.close()
        return True

    def begin(self):
        """Measure in a thread."""
        self.bar.show()
        self._measuring = self.body
        self.worker = Worker(self.body.measures, self.show_progress, self.on_end)
        self.worker.start()

    def renew(self):
        """The measures are others; those of before are told no more."""
        self.shell.setEnabled(False)
        self.put.setEnabled(False)
        self.table.setRowCount(0)
        if self.worker is not None:
            self.worker.cancel()
        else:
            self.begin()

    def on_end(self, measured, error):
        """The thread is through, with a table or an error."""
        self.worker = None
        self.follow()
        if self.closed or self.worker is not None:
            return
        if self._measuring is not self.body:
            self.begin()
        elif error is not None:
            self.fail(error)
        else:
            self.measured = measured
            more = translate("Swarf", "{0} smaller shells are not listed").format(measured.more)
            self.end(more if measured.more else "")
            self.shell.clear()
            self.shell.addItems([pieces.name_of(column) for column in measured.columns])  # which fills the table
            self.shell.setEnabled(True)
            self.put.setEnabled(True)

    def _fill(self, place):
        """The measures of the whole or of a shell; those by axes below a heading, in narrow rows."""
        self.table.setRowCount(0)
        self.table.clearSpans()
        if place < 0:
            return
        above = None
        for row in self.measured.rows:
            key, axis, unit, values = row
            if values[place] is None:
                continue
            value = numbers.measure(values[place], unit)
            if not axis:
                self._add_row(pieces.text_of(key), ("%s %s" % (value, unit)).strip())
                continue
            if key != above:
                self._add_row(pieces.text_of(key) + (", " + unit if unit else ""))
                above = key
            self._add_row("    " + axis, value)
        self.table.resizeRowsToContents()

    def _add_row(self, label, value=None):
        """At the end; a heading without a value."""
        number = self.table.rowCount()
        self.table.insertRow(number)
        self.table.setItem(number, 0, QtWidgets.QTableWidgetItem(label))
        if value is None:
            self.table.setSpan(number, 0, 1, 2)
            return
        item = QtWidgets.QTableWidgetItem(value)
        item.setTextAlignment(QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter)
        self.table.setItem(number, 1, item)

    def add_sheet(self, *_):
        """The table into the document; the panel stays."""
        self.follow()
        if self.closed or self.working:
            return
        try:
            made = pieces.add_sheet(self.obj, self.measured)
        except (ReferenceError, RuntimeError, ValueError) as error:
            self.fail(error)
            return
        self.end(translate("Swarf", "In the document: {0}").format(made.Label))


def show_panel(obj):
    """Open the panel, None when another task is open or nothing is left."""
    return taskpanel.show(lambda: MeasurePanel(obj))
