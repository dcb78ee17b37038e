# SPDX-License-Identifier: LGPL-2.1-or-later
"""How long the panel takes in the real GUI (see run, tests/bench/run_panel): a whole program from pressing the button
to the final sharp picture, FreeCAD's own work on the job included. $SWARF_BENCH_PROGRAM is the file of G-code,
$SWARF_BENCH_RESOLUTION voxels along the stock's longest edge; bear.json goes to $SWARF_GUI_OUT."""

import json
import os
import sys
import time

import FreeCAD
import FreeCADGui as Gui

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "inside")]

from gui_support import OUT, QtCore, QtWidgets, screenshot, start, wait_for  # noqa: E402

RUNS = 3


def make_job(document, program):
    """A block of 80 x 80 x 20 mm, an end mill of 3 mm, and the program as a Path object would have it."""
    import Part
    import Path
    import samples

    with open(program, encoding="ascii") as file:
        lines = [line.strip() for line in file]
    mill = samples.add_controller(document, 1, samples.end_mill(3.0, 18.0, 12.0), "Mill3", CuttingEdgeHeight=18.0)
    operation = samples.add_operation(document, "Bear", mill)
    state, commands = {}, []
    for line in lines:
        command = Path.Command()
        command.setFromGCode(line if line[:1] in "GM" else "%s%s" % (state.get("name", "G0"), line))
        if command.Name in ("G0", "G1"):
            state["name"] = command.Name
            words = dict(command.Parameters)
            if "F" in words:
                words["F"] /= 60.0  # a Path object has mm/s
            commands.append(Path.Command(command.Name, {key: words[key] for key in words if key in "XYZF"}))
    operation.Path = Path.Path(commands)
    return samples.make_job(document, [operation], [mill], Part.makeBox(80, 80, 20, FreeCAD.Vector(0, 0, -20)), False)


class LongestWait(QtCore.QObject):
    """How long the event loop did not come round, at most: a timer of 5 ms is looked at."""

    def __init__(self):
        super().__init__()
        self.longest, self._last = 0.0, time.monotonic()
        self._timer = QtCore.QTimer(self)
        self._timer.timeout.connect(self._tick)
        self._timer.start(5)

    def _tick(self):
        now = time.monotonic()
        self.longest, self._last = max(self.longest, now - self._last), now


def measure(document, job):
    """One run: seconds from the press of the button."""
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(document.Name, job.Name)
    waits, begin = LongestWait(), time.monotonic()
    Gui.runCommand("Swarf_Live", 0)
    times = {"returned": time.monotonic() - begin}
    panel = Gui.getMainWindow().findChild(QtWidgets.QDockWidget, "SwarfLive")

    def until(name, condition):
        while not condition():
            QtWidgets.QApplication.processEvents(QtCore.QEventLoop.AllEvents, 20)
            time.sleep(0.002)
        times[name] = time.monotonic() - begin
    until("opened", lambda: panel.session is not None)
    until("first picture", lambda: panel.view.frame is not None)
    until("whole, sharp", lambda: panel.view.frame.sharp and panel.view.frame.place == panel.transport.end)
    times["longest wait of the event loop"] = waits.longest
    assert panel.banner.isHidden(), panel.banner.text.text()
    screenshot("bear.png")
    wait_for(lambda: not panel.checking.running, "the checks")
    times["checked"] = time.monotonic() - begin
    panel.close()
    wait_for(lambda: panel.opening.ended, "the engine's end")
    return times


def check():
    """The runs, one document."""
    from freecad.swarf_cam.gui import settings

    settings.set_flag("AutoPlay", True)
    settings.set_speed(0.0)
    settings.set_resolution(int(os.environ["SWARF_BENCH_RESOLUTION"]))
    document = FreeCAD.newDocument("bear")
    job = make_job(document, os.environ["SWARF_BENCH_PROGRAM"])
    document.recompute()
    Gui.activateWorkbench("SwarfWorkbench")
    runs = [measure(document, job) for _ in range(RUNS)]
    with open(os.path.join(OUT, "bear.json"), "w", encoding="ascii") as file:
        json.dump(runs, file, indent=1)


start(check)
