# SPDX-License-Identifier: LGPL-2.1-or-later
"""The list of what was found, the worst first; buttons leave out severities, a box all kinds but one; a click goes
there. A finding can be accepted, with a reason that is typed below the list."""

import FreeCAD

from ...core import findings as model
from .. import icons, settings
from ..qt import QAction, QtCore, QtGui, QtWidgets

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

FILTERS = {"error": QT_TRANSLATE_NOOP("Swarf", "Show errors"), "warning": QT_TRANSLATE_NOOP("Swarf", "Show warnings"),
           "note": QT_TRANSLATE_NOOP("Swarf", "Show notes and what is accepted")}
NAMES = {"error": QT_TRANSLATE_NOOP("Swarf", "Error"), "warning": QT_TRANSLATE_NOOP("Swarf", "Warning"),
         "note": QT_TRANSLATE_NOOP("Swarf", "Note")}

# Kinds of swarf Verdicts and what they are called here; others are shown as they are.
KINDS = {
    "gouge": QT_TRANSLATE_NOOP("Swarf", "Gouges"), "excess": QT_TRANSLATE_NOOP("Swarf", "Material left"),
    "not reached": QT_TRANSLATE_NOOP("Swarf", "Not reached"), "rapid": QT_TRANSLATE_NOOP("Swarf", "Rapids in material"),
    "start": QT_TRANSLATE_NOOP("Swarf", "Starts in material"), "shank": QT_TRANSLATE_NOOP("Swarf", "Shank"),
    "holder": QT_TRANSLATE_NOOP("Swarf", "Holder"), "depth": QT_TRANSLATE_NOOP("Swarf", "Deeper than the flutes"),
    "near": QT_TRANSLATE_NOOP("Swarf", "Near misses"), "fixture": QT_TRANSLATE_NOOP("Swarf", "Fixtures"),
    "design": QT_TRANSLATE_NOOP("Swarf", "Model"), "spindle": QT_TRANSLATE_NOOP("Swarf", "Spindle"),
    "feed": QT_TRANSLATE_NOOP("Swarf", "Feed"), "plunge": QT_TRANSLATE_NOOP("Swarf", "Plunges"),
    "travel": QT_TRANSLATE_NOOP("Swarf", "Travel"), "tool": QT_TRANSLATE_NOOP("Swarf", "Tool"),
    "load": QT_TRANSLATE_NOOP("Swarf", "Loads"), "uncut": QT_TRANSLATE_NOOP("Swarf", "Not simulated"),
    "loose": QT_TRANSLATE_NOOP("Swarf", "Loose pieces"), "acceptance": QT_TRANSLATE_NOOP("Swarf", "Idle acceptances"),
}

# Numbers of pins.
CIRCLED = "①②③④⑤⑥⑦⑧⑨"


class FindingList(QtWidgets.QWidget):
    """Tells by chosen the core Finding that was clicked, by run_pressed that it is to be checked (again) or, while it
    is, that this is to end; by accept_pressed and refuse_pressed that one is to be accepted, and no longer."""

    chosen = QtCore.Signal(object)
    run_pressed = QtCore.Signal()
    accept_pressed = QtCore.Signal(object, str)
    refuse_pressed = QtCore.Signal(object)

    def __init__(self, parent=None):
        super().__init__(parent)
        self.setObjectName("SwarfFindings")
        self._shown = []
        column = QtWidgets.QVBoxLayout(self)
        column.setContentsMargins(0, 2, 0, 0)
        column.setSpacing(2)
        self._icons = {severity: icons.icon("finding-" + severity, self.palette()) for severity in model.SEVERITIES}
        blank = QtGui.QPixmap(16, 16)
        blank.fill(QtCore.Qt.transparent)
        self._icons[None] = QtGui.QIcon(blank)
        column.addLayout(self._make_row())
        column.addWidget(self._make_tree(), 1)
        column.addWidget(self._make_reason())
        self.show_findings((), {}, None)
        self.show_checked("")

    def _make_row(self):
        row = QtWidgets.QHBoxLayout()
        row.setContentsMargins(4, 0, 4, 0)
        self.filters = {}
        for severity in model.SEVERITIES:
            button = self._tool("SwarfFilter-" + severity, translate("Swarf", FILTERS[severity]), self._icons[severity])
            button.setToolButtonStyle(QtCore.Qt.ToolButtonTextBesideIcon)
            button.setCheckable(True)
            button.setChecked(True)
            button.toggled.connect(lambda *_: self._filter())
            row.addWidget(button)
            self.filters[severity] = button
        self.kind = QtWidgets.QComboBox()
        self.kind.setObjectName("SwarfKind")
        self.kind.setToolTip(translate("Swarf", "Show one kind of findings"))
        self.kind.setSizeAdjustPolicy(QtWidgets.QComboBox.AdjustToContents)
        self.kind.currentIndexChanged.connect(lambda *_: self._filter())
        row.addWidget(self.kind)
        self.accept = self._tool("SwarfAccept",
                                 translate("Swarf", "Accept the chosen finding, with a reason; or no more"),
                                 icons.icon("accept", self.palette()))
        self.accept.setText(translate("Swarf", "Accept"))
        self.accept.setToolButtonStyle(QtCore.Qt.ToolButtonTextBesideIcon)
        self.accept.setCheckable(True)
        self.accept.clicked.connect(lambda *_: self._accept_pressed())
        row.addWidget(self.accept)
        self.state = QtWidgets.QLabel()
        self.state.setObjectName("SwarfCheckState")
        self.state.setSizePolicy(QtWidgets.QSizePolicy.Ignored, QtWidgets.QSizePolicy.Preferred)
        row.addWidget(self.state, 1)
        self.bar = QtWidgets.QProgressBar()
        self.bar.setRange(0, 1000)
        self.bar.setMaximumWidth(120)
        self.bar.setTextVisible(False)
        row.addWidget(self.bar)
        self.run = self._tool("SwarfCheck", "", None)
        self.run.setToolButtonStyle(QtCore.Qt.ToolButtonTextOnly)
        self.run.setAutoRaise(False)
        self.run.setPopupMode(QtWidgets.QToolButton.MenuButtonPopup)
        self.run.clicked.connect(lambda *_: self.run_pressed.emit())
        menu = QtWidgets.QMenu(self.run)
        self.stop = QAction(translate("Swarf", "Stop at the first error"), menu)
        self.stop.setCheckable(True)
        self.stop.setChecked(settings.flag("StopAtError"))
        self.stop.toggled.connect(lambda on: settings.set_flag("StopAtError", on))
        menu.addAction(self.stop)
        self.run.setMenu(menu)
        row.addWidget(self.run)
        return row

    @staticmethod
    def _tool(name, tip, icon):
        button = QtWidgets.QToolButton()
        button.setObjectName(name)
        button.setToolTip(tip)
        button.setAccessibleName(tip)
        button.setAutoRaise(True)
        if icon is not None:
            button.setIcon(icon)
        return button

    def _make_tree(self):
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
        self.tree.itemClicked.connect(lambda *_: self.chosen.emit(self.current))
        self.tree.currentItemChanged.connect(lambda *_: self._show_choice())
        return self.tree

    def _make_reason(self):
        """The line where a reason is typed, hidden unless it is asked for."""
        self._reason_row = QtWidgets.QWidget()
        row = QtWidgets.QHBoxLayout(self._reason_row)
        row.setContentsMargins(4, 0, 4, 2)
        row.addWidget(QtWidgets.QLabel(translate("Swarf", "Accepted because")))
        self.reason = QtWidgets.QLineEdit()
        self.reason.setObjectName("SwarfReason")
        self.reason.setPlaceholderText(translate("Swarf", "the reason, kept in the document"))
        self.reason.returnPressed.connect(self._give_reason)
        row.addWidget(self.reason, 1)
        self.give = QtWidgets.QPushButton(translate("Swarf", "Accept"))
        self.give.setObjectName("SwarfGiveReason")
        self.give.setEnabled(False)
        self.reason.textChanged.connect(lambda text: self.give.setEnabled(bool(text.strip())))
        self.give.clicked.connect(lambda *_: self._give_reason())
        row.addWidget(self.give)
        self._reason_row.hide()
        return self._reason_row

    def icon(self, severity):
        """The sign of a severity; of None a blank one as large, so that a tab keeps its height."""
        return self._icons[severity]

    @property
    def current(self):
        """The finding that is chosen, None for none."""
        index = self.tree.indexOfTopLevelItem(self.tree.currentItem())
        return self._shown[index] if 0 <= index < len(self._shown) else None

    def show_findings(self, findings, numbers, listing):
        """A list of core Findings of a program's core Listing. numbers: Finding -> number of its pin."""
        chosen = self.current
        self._shown = list(findings)
        self.tree.clear()
        for finding in self._shown:
            operation = listing.operations[finding.operation].name if finding.operation >= 0 else "–"
            line = str(abs(listing.number[finding.line])) if finding.line >= 0 else "–"
            number = "%s " % CIRCLED[numbers[finding] - 1] if finding in numbers else ""
            item = QtWidgets.QTreeWidgetItem([number + finding.text, operation, line])
            item.setIcon(0, self._icons[finding.severity])
            tip = "%s: %s" % (translate("Swarf", NAMES[finding.severity]), finding.text)
            if finding.accepted is not None:
                item.setText(0, "✓ %s (%s)" % (finding.text, finding.accepted))
                tip += "\n" + translate("Swarf", "Accepted because: {0}").format(finding.accepted)
                for column in range(3):
                    item.setForeground(column, self.palette().brush(QtGui.QPalette.Disabled, QtGui.QPalette.Text))
            item.setToolTip(0, tip)
            self.tree.addTopLevelItem(item)
            if chosen is not None and (chosen.kind, chosen.place, chosen.point) == \
                    (finding.kind, finding.place, finding.point):
                self.tree.setCurrentItem(item)
        for column in (1, 2):
            self.tree.resizeColumnToContents(column)
        for severity, count in model.counts(self._shown).items():
            self.filters[severity].setText(str(count))
        self._show_kinds()
        self._show_choice()

    def _show_kinds(self):
        """Kinds that there are; the one that is chosen stays."""
        chosen = self.kind.currentData()
        self.kind.blockSignals(True)
        self.kind.clear()
        self.kind.addItem(translate("Swarf", "All kinds"), None)
        for kind in model.kinds(self._shown):
            self.kind.addItem(translate("Swarf", KINDS[kind]) if kind in KINDS else kind, kind)
        self.kind.setCurrentIndex(max(self.kind.findData(chosen), 0) if chosen is not None else 0)
        self.kind.blockSignals(False)
        self._filter()

    def _filter(self):
        kind = self.kind.currentData()
        for index, finding in enumerate(self._shown):
            self.tree.topLevelItem(index).setHidden(not self.filters[finding.severity].isChecked() or
                                                    kind not in (None, finding.kind))

    # Accepting

    def _show_choice(self):
        finding = self.current
        self.accept.setEnabled(finding is not None and finding.verdict is not None and finding.kind != "acceptance")
        self.accept.setChecked(finding is not None and finding.accepted is not None)
        self._reason_row.hide()

    def _accept_pressed(self):
        finding = self.current
        if finding is None:
            return
        if finding.accepted is not None:
            self.refuse_pressed.emit(finding)
            return
        self.accept.setChecked(False)
        self.reason.clear()
        self._reason_row.setVisible(not self._reason_row.isVisible())
        self.reason.setFocus()

    def _give_reason(self):
        reason, finding = self.reason.text().strip(), self.current
        if reason and finding is not None:
            self._reason_row.hide()
            self.accept_pressed.emit(finding, reason)

    # How the checks stand

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
