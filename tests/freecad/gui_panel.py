# SPDX-License-Identifier: LGPL-2.1-or-later
"""The live panel in the real GUI (see run): driven by buttons, slider, keys and mouse, judged by what it shows."""

import contextlib
import os
import sys
import shutil
import tempfile
import threading
import time

import FreeCADGui as Gui

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "inside")]

from gui_support import OUT, QtCore, QtWidgets, live, screenshot, start, wait_for  # noqa: E402
from PySide import QtGui  # noqa: E402
from panel_support import PanelTest, click, differing, drag, key, mouse, new_job, wheel  # noqa: E402


class Watching(PanelTest):
    """The checks in the order of a user."""

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
        page.lengths["tolerance"].setValue(0.125)
        page.lengths["clearance"].setValue(1.5)
        page.saveSettings()
        other = preferences.Page()
        other.loadSettings()
        assert other.resolution.value() == 500 and other.flags["Shadow"].isChecked()
        assert self.settings.tolerance() == 0.125 and self.settings.clearance() == 1.5
        assert (other.lengths["tolerance"].value(), other.lengths["clearance"].value()) == (0.125, 1.5)
        self.settings.set_tolerance(self.settings.TOLERANCE_MM)
        self.settings.set_clearance(0.0)
        self.settings.set_resolution(self.settings.RESOLUTION)
        self.settings.set_flag("Shadow", False)
        page.form.close()

    def opening(self, document, job):
        """By the command, with the job selected."""
        Gui.Selection.addSelection(document.Name, job.Name)
        assert Gui.Command.get("Swarf_Live").isActive() if hasattr(Gui, "Command") else True
        Gui.Selection.clearSelection()
        self.open(document, job)
        assert self.panel.view.frame.place == 0.0
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
        panel.player.set_speed(0.0)
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
        # at 5 times the machine's speed a second is at most five of the machine's; how many depends on this one
        panel.player.seek(listing.operation_begin[1])
        self.settle(float(listing.operation_begin[1]))
        begin = panel.transport.time
        panel.player.set_speed(5.0)
        clock = QtCore.QElapsedTimer()
        clock.start()
        key(panel.view, QtCore.Qt.Key_Space, " ")
        wait_for(lambda: panel.transport.time > begin + 2, "playing")
        # FreeCAD stands still: playing goes on without a jump of five seconds
        wanted = panel.session.clock.time_of(panel.transport.wanted)
        time.sleep(1.0)
        panel.player._tick()
        assert panel.session.clock.time_of(panel.transport.wanted) - wanted < 1.3
        key(panel.view, QtCore.Qt.Key_Space, " ")
        assert not panel.transport.playing
        speed = (panel.transport.time - begin) / (clock.elapsed() / 1000.0)
        assert speed < 5.25, "%.1f times as fast as the machine instead of 5" % speed
        key(panel.view, QtCore.Qt.Key_Space, " ")
        screenshot("panel-playing.png")
        panel.player.seek(0)
        # paused before the first picture of it: what is shown is still the one from before
        self.settle(0.0)
        panel.player.seek(panel.transport.end)
        self.settle(panel.transport.end)
        panel.player.seek(1)
        panel.player.toggle()
        assert panel.transport.playing
        panel.player.toggle()
        assert not panel.transport.playing and panel.transport.wanted == 1.0
        self.settle(1.0)
        # stops
        panel.bar._stops["operation"].setChecked(True)
        panel.player.seek(0)
        self.play(float(listing.operation_begin[1]))
        panel.bar._stops["operation"].setChecked(False)

    def steering(self):
        """Mouse and keys in the picture."""
        panel, view = self.panel, self.panel.view
        panel.player.seek(panel.transport.end)
        self.turn("f")
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
        for text in "1234562":
            self.turn(text)
        self.settle()
        forward = [b - a for a, b in zip(view.camera.eye, view.camera.target)]
        assert abs(forward[0]) < 1e-6 and abs(forward[1]) < 1e-6 and forward[2] < 0, "key 2 looks from the top"
        screenshot("panel-top.png")
        # the cube: the picture from the top, so its middle is the top and its left edge another view
        click(view, view.width() - 58 - 20, 58)
        wait_for(lambda: not view.turning, "the turn to the cube's edge")
        forward = [b - a for a, b in zip(view.camera.eye, view.camera.target)]
        assert forward[0] > 1e-3 and forward[2] < -1e-3, "the cube's edge turns the view: %s" % (forward,)
        self.settle()
        mouse(view, "double", view.width() * 0.4, view.height() * 0.5, QtCore.Qt.LeftButton)
        wait_for(lambda: not view.turning, "the point in the middle")
        key(view, QtCore.Qt.Key_P, "p")
        assert view.camera.perspective
        self.settle()
        key(view, QtCore.Qt.Key_P, "p")
        # what is pressed while it turns holds when it has turned
        key(view, QtCore.Qt.Key_2, "2")
        key(view, QtCore.Qt.Key_P, "p")
        key(view, QtCore.Qt.Key_F, "f")
        assert view.turning
        self.settle()
        forward = [b - a for a, b in zip(view.camera.eye, view.camera.target)]
        assert abs(forward[0]) < 1e-6 and abs(forward[1]) < 1e-6 and view.camera.perspective, (forward, view.camera)
        key(view, QtCore.Qt.Key_P, "p")
        key(view, QtCore.Qt.Key_0, "0")
        height = view.camera.height
        key(view, QtCore.Qt.Key_Plus, "+")
        assert not view.turning and view.camera.height < height
        self.resizing()
        self.turn("0")

    def resizing(self):
        """In another size the whole stock is shown as before; who has zoomed keeps what there is."""
        from freecad.swarf_cam.core import navigation

        view = self.panel.view
        size, whole = view.size(), lambda: navigation.shows_whole(view.camera, view.box, view.aspect())
        self.turn("0")
        assert whole()
        view.resize(size.width() // 2, size.height())
        assert whole(), "a narrow view shows the whole stock"
        view.resize(size.width(), size.height() // 2)
        assert whole(), "a low view shows the whole stock"
        key(view, QtCore.Qt.Key_Plus, "+")
        eye, height = view.camera.eye, view.camera.height
        view.resize(size)
        assert not whole() and (view.camera.eye, view.camera.height) == (eye, height)

    def origin(self):
        """The origin's axes and the outline of the stock as it was, by a setting."""
        panel = self.panel
        panel.player.seek(panel.session.listing.operation_begin[1])
        before = self.image()
        self.settings.set_flag("ShowOrigin", True)
        panel.wish()
        image = self.image()
        screenshot("panel-origin.png")
        assert 0.001 < differing(before, image) < 0.1
        x, y, _ = panel.view.camera.project((0.5 * panel.session.box[1][0], 0, 0), panel.view.aspect())
        rows = range(int((1 - y) / 2 * image.height()) - 3, int((1 - y) / 2 * image.height()) + 4)
        column = int((x + 1) / 2 * image.width())
        assert any(image.pixel(column, row) != before.pixel(column, row) for row in rows), "the outline's upper edge"
        self.settings.set_flag("ShowOrigin", False)
        panel.wish()
        assert differing(before, self.image()) == 0

    def looking(self, job):
        """Wide and floating, dark, in German."""
        from freecad.swarf_cam.gui.panel import dock

        panel = self.panel
        panel.player.set_speed(100.0)
        panel.player.seek(panel.session.listing.operation_begin[1] + 6.5)
        panel.tools.actions_by_name["path"].setChecked(True)
        panel.setFloating(True)
        panel.setGeometry(10, 10, 1180, 720)
        wait_for(lambda: panel.splitter.orientation() == QtCore.Qt.Horizontal, "the lists beside the picture")
        self.settle()
        bar = panel.tabs.tabBar()
        assert bar.tabRect(bar.count() - 1).right() <= panel.tabs.width(), "a tab is hidden"
        screenshot("panel-wide.png")
        panel.tools.actions_by_name["path"].setChecked(False)
        application = QtWidgets.QApplication.instance()
        style = application.styleSheet()
        application.setStyleSheet("QWidget { background-color: #35393e; color: #f0f0f0 }")  # as FreeCAD's themes are
        panel.tools.set_colouring("operation")
        panel.player.seek(panel.transport.end)
        self.settle()
        screenshot("panel-dark.png")
        corner = panel.view.image().pixelColor(3, 3)
        assert corner.lightness() < 100, "the background follows a dark theme"
        # what an operation made has the colour that it has in the list and on the time line
        for index, point in ((1, (25, 25, -5)), (0, (60, 10, -1))):
            x, y, _ = panel.view.camera.project(point, panel.view.aspect())
            image = panel.view.image()
            seen = image.pixelColor(int((x + 1) / 2 * image.width()), int((1 - y) / 2 * image.height()))
            shown = panel.operations.topLevelItem(index).icon(0).pixmap(16, 16).toImage().pixelColor(8, 8)
            assert abs((seen.hue() - shown.hue() + 180) % 360 - 180) < 14, (index, seen.getRgb(), shown.getRgb())
            selected = panel.operations.topLevelItem(index).icon(0).pixmap(16, 16, QtGui.QIcon.Selected)
            assert selected.toImage().pixelColor(8, 8) == shown
        application.setStyleSheet(style)
        panel.tools.set_colouring("material")
        panel.setFloating(False)
        Gui.setLocale("de")
        locale = QtCore.QLocale()
        self.write_numbers(QtCore.QLocale("de"))
        german = dock.LivePanel(Gui.getMainWindow())
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
        wait_for(lambda: german.view.frame is not None and german.view.frame.sharp, "the second panel's picture")
        screenshot("panel-german.png")
        self.check_numbers(german)
        german.tabs.setCurrentWidget(german.findings)
        wait_for(lambda: not german.checking.pending, "the second panel's checks")
        assert any(item.text.startswith("zu tief: ") for item in german.checking.found), \
            [item.text for item in german.checking.found]
        screenshot("panel-german-findings.png")
        bar = german.tabs.tabBar()
        assert bar.tabRect(0).left() >= 0, "a tab is hidden"
        assert bar.tabRect(bar.count() - 1).right() <= german.tabs.width(), "a tab is hidden"
        assert german.width() < 800, "the dock takes too much of a small screen: %d" % german.width()
        german.close()
        wait_for(lambda: german.opening.ended, "the second panel's end")
        Gui.getMainWindow().removeDockWidget(german)
        german.deleteLater()
        Gui.setLocale("en")
        self.write_numbers(locale)
        panel.raise_()
        self.settle()

    @staticmethod
    def write_numbers(locale):
        """As FreeCAD does when the user chooses how numbers are written."""
        QtCore.QLocale.setDefault(locale)
        Gui.getMainWindow().setLocale(locale)

    @staticmethod
    def check_numbers(german):
        """They have commas, in labels as in spin boxes."""
        from freecad.swarf_cam import native
        from freecad.swarf_cam.gui import numbers

        amount = native.said("amount at least", value=0.125, area=2.5, volume=0.25)
        assert numbers.in_words(native.said("gouge", amount=amount)) == \
            "zu tief: mindestens 0,125 mm, 2,5 mm², 0,25 mm³ fehlen"
        kept = native.said("set-up kept", job="30 mm3", path="/tmp/30 mm2.vdb")
        assert all(name in numbers.in_words(kept) for name in kept.values.values()), "the user's own names"
        assert numbers.in_words("another") == "another"
        assert [numbers.text(-0.0001, 3, True), numbers.text(1234.5, 1), numbers.short(-0.2, True)] == \
            ["+0,000", "1234,5", "-0,2"]
        in_german = [numbers.text(1234567.891, 3), numbers.short(2.5e-7)]
        assert in_german == ["1234567,891", "2,5e-07"], "in double precision"
        assert [numbers.count(1234567), numbers.size(4.2e9), numbers.size(1234)] == ["1.234.567", "4,2 GB", "1,2 kB"]
        assert german.accuracy.voxel.text() == "0,2000 mm"
        assert "60,00 cm³" in german.accuracy.outcome.text() and "." not in german.accuracy.estimate.text()
        volume = german.operations.topLevelItem(0).text(3)
        assert volume.endswith(" cm³") and "," in volume

    def clicking(self, document):
        """From the stock to the line, and from the line to the stock."""
        panel, view = self.panel, self.panel.view
        panel.player.seek(panel.transport.end)
        self.turn("2")
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
            found = panel.picking.found.point
            assert max(abs(a - b) for a, b in zip(found, point)) < 0.6, (found, point)
            assert abs(panel.picking.found.depth_below_top + point[2]) < 0.1
            assert [obj.Label for obj in Gui.Selection.getSelection()] == [operation]
        line = panel.picking.found.line
        self.settle()  # the picture that shows the line's faces is here: it does not move the lists on to the cutter
        assert panel.player.selected == line
        assert panel.program.currentIndex().row() == line, (panel.program.currentIndex().row(), line)
        assert panel.operations.currentItem() is panel.operations.topLevelItem(0)
        assert panel.view.caption[0] == "Facing" and panel.view.caption[1].startswith("T1 "), panel.view.caption
        wait_for(lambda: self.is_marked((60, 10, -1)), "the line's faces to stand out")
        assert not self.is_marked((25, 25, -5))
        self.settle()
        screenshot("panel-point.png")
        panel.tabs.setCurrentWidget(panel.program)
        row = panel.session.listing.line_of(panel.session.listing.operation_begin[2] + 4)
        index = panel.program.model().index(row, 0)
        panel.program.scrollTo(index)
        self.click_row(panel.program, lambda: panel.program.visualRect(index))
        self.settle(float(panel.session.listing.moves_of(row)[1]))
        assert panel.program.currentIndex().row() == row, "the line that was clicked stays marked"
        assert panel.session.listing.text(row) in panel.view.caption[1]
        assert panel.player.selected == row and self.is_marked((51.07, 12.93, -3)), "the line's faces stand out"
        assert [obj.Label for obj in Gui.Selection.getSelection()] == ["Wave"], "and its operation in FreeCAD's tree"
        screenshot("panel-line.png")
        panel.tabs.setCurrentWidget(panel.operations)
        item = panel.operations.topLevelItem(3)
        self.click_row(panel.operations, lambda: panel.operations.visualItemRect(item))
        self.settle(float(panel.session.listing.operation_begin[3]))
        assert [obj.Label for obj in Gui.Selection.getSelection()] == ["Holes"]
        item.setCheckState(0, QtCore.Qt.Unchecked)
        assert not document.getObject("Holes").ViewObject.Visibility
        item.setCheckState(0, QtCore.Qt.Checked)
        assert document.getObject("Holes").ViewObject.Visibility
        assert panel.player.selected is None and not self.is_marked((51.07, 12.93, -3))

    def clicking_while_playing(self):
        """It halts at the picture that was clicked, and tells of that."""
        panel, view = self.panel, self.panel.view
        panel.player.seek(0)
        self.turn("2")
        self.settle(0.0)
        panel.picking.found = None
        panel.player.set_speed(1.0)
        self.button("play")
        wait_for(lambda: panel.transport.at > 0, "playing")
        assert panel.transport.playing
        place = view.frame.place
        x, y, _ = view.camera.project((70, 40, 0), view.aspect())
        click(view, (x + 1) / 2 * view.width(), (1 - y) / 2 * view.height())
        assert not panel.transport.playing and panel.transport.wanted == place
        wait_for(lambda: panel.picking.found is not None, "the answer to a click")
        self.settle(place)
        panel.player.set_speed(100.0)
        self.turn("0")

    def is_marked(self, point):
        """Whether the picture shows a point in the colour of what is selected."""
        view = self.panel.view
        image = view.image()
        x, y, _ = view.camera.project(point, view.aspect())
        colour = image.pixelColor(int((x + 1) / 2 * image.width()), int((1 - y) / 2 * image.height()))
        return colour.red() > colour.blue() + 60

    @contextlib.contextmanager
    def kept_busy(self):
        """The engine does something that ends with this."""
        begun, go_on = threading.Event(), threading.Event()
        self.panel.opening.call(lambda session, progress: (begun.set(), go_on.wait(60)), lambda result, error: None)
        assert begun.wait(60)
        try:
            yield
        finally:
            go_on.set()

    @contextlib.contextmanager
    def told(self):
        """Texts that the banner shows meanwhile."""
        texts, banner = [], self.panel.banner
        say = banner.say
        banner.say = lambda kind, text, *how: (texts.append(text), say(kind, text, *how))
        try:
            yield texts
        finally:
            del banner.say

    def section(self):
        """Cut open by the button, the slider, the number, the other side; kept while it plays."""
        panel, row = self.panel, self.panel.section
        self.turn("0")
        panel.player.seek(panel.transport.end)
        whole = self.image()
        button = panel.tools.actions_by_name["section"]
        assert not button.isChecked() and row.isHidden(), "off at first"
        button.trigger()
        self.settle()
        half = self.image()
        assert row.isVisible() and differing(whole.scaled(half.size()), half) > 0.05
        row.position.setValue(25.0)
        panel.player.seek(panel.session.listing.operation_begin[2])
        self.settle()
        assert panel.section.planes() == (((40.0, 25.0, -7.5), (0.0, -1.0, 0.0)),)
        # the cut face through the middle of the pocket lies where its plane is
        view = panel.view
        x, y, _ = view.camera.project((60, 25, -8), view.aspect())
        point, hit = view.point_under((x + 1) / 2 * view.width(), (1 - y) / 2 * view.height())
        assert hit and abs(point[1] - 25) < view.camera.height / view.height(), point  # a pixel
        screenshot("panel-section.png")
        row.slider.setValue(0)
        self.settle()
        assert row.position.value() == 0.0
        row.axis.setCurrentIndex(0)
        row.slider.setValue(500)
        row.flip.click()
        assert panel.section.planes() == (((40.0, 25.0, -7.5), (-1.0, 0.0, 0.0)),)
        self.play(panel.transport.end)
        screenshot("panel-section-x.png")
        row.flip.click()
        row.axis.setCurrentIndex(1)
        row.slider.setValue(500)
        button.trigger()
        assert row.isHidden()
        self.settle()
        assert differing(whole, self.image()) == 0, "closed again it is as before"

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
        import samples
        from freecad.swarf_cam.app import simulation
        from freecad.swarf_cam.gui.panel import export

        panel = self.panel
        panel.player.seek(panel.transport.end)
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
            assert os.path.exists(os.path.join(folder, "swarf.mp4")) == (shutil.which("ffmpeg") is not None)
            assert folder in panel.banner.text.text(), panel.banner.text.text()
            panel.files.save_animation(folder, 20000, (320, 240))
            wait_for(lambda: panel.banner.bar.value() > 0, "some frames")
            screenshot("panel-animation.png")
            panel.banner.action.click()
            wait_for(lambda: not panel.banner.working, "breaking off the animation")
            assert "ancelled" in panel.banner.text.text()
            # before it is begun: the engine does something else; and on the way to another place, which it goes on
            with self.kept_busy():
                panel.player.seek(0)
                panel.files.save_animation(folder, 20000, (320, 240))
                assert panel.transport.at != panel.transport.wanted == 0.0
                panel.player.seek(panel.transport.end)
                panel.banner.action.click()
            wait_for(lambda: not panel.banner.working, "breaking off an animation that was not begun")
            assert "ancelled" in panel.banner.text.text()
            # nor does the end of one that was broken off by reading the job again say anything
            panel.files.save_animation(folder, 20000, (320, 240))
            wait_for(lambda: panel.banner.bar.value() > 0, "some frames")
            with self.told() as texts:
                panel.opening.reload()
                self.opened()
                wait_for(lambda: panel.opening.ended, "the first engine's end")
                live()
            assert len(texts) == 2 and not [text for text in texts if "ancelled" in text], texts
            self.checked()
        self.settle(panel.transport.end)
        undo = document.UndoCount
        panel.files.keep_result()
        wait_for(lambda: not panel.files.keeper.running, "the result")
        obj, = [item for item in document.Objects if simulation.is_simulation(item)]
        assert obj.UpToDate and document.UndoCount == undo + 1
        screenshot("panel-kept.png")
        removed = obj.VolumeRemoved.Value
        document.undo()
        assert not [item for item in document.Objects if simulation.is_simulation(item)]
        self.compared()
        # an edit that nobody has compared yet: the old result must not be stored for the new job
        document.getObject("Wave").Path = samples.path_of("G0 Z5")
        assert not panel.opening._watch.differs
        panel.files.keep_result()
        wait_for(lambda: not panel.files.keeper.running, "the result of the edited job")
        obj, = [item for item in document.Objects if simulation.is_simulation(item)]
        document.recompute()
        assert obj.UpToDate and obj.VolumeRemoved.Value < removed - 50, (obj.VolumeRemoved.Value, removed)
        document.undo()


def check():
    """All of it."""
    test = Watching()
    document, job = new_job("live")
    test.run((test.preferences,), (test.opening, document, job), (test.transporting,), (test.steering,),
             (test.origin,), (test.looking, job), (test.clicking, document), (test.clicking_while_playing,),
             (test.section,), (test.accuracy,), (test.outputs, document))


start(check)
