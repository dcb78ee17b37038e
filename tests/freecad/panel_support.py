# SPDX-License-Identifier: LGPL-2.1-or-later
"""What tests of the live panel share: a job to watch, mouse and keys as if from the user, waiting for pictures."""

import sys
from dataclasses import replace

import FreeCAD
import FreeCADGui as Gui
from gui_support import QtCore, QtWidgets, live, pump, wait_for
from PySide import QtGui


def circle(x, y, radius, feed):
    """A full circle about a point, two halves; the tool stands at its left end."""
    return ["G2 X%g Y%g I%g J0 F%g" % (x + radius, y, radius, feed), "G2 X%g Y%g I%g J0" % (x - radius, y, -radius)]


def make_job(document):
    """A plate: faced, a round pocket, a slot along a wave and four holes, with three tools; its model differs."""
    import Part
    import samples

    flat = samples.add_controller(document, 1, samples.end_mill(10), "Mill10", CuttingEdgeHeight=20.0)
    small = samples.add_controller(document, 2, samples.end_mill(4), "Mill4", CuttingEdgeHeight=20.0)
    drill = samples.add_controller(document, 3, samples.end_mill(5), "Drill5", CuttingEdgeHeight=25.0)
    face = ["G0 Z5", "G0 X-8 Y0", "G1 Z-1 F10"]
    for row in range(8):
        face += ["G1 Y%g" % (7.5 * row), "G1 X%g F20" % (88 if row % 2 == 0 else -8)]
    pocket = ["G0 Z5", "G0 X25 Y25"]
    for depth in (-3.0, -5.0):
        pocket += ["G1 X25 Y25 Z%g F5" % depth]
        for radius in (4.0, 8.0, 11.0):
            pocket += ["G1 X%g Y25 F15" % (25 - radius), *circle(25, 25, radius, 15)]
    wave = ["G0 Z5", "G0 X44 Y10", "G1 Z-3 F5", "G3 X54 Y20 I0 J10 F10", "G1 Y30", "G2 X64 Y40 I10 J0", "G1 X74",
            "G0 Z5"]
    holes = ["G0 Z5"] + ["G81 X%g Y%g Z-16 R2 F4" % place for place in ((6, 6), (74, 6), (74, 44), (6, 44))]
    operations = [samples.add_operation(document, name, tool, *lines) for name, tool, lines in (
        ("Facing", flat, [*face, "G0 Z5"]), ("RoundPocket", flat, [*pocket, "G0 Z5"]), ("Wave", small, wave),
        ("Holes", drill, [*holes, "G80", "G0 Z20"]))]
    job = samples.make_job(document, operations, [flat, small, drill],
                           Part.makeBox(80, 50, 15, FreeCAD.Vector(0, 0, -15)))
    # The model knows nothing of the wave, wants the pocket 0.2 mm deeper, and a hole that no operation makes.
    design = Part.makeBox(80, 50, 14, FreeCAD.Vector(0, 0, -15))
    for x, y, radius, bottom in ((25, 25, 16, -5.2), (6, 6, 2.5, -16), (74, 6, 2.5, -16), (74, 44, 2.5, -16),
                                 (6, 44, 2.5, -16), (42, 40, 4, -16)):
        design = design.cut(Part.makeCylinder(radius, 20, FreeCAD.Vector(x, y, bottom)))
    job.Model.Group[0].Shape = design
    return job


def mouse(widget, kind, x, y, button=None, held=None):
    """A mouse event as if from the user."""
    qt = QtCore.Qt
    kinds = {"press": QtCore.QEvent.MouseButtonPress, "move": QtCore.QEvent.MouseMove,
             "release": QtCore.QEvent.MouseButtonRelease, "double": QtCore.QEvent.MouseButtonDblClick}
    button = qt.NoButton if button is None else button
    held = (qt.NoButton if kind == "release" else button) if held is None else held
    local = QtCore.QPointF(x, y)
    event = QtGui.QMouseEvent(kinds[kind], local, QtCore.QPointF(widget.mapToGlobal(local.toPoint())), button, held,
                              qt.NoModifier)
    QtWidgets.QApplication.sendEvent(widget, event)


def click(widget, x, y):
    """Left press and release."""
    mouse(widget, "press", x, y, QtCore.Qt.LeftButton)
    mouse(widget, "release", x, y, QtCore.Qt.LeftButton)


def drag(widget, button, begin, end, steps=8):
    """Press, move, release."""
    mouse(widget, "press", *begin, button)
    for step in range(1, steps + 1):
        x, y = (a + (b - a) * step / steps for a, b in zip(begin, end))
        mouse(widget, "move", x, y, QtCore.Qt.NoButton, button)
        pump(0.02)
    mouse(widget, "release", *end, button)


def key(widget, code, text="", modifiers=None):
    """A key, pressed and released."""
    modifiers = QtCore.Qt.NoModifier if modifiers is None else modifiers
    for kind in (QtCore.QEvent.KeyPress, QtCore.QEvent.KeyRelease):
        QtWidgets.QApplication.sendEvent(widget, QtGui.QKeyEvent(kind, code, modifiers, text))


def wheel(widget, x, y, notches):
    """The wheel, turned at a place."""
    local = QtCore.QPointF(x, y)
    event = QtGui.QWheelEvent(local, QtCore.QPointF(widget.mapToGlobal(local.toPoint())), QtCore.QPoint(0, 0),
                              QtCore.QPoint(0, 120 * notches), QtCore.Qt.NoButton, QtCore.Qt.NoModifier,
                              QtCore.Qt.NoScrollPhase, False)
    QtWidgets.QApplication.sendEvent(widget, event)


def differing(a, b):
    """Part of the pixels in which two images differ."""
    assert a.size() == b.size(), (a.size(), b.size())
    places = [(x, y) for y in range(0, a.height(), 3) for x in range(0, a.width(), 3)]
    return sum(a.pixel(x, y) != b.pixel(x, y) for x, y in places) / len(places)


class PanelTest:
    """The panel, opened by the user's command; each step leaves it usable for the next."""

    def __init__(self, auto_play=False):
        from freecad.swarf_cam.gui import settings

        settings.set_flag("AutoPlay", auto_play)
        self.settings = settings
        self.panel = None

    def run(self, *steps):
        """(method, arguments ...) each."""
        for step, *arguments in steps:
            print("CHECK", step.__name__)
            sys.stdout.flush()
            step(*arguments)

    def button(self, name):
        """Press a button of the transport."""
        found = self.panel.findChild(QtWidgets.QToolButton, "Swarf-" + name)
        assert found is not None and found.isEnabled(), name
        found.click()

    def play(self, place):
        """Play as fast as it goes; it begins, stops by itself at a place, and the picture of that comes."""
        assert self.panel.transport.wanted != place, "it is there already"
        self.panel.player.set_speed(0.0)
        self.button("play")
        assert self.panel.transport.playing, "the button does not play"
        wait_for(lambda: not self.panel.transport.playing, "the end of playing")
        self.settle(place)

    def settle(self, place=None):
        """Wait for the sharp picture of what is wanted, once the view turns no more; at a place."""
        live()  # what was changed may have changed the size of the picture as well

        def there():
            frame = self.panel.view.frame
            camera = self.panel.view.camera
            return (not self.panel.view.turning and frame is not None and frame.sharp
                    and (frame.width, frame.height) == self.panel.view.pixels()
                    and frame.place == self.panel.transport.wanted
                    and replace(frame.view, camera=None) == replace(self.panel.current_view(), camera=None)
                    and (frame.camera.eye, frame.camera.target, frame.camera.height) ==
                    (camera.eye, camera.target, camera.height) and (place is None or frame.place == place))
        wait_for(there, "a sharp picture at %s" % place)

    def image(self):
        """The sharp picture."""
        self.settle()
        return self.panel.view.image()

    def turn(self, text):
        """Press the key of a view, and wait until it is there."""
        key(self.panel.view, getattr(QtCore.Qt, "Key_" + text.upper()), text)
        wait_for(lambda: not self.panel.view.turning, "the turn to key " + text)

    @staticmethod
    def click_row(widget, place_of):
        """Click on a row of a list that is shown; place_of() is its rectangle."""
        wait_for(lambda: widget.isVisible() and widget.viewport().rect().contains(place_of().center()),
                 "a row in sight")
        click(widget.viewport(), place_of().center().x(), place_of().center().y())

    def opened(self):
        """Wait for a session other than the one that is open."""
        old = self.panel.session
        wait_for(lambda: self.panel.session not in (old, None), "opening again")

    def compared(self):
        """Wait until the panel knows whether the job differs from what was read."""
        wait_for(lambda: not self.panel.opening.comparing, "comparing the job")

    def checked(self):
        """Wait for the end of the checks that are to come."""
        wait_for(lambda: not self.panel.checking.pending, "the checks")

    def open(self, document, job):
        """By the command, with the job selected; until it is checked."""
        Gui.Selection.addSelection(document.Name, job.Name)
        Gui.runCommand("Swarf_Live", 0)
        self.panel = Gui.getMainWindow().findChild(QtWidgets.QDockWidget, "SwarfLive")
        assert self.panel is not None, "the command opened no panel"
        wait_for(lambda: self.panel.session is not None, "opening")
        self.checked()
        self.settle()


def new_job(name):
    """(document, job) of make_job(), with undo, seen from the corner."""
    document = FreeCAD.newDocument(name)
    document.UndoMode = 1
    job = make_job(document)
    document.recompute()
    Gui.activateWorkbench("SwarfWorkbench")
    Gui.ActiveDocument.ActiveView.viewIsometric()
    Gui.SendMsgToActiveView("ViewFit")
    Gui.Selection.clearSelection()
    return document, job
