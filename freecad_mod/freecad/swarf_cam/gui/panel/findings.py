# SPDX-License-Identifier: LGPL-2.1-or-later
"""The list of what was found, the worst first; buttons leave out severities, a click goes there."""

import FreeCAD

from ...core import findings as model
from .. import icons
from ..qt import QtCore, QtGui, QtWidgets

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

FILTERS = {"error": QT_TRANSLATE_NOOP("Swarf", "Show errors"), "warning": QT_TRANSLATE_NOOP("Swarf", "Show warnings"),
           "note": QT_TRANSLATE_NOOP("Swarf", "Show notes")}
NAMES = {"error": QT_TRANSLATE_NOOP("Swarf", "Error"), "warning": QT_TRANSLATE_NOOP("Swarf", "Warning"),
         "note": QT_TRANSLATE_NOOP("Swarf", "Note")}

# Numbers of pins.
CIRCLED = "①②③④⑤⑥⑦⑧⑨"


class FindingList(QtWidgets.QWidget):
    """Tells by chosen the core Finding that was clicked, by run_pressed that it is to be checked (again) or, while it
    is, that this is to end."""

    chosen = QtCore.Signal(object)
    run_pressed = QtCore.Signal()

    def __init__(self, parent=None):
        super().__init__(parent)
        self.setObjectName("SwarfFindings")
        column = QtWidgets.QVBoxLayout(self)
        column.setContentsMargins(0, 2, 0, 0)
        column.setSpacing(2)
        row = QtWidgets.QHBoxLayout()
        row.setContentsMargins(4, 0, 4, 0)
        self._icons = {severity: icons.icon("finding-" + severity, self.palette()) for severity in model.SEVERITIES}
        blank = QtGui.QPixmap(16, 16)
        blank.fill(QtCore.Qt.transparent)
        self._icons[None] = QtGui.QIcon(blank)
        self.filters = {}
        for severity in model.SEVERITIES:
            button = QtWidgets.QToolButton()
            button.setObjectName("SwarfFilter-" + severity)
            button.setIcon(self._icons[severity])
            button.setToolTip(translate("Swarf", FILTERS[severity]))
            button.setToolButtonStyle(QtCore.Qt.ToolButtonTextBesideIcon)
            button.setAutoRaise(True)
            button.setCheckable(True)
            button.setChecked(True)
            button.toggled.connect(lambda *_: self._filter())
            row.addWidget(button)
            self.filters[severity] = button
        self.state = QtWidgets.QLabel()
        self.state.setObjectName("SwarfCheckState")
        row.addWidget(self.state, 1)
        self.bar = QtWidgets.QProgressBar()
        self.bar.setRange(0, 1000)
        self.bar.setMaximumWidth(120)
        self.bar.setTextVisible(False)
        row.addWidget(self.bar)
        self.run = QtWidgets.QPushButton()
        self.run.setObjectName("SwarfCheck")
        self.run.clicked.connect(lambda *_: self.run_pressed.emit())
        row.addWidget(self.run)
        column.addLayout(row)
        self.tree = QtWidgets.QTreeWidget()
        self.tree.setObjectName("SwarfFindingTree")
        self.tree.setRootIsDecorated(False)
        self.tree.setUniformRowHeights(True)
        self.tree.setHeaderLabels([translate("Swarf", "Finding"), translate("Swarf", "Operation"),
                                   translate("Swarf", "Line")])
        self.tree.setToolTip(translate("Swarf", "Click: go to the move and the place"))
        header = self.tree.header()
        header.setStretchLastSection(False)
        header.setSectionResizeMode(0, QtWidgets.QHeaderView.Stretch)
        self.tree.itemClicked.connect(
            lambda item, _: self.chosen.emit(self._shown[self.tree.indexOfTopLevelItem(item)]))
        column.addWidget(self.tree, 1)
        self._shown = []
        self.show_findings((), {}, None)
        self.show_checked("")

    def icon(self, severity):
        """The sign of a severity; of None a blank one as large, so that a tab keeps its height."""
        return self._icons[severity]

    def show_findings(self, findings, numbers, listing):
        """A list of core Findings of a program's core Listing. numbers: Finding -> number of its pin."""
        self._shown = list(findings)
        self.tree.clear()
        for finding in self._shown:
            operation = listing.operations[finding.operation].name if finding.operation >= 0 else "–"
            line = str(abs(listing.number[finding.line])) if finding.line >= 0 else "–"
            number = "%s " % CIRCLED[numbers[finding] - 1] if finding in numbers else ""
            item = QtWidgets.QTreeWidgetItem([number + finding.text, operation, line])
            item.setIcon(0, self._icons[finding.severity])
            item.setToolTip(0, "%s: %s" % (translate("Swarf", NAMES[finding.severity]), finding.text))
            self.tree.addTopLevelItem(item)
        for column in (1, 2):
            self.tree.resizeColumnToContents(column)
        for severity, count in model.counts(self._shown).items():
            self.filters[severity].setText(str(count))
        self._filter()

    def _filter(self):
        for index, finding in enumerate(self._shown):
            self.tree.topLevelItem(index).setHidden(not self.filters[finding.severity].isChecked())

    def show_running(self, text):
        """Checks go on."""
        self.state.setText(text)
        self.bar.setValue(0)
        self.bar.show()
        self.run.setText(translate("Swarf", "Cancel"))

    def show_progress(self, fraction):
        """Part of the checks that is done."""
        self.bar.setValue(int(1000 * fraction))

    def show_checked(self, text):
        """Checks are over, or were not begun; text says how they ended."""
        self.state.setText(text)
        self.state.setToolTip(text)
        self.bar.hide()
        self.run.setText(translate("Swarf", "Check again") if self._shown or text else translate("Swarf", "Check"))
