# SPDX-License-Identifier: LGPL-2.1-or-later
"""The row of buttons under the time line: play, steps, speed, stops, clock."""

import FreeCAD

from ...core import clock as clocks
from ...core import transport as model
from .. import icons, settings
from ..qt import QAction, QtCore, QtWidgets

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

# Name of icon and step, what it says.
STEPS_BACK = (
    ("operation-back", QT_TRANSLATE_NOOP("Swarf", "To the start of the operation (Ctrl+Left)")),
    ("line-back", QT_TRANSLATE_NOOP("Swarf", "One line back (Left)")),
    ("move-back", QT_TRANSLATE_NOOP("Swarf", "One move back (Alt+Left)")),
)
STEPS_FORWARD = (
    ("move-forward", QT_TRANSLATE_NOOP("Swarf", "One move forward (Alt+Right)")),
    ("line-forward", QT_TRANSLATE_NOOP("Swarf", "One line forward (Right)")),
    ("operation-forward", QT_TRANSLATE_NOOP("Swarf", "To the next operation (Ctrl+Right)")),
)
STOPS = (
    (model.STOP_OPERATION, QT_TRANSLATE_NOOP("Swarf", "Stop at every operation")),
    (model.STOP_TOOL_CHANGE, QT_TRANSLATE_NOOP("Swarf", "Stop at tool changes")),
    (model.STOP_FINDING, QT_TRANSLATE_NOOP("Swarf", "Stop at findings")),
)


class TransportBar(QtWidgets.QWidget):
    """Buttons that tell what was pressed; shows what it is told."""

    play_pressed = QtCore.Signal()
    stepped = QtCore.Signal(str)
    speed_chosen = QtCore.Signal(float)
    stops_chosen = QtCore.Signal(object)

    def __init__(self, parent=None):
        super().__init__(parent)
        row = QtWidgets.QHBoxLayout(self)
        row.setContentsMargins(8, 0, 8, 4)
        row.setSpacing(2)
        self._named = {}
        for name, text in STEPS_BACK:
            row.addWidget(self._button(name, text))
        self.play = self._button("play", QT_TRANSLATE_NOOP("Swarf", "Play or pause (Space)"), size=26)
        row.addWidget(self.play)
        for name, text in STEPS_FORWARD:
            row.addWidget(self._button(name, text))
        row.addSpacing(8)
        self.clock = QtWidgets.QLabel("0:00")
        self.clock.setObjectName("SwarfClock")
        self.clock.setToolTip(translate("Swarf", "Time at the programmed feeds, of the whole program's"))
        self.clock.setMinimumWidth(96)
        row.addWidget(self.clock)
        row.addStretch(1)
        self.speed = QtWidgets.QComboBox()
        self.speed.setObjectName("SwarfSpeed")
        self.speed.setToolTip(translate("Swarf", "How fast (Up, Down)"))
        for speed in model.SPEEDS:
            self.speed.addItem(self._speed_text(speed), speed)
        self.speed.activated.connect(lambda index: self.speed_chosen.emit(self.speed.itemData(index)))
        row.addWidget(self.speed)
        self.stops = self._button("stop", QT_TRANSLATE_NOOP("Swarf", "Where to stop by itself"))
        self.stops.setPopupMode(QtWidgets.QToolButton.InstantPopup)
        menu = QtWidgets.QMenu(self.stops)
        self._stops = {}
        for kind, text in STOPS:
            action = QAction(translate("Swarf", text), menu)
            action.setCheckable(True)
            action.toggled.connect(lambda _: self.stops_chosen.emit(self.chosen_stops()))
            menu.addAction(action)
            self._stops[kind] = action
        self.stops.setMenu(menu)
        row.addWidget(self.stops)
        self._playing = False
        self.take_theme()
        self.set_speed(settings.speed())

    @staticmethod
    def _speed_text(speed):
        if speed == model.AS_FAST_AS_POSSIBLE:
            return translate("Swarf", "max")
        return translate("Swarf", "real time") if speed == 1.0 else "× %g" % speed

    def _button(self, name, text, size=20):
        button = QtWidgets.QToolButton()
        button.setObjectName("Swarf-" + name)
        button.setAutoRaise(True)
        button.setIconSize(QtCore.QSize(size, size))
        button.setToolTip(translate("Swarf", text))
        button.setAccessibleName(translate("Swarf", text))
        button.setFocusPolicy(QtCore.Qt.TabFocus)
        if name == "play":
            button.clicked.connect(lambda *_: self.play_pressed.emit())
        elif name != "stop":
            button.clicked.connect(lambda *_: self.stepped.emit(name))
        self._named[name] = button
        return button

    def take_theme(self):
        """Icons in the theme's colours."""
        for name, button in self._named.items():
            if button is not self.play:
                button.setIcon(icons.icon(name, self.palette()))
        self.set_playing(self._playing)

    def changeEvent(self, event):
        """The theme may have changed."""
        super().changeEvent(event)
        if event.type() in (QtCore.QEvent.PaletteChange, QtCore.QEvent.StyleChange) and hasattr(self, "_playing"):
            self.take_theme()

    def set_playing(self, playing):
        """Play or pause on the button."""
        self._playing = playing
        self.play.setIcon(icons.icon("pause" if playing else "play", self.palette()))

    def set_speed(self, speed):
        """Show a speed."""
        index = self.speed.findData(speed)
        self.speed.setCurrentIndex(index if index >= 0 else 0)

    def chosen_stops(self):
        """Kinds of places to stop at."""
        return {kind for kind, item in self._stops.items() if item.isChecked()}

    def set_clock(self, seconds, total):
        """Show the time."""
        self.clock.setText("%s / %s" % (clocks.text_of(seconds), clocks.text_of(total)))
