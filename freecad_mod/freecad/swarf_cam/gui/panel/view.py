# SPDX-License-Identifier: LGPL-2.1-or-later
"""The picture and what the mouse and the keys do in it. It draws nothing of the part itself: it shows the newest frame,
asks for others by camera_changed, and paints the cube and the marks over it."""

import math

import FreeCAD

from ...core import navigation, viewcube
from .. import settings
from ..qt import QtCore, QtGui, QtWidgets, place_of
from . import overlay

translate = FreeCAD.Qt.translate

# More pixels than this are drawn smaller and scaled up: what a screen of 4K shows, at most.
PIXELS_MAX = 8_300_000

# Part of the stock's diagonal that the picture shows after flying to a place.
NEAR_SHARE = 0.3

# Pixels the mouse may move between press and release of a click.
CLICK_SLACK = 4

# Seconds a turn to one of the cube's places takes, and between two pictures of it.
TURN_SECONDS, TURN_TICK = 0.25, 0.016

VIEW_KEYS = {"0": "isometric", "1": "front", "2": "top", "3": "right", "4": "rear", "5": "bottom", "6": "left"}


# What the panel takes while the picture has the focus.
_KEY = QtCore.Qt
KEYS = frozenset((_KEY.Key_Left, _KEY.Key_Right, _KEY.Key_Up, _KEY.Key_Down, _KEY.Key_Home, _KEY.Key_End,
                  _KEY.Key_Space))
TEXTS = frozenset("0123456fFvVpP+-")


class PictureView(QtWidgets.QWidget):
    """Shows frames; clicked tells a place (x to the right, y upwards, -1 .. 1) and whether it was a double click."""

    camera_changed = QtCore.Signal()
    clicked = QtCore.Signal(float, float)

    def __init__(self, swarf, parent=None):
        super().__init__(parent)
        self.setObjectName("SwarfPicture")
        self.setMinimumSize(240, 180)
        self.setFocusPolicy(QtCore.Qt.StrongFocus)
        self.setMouseTracking(True)
        self.setAttribute(QtCore.Qt.WA_OpaquePaintEvent)
        self.setAccessibleName(translate("Swarf", "Picture of the stock"))
        self._swarf = swarf
        self.box = None
        self.camera = None
        self.frame = None
        self.mark = None  # point that was clicked, or where a finding is
        self.caption = ("", "", None)
        self.pins = []  # (point, text, colour) of places; shown with the legend
        self.legend = None  # core Legend of the deviations that are shown
        self.hover = None  # mm, deviation under the mouse
        self._image = None
        self._pressed = self._last = None
        self._dragging = False
        self._pivot = None
        self._turn = None
        self._timer = QtCore.QTimer(self)
        self._timer.setInterval(int(1000 * TURN_TICK))
        self._timer.timeout.connect(self._turn_on)

    def open(self, box):
        """Look at a new job's box."""
        self.box, self.frame, self._image, self.mark = box, None, None, None
        self.camera = self._seen_from("isometric", settings.flag("Perspective"))
        self.camera_changed.emit()
        self.update()

    def close_job(self):
        """Keep the last picture, steer no more."""
        self.camera = self.mark = None
        self.caption, self.pins = ("", "", None), []
        self._stop_turning()
        self.update()

    def set_mark(self, point):
        """Mark a point, None: none."""
        self.mark = point
        self.update()

    def aspect(self):
        """Width / height."""
        return max(self.width(), 1) / max(self.height(), 1)

    def pixels(self):
        """(width, height) of the picture wanted, in the screen's own pixels."""
        ratio = self.devicePixelRatioF()
        width, height = max(self.width() * ratio, 16), max(self.height() * ratio, 16)
        shrink = max(math.sqrt(width * height / PIXELS_MAX), 1.0)
        return int(width / shrink), int(height / shrink)

    def set_frame(self, frame):
        """Show a picture."""
        self.frame = frame
        self._image = QtGui.QImage(frame.rgba, frame.width, frame.height, 4 * frame.width,
                                   QtGui.QImage.Format_RGBA8888)  # frame keeps the bytes alive
        self.update()

    def set_legend(self, tolerance_mm, allowance_mm):
        """Of a picture in the colours of the deviation, over an allowance; tolerance 0: it has others."""
        wanted = (tolerance_mm, allowance_mm) if tolerance_mm > 0 else None
        if wanted != (None if self.legend is None else (self.legend.tolerance_mm, self.legend.allowance_mm)):
            self.legend = None if wanted is None else overlay.Legend(self._swarf, *wanted)
            self.update()

    def _set_hover(self, value):
        if value != self.hover:
            self.hover = value
            self.update()

    def value_under(self, x, y):
        """Deviation (mm) of what is seen at a pixel, None where there is none."""
        if self.frame is None or self.frame.values is None:
            return None
        value = self.frame.values[self._pixel(x, y)]
        return value if math.isfinite(value) else None

    def image(self):
        """What is shown, without the marks: a QImage of its own, or None."""
        return self._image.copy() if self._image is not None else None

    # Places

    def _place(self, x, y):
        return 2 * x / max(self.width(), 1) - 1, 1 - 2 * y / max(self.height(), 1)

    def _pixel(self, x, y):
        """(row, column) of the frame."""
        px, py = self._place(x, y)
        column = min(max(int((px + 1) / 2 * self.frame.width), 0), self.frame.width - 1)
        return min(max(int((1 - py) / 2 * self.frame.height), 0), self.frame.height - 1), column

    def point_under(self, x, y):
        """The point seen at a pixel; as deep as the middle of the part where nothing is."""
        px, py = self._place(x, y)
        depth = self.depth_under(x, y)
        hit = math.isfinite(depth)
        camera = self.frame.camera if hit else self.camera  # what is seen may be of before the last turn
        return navigation.point_at(camera, px, py, self.aspect(), depth), hit

    def depth_under(self, x, y):
        """mm along the view to what is seen at a pixel, inf for nothing."""
        return math.inf if self.frame is None or self.frame.depth is None else self.frame.depth[self._pixel(x, y)]

    # Steering

    def _changed(self):
        self.camera_changed.emit()
        self.update()

    @property
    def turning(self):
        """Whether the view is on its way to another."""
        return self._turn is not None

    def _heading(self):
        """A copy of the camera as it is, or will be when the view has turned."""
        return (self.camera if self._turn is None else self._turn[1]).copy()

    def _seen_from(self, name, perspective):
        """A camera that shows the whole stock from one of the seven views."""
        camera = self._swarf.Camera.view(name, self.box, self.aspect(), perspective=perspective)
        navigation.fit(camera, self.box, self.aspect())
        return camera

    def fit(self):
        """The whole stock, from where one looks."""
        if self.camera is not None:
            target = self._heading()
            navigation.fit(target, self.box, self.aspect())
            self._turn_to(target)

    def look(self, name):
        """From one of the seven views."""
        if self.camera is not None:
            self._turn_to(self._seen_from(name, self.camera.perspective))

    def fly_to(self, point):
        """Bring a point near, to the middle."""
        if self.camera is not None:
            target = self._heading()
            navigation.approach(target, point, self.aspect(), NEAR_SHARE * math.dist(*self.box))
            self._turn_to(target)

    def set_perspective(self, on):
        """Perspective or parallel rays."""
        if self.camera is not None and self.camera.perspective != bool(on):
            for camera in (self.camera, *(self._turn[:2] if self.turning else ())):
                camera.set_perspective(bool(on))
            self._changed()

    def _turn_to(self, camera):
        self._turn = (self.camera.copy(), camera, QtCore.QElapsedTimer())
        self._turn[2].start()
        self._timer.start()

    def _turn_on(self):
        if self._turn is None or self.camera is None:
            self._timer.stop()
            return
        begin, end, clock = self._turn
        share = min(clock.elapsed() / (1000 * TURN_SECONDS), 1.0)
        self.camera = end.copy() if share >= 1 else viewcube.between(self._swarf.Camera, begin, end, share)
        if share >= 1:
            self._turn = None
            self._timer.stop()
        self._changed()

    def _stop_turning(self):
        self._turn = None
        self._timer.stop()

    # Qt's events

    def resizeEvent(self, event):
        """Another size wants another picture; the whole stock stays in it where it was."""
        super().resizeEvent(event)
        if self.camera is None:
            return
        target, before = self._heading(), event.oldSize()
        if navigation.shows_whole(target, self.box, max(before.width(), 1) / max(before.height(), 1)):
            navigation.fit(target, self.box, self.aspect())
            self._stop_turning()
            self.camera = target
        self._changed()

    @staticmethod
    def _held(event):
        qt, buttons, keys = QtCore.Qt, event.buttons(), event.modifiers()
        return ({name for name, button in (("left", qt.LeftButton), ("middle", qt.MiddleButton),
                                           ("right", qt.RightButton)) if buttons & button},
                {name for name, key in (("shift", qt.ShiftModifier), ("ctrl", qt.ControlModifier),
                                        ("alt", qt.AltModifier)) if keys & key})

    def mousePressEvent(self, event):
        """Begin a click or a drag; the point under the mouse is what it turns about."""
        x, y = place_of(event)
        self._last = x, y
        if self.camera is None:
            return
        self._stop_turning()
        if event.button() == QtCore.Qt.LeftButton and overlay.cube_place(self, x, y) is not None:
            self._pressed = "cube"
            return
        self._pressed, self._dragging = (x, y), False
        point, hit = self.point_under(x, y)
        self._pivot = point if hit else self.camera.target

    def mouseMoveEvent(self, event):
        """Steer as the navigation style says."""
        x, y = place_of(event)
        buttons, keys = self._held(event)
        self._set_hover(None if buttons else self.value_under(x, y))
        if self.camera is None or not buttons or self._pressed in (None, "cube"):
            self.setCursor(QtCore.Qt.PointingHandCursor if self.camera is not None and
                           overlay.cube_place(self, x, y) is not None else QtCore.Qt.ArrowCursor)
            return
        if not self._dragging and max(abs(x - self._pressed[0]), abs(y - self._pressed[1])) <= CLICK_SLACK:
            return
        self._dragging = True
        style, turntable, _, _ = settings.navigation()
        what = navigation.action(style, buttons, keys)
        dx, dy = 2 * (x - self._last[0]) / self.width(), -2 * (y - self._last[1]) / self.height()
        self._last = x, y
        if what is not None:
            self.setCursor(QtCore.Qt.ClosedHandCursor if what == navigation.PAN else QtCore.Qt.SizeAllCursor)
            navigation.drag(self.camera, what, dx, dy, self.aspect(), self._pivot, turntable)
            self._changed()

    def leaveEvent(self, event):
        """Nothing is under the mouse any more."""
        super().leaveEvent(event)
        self._set_hover(None)

    def mouseReleaseEvent(self, event):
        """The end of a drag, or a click."""
        x, y = place_of(event)
        pressed, self._pressed = self._pressed, None
        self.setCursor(QtCore.Qt.ArrowCursor)
        if self.camera is None or event.button() != QtCore.Qt.LeftButton:
            return
        if pressed == "cube":
            towards = overlay.cube_place(self, x, y)
            if towards:
                self._turn_to(viewcube.look_from(self._swarf.Camera, self.camera, towards))
        elif pressed is not None and not self._dragging:
            self.clicked.emit(*self._place(x, y))

    def mouseDoubleClickEvent(self, event):
        """Bring the point under the mouse to the middle."""
        if self.camera is None or event.button() != QtCore.Qt.LeftButton:
            return
        x, y = place_of(event)
        point, hit = self.point_under(x, y)
        if hit:
            target = self._heading()
            navigation.centre(target, point, self.aspect())
            self._turn_to(target)

    def wheelEvent(self, event):
        """Zoom to the cursor."""
        if self.camera is None:
            return
        self._stop_turning()
        _, _, inverted, at_cursor = settings.navigation()
        notches = event.angleDelta().y() / 120.0 * (1 if inverted else -1)
        x, y = place_of(event)
        self.camera.zoom(navigation.WHEEL_FACTOR ** notches, self.point_under(x, y)[0] if at_cursor else None)
        self._changed()
        event.accept()

    def event(self, event):
        """FreeCAD has shortcuts on many keys; while the picture has the focus these are the panel's."""
        if event.type() == QtCore.QEvent.ShortcutOverride and self.camera is not None and \
                (event.key() in KEYS or event.text() in TEXTS):
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event):
        """Views by number as in FreeCAD, F fits, P perspective, +/- zoom, shift with the arrows turns."""
        text, qt = event.text(), QtCore.Qt
        arrows = {qt.Key_Left: (-1, 0), qt.Key_Right: (1, 0), qt.Key_Up: (0, 1), qt.Key_Down: (0, -1)}
        if self.camera is None:
            event.ignore()
        elif text in VIEW_KEYS:
            self.look(VIEW_KEYS[text])
        elif text in "fFvV" and text:
            self.fit()
        elif text and text in "+-":
            self._stop_turning()
            self.camera.zoom(navigation.WHEEL_FACTOR ** (1 if text == "+" else -1))
            self._changed()
        elif event.key() in arrows and event.modifiers() & qt.ShiftModifier:
            right, up = arrows[event.key()]
            self._stop_turning()
            self.camera.orbit(self.camera.target, right * navigation.KEY_DEGREES, up * navigation.KEY_DEGREES)
            self._changed()
        else:
            event.ignore()

    def paintEvent(self, _):
        """The frame, then what lies over it."""
        painter = QtGui.QPainter(self)
        if self._image is not None:
            painter.setRenderHint(QtGui.QPainter.SmoothPixmapTransform, True)
            painter.drawImage(QtCore.QRectF(self.rect()), self._image)
        else:
            painter.fillRect(self.rect(), self.palette().color(QtGui.QPalette.Window))
        overlay.paint(self, painter)
        painter.end()
