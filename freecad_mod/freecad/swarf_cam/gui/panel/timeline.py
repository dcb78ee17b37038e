# SPDX-License-Identifier: LGPL-2.1-or-later
"""The slider: the machine's time from left to right, operations in their colours, tool changes and findings marked."""

import FreeCAD

from ...core import clock as clocks
from .. import colours
from ..qt import QtCore, QtGui, QtWidgets, place_of

translate = FreeCAD.Qt.translate

HEIGHT, MARGIN = 46, 10


class Timeline(QtWidgets.QWidget):
    """Shows a place, and tells by sought where one dragged to."""

    sought = QtCore.Signal(float)

    def __init__(self, parent=None):
        super().__init__(parent)
        self.setObjectName("SwarfTimeline")
        self.setFixedHeight(HEIGHT)
        self.setMouseTracking(True)
        self.setFocusPolicy(QtCore.Qt.StrongFocus)
        self.setAccessibleName(translate("Swarf", "Time line"))
        self._session = None
        self._findings = []
        self._place = 0.0
        self._dragging = False

    def open(self, session):
        """Another job, None for none."""
        self._session, self._findings, self._place = session, [], 0.0
        self.update()

    def set_findings(self, marks):
        """What is marked below the band: (place, severity, text)."""
        self._findings = marks
        self.update()

    def set_place(self, place):
        """Stand at a place."""
        if place != self._place:
            self._place = place
            self.update()

    def x_of(self, place):
        """Pixel of a place."""
        total = self._session.clock.seconds
        share = self._session.clock.time_of(place) / total if total > 0 else place / max(len(self._session.clock), 1)
        return MARGIN + share * (self.width() - 2 * MARGIN)

    def place_at(self, x):
        """Place at a pixel."""
        share = min(max((x - MARGIN) / max(self.width() - 2 * MARGIN, 1), 0.0), 1.0)
        total = self._session.clock.seconds
        if share >= 1.0 or total <= 0:
            return share * len(self._session.clock)
        return self._session.clock.place_at(share * total)

    def _marks(self):
        """(place, kind, text) of what is marked, in drawing order."""
        session = self._session
        for place in session.tool_changes:
            tool = session.tool_at(place)
            name = session.data.tools.get(tool, ("",))[0]
            yield place, "tool", "T%d %s" % (tool, name)
        yield from self._findings

    def paintEvent(self, _):
        """Band of operations, played part strong; marks above; the hand."""
        painter = QtGui.QPainter(self)
        painter.setRenderHint(QtGui.QPainter.Antialiasing, True)
        palette = self.palette()
        top, height = 16.0, 20.0
        if self._session is None:
            painter.setPen(QtCore.Qt.NoPen)
            painter.setBrush(palette.color(QtGui.QPalette.Mid))
            painter.drawRoundedRect(QtCore.QRectF(MARGIN, top, self.width() - 2 * MARGIN, height), 4, 4)
            painter.end()
            return
        hand = self.x_of(self._place)
        begins = self._session.listing.operation_begin
        font = QtGui.QFont(self.font())
        font.setPixelSize(11)
        painter.setFont(font)
        metrics = QtGui.QFontMetricsF(font)
        for index, operation in enumerate(self._session.listing.operations):
            left, right = self.x_of(begins[index]), self.x_of(begins[index + 1])
            band = QtCore.QRectF(left, top, max(right - left - 1.0, 1.0), height)
            colour = colours.of_operation(index)
            pale = QtGui.QColor(colour)
            pale.setAlpha(80)
            painter.fillRect(band, pale)
            painter.fillRect(QtCore.QRectF(left, top, max(min(hand, right - 1) - left, 0.0), height), colour)
            text = metrics.elidedText(operation.name, QtCore.Qt.ElideRight, band.width() - 8)
            if len(text) > 2:
                painter.setPen(palette.color(QtGui.QPalette.WindowText))
                painter.drawText(band.adjusted(5, 0, -3, 0), QtCore.Qt.AlignVCenter, text)
        for place, kind, _ in self._marks():
            x = self.x_of(place)
            painter.setPen(QtCore.Qt.NoPen)
            if kind == "tool":
                painter.setBrush(palette.color(QtGui.QPalette.WindowText))
                points = ((x, top - 9), (x + 4, top - 5), (x, top - 1), (x - 4, top - 5))
            else:
                painter.setBrush(QtGui.QColor(colours.FINDINGS.get(kind, "#e5484d")))
                points = ((x, top + height), (x + 5, top + height + 9), (x - 5, top + height + 9))
            painter.drawPolygon(QtGui.QPolygonF([QtCore.QPointF(*point) for point in points]))
        painter.setPen(QtGui.QPen(palette.color(QtGui.QPalette.Base), 4.0))
        painter.drawLine(QtCore.QLineF(hand, top - 4, hand, top + height + 4))
        painter.setPen(QtGui.QPen(palette.color(QtGui.QPalette.Highlight if self.hasFocus()
                                                else QtGui.QPalette.WindowText), 2.0))
        painter.drawLine(QtCore.QLineF(hand, top - 4, hand, top + height + 4))
        painter.end()

    def _seek(self, event):
        self.sought.emit(self.place_at(place_of(event)[0]))

    def mousePressEvent(self, event):
        """Seek."""
        if self._session is not None and event.button() == QtCore.Qt.LeftButton:
            self._dragging = True
            self._seek(event)

    def mouseMoveEvent(self, event):
        """Drag, or tell what is under the mouse."""
        if self._session is None:
            return
        if self._dragging:
            self._seek(event)
        x = place_of(event)[0]
        place = self.place_at(x)
        near = [text for at, _, text in self._marks() if abs(self.x_of(at) - x) <= 5]
        session = self._session
        name = session.listing.operations[session.listing.operation_at(int(place))].name
        self.setToolTip("\n".join(["%s  %s" % (clocks.text_of(session.clock.time_of(place)), name), *near]))

    def mouseReleaseEvent(self, _):
        """The end of a drag."""
        self._dragging = False
