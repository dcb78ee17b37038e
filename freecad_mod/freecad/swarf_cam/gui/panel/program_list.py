# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program's lines: the one that is cut is marked and kept in sight; a click seeks."""

import FreeCAD

from .. import colours
from ..qt import QtCore, QtGui, QtWidgets

translate = FreeCAD.Qt.translate


class _Lines(QtCore.QAbstractListModel):
    """Texts are made when a row is shown: a program may have a million."""

    def __init__(self, parent=None):
        super().__init__(parent)
        self.listing = None

    def open(self, listing):
        self.beginResetModel()
        self.listing = listing
        self.endResetModel()

    def rowCount(self, parent=QtCore.QModelIndex()):
        return 0 if self.listing is None or parent.isValid() else len(self.listing)

    def data(self, index, role=QtCore.Qt.DisplayRole):
        if self.listing is None or not index.isValid():
            return None
        row = index.row()
        number = self.listing.number[row]
        if role == QtCore.Qt.DisplayRole:
            text = self.listing.text(row)
            return text if number == 0 else "%6d  %s" % (abs(number), text)
        if role == QtCore.Qt.FontRole and number == 0:
            font = QtGui.QFont()
            font.setBold(True)
            return font
        if role == QtCore.Qt.DecorationRole and number == 0:
            return colours.of_operation(self.listing.operation[row])
        return None


class ProgramList(QtWidgets.QListView):
    """Tells by chosen which line was clicked."""

    chosen = QtCore.Signal(int)

    def __init__(self, parent=None):
        super().__init__(parent)
        self.setObjectName("SwarfProgram")
        self.setUniformItemSizes(True)
        self.setFont(QtGui.QFontDatabase.systemFont(QtGui.QFontDatabase.FixedFont))
        self.setAccessibleName(translate("Swarf", "Program"))
        self._lines = _Lines(self)
        self.setModel(self._lines)
        self.clicked.connect(lambda index: self.chosen.emit(index.row()))

    def open(self, listing):
        """Lines of a job, None for none."""
        self._lines.open(listing)

    def set_current(self, line):
        """The line that is cut."""
        index = self._lines.index(line, 0)
        if index.isValid() and index.row() != self.currentIndex().row():
            self.setCurrentIndex(index)
            if self.isVisible():
                self.scrollTo(index, QtWidgets.QAbstractItemView.EnsureVisible)
