# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bad moments in the live panel (see run): each ends in a message and a panel that can be used."""

import os
import sys

import FreeCAD

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "inside")]

from gui_support import QtCore, pump, screenshot, start, wait_for  # noqa: E402
from panel_support import PanelTest, new_job  # noqa: E402


class Moments(PanelTest):
    """The checks in the order of a user."""

    def bad_moments(self, document, job):
        """Each ends in a message and a panel that can be used."""
        import samples

        panel, banner = self.panel, self.panel.banner
        panel.player.seek(0)
        panel.player.set_speed(1.0)
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
        panel.opening.reload()
        panel.close()  # while it works
        pump(0.5)
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

    def closing(self):
        """The document goes while the panel plays."""
        panel = self.panel
        document, job = new_job("second")
        self.open(document, job)
        panel.player.set_speed(1.0)
        self.button("play")
        pump(0.3)
        FreeCAD.closeDocument(document.Name)
        wait_for(lambda: panel.banner.isVisible() and "closed" in panel.banner.text.text(), "the notice of closing")
        pump(0.3)
        screenshot("panel-closed.png")


def check():
    """All of it."""
    test = Moments()
    document, job = new_job("moments")
    test.run((test.open, document, job), (test.bad_moments, document, job), (test.closing,))
    # FreeCAD closes while it plays
    document, job = new_job("third")
    test.open(document, job)
    test.button("play")
    pump(0.2)


start(check)
