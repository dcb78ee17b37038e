# SPDX-License-Identifier: LGPL-2.1-or-later
"""The add-on in the real GUI (see run): workbench, commands in both workbenches, panel, cancel, result, mark, icon."""

import os
import sys
import tempfile

import FreeCAD
import FreeCADGui as Gui
import Mesh

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "inside")]

from PySide import QtGui  # noqa: E402

from gui_support import OUT, QtWidgets, live, screenshot, start, wait_for  # noqa: E402


def menu_texts():
    """Texts of the entries in the menus that are shown now."""
    bar = Gui.getMainWindow().menuBar()
    shown = {action.text() for action in bar.actions() if action.isVisible()}
    found = []
    for menu in bar.findChildren(QtWidgets.QMenu):
        if menu.parent() is bar and menu.title() in shown:
            submenus = [menu, *menu.findChildren(QtWidgets.QMenu)]
            found += [action.text().replace("&", "") for item in submenus for action in item.actions()]
    return found


def no_panel():
    """Wait until no task is open: FreeCAD closes them when it comes to it."""
    wait_for(lambda: not Gui.Control.activeDialog(), "the task's end")


def close_panel():
    """Close the task that is open."""
    Gui.Control.closeDialog()
    no_panel()


def cancel_at_last(opened):
    """Cancel when the thread is through, and the panel has not heard of it yet: wait_for() lets it hear nothing."""
    wait_for(lambda: opened.worker is not None, "the thread")
    opened.worker.join(60)
    opened.reject()
    wait_for(lambda: not opened.working, "cancel")
    assert "ancelled" in opened.message.text() and not opened.closed, opened.message.text()


def tinted(obj, name):
    """Share of a picture of the object alone that has the colour of its operation: the stock's own is nearly grey."""
    Gui.Selection.clearSelection()
    others = [item for item in obj.Document.Objects if item is not obj and item.ViewObject.Visibility
              and not item.hasExtension("App::GroupExtension")]  # which would show all its members in the end
    for other in others:
        other.ViewObject.Visibility = False
    obj.ViewObject.Visibility = True
    path, view = os.path.join(OUT, name), Gui.ActiveDocument.ActiveView
    view.viewIsometric()
    view.fitAll()
    view.saveImage(path, 400, 300, "White")
    for other in others:
        other.ViewObject.Visibility = True
    image = QtGui.QImage(path)
    pixels = [image.pixelColor(x, y) for x in range(400) for y in range(300)]
    return sum(pixel.blue() > pixel.red() + 50 for pixel in pixels) / len(pixels)


def check_colours(obj, picture):
    """What an operation cut has its colour; who switches that off is left alone."""
    assert tinted(obj, picture) > 0.03, "the operation's colour is not seen"
    view = obj.ViewObject
    view.Coloring = False
    obj.FaceColours = colours = obj.FaceColours
    assert tinted(obj, "colourless.png") == 0 and not view.Coloring, "coloured though the user does not want it"
    view.Coloring = True
    assert tinted(obj, picture) > 0.03
    obj.FaceColours = []  # of a mesh that FreeCAD mended
    assert tinted(obj, "colourless.png") == 0, "coloured by what is no more"
    obj.FaceColours = colours
    assert tinted(obj, picture) > 0.03
    obj.Document.recompute()


def close_at_work(opened, start):
    """A panel that is closed by others while its thread works: nothing raises, nothing stays."""
    start()
    wait_for(lambda: opened.worker is not None, "the thread")
    folder = getattr(opened, "folder", None)
    close_panel()
    wait_for(lambda: opened.closed, "the panel's end")
    opened.show_progress(0.5)
    wait_for(lambda: not opened.working, "the thread's end")
    assert folder is None or not os.path.exists(folder.name), "a temporary folder stays"


def check_closed(job, obj):
    """Panels of all kinds closed by others."""
    from freecad.swarf_cam.gui import exporting, measuring, splitting
    from freecad.swarf_cam.gui import task as panel

    undo, path = obj.Document.UndoCount, os.path.join(OUT, "closed.ply")
    opened = panel.show_panel(job)
    opened.voxel.setValue(0.1)
    close_at_work(opened, opened.accept)
    opened = exporting.show_panel(obj)
    close_at_work(opened, lambda: opened.start(path))
    opened = splitting.show_panel(obj)
    opened.each.setChecked(True)
    close_at_work(opened, opened.accept)
    opened = measuring.show_panel(obj)
    close_at_work(opened, lambda: None)
    assert obj.Document.UndoCount == undo


def check_budget(opened):
    """Of the export panel: where it can be asked for, what is said of it and where it cannot be met."""
    opened.budget.setValue(5)
    assert opened.estimate.text().startswith("at most 5 triangles"), opened.estimate.text()
    error = opened.error.value()
    opened.error.setValue(0)
    assert not opened.budget.isEnabled() and opened.chosen_budget == 0 and "about" in opened.estimate.text()
    opened.error.setValue(error)
    assert opened.budget.isEnabled() and opened.chosen_budget == 5
    opened.kind.setCurrentIndex(opened.kind.findData(".step"))
    assert "faces as they were cut" in opened.estimate.text(), opened.estimate.text()
    screenshot("export_step.png")
    opened.kind.setCurrentIndex(opened.kind.findData(".vdb"))
    assert not opened.budget.isEnabled() and "triangles" not in opened.estimate.text()
    opened.kind.setCurrentIndex(opened.kind.findData(".ply"))
    path = os.path.join(OUT, "few.ply")
    opened.start(path)
    wait_for(lambda: not opened.working, "refusal of a budget that cannot be met")
    assert "28 triangles are the fewest" in opened.message.text() and not os.path.exists(path), opened.message.text()
    screenshot("export_budget.png")
    opened.budget.setValue(28)


def outlines():
    """How many panels show the curves of a plane in the 3D view."""
    graph = Gui.ActiveDocument.ActiveView.getSceneGraph()
    return sum(graph.getChild(place).getName().getString() == "SwarfCurves" for place in range(graph.getNumChildren()))


def check_section(obj):
    """The command, wires across the slot in one undoable step, and a plane that misses."""
    from freecad.swarf_cam.gui import sectioning

    document = obj.Document
    Gui.runCommand("Swarf_Section", 0)
    wait_for(lambda: Gui.Control.activeDialog() and outlines() == 1, "the panel")
    screenshot("section_panel.png")
    close_panel()
    opened = sectioning.show_panel(obj)
    assert abs(opened.position.value() + 5) < 1e-3 and "-10" in opened.extent.text(), "the middle of the stock's height"
    wait_for(lambda: opened.curves.count == 1, "the outline in the 3D view")
    opened.position.setValue(-1)
    wait_for(lambda: opened.curves.count == 2, "the outlines of both sides of the slot")
    assert outlines() == 1
    opened.axis.setCurrentIndex(0)
    assert abs(opened.position.value() - 20) < 1e-3, opened.position.value()
    for place in (1, 2, 3, 500):  # the last counts
        opened.position.setValue(place)
    undo, count = document.UndoCount, len(document.Objects)
    opened.accept()
    wait_for(lambda: opened.message.text(), "a plane that misses")
    assert "does not cut" in opened.message.text() and not opened.closed, opened.message.text()
    assert (document.UndoCount, len(document.Objects), opened.curves.count) == (undo, count, 0)
    screenshot("section_missed.png")
    opened.position.setValue(12.5)
    wait_for(lambda: opened.curves.count == 1, "the outline in the 3D view")
    screenshot("section_preview.png")
    opened.accept()
    no_panel()
    assert outlines() == 0, "the panel's outline stays in the 3D view"
    made = document.Objects[-1]
    assert document.UndoCount == undo + 1 and len(made.Shape.Wires) == 1 and made.Shape.Wires[0].isClosed()
    box = made.Shape.BoundBox
    assert abs(box.XMin - 12.5) < 1e-3 and abs(box.XMax - 12.5) < 1e-3
    assert abs(made.Shape.Length - (2 * 20 + 2 * 10 + 2 * 5)) < 1e-2, made.Shape.Length
    Gui.Selection.clearSelection()
    screenshot("section.png")
    document.undo()
    assert len(document.Objects) == count


def check_split(obj):
    """The command, its outline gone with the panel however that closes; parts in one undoable step, and a plane that
    misses."""
    from freecad.swarf_cam.gui import splitting

    document = obj.Document
    undo, count = document.UndoCount, len(document.Objects)
    Gui.runCommand("Swarf_Split", 0)
    wait_for(lambda: outlines() == 1, "the panel")
    close_panel()
    wait_for(lambda: outlines() == 0, "the outline gone with the panel")
    opened = splitting.show_panel(obj)
    opened.position.setValue(20)
    opened.accept()
    wait_for(lambda: not opened.working, "refusal of a plane that misses")
    assert "does not cut" in opened.message.text() and not opened.closed, opened.message.text()
    assert (document.UndoCount, len(document.Objects)) == (undo, count)
    opened.position.setValue(-3)
    opened.each.setChecked(True)
    opened.accept()
    cancel_at_last(opened)
    assert (document.UndoCount, len(document.Objects)) == (undo, count)
    wait_for(lambda: opened.curves.count == 2, "the outlines of both sides of the slot")
    screenshot("split_panel.png")
    opened.accept()
    no_panel()
    made = document.Objects[count:]
    assert document.UndoCount == undo + 1 and len(made) == 3 and not obj.Visibility
    assert all(part.Mesh.isSolid() for part in made)
    assert abs(sum(part.Mesh.Volume for part in made) - obj.Mesh.Volume) < 1e-3 * obj.Mesh.Volume
    assert len({part.ViewObject.ShapeColor for part in made}) == 3 and outlines() == 0
    Gui.Selection.clearSelection()
    screenshot("split.png")
    document.undo()
    assert len(document.Objects) == count and obj.Visibility


def check_agreed(obj):
    """The plane at which OK is pressed is the one that is added, wherever it is moved while its curves are looked for;
    none is when they cannot be found."""
    from freecad.swarf_cam.gui import sectioning

    def fail(point, normal):
        raise ValueError("no curves")

    document = obj.Document
    count = len(document.Objects)
    opened = sectioning.show_panel(obj)
    wait_for(lambda: opened.found is not None, "the outline")
    opened.position.setValue(-1.94)
    opened.accept()
    opened.position.setValue(-2)
    no_panel()
    made, = document.Objects[count:]
    assert abs(made.Shape.BoundBox.ZMin + 1.94) < 1e-3, made.Shape.BoundBox
    document.undo()
    opened = sectioning.show_panel(obj)
    wait_for(lambda: opened.found is not None, "the outline")
    opened.body.section = fail
    opened.position.setValue(-1)
    opened.accept()
    wait_for(lambda: "no curves" in opened.message.text(), "an error")
    del opened.body.section
    opened.position.setValue(-1.5)
    wait_for(lambda: opened.closed or opened.found[0] == opened.plane, "the outline")
    assert not opened.closed and len(document.Objects) == count, "added though nobody agreed to it"
    opened.reject()
    no_panel()


def check_followed(obj):
    """Panels follow the stock: to another mesh and back, and with the part that it is in."""
    from freecad.swarf_cam.gui import measuring, sectioning, splitting

    document = obj.Document
    undo, count = document.UndoCount, len(document.Objects)

    def change(mesh):
        document.openTransaction("Change")
        obj.Mesh = mesh
        document.commitTransaction()

    box = Mesh.createBox(10.0, 10.0, 4.0)
    opened = sectioning.show_panel(obj)
    assert "between -10" in opened.extent.text()
    change(box)
    wait_for(lambda: "between -2" in opened.extent.text(), "the other mesh")
    document.undo()
    wait_for(lambda: "between -10" in opened.extent.text(), "the mesh of before")
    part = document.addObject("App::Part", "Raised")
    part.Placement.Base.z = 50
    part.addObject(obj)
    document.recompute()
    wait_for(lambda: "between 40" in opened.extent.text(), "the part's place")
    opened.position.setValue(49)
    wait_for(lambda: opened.curves.count == 2, "the outlines of both sides of the slot")
    assert {place[2] for line in opened.found[1] for place in line} == {49}
    Gui.SendMsgToActiveView("ViewFit")
    screenshot("section_in_part.png")
    part.removeObject(obj)
    document.removeObject(part.Name)
    document.recompute()
    wait_for(lambda: "between -10" in opened.extent.text(), "the stock where it was")
    opened.reject()
    no_panel()
    while document.UndoCount > undo:
        document.undo()

    opened = splitting.show_panel(obj)
    opened.position.setValue(-1)
    opened.accept()
    change(box)
    wait_for(lambda: not opened.working, "the split")
    assert "changed meanwhile" in opened.message.text() and len(document.Objects) == count, opened.message.text()
    opened.accept()
    no_panel()
    made = document.Objects[count:]
    assert [round(part.Mesh.Volume) for part in made] == [100, 300], "of the mesh of before"
    document.undo()
    many = Mesh.Mesh()
    for number in range(splitting.MOST_PIECES // 2 + 1):
        other = Mesh.createBox(1.0, 1.0, 1.0)
        other.translate(2.0 * number, 0, 0)
        many.addMesh(other)
    document.undo()
    change(many)
    opened = splitting.show_panel(obj)
    opened.position.setValue(0)
    opened.each.setChecked(True)
    opened.accept()
    wait_for(lambda: not opened.working, "refusal of too many pieces")
    assert "these are 102 pieces, of which at most 100" in opened.message.text(), opened.message.text()
    screenshot("split_many.png")
    opened.reject()
    no_panel()
    document.undo()

    opened = measuring.show_panel(obj)
    for _ in range(2):  # while it measures, and after
        change(box)
        opened.follow()
        wait_for(lambda: not opened.working, "the measures")
        assert opened.table.item(0, 1).text() == "400 mm³", opened.table.item(0, 1).text()
        document.undo()
        opened.follow()
        wait_for(lambda: not opened.working, "the measures of before")
        assert opened.table.item(0, 1).text() == "6800 mm³", opened.table.item(0, 1).text()
    opened.reject()
    no_panel()
    assert (document.UndoCount, len(document.Objects)) == (undo, count)


def check_no_place(obj):
    """Without a folder of temporary files there is no panel, and one line that says why."""
    from freecad.swarf_cam.gui import measuring, sectioning, splitting

    usual, tempfile.tempdir = tempfile.tempdir, os.path.join(OUT, "no", "folder")
    try:
        for kind in (sectioning, splitting, measuring):
            assert kind.show_panel(obj) is None and not Gui.Control.activeDialog()
    finally:
        tempfile.tempdir = usual


def check_gone(samples, simulation):
    """Panels of a simulation that is deleted, or whose document is closed, go with it."""
    from freecad.swarf_cam.gui import measuring, sectioning, splitting

    name = FreeCAD.ActiveDocument.Name
    for kind in (sectioning, splitting, measuring):
        document = FreeCAD.newDocument("gone")
        job = samples.make_job(document)
        document.recompute()
        for end in (lambda: document.removeObject(obj.Name), lambda: FreeCAD.closeDocument(document.Name)):
            obj = simulation.simulate(simulation.make(job, 1.0))
            opened = kind.show_panel(obj)
            wait_for(lambda: not opened.working and (kind is measuring or opened.found), "the panel's first look")
            end()
            opened.accept()  # at once
            assert opened.closed, kind
            no_panel()
        document = FreeCAD.newDocument("gone")
        job = samples.make_job(document)
        document.recompute()
        opened = kind.show_panel(simulation.simulate(simulation.make(job, 1.0)))
        FreeCAD.closeDocument(document.Name)
        wait_for(lambda: opened.closed, "the panel's end")
        no_panel()
    FreeCAD.setActiveDocument(name)


def check_measure(obj):
    """The command, its table, and the sheet that is made of it."""
    from freecad.swarf_cam.gui import measuring

    document = obj.Document
    undo, count = document.UndoCount, len(document.Objects)
    Gui.runCommand("Swarf_Measure", 0)
    wait_for(lambda: Gui.Control.activeDialog(), "the panel")
    close_panel()  # while it measures
    opened = measuring.show_panel(obj)
    assert not opened.put.isEnabled()
    wait_for(lambda: not opened.working, "the measures")
    table = opened.table
    assert opened.put.isEnabled() and [opened.shell.itemText(k) for k in (0, 1)] == ["Whole", "Piece 1"]
    rows = [(table.item(k, 0).text().strip(), table.item(k, 1).text() if table.item(k, 1) else None)
            for k in range(table.rowCount())]
    assert rows[0] == ("Volume", "6800 mm³") and ("Holes through it", "0") in rows, rows
    assert rows[4:8] == [("Size, mm", None), ("X", "40.0000"), ("Y", "20.0000"), ("Z", "10.0000")], rows
    for label, value in rows:
        width = sum(table.fontMetrics().boundingRect(text or "").width() for text in (label, value))
        assert width < table.viewport().width() - 20, "%s %s is not seen" % (label, value)
    opened.shell.setCurrentIndex(1)
    assert "Thinnest wall" in [label for label, _ in rows] and table.rowCount() == len(rows) - 5
    opened.shell.setCurrentIndex(0)
    screenshot("measures.png")
    opened.put.click()
    sheet, = document.Objects[count:]
    assert document.UndoCount == undo + 1 and sheet.TypeId == "Spreadsheet::Sheet" and sheet.Label in \
        opened.message.text(), opened.message.text()
    sheet.ViewObject.doubleClicked()
    screenshot("measures_sheet.png")
    opened.reject()
    no_panel()
    document.undo()
    assert len(document.Objects) == count


def check_export(obj):
    """The panel, its estimates, a coloured file, and an error told in it."""
    from freecad.swarf_cam.gui import exporting

    Gui.runCommand("Swarf_Export", 0)
    wait_for(lambda: Gui.getMainWindow().findChild(QtWidgets.QWidget, "SwarfExportPanel") is not None, "the panel")
    screenshot("export.png")
    close_panel()
    opened = exporting.show_panel(obj)
    opened.kind.setCurrentIndex(opened.kind.findData(".ply"))
    opened.colour.setCurrentIndex(opened.colour.findData("operation"))
    assert "about" in opened.estimate.text() and "triangles" in opened.estimate.text()
    check_budget(opened)
    opened.start(os.path.join(OUT, "no", "folder.ply"))
    wait_for(lambda: not opened.working, "a folder that is not there")
    assert "folder.ply" in opened.message.text(), opened.message.text()
    shape = os.path.join(OUT, "stock.brep")
    opened.start(shape)
    cancel_at_last(opened)
    assert not os.path.exists(shape)
    path = os.path.join(OUT, "stock.ply")
    opened.start(path)
    wait_for(lambda: opened.closed, "export")
    with open(path, "rb") as file:
        assert b"red" in file.read(600)
    no_panel()


def check_next(document, first):
    """The panel of a second job offers what the first one left, and how it may lie."""
    import samples
    from freecad.swarf_cam.app import setups, simulation
    from freecad.swarf_cam.gui import commands, task as panel

    controller = samples.add_controller(document, 1, samples.end_mill(), CuttingEdgeHeight=20.0)
    across = samples.add_operation(document, "Across", controller, "G0 X15 Y-5 Z-3", "G1 Y25 F10")
    job = samples.make_job(document, [across], [controller], design=False)
    document.recompute()
    opened = panel.show_panel(job)
    assert opened.stock.source.count() == 2 and not opened.stock.lie.isEnabled()
    opened.stock.source.setCurrentIndex(1)
    opened.stock.lie.setCurrentIndex(opened.stock.lie.findData("X"))
    assert opened.voxel.value() == first.VoxelSize.Value
    screenshot("next.png")
    opened.accept()
    wait_for(lambda: opened.closed, "the second set-up")
    no_panel()
    assert setups.previous_of(job) is first
    second, = [item for item in document.Objects if simulation.is_simulation(item) and item is not first]
    assert second.UpToDate and abs(second.VolumeInitial.Value - first.VolumeFinal.Value) < 1
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(document.Name, first.Name)
    assert commands.chosen_job() is first.Job, "the simulation's own job, not the one that cuts its result"
    Gui.Selection.clearSelection()
    mine, first.Job = first.Job, None
    opened = panel.show_panel(job, second, start=True)
    wait_for(lambda: not opened.working, "refusal of a set-up that is gone")
    assert "no job" in opened.message.text() and opened.stock.lie.count() == 1, opened.message.text()
    assert setups.previous_of(job) is first, "nobody wanted another stock"
    screenshot("lost.png")
    opened.close()
    first.Job = mine
    for hidden in (job.Stock, *job.Tools.Group, first):
        hidden.ViewObject.Visibility = False
    screenshot("second.png")
    document.undo()
    document.undo()
    assert setups.previous_of(job) is None
    for obj in (job, across):
        document.removeObject(obj.Name)


def check():
    """All of it, in the order of a user."""
    import samples
    from freecad.swarf_cam import native
    from freecad.swarf_cam.app import simulation
    from freecad.swarf_cam.gui import task as panel

    assert "SwarfWorkbench" in Gui.listWorkbenches()
    assert {"Swarf_Simulate", "Swarf_Update"} <= set(Gui.listCommands())
    document = FreeCAD.newDocument("gui")
    document.UndoMode = 1
    job = samples.make_job(document)
    document.recompute()
    Gui.activateWorkbench("SwarfWorkbench")
    wait_for(lambda: "Simulate milling" in menu_texts(), "the workbench's menu")
    assert native.is_available(), "the native module is not on the path"
    Gui.ActiveDocument.ActiveView.viewIsometric()
    Gui.SendMsgToActiveView("ViewFit")

    Gui.Selection.addSelection(document.Name, job.Name)
    Gui.runCommand("Swarf_Simulate", 0)
    wait_for(lambda: Gui.getMainWindow().findChild(QtWidgets.QWidget, "SwarfSimulationPanel") is not None, "the panel")
    screenshot("panel.png")
    close_panel()

    opened = panel.show_panel(job)
    opened.voxel.setValue(0.0001)  # hundreds of terabytes
    opened.accept()
    wait_for(lambda: not opened.working, "refusal of a voxel that needs too much memory")
    screenshot("refused.png")
    assert opened.message.text(), "no message for a voxel that needs too much memory"
    assert not [obj for obj in document.Objects if simulation.is_simulation(obj)]

    opened.voxel.setValue(0.04)
    opened.accept()
    opened.reject()  # before the first slice of reading
    assert not opened.working and not opened.closed
    assert not [obj for obj in document.Objects if simulation.is_simulation(obj)], "cancelled, but not undone"
    opened.voxel.setValue(0.2)
    undo = document.UndoCount
    opened.accept()
    cancel_at_last(opened)
    assert document.UndoCount == undo and len(document.findObjects("Mesh::FeaturePython")) == 0
    opened.accept()
    wait_for(lambda: opened.closed, "simulation")
    assert document.UndoCount == undo + 1, "not one transaction"
    no_panel()

    obj, = [item for item in document.Objects if simulation.is_simulation(item)]
    assert obj.UpToDate and obj.VolumeRemoved.Value > 400, obj.VolumeRemoved
    assert obj.ViewObject.Proxy.getIcon().endswith("swarf.svg")
    for hidden in (job.Stock, *job.Model.Group, *(tc.Tool for tc in job.Tools.Group)):
        hidden.ViewObject.Visibility = False
    Gui.Selection.clearSelection()
    Gui.SendMsgToActiveView("ViewFit")
    screenshot("result.png")
    check_colours(obj, "colours.png")

    job.Operations.Group[0].Path = samples.path_of("G0 X-5 Y10 Z-5", "G1 X45 F10")
    document.recompute()
    assert not obj.UpToDate
    assert obj.ViewObject.Proxy.getIcon().endswith("swarf-outdated.svg")
    screenshot("outdated.png")
    Gui.Selection.addSelection(document.Name, obj.Name)
    Gui.runCommand("Swarf_Update", 0)
    wait_for(lambda: obj.UpToDate, "update")
    no_panel()
    assert obj.VolumeRemoved.Value > 1000, obj.VolumeRemoved
    for name, change in (("undone", document.undo), ("redone", document.redo)):
        change()
        assert tinted(obj, name + ".png") > 0.03, name
    Gui.Selection.addSelection(document.Name, obj.Name)

    check_export(obj)
    Gui.Selection.addSelection(document.Name, obj.Name)
    check_section(obj)
    check_split(obj)
    check_measure(obj)
    check_closed(job, obj)
    check_agreed(obj)
    check_followed(obj)
    check_no_place(obj)
    check_gone(samples, simulation)
    check_next(document, obj)

    cam = "CAMWorkbench" if "CAMWorkbench" in Gui.listWorkbenches() else "PathWorkbench"
    Gui.activateWorkbench(cam)
    wait_for(lambda: "Simulate milling" in menu_texts(), "the command in the menu of " + cam)
    screenshot("cam.png")

    path = os.path.join(OUT, "gui.FCStd")
    document.saveAs(path)
    FreeCAD.closeDocument(document.Name)
    document = FreeCAD.openDocument(path)
    live()
    obj, = [item for item in document.Objects if simulation.is_simulation(item)]
    assert type(obj.ViewObject.Proxy).__name__ == "SimulationView" and obj.ViewObject.CreaseAngle == 25
    assert obj.UpToDate and obj.ViewObject.Proxy.getIcon().endswith("swarf.svg")
    assert tinted(obj, "reopened.png") > 0.03, "no colours in a document that was opened"


start(check)
