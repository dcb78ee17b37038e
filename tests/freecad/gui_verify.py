# SPDX-License-Identifier: LGPL-2.1-or-later
"""Verification in the live panel (see run): findings, deviations."""

import os
import sys

import FreeCAD
import FreeCADGui as Gui

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "inside")]

from gui_support import OUT, QtCore, QtWidgets, live, screenshot, start, wait_for  # noqa: E402
from PySide import QtGui  # noqa: E402
from panel_support import PanelTest, click, differing, drag, key, mouse, new_job  # noqa: E402


class Verifying(PanelTest):
    """The checks in the order of a user."""

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
        assert "mm²," in tree.topLevelItem(index).text(0) and "mm³" in tree.topLevelItem(index).text(0)
        assert {"gouge", "excess"} <= {item.kind for item in found}, [item.text for item in found]
        self.click_row(tree, lambda: tree.visualItemRect(tree.topLevelItem(index)))
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
        kind = panel.findings.kind
        kind.setCurrentIndex(kind.findData("gouge"))
        assert [tree.topLevelItem(row).isHidden() for row in range(len(found))] == \
            [item.kind != "gouge" for item in found]
        kind.setCurrentIndex(0)
        key(view, QtCore.Qt.Key_Right)
        assert view.mark is None, "the mark of a finding stays where the stock has moved on"
        panel.bar._stops["finding"].setChecked(True)
        panel.player.seek(0)
        self.play(min(item.place for item in found if item.place))
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
        self.turn("0")

    def accepting(self, document, job):
        """With a reason that is kept in the job, can be undone, and taken back."""
        panel, page = self.panel, self.panel.findings
        panel.tabs.setCurrentWidget(page)
        found = list(panel.checking.found)
        index = next(index for index, item in enumerate(found) if item.kind == "gouge")
        page.tree.setCurrentItem(page.tree.topLevelItem(index))
        assert page.accept.isEnabled() and not page.accept.isChecked() and page.reason.isHidden() is False
        page.accept.click()
        assert page.reason.isVisible() and not page.give.isEnabled(), "no acceptance without a reason"
        page.reason.setText("the wave is wanted")
        screenshot("panel-accepting.png")
        undo = document.UndoCount
        page.give.click()
        taken = [item for item in panel.checking.found if item.accepted == "the wave is wanted"]
        assert [item.kind for item in taken] == ["gouge"] and panel.checking.found[-1] is taken[0]
        assert document.UndoCount == undo + 1 and len(job.SwarfAccepted) == 1
        assert panel.tabs.tabText(panel.tabs.indexOf(page)) == "Findings (%d)" % (len(found) - 1)
        assert "the wave is wanted" in page.tree.topLevelItem(len(found) - 1).text(0)
        assert not any(mark[0] == taken[0].place for mark in panel.timeline._findings), "it is marked no more"
        self.compared()
        assert panel.banner.isHidden(), "an acceptance is no change of the job: " + panel.banner.text.text()
        screenshot("panel-accepted.png")
        page.run.click()
        wait_for(lambda: not panel.checking.pending, "checking again")
        assert [item.kind for item in panel.checking.found if item.accepted] == ["gouge"], "found again, accepted again"
        document.undo()
        wait_for(lambda: not [item for item in panel.checking.found if item.accepted], "undoing")
        document.redo()
        wait_for(lambda: [item for item in panel.checking.found if item.accepted], "doing it again")
        page.tree.setCurrentItem(page.tree.topLevelItem(len(found) - 1))
        assert page.accept.isChecked()
        page.accept.click()
        wait_for(lambda: panel.checking.found == found, "taking it back")
        assert job.SwarfAccepted == []

    def stopping(self):
        """At the first error, where the panel then stands."""
        panel, page = self.panel, self.panel.findings
        panel.player.seek(0)
        self.settle(0.0)
        page.stop.setChecked(True)
        page.run.click()
        wait_for(lambda: not panel.checking.pending, "the checks, stopped or not")
        assert not panel.checking.outcome.stopped, "nothing collides: there is nothing to stop at"
        page.stop.setChecked(False)

    def comparing(self):
        """The stock, the model, one over the other."""
        panel, compared = self.panel, self.panel.tools.compared
        panel.player.seek(0)
        self.turn("0")
        pictures = {}
        for name in ("both", "design", "stock"):
            compared.setCurrentIndex(compared.findData(name))
            self.settle()
            pictures[name] = self.image()
            screenshot("panel-shown-%s.png" % name)
        assert min(differing(pictures[a], pictures[b]) for a, b in (("both", "design"), ("both", "stock"),
                                                                    ("design", "stock"))) > 0.1
        compared.setCurrentIndex(compared.findData("both"))
        panel.tools.set_colouring("deviation")
        panel.player.seek(panel.transport.end)
        self.settle()
        screenshot("panel-shown-deviation.png")
        assert panel.view.legend is not None
        compared.setCurrentIndex(compared.findData("design"))
        self.settle()
        screenshot("panel-shown-design-deviation.png")
        told = {name: self.value_at(point) for name, point in (("facing", (60, 35, -1)), ("pocket", (25, 25, -5.2)))}
        assert abs(told["facing"]) < 0.02 and abs(told["pocket"] - 0.2) < 0.02, told
        assert panel.view.legend is not None
        path = os.path.join(OUT, "design.png")
        panel.files.save_picture(path)
        wait_for(lambda: not panel.banner.working, "writing the picture")
        saved = QtGui.QImage(path).convertToFormat(panel.view.image().format())
        assert differing(saved, panel.view.image()) < 0.01, "the file shows what the panel shows"
        panel.banner.done()
        compared.setCurrentIndex(0)
        panel.tools.set_colouring("material")
        self.settle()

    def value_at(self, point):
        """The deviation that the sharp picture tells at a point."""
        frame = self.panel.view.frame
        x, y, _ = frame.camera.project(point, self.panel.view.aspect())
        return frame.values[int((1 - y) / 2 * frame.height), int((x + 1) / 2 * frame.width)]

    def fixtures(self, document, job):
        """Chosen in the document, seen in the picture, found by the checks, kept, undone."""
        import Part

        panel, page = self.panel, self.panel.setup
        panel.tabs.setCurrentWidget(page)
        place = panel.session.listing.operation_begin[1] - 1.5
        panel.player.seek(place)
        bare = self.image()
        assert page.add.isEnabled() and not page.remove.isEnabled()
        Gui.Selection.clearSelection()
        page.add.click()
        assert "Select" in panel.banner.text.text(), panel.banner.text.text()
        Gui.Selection.addSelection(job.Stock)
        page.add.click()
        assert "stock or model" in panel.banner.text.text(), "the stock is no fixture"
        panel.banner.done()
        clamp = document.addObject("Part::Feature", "Clamp")
        clamp.Shape = Part.makeBox(24, 20, 17, FreeCAD.Vector(70, 15, -15))
        clamp.Shape = clamp.Shape.cut(Part.makeBox(10, 20, 15, FreeCAD.Vector(70, 15, -15)))
        document.recompute()
        undo = document.UndoCount
        Gui.Selection.clearSelection()
        Gui.Selection.addSelection(clamp)
        page.add.click()
        self.opened()
        assert page.fixtures.topLevelItemCount() == 1 and page.fixtures.topLevelItem(0).text(0) == "Clamp"
        assert job.SwarfFixtures == [clamp] and document.UndoCount == undo + 1
        self.checked()
        self.settle(place)
        clamped = self.image()
        assert panel.tabs.minimumSizeHint().width() < 560, "a page makes the panel too wide"
        assert differing(bare.scaled(clamped.size()), clamped) > 0.01, "the clamp is not seen"
        hits = [item for item in panel.checking.found if item.kind == "fixture"]
        assert hits and {panel.session.listing.operations[item.operation].name for item in hits} == {"Facing"}, hits
        screenshot("panel-fixture.png")
        panel.checking.go_to(hits[0])
        self.settle(hits[0].place)
        assert hits[0].severity == "error"
        screenshot("panel-fixture-hit.png")
        panel.findings.stop.setChecked(True)
        panel.player.seek(0)
        panel.findings.run.click()
        self.checked()
        assert panel.checking.outcome.stopped and len(panel.checking.found) == 1
        assert panel.transport.wanted == panel.checking.found[0].place, "the panel stands at what stopped the checks"
        panel.findings.stop.setChecked(False)
        clamp.Placement.Base.z = -40  # elsewhere: the job is not what was read
        clamp.Placement = FreeCAD.Placement(FreeCAD.Vector(0, 0, -40), FreeCAD.Rotation())
        wait_for(lambda: panel.banner.isVisible() and "changed" in panel.banner.text.text(), "a fixture that moves")
        panel.banner.action.click()
        self.opened()
        self.checked()
        assert not [item for item in panel.checking.found if item.kind == "fixture"]
        page.fixtures.setCurrentItem(page.fixtures.topLevelItem(0))
        page.remove.click()
        self.opened()
        assert job.SwarfFixtures == [] and page.fixtures.topLevelItemCount() == 0
        self.checked()

    def holders(self, document, job):
        """From the library, with a stickout; found by the checks; a wrong one is refused."""
        panel, page = self.panel, self.panel.setup
        panel.tabs.setCurrentWidget(page)
        controller = job.Tools.Group[2]
        box = page.tools.itemWidget(page.tools.topLevelItem(2), 1)
        assert box.findText("SK40-ER16") > 0 and box.currentText() == ""
        undo = document.UndoCount
        box.setCurrentIndex(box.findText("SK40-ER16"))
        box.activated.emit(box.currentIndex())
        self.opened()
        assert (controller.SwarfHolder, controller.SwarfStickout.Value) == ("SK40-ER16", 26.0), "above its flutes"
        assert document.UndoCount == undo + 1
        self.checked()
        assert not [item for item in panel.checking.found if item.kind == "holder"], "26 mm reach 16 mm deep"
        length = page.tools.itemWidget(page.tools.topLevelItem(2), 2)
        length.setValue(12.0)
        self.opened()
        self.checked()
        hits = [item for item in panel.checking.found if item.kind == "holder"]
        assert hits and panel.session.listing.operations[hits[0].operation].name == "Holes"
        panel.tabs.setCurrentWidget(page)
        panel.player.seek(hits[0].place)
        self.settle(hits[0].place)
        screenshot("panel-holder.png")
        box = page.tools.itemWidget(page.tools.topLevelItem(2), 1)
        box.setEditText("ER17")
        box.lineEdit().editingFinished.emit()
        assert "ER17" in panel.banner.text.text() and panel.banner.isVisible()
        assert controller.SwarfHolder == "SK40-ER16", "nothing of it is in the document"
        panel.banner.done()
        document.undo()
        document.undo()
        wait_for(lambda: panel.banner.isVisible() and "changed" in panel.banner.text.text(), "undoing is a change")
        panel.banner.action.click()
        self.opened()
        assert page.tools.itemWidget(page.tools.topLevelItem(2), 1).currentText() == ""
        self.checked()
        page.clearance.setValue(2.0)
        self.checked()
        assert self.settings.clearance() == 2.0
        # changed again just before the end of a check: that was made with the old one
        from freecad.swarf_cam import checks

        run, clearances = checks.run, []
        checks.run = lambda *what: clearances.append(what[5]) or run(*what)
        panel.findings.run.click()
        panel.checking.join(60)
        page.clearance.setValue(0.0)
        self.checked()
        checks.run = run
        assert clearances == [2.0, 0.0], "judged, not checked"

    def typing(self, document, job):
        """Into the page while the job is read and cut: it stays, and nothing is told before it is finished."""
        panel, page = self.panel, self.panel.setup
        panel.tabs.setCurrentWidget(page)
        told = []
        page.held.connect(lambda *what: told.append(what))
        panel.opening.reload()
        box = page.tools.itemWidget(page.tools.topLevelItem(1), 1)
        panel.activateWindow()
        box.lineEdit().setFocus()
        box.setEditText("SK4")
        undo = document.UndoCount
        wait_for(lambda: panel.session is not None, "opening")
        assert page.tools.itemWidget(page.tools.topLevelItem(1), 1) is box and box.currentText() == "SK4"
        assert document.UndoCount == undo
        # a page that must be filled again, for a tool has got another name
        job.Tools.Group[1].Tool.Label = "Other"
        panel.setting_up.show()
        live()  # what is in the way goes
        box = page.tools.itemWidget(page.tools.topLevelItem(1), 1)
        assert page.tools.topLevelItem(1).text(0) == "T2 Other" and box.currentText() == ""
        assert not told, "what is half typed was taken for a holder: %s" % told
        assert page.tools.topLevelItemCount() == 3
        self.checked()

    def deviation(self):
        """Colours, legend, value under the mouse, pins, another tolerance."""
        panel, view = self.panel, self.panel.view
        panel.player.seek(panel.transport.end)
        self.turn("2")
        self.settle()
        assert panel.tools.tolerance.isHidden()
        panel.tools.set_colouring("deviation")
        self.settle()
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
        panel.tabs.setCurrentWidget(panel.deviation)
        bars = panel.deviation.bars
        shown = bars._shown
        assert abs(sum(shown.areas) - panel.checking.outcome.deviation.area) < 0.2 * sum(shown.areas)  # less the edges
        assert max(range(len(shown.areas)), key=shown.areas.__getitem__) in (31, 32), "most of it is well"
        assert shown.areas[0] > 100 and shown.areas[-1] > 500, "the wave and the pocket"
        screenshot("panel-histogram.png")
        picture, bar = bars.grab().toImage(), bars.bar(63)
        assert picture.pixelColor(int(bar.center().x()), int(bar.bottom()) - 2).red() > 150, "the last bar is red"
        assert panel.findChild(QtWidgets.QLabel, "SwarfDeviation-range").text().startswith("-2.0")
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
        measured = panel.checking.outcome.verification.result
        panel.tools.tolerance.setValue(0.3)
        self.settle()
        wide = colour(floor)
        assert wide.green() >= wide.red(), "with a wider tolerance the pocket is well"
        self.checked()
        assert panel.checking.outcome.verification.result is measured, "nothing was cut or measured again"
        assert not [item for item in panel.checking.found if abs(abs(item.amount) - 0.2) < 0.01]
        # what is meant to be left is no deviation
        panel.tools.tolerance.setValue(self.settings.TOLERANCE_MM)
        panel.tabs.setCurrentWidget(panel.deviation)
        panel.deviation.allowance.setValue(0.2)
        self.settle()
        for point, value in expected.items():
            assert abs(view.value_under(*pixel(point)) - value + 0.2) < 0.01, (point, view.value_under(*pixel(point)))
        self.checked()
        assert panel.checking.outcome.verification.result is measured, "nothing was cut or measured again"
        assert panel.checking.outcome.verification.allowance == 0.2
        assert panel.findChild(QtWidgets.QLabel, "SwarfDeviation-range").text().startswith("-2.2")
        assert not [item for item in panel.checking.found if abs(item.amount - 0.2) < 0.01 and item.kind == "excess"]
        mouse(view, "move", *pixel(floor))
        screenshot("panel-allowance.png")
        panel.deviation.allowance.setValue(0.0)
        panel.tools.tolerance.setValue(0.3)
        self.checked()
        panel.tabs.setCurrentWidget(panel.findings)
        application = QtWidgets.QApplication.instance()
        style = application.styleSheet()
        application.setStyleSheet("QWidget { background-color: #35393e; color: #f0f0f0 }")
        self.turn("0")
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
        wait_for(lambda: not panel.tools.compared.isVisible(), "the choice without a model to go")
        panel.tools.open(True)
        panel.tools.tolerance.setValue(self.settings.TOLERANCE_MM)
        self.checked()
        self.settle()
        self.turn("0")


def check():
    """All of it."""
    test = Verifying()
    document, job = new_job("verify")
    test.run((test.open, document, job), (test.findings,), (test.accepting, document, job), (test.stopping,),
             (test.deviation,), (test.comparing,), (test.fixtures, document, job), (test.holders, document, job),
             (test.typing, document, job))


start(check)
