# SPDX-License-Identifier: LGPL-2.1-or-later
"""Holders and fixtures from the page into the document, each in a step that can be undone; the job is then read
again."""

import FreeCAD
import FreeCADGui as Gui

from ... import native
from ...app import fixtures, holders
from ...core.errors import JobError

translate = FreeCAD.Qt.translate


class SettingUp:
    """What the page shows is what the document has."""

    def __init__(self, panel):
        self._panel = panel
        page = panel.setup
        page.held.connect(self._hold)
        page.add_pressed.connect(self._add_fixtures)
        page.removed.connect(self._remove_fixture)

    def show(self):
        """Show the job that is watched, open or not: a wrong set-up may be why it is not."""
        job, session = self._panel.job, self._panel.session
        if job is None:
            self._panel.setup.show_job((), ())
            return
        tools = []
        for controller in getattr(job.Tools, "Group", None) or []:
            number = int(controller.ToolNumber)
            holder, stickout = holders.holder_of(controller) or ("", None)
            cutter = session.tools.get(number) if session is not None else None
            usual = float(int(cutter.extent("flutes")[1]) + 1) if cutter is not None else 1.0
            tools.append((controller.Name, "T%d %s" % (number, getattr(controller.Tool, "Label", "")), holder,
                          stickout or 0.0, usual))
        self._panel.setup.show_job(tools, [(obj.Name, obj.Label) for obj in fixtures.fixtures_of(job)])

    def _change(self, name, change):
        """Do change(job) in a transaction of this name, and read the job again."""
        panel, job = self._panel, self._panel.job
        if job is None:
            panel.fail(JobError(translate("Swarf", "The job is gone: nothing can be kept in it.")))
            return
        job.Document.openTransaction(name)
        try:
            change(job)
        except BaseException as error:
            job.Document.abortTransaction()
            if not isinstance(error, JobError):
                raise
            panel.fail(error)
            self.show()
        else:
            job.Document.commitTransaction()
            panel.opening.reload()

    def _hold(self, name, holder, stickout):
        def change(job):
            controller = job.Document.getObject(name)
            if controller is None:
                raise JobError(translate("Swarf", "The tool controller is gone."))
            if holder:
                self._try(controller, holder, stickout)
            holders.assign(controller, holder, stickout)
        self._change(translate("Swarf", "Choose a holder"), change)

    def _try(self, controller, holder, stickout):
        """JobError for a holder that is none, before it is in the document."""
        session, number = self._panel.session, int(controller.ToolNumber)
        if session is not None and number in session.tools:
            native.hold_one(session.tools[number], holder, stickout, controller.Label)

    def _add_fixtures(self):
        chosen = [obj for obj in Gui.Selection.getSelection() if obj.Document is self._panel.job.Document] \
            if self._panel.job is not None else []
        if not chosen:
            self._panel.banner.say("note", translate(
                "Swarf", "Select the solids or meshes that hold the stock in FreeCAD's tree or 3D view first."))
            return
        self._change(translate("Swarf", "Add fixtures"),
                     lambda job: fixtures.keep(job, fixtures.fixtures_of(job) + chosen))

    def _remove_fixture(self, name):
        self._change(translate("Swarf", "Remove a fixture"), lambda job: fixtures.keep(
            job, [obj for obj in fixtures.fixtures_of(job) if obj.Name != name]))
