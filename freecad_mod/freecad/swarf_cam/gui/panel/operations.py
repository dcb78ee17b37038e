# SPDX-License-Identifier: LGPL-2.1-or-later
"""The operations: colour, tool, time, volume removed; the box shows or hides their path in FreeCAD's own view."""

import FreeCAD

from ...core import clock as clocks
from .. import colours, numbers
from ..qt import QtCore, QtGui, QtWidgets, flags

translate = FreeCAD.Qt.translate


class OperationList(QtWidgets.QTreeWidget):
    """Tells by chosen which operation was clicked, by shown whose path is to be shown."""

    chosen = QtCore.Signal(int)
    shown = QtCore.Signal(int, bool)

    def __init__(self, parent=None):
        super().__init__(parent)
        self.setObjectName("SwarfOperations")
        self.setRootIsDecorated(False)
        self.setUniformRowHeights(True)
        self.setHeaderLabels([translate("Swarf", "Operation"), translate("Swarf", "Tool"), translate("Swarf", "Time"),
                              translate("Swarf", "Removed")])
        self.setToolTip(translate("Swarf", "Click: go to the operation. The box shows its path in the 3D view."))
        self._filling = False
        self.itemClicked.connect(lambda item, column: self.chosen.emit(self.indexOfTopLevelItem(item)))
        self.itemChanged.connect(self._changed)

    def open(self, session, visible):
        """The operations of a job; visible: whether each one's path is shown."""
        self._filling = True
        self.clear()
        if session is not None:
            begins = session.listing.operation_begin
            for index, operation in enumerate(session.listing.operations):
                seconds = session.clock.time_of(begins[index + 1]) - session.clock.time_of(begins[index])
                removed = session.overview.removed[index]
                item = QtWidgets.QTreeWidgetItem([operation.name, "T%d" % operation.tool, clocks.text_of(seconds),
                                                  numbers.text(removed / 1000, 2) + " cm³"])
                item.setCheckState(0, QtCore.Qt.Checked if visible[index] else QtCore.Qt.Unchecked)
                item.setIcon(0, self._chip(index))
                item.setToolTip(1, session.data.tools.get(operation.tool, ("",))[0])
                for column in (2, 3):
                    item.setData(column, QtCore.Qt.TextAlignmentRole,
                                 flags(QtCore.Qt.AlignRight, QtCore.Qt.AlignVCenter))
                self.addTopLevelItem(item)
            for column in range(1, 4):
                self.resizeColumnToContents(column)
            header = self.header()
            header.setStretchLastSection(False)
            header.setSectionResizeMode(0, QtWidgets.QHeaderView.Stretch)
        self._filling = False

    @staticmethod
    def _chip(index):
        pixmap = QtGui.QPixmap(24, 24)
        pixmap.fill(colours.of_operation(index))
        icon = QtGui.QIcon(pixmap)
        icon.addPixmap(pixmap, QtGui.QIcon.Selected)  # else Qt tints it there, and it is no longer the time line's
        return icon

    def _changed(self, item, column):
        if not self._filling and column == 0:
            self.shown.emit(self.indexOfTopLevelItem(item), item.checkState(0) == QtCore.Qt.Checked)

    def set_current(self, index):
        """The operation that is under way."""
        item = self.topLevelItem(index)
        if item is not None and item is not self.currentItem():
            self.setCurrentItem(item)
