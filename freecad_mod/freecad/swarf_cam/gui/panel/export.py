# SPDX-License-Identifier: LGPL-2.1-or-later
"""The picture to the clipboard or a file, the machining as frames, and as a video where there is an encoder."""

import os

import FreeCAD

from ... import native
from ...core import video
from ..qt import QtCore, QtWidgets

translate = FreeCAD.Qt.translate

# An animation: pictures a second, seconds it lasts, and its size in pixels (even numbers, for encoders).
FRAMES_PER_SECOND, LENGTH_SECONDS, SIZE = 25, 12, (1280, 720)

# Drawing the frames is about this part of making a video.
FRAMES_SHARE = 0.85


def write_animation(session, progress, folder, view, count, report):
    """In the engine's thread: frames into a folder, then the video where there is an encoder -> the path that was made.
    report(fraction): how much of all is done."""
    encoder = video.find_encoder()
    share = FRAMES_SHARE if encoder else 1.0
    session.write_frames(folder, view, video.places(session.clock, count), progress, lambda done: report(share * done))
    if encoder is None:
        return folder
    path = os.path.join(folder, "swarf.mp4")
    if not video.encode(encoder, folder, path, FRAMES_PER_SECOND, count, progress,
                        lambda done: report(share + (1.0 - share) * done)):
        raise native.load().Cancelled(path)
    return path


def ask_file(parent, title, name, kinds):
    """Path of a file to write, "" for none."""
    path, _ = QtWidgets.QFileDialog.getSaveFileName(parent, title, name, kinds)
    return path


def ask_folder(parent, title):
    """Folder to write into, "" for none."""
    return QtWidgets.QFileDialog.getExistingDirectory(parent, title)


def copy(image):
    """A QImage to the clipboard."""
    if image is not None:
        QtWidgets.QApplication.clipboard().setImage(image)


class Report(QtCore.QObject):
    """Progress of a call in the engine's thread, told in the GUI's."""

    came = QtCore.Signal(float)

    def __call__(self, fraction):
        try:
            self.came.emit(float(fraction))
        except RuntimeError:
            pass
