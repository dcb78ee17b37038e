# SPDX-License-Identifier: LGPL-2.1-or-later
"""A click on the stock: asks the engine what made the point, and shows the answer in the lists and in FreeCAD's
tree. A click in a list shows there as well."""

import FreeCAD
import FreeCADGui as Gui

from ...core import clock as clocks
from .. import numbers

translate = FreeCAD.Qt.translate


class Picking:
    """The panel's clicks. found: the session.Picked that is shown, None for none."""

    def __init__(self, panel):
        self._panel = panel
        self.found = None

    def close_job(self):
        """Forget the point."""
        self.found = None
        self._panel.inspector.show_values(None)

    def pick(self, x, y):
        """Tell what made the point at a place of the picture, as it is seen; what plays halts at that picture."""
        panel, frame = self._panel, self._panel.view.frame
        if panel.session is None or frame is None:
            return
        if panel.transport.playing:
            panel.player.seek(frame.place)
        panel.opening.call(lambda session, progress: session.pick(frame.view, x, y, frame.place, progress),
                           self._answered)

    def _answered(self, found, error):
        panel = self._panel
        if error is not None:
            panel.fail(error)
            return
        if panel.transport.playing:  # again: what was clicked is being cut
            return
        self.found = found
        panel.view.set_mark(found.point if found else None)
        panel.player.select(found.line if found and found.move >= 0 else None)
        if found is None:
            panel.inspector.show_values(None)
            return
        panel.inspector.show_values(self._values(panel.session, found))
        if found.move >= 0:
            panel.program.set_current(found.line)
            panel.operations.set_current(found.operation)
            self.select_operation(found.operation)
        panel.tabs.setCurrentWidget(panel.inspector)

    @staticmethod
    def _values(session, found):
        """Texts of the inspector's rows."""
        values = {"point": "X %s  Y %s  Z %s" % tuple(numbers.text(value, 3) for value in found.point),
                  "depth": numbers.text(found.depth_below_top, 3) + " mm",
                  "slope": numbers.text(found.slope_deg, 1) + "°", "hint": ""}
        if found.deviation is not None:
            values["deviation"] = numbers.deviation(found.deviation) + " mm"
        if found.move < 0:
            values["hint"] = translate("Swarf", "The stock as it was: nothing was cut here yet.")
        else:
            listing = session.listing
            number = abs(listing.number[found.line])
            values.update(operation=listing.operations[found.operation].name,
                          line="%d: %s" % (number, listing.text(found.line)),
                          tool="T%d %s" % (found.tool, session.data.tools.get(found.tool, ("",))[0]),
                          time=clocks.text_of(session.clock.time_of(found.move)))
        return values

    def select_line(self, line):
        """Select the operation of a line in FreeCAD's tree."""
        if self._panel.session is not None:
            self.select_operation(self._panel.session.listing.operation[line])

    def select_operation(self, operation):
        """Select an operation in FreeCAD's tree."""
        if self._panel.session is None:
            return
        obj = self._panel.document_object(self._panel.session.listing.operations[operation].source)
        if obj is not None:
            Gui.Selection.clearSelection()
            Gui.Selection.addSelection(obj)
