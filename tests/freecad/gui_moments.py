# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bad moments in the live panel (see run): each ends in a message and a panel that can be used."""

import os
import sys
import types

import FreeCAD

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "inside")]

from gui_support import live, screenshot, start, wait_for  # noqa: E402
from panel_support import PanelTest, new_job  # noqa: E402


def samples_path(*lines):
    """A Path of lines."""
    import samples

    return samples.path_of(*lines)


class Moments(PanelTest):
    """The checks in the order of a user."""

    def bad_moments(self, document, job):
        """Each ends in a message and a panel that can be used."""
        import samples

        panel, banner = self.panel, self.panel.banner
        panel.player.seek(0)
        panel.player.set_speed(1.0)
        self.button("play")
        wait_for(lambda: panel.transport.at > 0, "playing")
        document.getObject("Wave").Path = samples.path_of("G0 Z5", "G0 X44 Y10", "G1 Z-4 F5", "G1 X74 F10")
        document.recompute()
        wait_for(lambda: banner.isVisible() and "changed" in banner.text.text(), "the notice of an edit")
        assert panel.transport.playing, "an edit stopped playing"
        screenshot("panel-edited.png")
        banner.action.click()
        wait_for(lambda: panel.session is not None, "reading again")
        self.settle()
        document.getObject("Tool").Shape = samples.end_mill(8)
        wait_for(lambda: banner.isVisible() and "changed" in banner.text.text(), "the notice of another tool")
        panel.opening.reload()
        panel.close()  # while it works
        wait_for(lambda: panel.opening.ended, "the engine's end")
        self.open(document, job)
        document.removeObject(job.Name)
        document.recompute()
        wait_for(lambda: banner.isVisible() and "deleted" in banner.text.text(), "the notice of deleting")
        panel.player.seek(panel.transport.end)
        self.settle(panel.transport.end)
        screenshot("panel-deleted.png")
        panel.opening.reload()
        assert banner.isVisible()

    def reading(self, document, job):
        """Things happen while the job is read, which is between the events: the first slice is still to come."""
        panel, banner, opening = self.panel, self.panel.banner, self.panel.opening
        opening.watch(job)
        assert banner.working and "Reading" in banner.text.text() and panel.session is None
        banner.action.click()
        assert "ancelled" in banner.text.text() and not banner.working
        banner.action.click()
        wait_for(lambda: panel.session is not None, "opening after all")
        opening.watch(job)
        document.getObject("Wave").Path = samples_path("G0 Z5", "G0 X44 Y10", "G1 Z-2 F5", "G1 X70 F10")
        document.recompute()
        wait_for(lambda: panel.session is not None and not opening.comparing, "opening")
        wave = panel.session.listing.operations[2]
        assert dict(wave.commands[-1].Parameters)["X"] == 70.0, "what is shown is what the document has"
        assert banner.isHidden(), banner.text.text()
        opening.watch(job)
        panel.close()
        wait_for(lambda: opening.ended, "the engine's end")
        assert panel.session is None
        self.open(document, job)
        panel.findings.run.click()
        panel.close()  # while it checks
        wait_for(lambda: opening.ended, "the engine's end")
        self.open(document, job)

    def memory(self):
        """It ends while the stock is cut, drawn, or checked: a message, and the panel can be used."""
        panel, banner, session = self.panel, self.panel.banner, self.panel.session
        panel.player.seek(0)
        self.settle(0.0)

        def no_memory(*_, **__):
            raise MemoryError("a block of 1 GiB cannot be had")
        session.step = no_memory
        panel.player.set_speed(0.0)
        self.button("play")
        wait_for(lambda: banner.isVisible() and "emory" in banner.text.text(), "the message")
        assert not panel.transport.playing and panel.tabs.currentWidget() is panel.accuracy
        screenshot("panel-no-memory.png")
        del session.step
        panel.player.seek(5)
        self.settle(5.0)
        from freecad.swarf_cam import checks
        from freecad.swarf_cam.gui.panel import dock

        drawn, told, console = [], [], dock.FreeCAD
        dock.FreeCAD = types.SimpleNamespace(Console=types.SimpleNamespace(PrintError=told.append))
        session.draw = lambda *_, **__: (drawn.append(None), no_memory())
        banner.done()
        for text in "120":
            before = len(drawn)
            self.turn(text)
            wait_for(lambda: len(drawn) > before, "a picture of another view")
        wait_for(lambda: banner.isVisible() and "emory" in banner.text.text(), "the message")
        live()
        assert len(told) == 1, "the report view says it once, not with each picture: %s" % told
        del session.draw
        dock.FreeCAD = console
        run, checks.run = checks.run, no_memory
        panel.findings.run.click()
        wait_for(lambda: not panel.checking.running, "the end of the checks")
        checks.run = run
        assert "1 GiB" in panel.findings.state.text()
        panel.opening.reload()
        self.opened()
        self.checked()
        assert panel.checking.outcome is not None

    def gone(self):
        """The job or its document goes while the job is read."""
        panel, banner = self.panel, self.panel.banner
        document, job = new_job("gone")
        panel.opening.watch(job)
        document.removeObject(job.Name)
        wait_for(lambda: banner.isVisible() and "deleted while" in banner.text.text(), "the notice of deleting")
        FreeCAD.closeDocument(document.Name)
        document, job = new_job("gone")
        panel.opening.watch(job)
        FreeCAD.closeDocument(document.Name)
        wait_for(lambda: banner.isVisible() and "closed" in banner.text.text(), "the notice of closing")
        wait_for(lambda: panel.opening.ended, "the engine's end")
        assert panel.session is None and not banner.working

    def closing(self):
        """The document goes while the panel plays."""
        panel = self.panel
        document, job = new_job("second")
        self.open(document, job)
        panel.player.set_speed(1.0)
        self.button("play")
        wait_for(lambda: panel.transport.at > 0, "playing")
        FreeCAD.closeDocument(document.Name)
        wait_for(lambda: panel.banner.isVisible() and "closed" in panel.banner.text.text(), "the notice of closing")
        screenshot("panel-closed.png")


def check():
    """All of it."""
    test = Moments()
    document, job = new_job("moments")
    test.run((test.open, document, job), (test.reading, document, job), (test.memory,),
             (test.bad_moments, document, job), (test.gone,),
             (test.closing,))
    # FreeCAD closes while it plays
    document, job = new_job("third")
    test.open(document, job)
    test.button("play")
    wait_for(lambda: test.panel.transport.at > 0, "playing")


start(check)
