# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs the checks of the job that is watched, in a thread of their own, and shows what they find: in the list, on the
time line, in the tab's title."""

import FreeCAD

from ... import checks
from ...core import findings as model
from ...core.transport import STOP_FINDING
from .. import colours, settings
from ..qt import QtCore
from ..worker import Worker

translate = FreeCAD.Qt.translate


# Milliseconds without another tolerance before it is checked with the new one.
QUIET_MS = 700

# Milliseconds after opening at which checks begin at the latest.
FIRST_MS = 5000

# Worst places that are shown as pins.
PINS = 8


class Checking:
    """One run at a time. found: the core Findings that are shown."""

    def __init__(self, panel):
        self._panel = panel
        self._worker = None
        self._old = []
        self.found = []
        panel.findings.chosen.connect(self._go_to)
        panel.findings.run_pressed.connect(self._pressed)
        self._later = QtCore.QTimer(panel)
        self._later.setSingleShot(True)
        self._later.setInterval(QUIET_MS)
        self._later.timeout.connect(self.start)
        self._first = QtCore.QTimer(panel)
        self._first.setSingleShot(True)
        self._first.setInterval(FIRST_MS)
        self._first.timeout.connect(self.start)

    @property
    def running(self):
        """Whether checks go on."""
        return self._worker is not None

    @property
    def pending(self):
        """Whether checks go on or will begin by themselves."""
        return self.running or self._first.isActive() or self._later.isActive()

    def open(self, session):
        """A job was opened: what its simulation noticed; the rest follows."""
        self._panel.findings.show_checked("")
        self._show(model.from_overview(session.overview.findings, session.listing))
        if settings.flag("AutoCheck"):
            self._first.start()

    def picture_came(self, frame):
        """Checks begin by themselves once the first good picture is there: it comes sooner without them."""
        if frame.sharp and self._first.isActive():
            self._first.stop()
            self.start()

    def start_soon(self):
        """Check again, when the last call of this was a while ago."""
        if self.found or self.running or settings.flag("AutoCheck"):
            self._later.start()

    def close_job(self):
        """Nothing is watched any more."""
        self._later.stop()
        self._first.stop()
        self.cancel()
        self._old += [self._worker] if self._worker is not None else []
        self._worker, self.found = None, []
        self._panel.findings.show_findings((), {}, None)
        self._panel.view.pins = []
        self._panel.findings.show_checked("")
        self._show_title()

    def start(self):
        """Check, from the beginning when checks go on; returns at once."""
        panel, session = self._panel, self._panel.session
        if session is None:
            return
        self._first.stop()
        if self._worker is not None:
            self.cancel()
            self._old.append(self._worker)
        tolerance = settings.tolerance()
        # Qt keeps no worker alive: the closures do, until its end was told.
        worker = Worker(lambda progress: checks.run(session.job, session.voxel_mm, tolerance, progress),
                        lambda fraction: panel.findings.show_progress(fraction) if worker is self._worker else None,
                        lambda found, error: self._end(worker, session, found, error))
        self._worker = worker
        panel.findings.show_running(translate("Swarf", "Checking ..."))
        self._show_title()
        worker.start()

    def cancel(self):
        """Break it off."""
        if self._worker is not None:
            self._worker.cancel()

    def join(self, seconds):
        """Wait for the threads."""
        for worker in [*self._old, *([self._worker] if self._worker is not None else [])]:
            worker.join(seconds)

    def _pressed(self):
        if self.running:
            self.cancel()
        else:
            self.start()

    def _end(self, worker, session, found, error):
        if worker is not self._worker:
            self._old.remove(worker)
            return
        self._worker = None
        panel = self._panel
        if error is None:
            self._show(model.from_verdicts(found, session.listing))
            text = translate("Swarf", "Checked") if found else translate("Swarf", "Checked: nothing was found")
            if session.job.design is None:
                text = translate("Swarf", "Checked, without a model to compare with")
        else:
            text = translate("Swarf", "Cancelled.") if panel.is_cancelled(error) else str(error)
        panel.findings.show_checked(text)
        self._show_title()

    def _show(self, found):
        panel, self.found = self._panel, found
        marks = model.marks(found)
        worst = {finding: number for number, finding in enumerate(model.worst_places(found, PINS), 1)}
        panel.findings.show_findings(found, worst, panel.session.listing)
        panel.view.pins = [(finding.point, str(number), colours.FINDINGS[finding.severity])
                           for finding, number in worst.items()]
        panel.view.update()
        panel.timeline.set_findings(marks)
        panel.transport.stops = dict(panel.session.stops, **{STOP_FINDING: sorted({place for place, _, _ in marks})})
        self._show_title()

    def _show_title(self):
        tabs, page = self._panel.tabs, self._panel.findings
        count = model.counts(self.found)
        serious = count["error"] + count["warning"]
        text = translate("Swarf", "Findings")
        text += " …" if self.running else " (%d)" % serious if serious else ""
        tabs.setTabText(tabs.indexOf(page), text)
        worst = next((severity for severity in model.SEVERITIES if count[severity]), None)
        tabs.setTabIcon(tabs.indexOf(page), page.icon(worst))

    def _go_to(self, finding):
        """Stand where it happens and look at it."""
        panel = self._panel
        if panel.session is None:
            return
        if finding.place is not None:
            panel.player.seek(finding.place, finding.line if finding.line >= 0 else None, finding.point)
        else:
            panel.view.set_mark(finding.point)
        if finding.point is not None:
            panel.view.fly_to(finding.point)
