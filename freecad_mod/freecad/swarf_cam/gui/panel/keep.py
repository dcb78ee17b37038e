# SPDX-License-Identifier: LGPL-2.1-or-later
"""The whole program's result into the document: cut and compared in a thread of its own, stored in one undoable
step."""

import tempfile

import FreeCAD

from ...app import simulation
from ..slices import Slices
from ..worker import Worker

translate = FreeCAD.Qt.translate


class Keeper:
    """One result at a time, told about in the panel's banner."""

    def __init__(self, panel):
        self._panel = panel
        self.worker = self._reading = self._prepared = self._job = self._folder = None

    def start(self, job, session, known):
        """Begin, unless one is under way. known: hashes of the job's paths that have not changed since the session was
        opened, None when the job did change: it is read again then."""
        if self.worker is not None or self._reading is not None:
            return
        self._job = job
        self._panel.banner.work(translate("Swarf", "Reading '{0}' ...").format(job.Label), self.cancel, measured=False)
        data = session.data if known is not None else None
        self._reading = Slices(simulation.prepare_steps(job, session.voxel_mm, data, known), self._read, self._panel)

    def _read(self, prepared, error):
        self._reading = None
        if error is not None:
            self._job = None
            self._panel.fail(error)
            return
        self._prepared = prepared
        self._folder = folder = tempfile.TemporaryDirectory(prefix="swarf-")
        self._panel.banner.work(translate("Swarf", "Cutting and comparing for the document ..."), self.cancel)
        self.worker = Worker(lambda progress: prepared.run(folder.name, progress), self._panel.banner.progress,
                             self._end)
        self.worker.start()

    def cancel(self):
        """Break it off."""
        if self._reading is not None:
            self._reading.cancel()
            self._reading = self._job = None
            self._panel.banner.say("note", translate("Swarf", "Cancelled; nothing was changed."))
        if self.worker is not None:
            self.worker.cancel()

    @property
    def running(self):
        """Whether one is under way."""
        return self.worker is not None or self._reading is not None

    def join(self, seconds):
        """Wait for its thread."""
        if self.worker is not None:
            self.worker.join(seconds)

    def _end(self, result, error):
        cancelled, banner = self.worker.cancelled, self._panel.banner
        self.worker = None
        try:
            if cancelled:
                banner.say("note", translate("Swarf", "Cancelled; nothing was changed."))
            elif error is not None:
                self._panel.fail(error)
            else:
                obj = simulation.add(self._job, self._prepared, result)
                banner.say("note", translate("Swarf", "In the document: {0}").format(obj.Label))
        except ReferenceError:
            banner.say("warning", translate("Swarf", "The job was deleted meanwhile; its simulation is discarded."))
        except (RuntimeError, OSError) as problem:
            self._panel.fail(problem)
        finally:
            self._folder.cleanup()
            self._prepared = self._job = self._folder = None
