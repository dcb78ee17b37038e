# SPDX-License-Identifier: LGPL-2.1-or-later
"""The whole program's result into the document: cut and compared in a thread of its own, stored in one undoable step."""

import tempfile

import FreeCAD

from ...app import simulation
from ...core.errors import JobError
from ..worker import Worker

translate = FreeCAD.Qt.translate


class Keeper:
    """One result at a time, told about in the panel's banner."""

    def __init__(self, panel):
        self._panel = panel
        self.worker = self._prepared = self._job = self._folder = None

    def start(self, job, voxel_mm):
        """Begin, unless one is under way."""
        if self.worker is not None:
            return
        try:
            prepared = simulation.Prepared(job, voxel_mm)
        except JobError as error:
            self._panel.fail(error)
            return
        self._prepared, self._job = prepared, job
        self._folder = folder = tempfile.TemporaryDirectory(prefix="swarf-")
        self._panel.banner.work(translate("Swarf", "Cutting and comparing for the document ..."), self.cancel)
        self.worker = Worker(lambda progress: prepared.run(folder.name, progress), self._panel.banner.progress,
                             self._end)
        self.worker.start()

    def cancel(self):
        """Break it off."""
        if self.worker is not None:
            self.worker.cancel()

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
