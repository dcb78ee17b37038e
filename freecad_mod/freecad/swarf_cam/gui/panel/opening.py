# SPDX-License-Identifier: LGPL-2.1-or-later
"""Opens a job: reads it from its document in slices between the events, as only the GUI's thread may, then lets an
engine cut and draw it. Notices what becomes of the job meanwhile."""

import time

import FreeCAD

from ... import session as sessions
from ...app import job as jobs
from ...app import setups, simulation
from ...core.engine import Engine
from ...core.errors import JobError
from .. import settings
from ..qt import QtCore
from ..slices import Slices
from .bridge import Bridge
from .watch import JobWatch

translate = FreeCAD.Qt.translate


class Opening:
    """One job at a time. session: what is open, None for none."""

    def __init__(self, panel):
        self._panel = panel
        self.session = None
        self._engine = self._bridge = self._watch = self._reading = None
        self._old_engines = []
        self._tag = 0  # of the job that is open or being opened: what comes from older ones is not for us
        self._began = 0.0
        self._resume = None

    @property
    def job(self):
        """The job that is watched, None once it is gone."""
        return self._watch.job if self._watch is not None else None

    @property
    def ended(self):
        """Whether no engine of a job that was closed is left."""
        return not self._old_engines

    @property
    def comparing(self):
        """Whether something changed of which is not known yet whether the job differs by it."""
        return self._watch is not None and self._watch.comparing

    @property
    def known_hashes(self):
        """Hashes of the job's paths that have not changed since it was read, None when the job did change, or may
        have."""
        watch = self._watch
        return None if watch is None or watch.differs or watch.comparing else watch.known

    # Reading

    def watch(self, job, voxel_mm=None):
        """Read a job and show it; voxel_mm None: from the preferences."""
        panel = self._panel
        panel.close_job(for_another=True)
        self._watch = watch = JobWatch(job, panel)
        watch.changed.connect(self._job_changed)
        watch.deleted.connect(self._job_deleted)
        watch.closed.connect(self._document_closed)
        watch.accepted.connect(panel.checking.accepted_changed, QtCore.Qt.QueuedConnection)
        self._began = time.monotonic()
        panel.setting_up.show()
        try:
            box = simulation.job_box(job)
        except JobError as error:
            panel.fail(error)
            panel.show_state()
            return
        voxel_mm = voxel_mm or self._default_voxel(box)
        panel.accuracy.open(box, voxel_mm)
        panel.banner.work(translate("Swarf", "Reading '{0}' ...").format(job.Label), self._cancel, measured=False)
        self._reading = Slices(self._read_steps(watch, job),
                               lambda data, error: self._read(data, error, voxel_mm), panel)
        panel.show_state()

    @staticmethod
    def _read_steps(watch, job):
        yield from watch.remember_steps()
        return (yield from setups.gather(job))

    @staticmethod
    def _default_voxel(box):
        edge = max(b - a for a, b in zip(*box)) / settings.resolution()
        return float("%.1e" % edge) if edge > 0 else 0.1

    def _read(self, data, error, voxel_mm):
        self._reading = None
        if error is not None:
            if not isinstance(error, (JobError, MemoryError)):  # half way through an edit
                error = JobError(translate("Swarf", "The job cannot be read: {0}").format(error))
            self._panel.fail(error)
            self._panel.show_state()
        else:
            self._start(data, voxel_mm)

    def reload(self, voxel_mm=None):
        """Read the job again, with another voxel size or the same, and go back to where it stood."""
        job, panel = self.job, self._panel
        if job is None:
            panel.fail(JobError(translate("Swarf", "The job is gone: select another one and start again.")))
            return
        place = panel.transport.wanted if panel.transport is not None else self._resume
        keep = self.session.voxel_mm if self.session is not None else panel.accuracy.voxel.value()
        self.watch(job, voxel_mm or keep)
        self._resume = place

    # The engine

    def _start(self, data, voxel_mm):
        panel = self._panel
        self._tag += 1
        tag = self._tag
        bridge = Bridge(panel)
        self._engine = engine = Engine(
            lambda progress: sessions.Session(jobs.finish(data), voxel_mm, progress), bridge.listener,
            panel.cancelled_type)
        queued = QtCore.Qt.QueuedConnection
        bridge.opened.connect(lambda session: self._opened(session) if tag == self._tag else None, queued)
        bridge.progressed.connect(lambda done: self._progress(done) if tag == self._tag else None, queued)
        bridge.failed.connect(lambda error: panel.fail_or_cancel(error) if tag == self._tag else None, queued)
        bridge.frame_came.connect(lambda: self._show_frame(bridge) if tag == self._tag else None, queued)
        bridge.finished.connect(lambda: self._ended(engine), queued)
        self._bridge = bridge
        panel.banner.work(translate("Swarf", "Cutting '{0}' once ...").format(data.name), self._cancel)
        engine.start()

    def _cancel(self):
        if self._reading is not None:
            self._reading.cancel()
            self._reading = None
            self._panel.fail_or_cancel(self._panel.cancelled_type())
        elif self._engine is not None:
            self._engine.cancel()
            self._panel.banner.text.setText(translate("Swarf", "Cancelling ..."))

    def _progress(self, fraction):
        if self.session is None and self._panel.banner.working:
            self._panel.banner.progress(fraction)

    def _opened(self, session):
        self.session = session
        place, self._resume = self._resume, None
        self._panel.open_session(session, place, time.monotonic() - self._began)
        if self._watch.differs:  # while it was being cut
            self._job_changed(True)

    def _show_frame(self, bridge):
        frame = bridge.take_frame()
        if frame is not None and self.session is not None:
            self._panel.show_frame(frame)

    def wish(self, place=None, view=None):
        """Where to stand and what to show from now on."""
        if self._engine is not None and self.session is not None:
            self._engine.wish(place, view)

    def call(self, function, on_result):
        """Do function(session, progress) in the engine's thread; on_result(result, error) follows in this one, unless
        the job was closed meanwhile -> core.engine.Call."""
        tag = self._tag
        return self._engine.call(function, self._bridge.answer_to(
            lambda result, error: on_result(result, error) if tag == self._tag else None))

    # Closing

    def close_job(self):
        """Watch no job: the engine ends by itself, as soon as what it does lets it."""
        self._tag += 1
        if self._reading is not None:
            self._reading.cancel()
        if self._watch is not None:
            self._watch.stop()
            self._watch.deleteLater()
        if self._engine is not None:
            self._engine.stop()
            self._old_engines.append(self._engine)
        self._reading = self._watch = self._engine = self._bridge = self.session = self._resume = None

    def _ended(self, engine):
        if engine in self._old_engines:
            self._old_engines.remove(engine)
        if engine is self._engine and self.session is None:
            self._engine = None
            self._panel.show_state()

    def join(self, seconds):
        """Wait for the engines."""
        for engine in list(self._old_engines):
            engine.join(seconds)

    # The document

    def _job_changed(self, differs):
        panel = self._panel
        if self._reading is not None:
            if differs:  # what was read so far is of the job as it was
                self.reload()
        elif self.session is not None and differs:
            panel.banner.say("warning", translate("Swarf", "The job was changed. What you see is how it was."),
                             translate("Swarf", "Read the job again"), self.reload)
        elif self.session is not None and not panel.banner.working:
            panel.banner.done()

    def _job_deleted(self):
        panel = self._panel
        panel.files.keeper.cancel()
        text = translate("Swarf", "The job was deleted. What you see is how it was; it can still be played.")
        if self.session is None:
            panel.close_job()
            text = translate("Swarf", "The job was deleted while it was being read.")
        panel.banner.say("warning", text)
        panel.show_state()

    def _document_closed(self):
        self._panel.files.keeper.cancel()
        self._panel.close_job()
        self._panel.banner.say("note", translate("Swarf", "The document was closed."))
