# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is written from the panel: pictures, animations, and the result into the document."""

import FreeCAD

from ...core.errors import JobError
from ..qt import QtCore
from . import export
from .keep import Keeper

translate = FreeCAD.Qt.translate


class Files:
    """The panel's writing, told about in its banner; returns at once."""

    def __init__(self, panel):
        self._panel = panel
        self.keeper = Keeper(panel)

    def copy_picture(self):
        """What is shown to the clipboard."""
        export.copy(self._panel.view.image())

    def keep_result(self):
        """Put the whole program's result into the document."""
        panel = self._panel
        if panel.job is None or panel.session is None:
            panel.fail(JobError(translate("Swarf", "The job is gone: its result cannot be kept.")))
            return
        self.keeper.start(panel.job, panel.session, panel.opening.known_hashes)

    def ask_picture(self):
        """Save the picture where the user says."""
        path = export.ask_file(self._panel, translate("Swarf", "Save the picture"), "swarf.png", "PNG (*.png)")
        if path:
            self.save_picture(path)

    def save_picture(self, path):
        """The picture as good as it gets to a PNG file."""
        panel = self._panel
        if panel.session is None or panel.banner.working:  # its button ends one thing
            return
        view, place = panel.current_view(), panel.transport.at
        call = panel.opening.call(lambda session, progress: session.write_png(path, view, place, progress),
                                  lambda _, error: self._written(path, error))
        panel.banner.work(translate("Swarf", "Drawing ..."), call.cancel)

    def ask_animation(self):
        """Save an animation where the user says."""
        folder = export.ask_folder(self._panel, translate("Swarf", "Folder for the frames of the animation"))
        if folder:
            self.save_animation(folder)

    def save_animation(self, folder, count=export.FRAMES_PER_SECOND * export.LENGTH_SECONDS, size=export.SIZE):
        """The whole program as frames, and a video where there is an encoder."""
        panel = self._panel
        if panel.session is None or panel.banner.working:
            return
        panel.player.pause()
        panel.player.select(None)
        panel.view.set_mark(None)
        view, report = panel.current_view(size), export.Report(panel)
        report.came.connect(panel.banner.progress, QtCore.Qt.QueuedConnection)
        call = panel.opening.call(
            lambda session, progress: export.write_animation(session, progress, folder, view, count, report),
            self._written)
        panel.banner.work(translate("Swarf", "Drawing the animation ..."), call.cancel)

    def _written(self, path, error):
        panel = self._panel
        if panel.is_cancelled(error):
            panel.banner.say("note", translate("Swarf", "Cancelled."))
        elif error is not None:
            panel.fail(error)
        else:
            panel.banner.say("note", translate("Swarf", "Written: {0}").format(path))
