# SPDX-License-Identifier: LGPL-2.1-or-later
"""The live panel in the real GUI (see run): driven by buttons, slider, keys and mouse, judged by what it shows."""

import os
import sys
import tempfile

import FreeCAD
import FreeCADGui as Gui

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "inside")]

from gui_support import OUT, QtCore, QtWidgets, pump, screenshot, start, wait_for  # noqa: E402
from PySide import QtGui  # noqa: E402


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
    assert (a.width(), a.height()) == (b.width(), b.height())
    places = [(x, y) for y in range(0, a.height(), 3) for x in range(0, a.width(), 3)]
    return sum(a.pixel(x, y) != b.pixel(x, y) for x, y in places) / len(places)


class Check:
    """The checks in the order of a user; each leaves the panel usable for the next."""

    def __init__(self):
        from freecad.swarf_cam.gui import settings
        from freecad.swarf_cam.gui.panel import dock

        settings.set_flag("AutoPlay", False)
        self.settings, self.dock = settings, dock
        self.panel = None

    def button(self, name):
        """Press a button of the transport."""
        found = self.panel.findChild(QtWidgets.QToolButton, "Swarf-" + name)
        assert found is not None and found.isEnabled(), name
        found.click()

    def settle(self, place=None):
        """Wait for the sharp picture, at a place."""
        def there():
            frame = self.panel.view.frame
            camera = self.panel.view.camera
            return (frame is not None and frame.sharp and (frame.width, frame.height) == self.panel.view.pixels()
                    and frame.place == self.panel.transport.wanted
                    and (frame.camera.eye, frame.camera.target, frame.camera.height) ==
                    (camera.eye, camera.target, camera.height) and (place is None or frame.place == place))
        wait_for(there, "a sharp picture at %s" % place)

    def redrawn(self):
        """Wait for another sharp picture than the last one: something else than camera and place has changed."""
        self.panel.view.frame = None
        pump(0.1)
        self.settle()

    def image(self):
        """The sharp picture."""
        self.settle()
        return self.panel.view.image()

    def preferences(self):
        """What the page shows is kept, and what was kept is shown."""
        from freecad.swarf_cam.gui import preferences

        page = preferences.Page()
        page.loadSettings()
        assert page.resolution.value() == self.settings.RESOLUTION and not page.flags["AutoPlay"].isChecked()
        page.form.show()
        screenshot("preferences.png")
        page.resolution.setValue(500)
        page.flags["Shadow"].setChecked(True)
        page.saveSettings()
        other = preferences.Page()
        other.loadSettings()
        assert other.resolution.value() == 500 and other.flags["Shadow"].isChecked()
        self.settings.set_resolution(self.settings.RESOLUTION)
        self.settings.set_flag("Shadow", False)
        page.form.close()

    def opening(self, document, job):
        """By the command, with the job selected."""
        Gui.Selection.addSelection(document.Name, job.Name)
        assert Gui.Command.get("Swarf_Live").isActive() if hasattr(Gui, "Command") else True
        Gui.runCommand("Swarf_Live", 0)
        self.panel = Gui.getMainWindow().findChild(QtWidgets.QDockWidget, "SwarfLive")
        assert self.panel is not None, "the command opened no panel"
        wait_for(lambda: self.panel.session is not None, "opening")
        wait_for(lambda: not self.panel.checking.running, "the checks")
        self.settle(0.0)
        screenshot("panel-start.png")
        # What lies within the picture's middle is stock, the corner is background.
        image = self.panel.view.image()
        middle, corner = image.pixelColor(image.width() // 2, image.height() // 2), image.pixelColor(3, 3)
        assert middle != corner
        assert self.panel.operations.topLevelItemCount() == 4
        icon = self.panel.bar.play.icon().pixmap(26, 26).toImage()
        inked = sum(icon.pixelColor(x, y).alpha() > 128 for x in range(icon.width()) for y in range(icon.height()))
        assert inked > 0.1 * icon.width() * icon.height(), "the button to play shows no drawing"

    def transporting(self):
        """Buttons, keys, slider."""
        panel = self.panel
        before = self.image()
        panel.set_speed(0.0)
        self.button("play")
        wait_for(lambda: panel.transport.at > 0, "playing")
        wait_for(lambda: not panel.transport.playing, "the end")
        self.settle(panel.transport.end)
        after = self.image()
        assert differing(before, after) > 0.02, "cutting changed nothing to be seen"
        screenshot("panel-end.png")
        self.button("operation-back")
        listing = panel.session.listing
        self.settle(float(listing.operation_begin[3]))
        self.button("operation-back")
        self.settle(float(listing.operation_begin[2]))
        self.button("line-forward")
        self.settle()
        assert panel.transport.at > listing.operation_begin[2]
        self.button("line-back")
        self.settle(float(listing.operation_begin[2]))
        self.button("move-forward")
        self.settle(float(listing.operation_begin[2]) + 1)
        key(panel.view, QtCore.Qt.Key_Left)
        self.settle(float(listing.operation_begin[2]))
        key(panel.view, QtCore.Qt.Key_Right, modifiers=QtCore.Qt.ControlModifier)
        self.settle(float(listing.operation_begin[3]))
        key(panel.view, QtCore.Qt.Key_Home)
        self.settle(0.0)
        assert differing(before, self.image()) == 0, "going back does not give the first picture"
        key(panel.view, QtCore.Qt.Key_End)
        self.settle(panel.transport.end)
        assert differing(after, self.image()) == 0, "going forward again gives another picture"
        line = panel.timeline
        drag(line, QtCore.Qt.LeftButton, (line.width() - 12, 24), (line.width() * 0.4, 24))
        self.settle()
        share = panel.transport.time / panel.session.clock.seconds
        assert abs(share - 0.4) < 0.02, share
        screenshot("panel-slider.png")
        # at 20 times the machine's speed a second is at most twenty of the machine's; how many depends on this one
        panel.seek(0)
        self.settle(0.0)
        panel.set_speed(20.0)
        clock = QtCore.QElapsedTimer()
        clock.start()
        key(panel.view, QtCore.Qt.Key_Space, " ")
        pump(1.5)
        wait_for(lambda: panel.transport.time > 1, "playing")
        screenshot("panel-playing.png")
        key(panel.view, QtCore.Qt.Key_Space, " ")
        assert not panel.transport.playing
        speed = panel.transport.time / (clock.elapsed() / 1000.0)
        assert speed < 21, "%.1f times as fast as the machine instead of 20" % speed
        # stops
        panel.bar._stops["operation"].setChecked(True)
        panel.seek(0)
        panel.set_speed(0.0)
        self.button("play")
        wait_for(lambda: not panel.transport.playing, "the stop")
        self.settle(float(listing.operation_begin[1]))
        panel.bar._stops["operation"].setChecked(False)

    def steering(self):
        """Mouse and keys in the picture."""
        panel, view = self.panel, self.panel.view
        panel.seek(panel.transport.end)
        key(view, QtCore.Qt.Key_F, "f")
        pump(0.4)
        before, eye = self.image(), view.camera.eye
        drag(view, QtCore.Qt.LeftButton, (120, 150), (220, 190))
        assert view.camera.eye != eye
        assert differing(before, self.image()) > 0.05
        height = view.camera.height
        x, y = view.width() * 0.45, view.height() * 0.5
        point, _ = view.point_under(x, y)
        wheel(view, x, y, 3)
        assert view.camera.height < height
        px, py, _ = view.camera.project(point, view.aspect())
        assert abs(px - view._place(x, y)[0]) < 1e-6 and abs(py - view._place(x, y)[1]) < 1e-6, "zoom to the cursor"
        self.settle()
        screenshot("panel-zoomed.png")
        target = view.camera.target
        drag(view, QtCore.Qt.MiddleButton, (200, 150), (240, 170))
        assert view.camera.target != target
        for text in "123456":
            key(view, getattr(QtCore.Qt, "Key_" + text), text)
            pump(0.35)
        key(view, QtCore.Qt.Key_2, "2")
        pump(0.4)
        self.settle()
        forward = [b - a for a, b in zip(view.camera.eye, view.camera.target)]
        assert abs(forward[0]) < 1e-6 and abs(forward[1]) < 1e-6 and forward[2] < 0, "key 2 looks from the top"
        screenshot("panel-top.png")
        # the cube: the picture from the top, so its middle is the top and its left edge another view
        click(view, view.width() - 58 - 20, 58)
        pump(0.5)
        forward = [b - a for a, b in zip(view.camera.eye, view.camera.target)]
        assert forward[0] > 1e-3 and forward[2] < -1e-3, "the cube's edge turns the view: %s" % (forward,)
        mouse(view, "double", view.width() * 0.4, view.height() * 0.5, QtCore.Qt.LeftButton)
        pump(0.4)
        key(view, QtCore.Qt.Key_P, "p")
        assert view.camera.perspective
        self.settle()
        key(view, QtCore.Qt.Key_P, "p")
        key(view, QtCore.Qt.Key_0, "0")
        pump(0.5)

    def looking(self, document, job):
        """Wide and floating, dark, in German."""
        panel = self.panel
        panel.set_speed(100.0)
        panel.seek(panel.session.listing.operation_begin[1] + 6.5)
        panel.tools.actions_by_name["path"].setChecked(True)
        panel.setFloating(True)
        panel.setGeometry(10, 10, 1180, 720)
        self.settle()
        assert panel.splitter.orientation() == QtCore.Qt.Horizontal
        bar = panel.tabs.tabBar()
        assert bar.tabRect(bar.count() - 1).right() <= panel.tabs.width(), "a tab is hidden"
        screenshot("panel-wide.png")
        panel.tools.actions_by_name["path"].setChecked(False)
        application = QtWidgets.QApplication.instance()
        style = application.styleSheet()
        application.setStyleSheet("QWidget { background-color: #35393e; color: #f0f0f0 }")  # as FreeCAD's themes are
        panel.tools.set_colouring("operation")
        panel.seek(panel.transport.end)
        self.settle()
        screenshot("panel-dark.png")
        corner = panel.view.image().pixelColor(3, 3)
        assert corner.lightness() < 100, "the background follows a dark theme"
        application.setStyleSheet(style)
        panel.tools.set_colouring("material")
        panel.setFloating(False)
        Gui.setLocale("de")
        pump(0.2)
        german = self.dock.LivePanel(Gui.getMainWindow())
        german.setObjectName("SwarfGerman")
        Gui.getMainWindow().addDockWidget(QtCore.Qt.RightDockWidgetArea, german)
        Gui.getMainWindow().tabifyDockWidget(panel, german)
        german.raise_()
        german.watch(job)
        wait_for(lambda: german.session is not None, "opening a second panel")
        assert german.tabs.tabText(0) == "Operationen"
        german.tabs.setCurrentWidget(german.accuracy)
        german.show()
        german.raise_()
        pump(1.0)
        screenshot("panel-german.png")
        german.close()
        wait_for(lambda: not german._old_engines, "the second panel's end")
        Gui.getMainWindow().removeDockWidget(german)
        german.deleteLater()
        Gui.setLocale("en")
        panel.raise_()
        pump(0.3)
        self.settle()

    def clicking(self, document):
        """From the stock to the line, and from the line to the stock."""
        panel, view = self.panel, self.panel.view
        panel.seek(panel.transport.end)
        key(view, QtCore.Qt.Key_2, "2")
        pump(0.4)
        self.settle()
        for point, operation, tool in (((25, 25, -5), "RoundPocket", "T1"), ((54, 25, -3), "Wave", "T2"),
                                       ((60, 10, -1), "Facing", "T1")):
            x, y, _ = view.camera.project(point, view.aspect())
            panel.picking.found = None
            click(view, (x + 1) / 2 * view.width(), (1 - y) / 2 * view.height())
            wait_for(lambda: panel.picking.found is not None, "the answer to a click")
            shown = panel.findChild(QtWidgets.QLabel, "SwarfPoint-operation").text()
            assert shown == operation, (shown, operation)
            assert panel.findChild(QtWidgets.QLabel, "SwarfPoint-tool").text().startswith(tool)
            assert max(abs(a - b) for a, b in zip(panel.picking.found.point, point)) < 0.6, (panel.picking.found.point, point)
            assert abs(panel.picking.found.depth_below_top + point[2]) < 0.1
            assert [obj.Label for obj in Gui.Selection.getSelection()] == [operation]
        line = panel.picking.found.line
        assert panel.program.currentIndex().row() == line
        screenshot("panel-point.png")
        panel.tabs.setCurrentWidget(panel.program)
        pump(0.2)
        row = panel.session.listing.line_of(panel.session.listing.operation_begin[2] + 3)
        index = panel.program.model().index(row, 0)
        panel.program.scrollTo(index)
        place = panel.program.visualRect(index).center()
        click(panel.program.viewport(), place.x(), place.y())
        self.settle(float(panel.session.listing.moves_of(row)[1]))
        assert panel.program.currentIndex().row() == row, "the line that was clicked stays marked"
        assert panel.session.listing.text(row) in panel.view.caption[1]
        screenshot("panel-line.png")
        panel.tabs.setCurrentWidget(panel.operations)
        pump(0.2)
        item = panel.operations.topLevelItem(3)
        place = panel.operations.visualItemRect(item).center()
        click(panel.operations.viewport(), place.x(), place.y())
        self.settle(float(panel.session.listing.operation_begin[3]))
        item.setCheckState(0, QtCore.Qt.Unchecked)
        assert not document.getObject("Holes").ViewObject.Visibility
        item.setCheckState(0, QtCore.Qt.Checked)
        assert document.getObject("Holes").ViewObject.Visibility

    def findings(self):
        """What the checks found: list, marks, going there, leaving out, breaking off."""
        panel, tree = self.panel, self.panel.findings.tree
        page = panel.tabs.indexOf(panel.findings)
        panel.tabs.setCurrentIndex(page)
        found = panel.checking.found
        listing = panel.session.listing
        assert tree.topLevelItemCount() == len(found) > 0
        assert panel.tabs.tabText(page) == "Findings (%d)" % sum(item.severity != "note" for item in found)
        index = next(index for index, item in enumerate(found)
                     if item.kind == "gouge" and listing.operations[item.operation].name == "Wave")
        assert tree.topLevelItem(index).text(1) == "Wave"
        assert {"gouge", "excess"} <= {item.kind for item in found}, [item.text for item in found]
        pump(0.2)
        place = tree.visualItemRect(tree.topLevelItem(index)).center()
        click(tree.viewport(), place.x(), place.y())
        pump(0.5)
        self.settle(found[index].place)
        view = panel.view
        x, y, _ = view.camera.project(found[index].point, view.aspect())
        assert max(abs(x), abs(y)) < 1e-6 and view.mark == found[index].point
        assert view.camera.height < 0.35 * sum((b - a) ** 2 for a, b in zip(*view.box)) ** 0.5
        screenshot("panel-findings.png")
        errors = panel.findings.filters["error"]
        errors.click()
        assert [tree.topLevelItem(row).isHidden() for row in range(len(found))] == \
            [item.severity == "error" for item in found]
        errors.click()
        assert not any(tree.topLevelItem(row).isHidden() for row in range(len(found)))
        panel.bar._stops["finding"].setChecked(True)
        panel.seek(0)
        panel.set_speed(0.0)
        self.button("play")
        wait_for(lambda: not panel.transport.playing, "the stop at a finding")
        self.settle(min(item.place for item in found if item.place))
        panel.bar._stops["finding"].setChecked(False)
        panel.findings.run.click()
        panel.findings.run.click()
        wait_for(lambda: not panel.checking.running, "breaking off the checks")
        assert "ancelled" in panel.findings.state.text() or panel.checking.found == found  # too fast to be stopped
        assert panel.checking.found == found, "cancelling keeps what was known"
        panel.findings.run.click()
        assert panel.tabs.tabText(page).endswith("…")
        wait_for(lambda: not panel.checking.running, "checking again")
        assert panel.checking.found == found
        key(view, QtCore.Qt.Key_0, "0")
        pump(0.5)

    def section(self):
        """Cut open by the button, the slider, the number, the other side; kept while it plays."""
        panel, row = self.panel, self.panel.section
        panel.seek(panel.transport.end)
        whole = self.image()
        button = panel.tools.actions_by_name["section"]
        assert not button.isChecked() and row.isHidden(), "off at first"
        button.trigger()
        self.redrawn()
        half = self.image()
        assert row.isVisible() and differing(whole.scaled(half.size()), half) > 0.05
        row.position.setValue(25.0)
        panel.seek(panel.session.listing.operation_begin[2])
        self.settle()
        assert panel.section.planes() == (((40.0, 25.0, -7.5), (0.0, -1.0, 0.0)),)
        # the cut face through the middle of the pocket lies where its plane is
        view = panel.view
        x, y, _ = view.camera.project((60, 25, -8), view.aspect())
        point, hit = view.point_under((x + 1) / 2 * view.width(), (1 - y) / 2 * view.height())
        assert hit and abs(point[1] - 25) < view.camera.height / view.height(), point  # a pixel
        screenshot("panel-section.png")
        row.slider.setValue(0)
        self.redrawn()
        assert row.position.value() == 0.0
        row.axis.setCurrentIndex(0)
        row.slider.setValue(500)
        row.flip.click()
        assert panel.section.planes() == (((40.0, 25.0, -7.5), (-1.0, 0.0, 0.0)),)
        panel.set_speed(0.0)
        self.button("play")
        wait_for(lambda: not panel.transport.playing, "the end of playing cut open")
        self.settle()
        screenshot("panel-section-x.png")
        row.flip.click()
        row.axis.setCurrentIndex(1)
        row.slider.setValue(500)
        button.trigger()
        assert row.isHidden()
        self.redrawn()
        assert differing(whole, self.image()) == 0, "closed again it is as before"

    def deviation(self):
        """Colours, legend, value under the mouse, pins, another tolerance."""
        panel, view = self.panel, self.panel.view
        panel.seek(panel.transport.end)
        key(view, QtCore.Qt.Key_2, "2")
        pump(0.5)
        self.settle()
        assert panel.tools.tolerance.isHidden()
        panel.tools.set_colouring("deviation")
        self.redrawn()
        assert panel.tools.tolerance.isVisible()

        def pixel(point):
            x, y, _ = view.camera.project(point, view.aspect())
            return (x + 1) / 2 * view.width(), (1 - y) / 2 * view.height()

        def colour(point):
            image, (x, y) = view.image(), pixel(point)
            return image.pixelColor(int(x * image.width() / view.width()), int(y * image.height() / view.height()))

        # the wave is missing, the pocket not deep enough, the top right
        floor, top, wave = (30, 28, -5), (70, 20, -1), (54, 25, -3)
        expected = {floor: 0.2, top: 0.0, wave: -2.0}
        for point, value in expected.items():
            assert abs(view.value_under(*pixel(point)) - value) < 0.01, (point, view.value_under(*pixel(point)))
        red, green, blue = colour(floor), colour(top), colour(wave)
        assert red.red() > 2 * red.blue() and blue.blue() > 2 * blue.red() and green.green() > green.red(), \
            (red.getRgb(), green.getRgb(), blue.getRgb())
        mouse(view, "move", *pixel(floor))
        assert abs(view.hover - 0.2) < 0.01
        panel.tabs.setCurrentWidget(panel.findings)
        assert len(view.pins) == len(panel.checking.found) == 3
        numbered = [panel.findings.tree.topLevelItem(row).text(0)[0] for row in range(3)]
        assert sorted(numbered) == ["①", "②", "③"]
        screenshot("panel-deviation.png")
        path = os.path.join(OUT, "deviation.png")
        panel.files.save_picture(path)
        wait_for(lambda: not panel.banner.working, "writing the picture")
        saved = QtGui.QImage(path).convertToFormat(view.image().format())
        assert differing(saved, view.image()) < 0.01, "the file has the colours too"
        panel.banner.done()
        panel.picking.found = None
        click(view, *pixel(floor))
        wait_for(lambda: panel.picking.found is not None, "the answer to a click")
        assert panel.findChild(QtWidgets.QLabel, "SwarfPoint-deviation").text() == "+0.200 mm"
        panel.tools.tolerance.setValue(0.3)
        self.redrawn()
        wide = colour(floor)
        assert wide.green() >= wide.red(), "with a wider tolerance the pocket is well"
        wait_for(lambda: panel.checking.running, "checks with another tolerance")
        wait_for(lambda: not panel.checking.running, "the end of the checks")
        assert not [item for item in panel.checking.found if abs(abs(item.amount) - 0.2) < 0.01]
        application = QtWidgets.QApplication.instance()
        style = application.styleSheet()
        application.setStyleSheet("QWidget { background-color: #35393e; color: #f0f0f0 }")
        key(view, QtCore.Qt.Key_0, "0")
        pump(0.5)
        drag(view, QtCore.Qt.LeftButton, (120, 150), (180, 170))
        screenshot("panel-deviation-moving.png")
        self.settle()
        mouse(view, "move", *pixel(wave))
        screenshot("panel-deviation-dark.png")
        mouse(view, "move", 3, 3)
        assert view.hover is None, "there is no deviation beside the part"
        application.setStyleSheet(style)
        panel.tools.open(False)
        assert panel.tools.colouring == "material" and view.legend is None, "without a model"
        panel.tools.open(True)
        panel.tools.tolerance.setValue(self.settings.TOLERANCE_MM)
        wait_for(lambda: panel.checking.running, "checks with the first tolerance")
        wait_for(lambda: not panel.checking.running, "the end of the checks")
        self.settle()
        key(view, QtCore.Qt.Key_0, "0")
        pump(0.5)

    def accuracy(self):
        """Estimate, another voxel size, one that cannot be, cancelling."""
        panel = self.panel
        panel.tabs.setCurrentWidget(panel.accuracy)
        panel.accuracy.voxel.setValue(0.4)
        place = panel.transport.wanted
        assert "MB" in panel.accuracy.estimate.text()
        screenshot("panel-accuracy.png")
        panel.accuracy.apply.click()
        wait_for(lambda: panel.session is not None and panel.session.voxel_mm == 0.4, "another voxel size")
        self.settle(place)
        panel.accuracy.voxel.setValue(0.0005)
        panel.accuracy.apply.click()
        wait_for(lambda: panel.banner.isVisible() and not panel.banner.working, "the refusal")
        assert "emory" in panel.banner.text.text(), panel.banner.text.text()
        screenshot("panel-memory.png")
        panel.accuracy.voxel.setValue(0.02)
        panel.accuracy.apply.click()
        panel.banner.action.click()
        wait_for(lambda: not panel.banner.working, "cancelling")
        panel.accuracy.voxel.setValue(0.2)
        panel.accuracy.apply.click()
        wait_for(lambda: panel.session is not None and panel.session.voxel_mm == 0.2, "going on")
        self.settle()

    def outputs(self, document):
        """Clipboard, file, frames, the document."""
        from freecad.swarf_cam.app import simulation
        from freecad.swarf_cam.gui.panel import export

        panel = self.panel
        panel.seek(panel.transport.end)
        self.settle()
        export.copy(panel.view.image())
        assert QtWidgets.QApplication.clipboard().image().width() == panel.view.frame.width
        path = os.path.join(OUT, "saved.png")
        panel.files.save_picture(path)
        wait_for(lambda: not panel.banner.working, "writing the picture")
        assert differing(QtGui.QImage(path).convertToFormat(panel.view.image().format()), panel.view.image()) < 0.01
        with tempfile.TemporaryDirectory() as folder:
            panel.files.save_animation(folder, 4, (160, 120))
            wait_for(lambda: not panel.banner.working, "writing the animation")
            frames = [QtGui.QImage(os.path.join(folder, "frame-%05d.png" % number)) for number in range(4)]
            assert differing(frames[0], frames[3]) > 0.02
        undo = document.UndoCount
        panel.files.keep_result()
        wait_for(lambda: panel.files.keeper.worker is None, "the result")
        obj, = [item for item in document.Objects if simulation.is_simulation(item)]
        assert obj.UpToDate and document.UndoCount == undo + 1
        screenshot("panel-kept.png")
        document.undo()
        assert not [item for item in document.Objects if simulation.is_simulation(item)]

    def bad_moments(self, document, job):
        """Each ends in a message and a panel that can be used."""
        import samples

        panel, banner = self.panel, self.panel.banner
        panel.seek(0)
        panel.set_speed(1.0)
        self.button("play")
        pump(0.3)
        holes = document.getObject("Wave")
        holes.Path = samples.path_of("G0 Z5", "G0 X44 Y10", "G1 Z-4 F5", "G1 X74 F10")
        document.recompute()
        wait_for(lambda: banner.isVisible() and "changed" in banner.text.text(), "the notice of an edit")
        assert panel.transport.playing, "an edit stopped playing"
        screenshot("panel-edited.png")
        banner.action.click()
        wait_for(lambda: panel.session is not None, "reading again")
        self.settle()
        document.getObject("Tool").Shape = samples.end_mill(8)
        wait_for(lambda: banner.isVisible() and "changed" in banner.text.text(), "the notice of another tool")
        panel.reload()
        panel.close()  # while it works
        pump(0.5)
        wait_for(lambda: not panel._old_engines, "the engine's end")
        self.opening(document, job)
        document.removeObject(job.Name)
        document.recompute()
        wait_for(lambda: banner.isVisible() and "deleted" in banner.text.text(), "the notice of deleting")
        panel.seek(panel.transport.end)
        self.settle(panel.transport.end)
        screenshot("panel-deleted.png")
        panel.reload()
        assert banner.isVisible()

    def closing(self):
        """The document goes while the panel plays."""
        panel = self.panel
        document = FreeCAD.newDocument("second")
        job = make_job(document)
        document.recompute()
        Gui.Selection.clearSelection()
        self.opening(document, job)
        panel.set_speed(1.0)
        self.button("play")
        pump(0.3)
        FreeCAD.closeDocument(document.Name)
        wait_for(lambda: panel.banner.isVisible() and "closed" in panel.banner.text.text(), "the notice of closing")
        pump(0.3)
        screenshot("panel-closed.png")


def check():
    """All of it."""
    check = Check()
    document = FreeCAD.newDocument("live")
    document.UndoMode = 1
    job = make_job(document)
    document.recompute()
    Gui.activateWorkbench("SwarfWorkbench")
    Gui.ActiveDocument.ActiveView.viewIsometric()
    Gui.SendMsgToActiveView("ViewFit")
    for step, arguments in ((check.preferences, ()), (check.opening, (document, job)), (check.transporting, ()), (check.steering, ()),
                            (check.looking, (document, job)),
                            (check.clicking, (document,)), (check.findings, ()), (check.section, ()), (check.deviation, ()),
                            (check.accuracy, ()), (check.outputs, (document,)),
                            (check.bad_moments, (document, job)), (check.closing, ())):
        print("CHECK", step.__name__)
        sys.stdout.flush()
        step(*arguments)
    # FreeCAD closes while it plays
    document = FreeCAD.newDocument("third")
    job = make_job(document)
    document.recompute()
    check.opening(document, job)
    check.button("play")
    pump(0.2)


start(check)
