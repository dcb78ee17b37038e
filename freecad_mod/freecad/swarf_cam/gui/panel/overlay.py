# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is painted over the picture: the cube, the caption, the mark of the point that was clicked."""

import math

import FreeCAD

from ...core import legend, viewcube
from .. import colours, numbers
from ..qt import QtCore, QtGui

translate = FreeCAD.Qt.translate

# Half edge of the cube and its middle's distance from the corner, pixels.
CUBE, CUBE_MARGIN = 24.0, 58.0

# Pins: length of the stem and radius of the head, pixels; a place is hidden when the part is nearer than it by this
# share of the stock's diagonal.
PIN_STEM, PIN_HEAD, HIDDEN_SHARE = 24.0, 9.0, 0.01

# The legend of deviations, pixels, and rows of colours in it.
LEGEND_WIDTH, LEGEND_HEIGHT, LEGEND_ROWS = 14.0, 170.0, 160

FACE_TEXTS = {
    "front": FreeCAD.Qt.QT_TRANSLATE_NOOP("Swarf", "FRONT"), "rear": FreeCAD.Qt.QT_TRANSLATE_NOOP("Swarf", "REAR"),
    "left": FreeCAD.Qt.QT_TRANSLATE_NOOP("Swarf", "LEFT"), "right": FreeCAD.Qt.QT_TRANSLATE_NOOP("Swarf", "RIGHT"),
    "top": FreeCAD.Qt.QT_TRANSLATE_NOOP("Swarf", "TOP"), "bottom": FreeCAD.Qt.QT_TRANSLATE_NOOP("Swarf", "BOTTOM"),
}
AXES = (((1, 0, 0), "#d64545", "X"), ((0, 1, 0), "#3a9a48", "Y"), ((0, 0, 1), "#3d6fd1", "Z"))


def _cube_centre(view):
    return view.width() - CUBE_MARGIN, CUBE_MARGIN


def cube_place(view, x, y):
    """Where a click at a pixel of the view wants to look from, None beside the cube."""
    if view.camera is None:
        return None
    cx, cy = _cube_centre(view)
    return viewcube.pick(view.camera, (x - cx) / CUBE, (cy - y) / CUBE)


def paint(view, painter):
    """All of it."""
    painter.setRenderHint(QtGui.QPainter.Antialiasing, True)
    dark = colours.is_dark(view.palette())
    if view.camera is not None:
        _paint_cube(view, painter)
        if view.legend is not None:
            _paint_pins(view, painter)
            view.legend.paint(view, painter, dark)
        _paint_mark(view, painter)
    _paint_caption(view, painter, dark)


def _paint_axes(view, painter, cx, cy):
    """From the cube's lowest corner along its edges, and a little beyond; the cube is painted over them."""
    right, up, _ = viewcube.axes(view.camera)
    font = QtGui.QFont(view.font())
    font.setPixelSize(11)
    font.setBold(True)
    painter.setFont(font)
    x0, y0 = cx - CUBE * sum(right), cy + CUBE * sum(up)
    for axis, colour, letter in AXES:
        x = sum(a * b for a, b in zip(axis, right))
        y = sum(a * b for a, b in zip(axis, up))
        if math.hypot(x, y) < 0.15:
            continue
        end = QtCore.QPointF(x0 + 2.6 * CUBE * x, y0 - 2.6 * CUBE * y)
        painter.setPen(QtGui.QPen(QtGui.QColor(colour), 2.0))
        painter.drawLine(QtCore.QLineF(QtCore.QPointF(x0, y0), end))
        painter.drawText(QtCore.QRectF(end.x() + 8 * x - 8, end.y() - 8 * y - 8, 16, 16), QtCore.Qt.AlignCenter, letter)


def _paint_cube(view, painter):
    cx, cy = _cube_centre(view)
    _paint_axes(view, painter, cx, cy)
    font = QtGui.QFont(view.font())
    font.setPixelSize(20)
    font.setBold(True)
    ink = QtGui.QColor("#20262b")
    for name, corners, facing in viewcube.faces(view.camera):
        polygon = QtGui.QPolygonF([QtCore.QPointF(cx + CUBE * x, cy - CUBE * y) for x, y in corners])
        shade = int(196 + 50 * facing)
        painter.setPen(QtGui.QPen(QtGui.QColor("#5c6770"), 1.0))
        painter.setBrush(QtGui.QColor(shade - 4, shade, min(shade + 4, 255), 235))
        painter.drawPolygon(polygon)
        (nx, ny), (ux, uy), (vx, vy) = viewcube.label_transform(view.camera, name)
        painter.save()
        # text of 100 units across a face of 2
        painter.setTransform(QtGui.QTransform(ux * CUBE / 50, -uy * CUBE / 50, -vx * CUBE / 50, vy * CUBE / 50,
                                              cx + CUBE * nx, cy - CUBE * ny), True)
        painter.setFont(font)
        painter.setPen(ink)
        painter.drawText(QtCore.QRectF(-50, -50, 100, 100), QtCore.Qt.AlignCenter,
                         translate("Swarf", FACE_TEXTS[name]))
        painter.restore()


def _seen_at(view, point):
    """(QPointF, depth) where a point of the part appears, None outside the picture."""
    x, y, depth = view.camera.project(point, view.aspect())
    if not (math.isfinite(x) and abs(x) <= 1.2 and abs(y) <= 1.2):
        return None
    return QtCore.QPointF((x + 1) / 2 * view.width(), (1 - y) / 2 * view.height()), depth


def _paint_pins(view, painter):
    """Numbers on stems, the worst last; pale where the part hides the place."""
    font = QtGui.QFont(view.font())
    font.setPixelSize(11)
    font.setBold(True)
    painter.setFont(font)
    slack = HIDDEN_SHARE * math.dist(*view.box)
    for point, text, colour in reversed(view.pins):
        seen = _seen_at(view, point)
        if seen is None:
            continue
        place, depth = seen
        painter.setOpacity(0.35 if view.depth_under(place.x(), place.y()) < depth - slack else 1.0)
        head = QtCore.QPointF(place.x(), place.y() - PIN_STEM)
        painter.setPen(QtGui.QPen(QtGui.QColor("#ffffff"), 4.0))
        painter.drawLine(QtCore.QLineF(place, head))
        painter.setPen(QtGui.QPen(QtGui.QColor(colour), 2.0))
        painter.drawLine(QtCore.QLineF(place, head))
        painter.setPen(QtGui.QPen(QtGui.QColor("#ffffff"), 1.5))
        painter.setBrush(QtGui.QColor(colour))
        painter.drawEllipse(head, PIN_HEAD, PIN_HEAD)
        painter.drawText(QtCore.QRectF(head.x() - PIN_HEAD, head.y() - PIN_HEAD, 2 * PIN_HEAD, 2 * PIN_HEAD),
                         QtCore.Qt.AlignCenter, text)
    painter.setOpacity(1.0)


class Legend:
    """The scale of deviations at the right border, with a hand for what is under the mouse."""

    def __init__(self, swarf, tolerance_mm, allowance_mm):
        self.tolerance_mm, self.allowance_mm = tolerance_mm, allowance_mm
        values = [legend.value_at(1 - (row + 0.5) / LEGEND_ROWS, tolerance_mm) for row in range(LEGEND_ROWS)]
        self._bytes = colours.of_deviations(swarf, values, tolerance_mm)
        self._strip = QtGui.QImage(self._bytes, 1, LEGEND_ROWS, 4, QtGui.QImage.Format_RGBA8888)  # the bytes stay

    def paint(self, view, painter, dark):
        """Below the cube, as high as there is room for."""
        height = min(LEGEND_HEIGHT, view.height() - 2 * CUBE_MARGIN - 40)
        if height < LEGEND_HEIGHT / 3:
            return
        font = QtGui.QFont(view.font())
        font.setPixelSize(11)
        metrics = QtGui.QFontMetricsF(font)
        ticks = [(share, numbers.short(value, True)) for share, value in legend.ticks(self.tolerance_mm)]
        title = "mm"
        if self.allowance_mm > 0:
            title = translate("Swarf", "mm over {0}").format(numbers.short(self.allowance_mm))
        room = max(*(metrics.boundingRect(text).width() for _, text in ticks),
                   metrics.boundingRect(title).width() - LEGEND_WIDTH - 6) + 4
        left, top = view.width() - LEGEND_WIDTH - room - 20, 2 * CUBE_MARGIN + 22
        bar = QtCore.QRectF(left, top, LEGEND_WIDTH, height)
        ink = QtGui.QColor("#f2f4f5") if dark else QtGui.QColor("#1d2329")
        painter.setPen(QtCore.Qt.NoPen)
        painter.setBrush(QtGui.QColor(20, 24, 28, 190) if dark else QtGui.QColor(255, 255, 255, 205))
        painter.drawRoundedRect(bar.adjusted(-8, -20, room + 10, 10), 5, 5)
        painter.setRenderHint(QtGui.QPainter.SmoothPixmapTransform, False)
        painter.drawImage(bar, self._strip)
        painter.setFont(font)
        painter.setPen(ink)
        painter.drawText(QtCore.QRectF(left - 8, top - 19, LEGEND_WIDTH + room + 18, 16), QtCore.Qt.AlignCenter, title)
        for share, text in ticks:
            y = top + (1 - share) * height
            painter.drawLine(QtCore.QLineF(bar.right(), y, bar.right() + 3, y))
            painter.drawText(QtCore.QRectF(bar.right() + 6, y - 8, room + 4, 16), QtCore.Qt.AlignVCenter, text)
        if view.hover is not None:
            self._paint_hand(view, painter, bar, ink, dark)

    def _paint_hand(self, view, painter, bar, ink, dark):
        """The value under the mouse, left of the bar."""
        y = bar.top() + (1 - legend.share_of(view.hover, self.tolerance_mm)) * bar.height()
        text = numbers.deviation(view.hover)
        width = QtGui.QFontMetricsF(painter.font()).boundingRect(text).width() + 12
        plate = QtCore.QRectF(bar.left() - width - 16, y - 9, width, 18)
        painter.setPen(QtCore.Qt.NoPen)
        painter.setBrush(QtGui.QColor(20, 24, 28, 230) if dark else QtGui.QColor(255, 255, 255, 235))
        painter.drawRoundedRect(plate, 4, 4)
        painter.setBrush(ink)
        painter.drawPolygon(QtGui.QPolygonF([QtCore.QPointF(bar.left(), y), QtCore.QPointF(bar.left() - 8, y - 5),
                                             QtCore.QPointF(bar.left() - 8, y + 5)]))
        painter.setPen(ink)
        painter.drawText(plate, QtCore.Qt.AlignCenter, text)


def _paint_mark(view, painter):
    seen = _seen_at(view, view.mark) if view.mark is not None else None
    if seen is None:
        return
    point = seen[0]
    for colour, width in (("#ffffff", 4.0), ("#e5484d", 2.0)):
        painter.setPen(QtGui.QPen(QtGui.QColor(colour), width))
        painter.setBrush(QtCore.Qt.NoBrush)
        painter.drawEllipse(point, 6.0, 6.0)
        painter.drawPoint(point)


def _paint_caption(view, painter, dark):
    """Operation and line in the upper left corner, on a plate so that they can be read over anything."""
    title, text, colour = view.caption
    if not title:
        return
    font = QtGui.QFont(view.font())
    bold = QtGui.QFont(font)
    bold.setBold(True)
    room = view.width() - 2 * CUBE_MARGIN - 60
    metrics, bold_metrics = QtGui.QFontMetricsF(font), QtGui.QFontMetricsF(bold)
    title = bold_metrics.elidedText(title, QtCore.Qt.ElideRight, room)
    text = metrics.elidedText(text, QtCore.Qt.ElideRight, room)
    line = metrics.height()
    width = max(bold_metrics.boundingRect(title).width(), metrics.boundingRect(text).width()) + 30
    plate = QtCore.QRectF(8, 8, width, 2 * line + 12)
    painter.setPen(QtCore.Qt.NoPen)
    painter.setBrush(QtGui.QColor(20, 24, 28, 190) if dark else QtGui.QColor(255, 255, 255, 205))
    painter.drawRoundedRect(plate, 5, 5)
    if colour is not None:
        painter.setBrush(colour)
        painter.drawRoundedRect(QtCore.QRectF(14, 14, 5, 2 * line), 2, 2)
    painter.setPen(QtGui.QColor("#f2f4f5") if dark else QtGui.QColor("#1d2329"))
    painter.setFont(bold)
    painter.drawText(QtCore.QRectF(26, 14, width, line), QtCore.Qt.AlignVCenter, title)
    painter.setFont(font)
    painter.drawText(QtCore.QRectF(26, 14 + line, width, line), QtCore.Qt.AlignVCenter, text)
