# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is known of the point that was clicked."""

import FreeCAD

from ..qt import QtCore, QtWidgets

translate = FreeCAD.Qt.translate


class Inspector(QtWidgets.QWidget):
    """Operation, line, tool, point and depth of a session.Picked."""

    def __init__(self, parent=None):
        super().__init__(parent)
        self.setObjectName("SwarfInspector")
        form = QtWidgets.QFormLayout(self)
        form.setLabelAlignment(QtCore.Qt.AlignRight)
        self.hint = QtWidgets.QLabel(translate("Swarf", "Click on the stock to learn which line cut it."))
        self.hint.setWordWrap(True)
        form.addRow(self.hint)
        self._rows = {}
        for key, text in (("operation", translate("Swarf", "Operation")), ("line", translate("Swarf", "Line")),
                          ("tool", translate("Swarf", "Tool")), ("time", translate("Swarf", "Cut at")),
                          ("point", translate("Swarf", "Point")), ("depth", translate("Swarf", "Below the top")),
                          ("slope", translate("Swarf", "Slope")),
                          ("deviation", translate("Swarf", "Deviation"))):
            label = QtWidgets.QLabel("–")
            label.setObjectName("SwarfPoint-" + key)
            label.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
            label.setWordWrap(True)
            form.addRow(text, label)
            self._rows[key] = label

    def show_values(self, values):
        """Texts by row; rows without one are emptied. None: nothing was hit."""
        self.hint.setText(translate("Swarf", "Click on the stock to learn which line cut it.") if values is None
                          else values.get("hint", ""))
        self.hint.setVisible(bool(self.hint.text()))
        for key, label in self._rows.items():
            label.setText((values or {}).get(key, "–"))
