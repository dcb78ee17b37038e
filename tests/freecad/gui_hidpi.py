# SPDX-License-Identifier: LGPL-2.1-or-later
"""The live panel on a screen of twice the density (see run): as many pixels as the screen has, nothing out of place."""

import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "inside")]

from gui_support import QtWidgets, screenshot, start, wait_for  # noqa: E402
from panel_support import PanelTest, click, new_job  # noqa: E402


class Dense(PanelTest):
    """What depends on the density."""

    def pixels(self):
        """The picture has the screen's own pixels; places in it are the widget's."""
        panel, view = self.panel, self.panel.view
        ratio = view.devicePixelRatioF()  # QT_SCALE_FACTOR times what Qt makes of the screen
        assert ratio >= 2.0, ratio
        panel.player.seek(panel.transport.end)
        self.turn("2")
        self.settle()
        assert (view.frame.width, view.frame.height) == (int(ratio * view.width()), int(ratio * view.height()))
        x, y, _ = view.camera.project((54, 25, -3), view.aspect())
        panel.picking.found = None
        click(view, (x + 1) / 2 * view.width(), (1 - y) / 2 * view.height())
        wait_for(lambda: panel.picking.found is not None, "the answer to a click")
        assert panel.findChild(QtWidgets.QLabel, "SwarfPoint-operation").text() == "Wave"
        panel.tools.set_colouring("deviation")
        self.settle()
        for page in (panel.operations, panel.findings, panel.deviation, panel.setup):
            panel.tabs.setCurrentWidget(page)
            screenshot("dense-%s.png" % page.objectName())


def check():
    """All of it."""
    test = Dense()
    document, job = new_job("dense")
    test.run((test.open, document, job), (test.pixels,))


start(check)
