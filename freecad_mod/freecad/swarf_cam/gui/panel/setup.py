# SPDX-License-Identifier: LGPL-2.1-or-later
"""What holds the tools and the stock: a holder with its stickout for each tool controller, the fixtures, and how near
holders may come to the stock. Shows what it is told, and tells what the user wants."""

import FreeCAD

from .. import settings
from ..qt import QtCore, QtWidgets

translate = FreeCAD.Qt.translate

STICKOUT_MAX_MM = 1000.0
LENGTH_DECIMALS = 2

# Columns of the tools.
TOOL, HOLDER, STICKOUT = range(3)


class SetupPage(QtWidgets.QWidget):
    """Tells by held (name of a tool controller, holder, stickout in mm), by add_pressed that the objects selected in
    FreeCAD are to be fixtures, by removed the name of one that is none any more, by cleared another clearance, which is
    kept in the settings.

    _told: name of a tool controller -> [holder, stickout] as it was shown or told last; _usual: -> stickout to begin
    with; _filling: the page is being filled, so that what its editors say on going is nothing that the user wants."""

    held = QtCore.Signal(str, str, float)
    add_pressed = QtCore.Signal()
    removed = QtCore.Signal(str)
    cleared = QtCore.Signal()

    def __init__(self, holder_names, parent=None):
        super().__init__(parent)
        self.setObjectName("SwarfSetup")
        self._holder_names = holder_names
        self._told, self._usual, self._filling = {}, {}, False
        self._texts, self._fixtures = [], []
        row = QtWidgets.QHBoxLayout(self)
        row.setContentsMargins(6, 6, 6, 6)
        row.addLayout(self._make_tools(), 3)
        row.addLayout(self._make_fixtures(), 2)

    def _make_tools(self):
        column = QtWidgets.QVBoxLayout()
        self.tools = QtWidgets.QTreeWidget()
        self.tools.setObjectName("SwarfHolders")
        self.tools.setRootIsDecorated(False)
        self.tools.setSelectionMode(QtWidgets.QAbstractItemView.NoSelection)
        self.tools.setHeaderLabels([translate("Swarf", "Tool"), translate("Swarf", "Holder"),
                                    translate("Swarf", "Stickout")])
        self.tools.headerItem().setToolTip(STICKOUT, translate("Swarf", "From the tool's tip to the holder"))
        header = self.tools.header()
        header.setStretchLastSection(False)
        header.setSectionResizeMode(TOOL, QtWidgets.QHeaderView.Stretch)
        for column_index in (HOLDER, STICKOUT):
            header.setSectionResizeMode(column_index, QtWidgets.QHeaderView.ResizeToContents)
        column.addWidget(self.tools, 1)
        clearance = QtWidgets.QHBoxLayout()
        clearance.addWidget(QtWidgets.QLabel(translate("Swarf", "Clearance of holders")))
        self.clearance = self._length("SwarfClearance", settings.CLEARANCE_MAX_MM)
        self.clearance.setToolTip(translate("Swarf", "Warn where a holder comes nearer to the stock than this"))
        self.clearance.setValue(settings.clearance())
        self.clearance.valueChanged.connect(self._set_clearance)
        clearance.addWidget(self.clearance)
        clearance.addStretch(1)
        column.addLayout(clearance)
        return column

    def _make_fixtures(self):
        column = QtWidgets.QVBoxLayout()
        self.fixtures = QtWidgets.QTreeWidget()
        self.fixtures.setObjectName("SwarfFixtureList")
        self.fixtures.setRootIsDecorated(False)
        self.fixtures.setHeaderLabels([translate("Swarf", "Fixtures")])
        self.fixtures.headerItem().setToolTip(0, translate("Swarf", "What holds the stock: nothing may touch it"))
        self.fixtures.itemSelectionChanged.connect(self._show_choice)
        column.addWidget(self.fixtures, 1)
        buttons = QtWidgets.QHBoxLayout()
        self.add = QtWidgets.QPushButton(translate("Swarf", "Add selected"))
        self.add.setObjectName("SwarfAddFixture")
        self.add.setToolTip(translate("Swarf", "Solids and meshes that are selected in FreeCAD hold the stock"))
        self.add.clicked.connect(lambda *_: self.add_pressed.emit())
        buttons.addWidget(self.add)
        self.remove = QtWidgets.QPushButton(translate("Swarf", "Remove"))
        self.remove.setObjectName("SwarfRemoveFixture")
        self.remove.clicked.connect(lambda *_: self._remove())
        buttons.addWidget(self.remove)
        self._show_choice()
        column.addLayout(buttons)
        return column

    @staticmethod
    def _length(name, most):
        box = QtWidgets.QDoubleSpinBox()
        box.setObjectName(name)
        box.setDecimals(LENGTH_DECIMALS)
        box.setRange(0.0, most)
        box.setSuffix(" mm")
        box.setKeyboardTracking(False)
        return box

    def show_job(self, tools, fixtures):
        """tools: (name of the controller, text, holder, stickout in mm, the stickout to begin with) each; fixtures:
        (name, label) each. Empty for no job. What is shown already stays as it is, with what is being typed into it."""
        self._usual = {name: usual for name, _, _, _, usual in tools}
        texts = [(name, text) for name, text, _, _, _ in tools]
        wanted = {name: [holder, round(stickout, LENGTH_DECIMALS)] for name, _, holder, stickout, _ in tools}
        self._filling = True  # an editor that loses the focus because it goes would tell what is half typed
        try:
            if (texts, wanted) != (self._texts, self._told):
                self._fill_tools(tools)
                self._texts = texts
            if list(fixtures) != self._fixtures:
                self._fill_fixtures(fixtures)
                self._fixtures = list(fixtures)
        finally:
            self._filling = False

    def _fill_tools(self, tools):
        self.tools.clear()
        self._told = {}
        for name, text, holder, stickout, _ in tools:
            item = QtWidgets.QTreeWidgetItem([text])
            item.setToolTip(TOOL, text)
            self.tools.addTopLevelItem(item)
            self._add_editors(item, name, holder, stickout)

    def _fill_fixtures(self, fixtures):
        self.fixtures.clear()
        for name, label in fixtures:
            item = QtWidgets.QTreeWidgetItem([label])
            item.setData(0, QtCore.Qt.UserRole, name)
            self.fixtures.addTopLevelItem(item)
        self._show_choice()

    def _add_editors(self, item, name, holder, stickout):
        box = QtWidgets.QComboBox()
        box.setObjectName("SwarfHolder-" + name)
        box.setEditable(True)
        box.setInsertPolicy(QtWidgets.QComboBox.NoInsert)
        box.addItem("")
        box.addItems(self._holder_names)
        box.completer().setFilterMode(QtCore.Qt.MatchContains)
        box.setMinimumContentsLength(12)
        box.lineEdit().setPlaceholderText(translate("Swarf", "none"))
        box.setEditText(holder)
        box.setToolTip(translate("Swarf", "A holder of the library, or form:r/z:r/z... from its lower face up, in mm"))
        length = self._length("SwarfStickout-" + name, STICKOUT_MAX_MM)
        length.setValue(stickout)
        length.setEnabled(bool(holder))
        self._told[name] = [holder, length.value()]

        def tell():
            if self._filling:
                return
            text = box.currentText().strip()
            length.setEnabled(bool(text))
            if text and length.value() == 0.0:
                length.blockSignals(True)
                length.setValue(self._usual[name])
                length.blockSignals(False)
            wanted = [text, length.value() if text else 0.0]
            if wanted != self._told[name]:
                self._told[name] = wanted
                self.held.emit(name, *wanted)
        box.activated.connect(lambda *_: tell())
        box.lineEdit().editingFinished.connect(tell)
        length.valueChanged.connect(lambda *_: tell() if box.currentText().strip() else None)
        self.tools.setItemWidget(item, HOLDER, box)
        self.tools.setItemWidget(item, STICKOUT, length)

    def _set_clearance(self, value):
        settings.set_clearance(value)
        self.cleared.emit()

    def _show_choice(self):
        self.remove.setEnabled(bool(self.fixtures.selectedItems()))

    def _remove(self):
        for item in self.fixtures.selectedItems():
            self.removed.emit(item.data(0, QtCore.Qt.UserRole))
