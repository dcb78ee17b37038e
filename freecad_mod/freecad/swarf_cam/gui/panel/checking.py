# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs the checks of the job that is watched, in a thread of their own, and shows what they find: in the list, on the
time line, in the tab's title, as pins, in the histogram."""

import FreeCAD

from ... import checks, native
from ...app import accepted
from ...core import findings as model
from ...core.errors import JobError
from ...core.transport import STOP_FINDING
from .. import colours, numbers, settings
from ..qt import QtCore
from ..worker import Worker

translate = FreeCAD.Qt.translate


# Milliseconds without another tolerance before it is judged by the new one.
QUIET_MS = 300

# Milliseconds after opening at which checks begin at the latest.
FIRST_MS = 5000

# Worst places that are shown as pins.
PINS = 8


class Checking:
    """One run at a time. found: the core Findings that are shown. outcome: the checks.Outcome that they are of, None
    before the first."""

    def __init__(self, panel):
        self._panel = panel
        self._worker = self.outcome = None
        self._old, self._again = [], False  # _again: to be judged by another tolerance is not enough
        self.found = []
        panel.findings.chosen.connect(self.go_to)
        panel.findings.run_pressed.connect(self._pressed)
        panel.findings.accept_pressed.connect(self.accept)
        panel.findings.refuse_pressed.connect(self.accept_no_more)
        self._later = self._timer(QUIET_MS, self._judge)
        self._first = self._timer(FIRST_MS, self.start)

    def _timer(self, milliseconds, call):
        timer = QtCore.QTimer(self._panel)
        timer.setSingleShot(True)
        timer.setInterval(milliseconds)
        timer.timeout.connect(call)
        return timer

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
        self._show(model.from_overview(session.overview.findings, session.listing, numbers.in_words))
        if settings.flag("AutoCheck"):
            self._first.start()

    def picture_came(self, frame):
        """Checks begin by themselves once the first good picture is there: it comes sooner without them."""
        if frame.sharp and self._first.isActive():
            self._first.stop()
            self.start()

    def check_soon(self):
        """Check again, when the last call of this was a while ago."""
        if self.outcome is not None or self.running:
            self._again = True
            self._later.start()

    def judge_soon(self):
        """Judge by another tolerance or allowance, when the last call of this was a while ago."""
        if self.outcome is not None or self.running:
            self._later.start()

    def close_job(self):
        """Nothing is watched any more."""
        self._later.stop()
        self._first.stop()
        self.cancel()
        self._old += [self._worker] if self._worker is not None else []
        self._worker, self.outcome, self.found, self._again = None, None, [], False
        self._panel.findings.show_findings((), {}, None)
        self._panel.deviation.show_outcome(None)
        self._panel.findings.show_checked("")
        self._show_title()

    def start(self):
        """Check, from the beginning when checks go on; returns at once."""
        session = self._panel.session
        if session is None:
            return
        self._first.stop()
        self._later.stop()
        self._again = False
        tolerance, stop, clearance = settings.tolerance(), settings.flag("StopAtError"), settings.clearance()
        allowance = self._panel.deviation.allowance.value()
        self._run(translate("Swarf", "Checking ..."), lambda progress: checks.run(
            session.job, session.voxel_mm, tolerance, progress, stop, clearance, allowance))

    def _judge(self):
        if self._panel.session is None:
            return
        if self._again or self.running or self.outcome is None or self.outcome.verification is None:
            self.start()
            return
        outcome, tolerance = self.outcome, settings.tolerance()
        allowance = self._panel.deviation.allowance.value()
        self._run(translate("Swarf", "Judging ..."),
                  lambda progress: checks.judge(outcome, tolerance, progress, allowance))

    def _run(self, text, call):
        panel, session = self._panel, self._panel.session
        if self._worker is not None:
            self.cancel()
            self._old.append(self._worker)
        # Qt keeps no worker alive: the closures do, until its end was told.
        worker = Worker(call, lambda done: panel.findings.show_progress(done) if worker is self._worker else None,
                        lambda outcome, error: self._end(worker, session, outcome, error))
        self._worker = worker
        panel.findings.show_running(text)
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

    def _end(self, worker, session, outcome, error):
        if worker is not self._worker:
            self._old.remove(worker)
            return
        self._worker = None
        if error is None:
            self.outcome = outcome
            self.accepted_changed()  # it may have, meanwhile
            text = self._summary(session)
        else:
            text = translate("Swarf", "Cancelled.") if self._panel.is_cancelled(error) else str(error)
        self._panel.findings.show_checked(text)
        self._show_title()
        worst = next((finding for finding in self.found if finding.severity == "error"), None)
        if error is None and outcome.stopped and worst is not None:  # it may have been accepted meanwhile
            self.go_to(worst)

    def _summary(self, session):
        if self.outcome.stopped:
            return translate("Swarf", "Stopped at the first error: the rest was not looked at")
        if session.job.design is None:
            return translate("Swarf", "Checked, without a model to compare with")
        allowance = self._panel.deviation.allowance.value()
        if allowance > 0:
            return translate("Swarf", "Checked, over an allowance of {0} mm").format(numbers.text(allowance, 3))
        return translate("Swarf", "Checked") if self.found else translate("Swarf", "Checked: nothing was found")

    # What is accepted

    def accepted_changed(self):
        """What the job's document accepts may be another: judge what was found by it."""
        panel = self._panel
        if self.outcome is None or panel.session is None:
            return
        try:
            if panel.job is not None:
                entries = accepted.accepted_of(panel.job)
                self.outcome = checks.accept(self.outcome, native.to_accepted(panel.job.Label, entries))
        except JobError as error:
            panel.fail(error)
        self._show(model.from_verdicts(self.outcome.verdicts, panel.session.listing, numbers.in_words))
        panel.deviation.show_outcome(self.outcome)

    def accept(self, finding, reason):
        """Accept a finding for a reason, which is kept in the job."""
        entry = model.acceptance(finding.verdict, reason, self._panel.session.voxel_mm)
        self._keep(lambda entries: entries + [entry], translate("Swarf", "Accept a finding"))

    def accept_no_more(self, finding):
        """Take back whatever accepts a finding."""
        def others(entries):
            knows = [acceptance.knows(finding.verdict) for acceptance in native.to_accepted("", entries)]
            return [entry for entry, known in zip(entries, knows) if not known]
        self._keep(others, translate("Swarf", "Accept a finding no more"))

    def _keep(self, change, name):
        job = self._panel.job
        if job is None:
            self._panel.fail(JobError(translate("Swarf", "The job is gone: nothing can be kept in it.")))
            return
        job.Document.openTransaction(name)
        try:
            accepted.keep(job, change(accepted.accepted_of(job)))
        except BaseException as error:
            job.Document.abortTransaction()
            if not isinstance(error, JobError):
                raise
            self._panel.fail(error)
        else:
            job.Document.commitTransaction()
            self.accepted_changed()

    # What is shown

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

    def go_to(self, finding):
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
