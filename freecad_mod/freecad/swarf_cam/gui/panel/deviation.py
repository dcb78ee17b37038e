# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the result deviates from the model as a whole: a histogram in the colours of the picture, and numbers."""

import math

import FreeCAD

from ...core import histogram, legend
from .. import colours, numbers, settings
from ..qt import QtCore, QtGui, QtWidgets, place_of

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

# Pixels around the bars, and for the scale below them.
MARGIN, SCALE = 10, 22

ROWS = (("verdict", QT_TRANSLATE_NOOP("Swarf", "Result")),
        ("good", QT_TRANSLATE_NOOP("Swarf", "Within the tolerance")),
        ("excess", QT_TRANSLATE_NOOP("Swarf", "Too much left")),
        ("gouge", QT_TRANSLATE_NOOP("Swarf", "Cut too deep")),
        ("unreached", QT_TRANSLATE_NOOP("Swarf", "Not reached")),
        ("range", QT_TRANSLATE_NOOP("Swarf", "Least and greatest")),
        ("middle", QT_TRANSLATE_NOOP("Swarf", "98 % lie within")),
        ("mean", QT_TRANSLATE_NOOP("Swarf", "Mean, root mean square")))


class Bars(QtWidgets.QWidget):
    """A core Histogram, painted; the mouse tells what a bar stands for."""

    def __init__(self, swarf, parent=None):
        super().__init__(parent)
        self.setObjectName("SwarfHistogram")
        self.setMinimumSize(180, 90)
        self.setMouseTracking(True)
        self.setAccessibleName(translate("Swarf", "Area of the surface by its deviation"))
        self._swarf, self._shown, self._tints = swarf, None, ()

    def show_histogram(self, shown):
        """A Histogram, None for none."""
        self._shown = shown
        if shown is not None:
            rgba = colours.of_deviations(self._swarf, [shown.middle(i) for i in range(len(shown.areas))],
                                         shown.tolerance_mm)
            self._tints = [QtGui.QColor(*rgba[4 * i:4 * i + 3]) for i in range(len(shown.areas))]
        self.update()

    def _frame(self):
        return QtCore.QRectF(self.rect()).adjusted(MARGIN, MARGIN, -MARGIN, -SCALE)

    def bar(self, index):
        """Where a bar is painted."""
        frame, count = self._frame(), len(self._shown.areas)
        height = self._shown.heights()[index] * frame.height()
        return QtCore.QRectF(frame.left() + index * frame.width() / count, frame.bottom() - height,
                             frame.width() / count, height)

    def paintEvent(self, _):
        """Bars, the bounds of the tolerance, the scale."""
        painter = QtGui.QPainter(self)
        frame, palette = self._frame(), self.palette()
        ink = palette.color(QtGui.QPalette.WindowText)
        if self._shown is None:
            painter.setPen(palette.color(QtGui.QPalette.Disabled, QtGui.QPalette.WindowText))
            painter.drawText(self.rect(), QtCore.Qt.AlignCenter | QtCore.Qt.TextWordWrap,
                             translate("Swarf", "The result has not been held against a model yet."))
            painter.end()
            return
        for index, area in enumerate(self._shown.areas):
            if area > 0:
                bar = self.bar(index)
                painter.fillRect(bar.adjusted(0, min(bar.height() - 1.0, 0.0), -0.5, 0), self._tints[index])
        painter.setPen(ink)
        painter.drawLine(frame.bottomLeft(), frame.bottomRight())
        font = QtGui.QFont(self.font())
        font.setPixelSize(11)
        painter.setFont(font)
        metrics, free = QtGui.QFontMetricsF(font), frame.right() + MARGIN
        ticks = [(share, numbers.short(value, True)) for share, value in legend.ticks(self._shown.tolerance_mm)]
        for share, text in [*ticks, (0.5, "0")]:
            x = frame.left() + share * frame.width()
            painter.drawLine(QtCore.QLineF(x, frame.bottom(), x, frame.bottom() + 3))
            if abs(abs(share - 0.5) - 0.5 / legend.TOLERANCES) < 1e-9:
                painter.setPen(QtGui.QPen(ink, 1.0, QtCore.Qt.DashLine))
                painter.drawLine(QtCore.QLineF(x, frame.top(), x, frame.bottom()))
                painter.setPen(ink)
            width = metrics.boundingRect(text).width() + 2
            left = min(max(x - width / 2, 1.0), self.width() - width - 1.0)
            if left + width <= free or text == "0":
                painter.drawText(QtCore.QRectF(left, frame.bottom() + 4, width, SCALE - 5), QtCore.Qt.AlignCenter, text)
                free = left - 3
        painter.end()

    def mouseMoveEvent(self, event):
        """Tell what the bar under the mouse stands for."""
        if self._shown is None:
            return
        frame, count = self._frame(), len(self._shown.areas)
        index = int((place_of(event)[0] - frame.left()) / frame.width() * count)
        if not 0 <= index < count:
            self.setToolTip("")
            return
        lower, upper = self._shown.bounds(index)
        text = "%s … %s mm" % (numbers.deviation(lower) if math.isfinite(lower) else "",
                               numbers.deviation(upper) if math.isfinite(upper) else "")
        self.setToolTip("%s: %s" % (text, area_text(self._shown.areas[index])))


def area_text(area):
    """An area for people."""
    return numbers.text(area / 100, 1) + " cm²" if area >= 1000 else numbers.text(area, 1) + " mm²"


def volume_text(volume, allowance_mm):
    """A volume behind an area. Volumes are measured from the model: over an allowance there are none to tell."""
    return "" if allowance_mm > 0 else ", %s mm³" % numbers.text(volume, 1)


class DeviationPage(QtWidgets.QWidget):
    """Histogram and numbers of a checks.Outcome, and the allowance that they are over. Tells by allowed another one,
    which is kept in the settings."""

    allowed = QtCore.Signal()

    def __init__(self, swarf, parent=None):
        super().__init__(parent)
        self.setObjectName("SwarfDeviation")
        row = QtWidgets.QHBoxLayout(self)
        row.setContentsMargins(0, 0, 8, 0)
        self.bars = Bars(swarf)
        row.addWidget(self.bars, 1)
        form = QtWidgets.QFormLayout()
        form.setContentsMargins(4, 8, 0, 4)
        form.setVerticalSpacing(2)
        self._values = {}
        for name, text in ROWS:
            value = QtWidgets.QLabel("–")
            value.setObjectName("SwarfDeviation-" + name)
            value.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
            form.addRow(translate("Swarf", text), value)
            self._values[name] = value
        self.allowance = QtWidgets.QDoubleSpinBox()
        self.allowance.setObjectName("SwarfAllowance")
        self.allowance.setToolTip(
            translate("Swarf", "What is meant to be left on the model: it counts as no deviation"))
        self.allowance.setDecimals(3)
        self.allowance.setRange(0.0, settings.ALLOWANCE_MAX_MM)
        self.allowance.setSingleStep(0.05)
        self.allowance.setSuffix(" mm")
        self.allowance.setKeyboardTracking(False)
        self.show_allowance()
        self.allowance.valueChanged.connect(self._allow)
        form.addRow(translate("Swarf", "Allowance"), self.allowance)
        row.addLayout(form)

    def show_allowance(self):
        """As the settings have it."""
        self.allowance.blockSignals(True)
        self.allowance.setValue(settings.allowance())
        self.allowance.blockSignals(False)

    def _allow(self, value):
        settings.set_allowance(value)
        self.allowed.emit()

    def show_outcome(self, outcome):
        """What the checks came to, None: nothing yet."""
        deviation = outcome.deviation if outcome is not None else None
        if deviation is None:
            self.bars.show_histogram(None)
            for value in self._values.values():
                value.setText("–")
            return
        made = outcome.verification
        self.bars.show_histogram(histogram.of(deviation, max(made.tolerance)))
        low, high = deviation.percentiles[0], deviation.percentiles[-1]
        good = deviation.area - deviation.excess_area - deviation.gouge_area - deviation.not_reached_area
        volumes = deviation.comparison
        for name, text in (
                ("verdict", translate("Swarf", "passed") if made.passed else translate("Swarf", "FAILED")),
                ("good", "%s (%s %%)" % (
                    area_text(good), numbers.text(100 * good / deviation.area if deviation.area else 0.0, 2))),
                ("excess", area_text(deviation.excess_area) + volume_text(volumes.excess_mm3, made.allowance)),
                ("gouge", area_text(deviation.gouge_area) + volume_text(volumes.gouge_mm3, made.allowance)),
                ("unreached", area_text(deviation.not_reached_area)),
                ("range", "%s … %s mm" % (numbers.deviation(deviation.least), numbers.deviation(deviation.most))),
                ("middle", "%s … %s mm" % (numbers.deviation(low), numbers.deviation(high))),
                ("mean", "%s mm, %s mm" % (numbers.deviation(deviation.mean), numbers.text(deviation.rms, 3)))):
            self._values[name].setText(text)
