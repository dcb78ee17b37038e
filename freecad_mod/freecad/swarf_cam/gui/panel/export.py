# SPDX-License-Identifier: LGPL-2.1-or-later
"""The picture to the clipboard or a file, the machining as frames, and as a video where there is an encoder."""

import os
import shutil
import subprocess

import FreeCAD

from ..qt import QtCore, QtWidgets

translate = FreeCAD.Qt.translate

# An animation: pictures a second, seconds it lasts, and its size in pixels (even numbers, for encoders).
FRAMES_PER_SECOND, LENGTH_SECONDS, SIZE = 25, 12, (1280, 720)


def video_command(folder, path):
    """The encoder's command line for frames in a folder, None where there is no encoder."""
    encoder = shutil.which("ffmpeg")
    if encoder is None:
        return None
    return [encoder, "-y", "-loglevel", "error", "-framerate", str(FRAMES_PER_SECOND), "-i",
            os.path.join(folder, "frame-%05d.png"), "-pix_fmt", "yuv420p", path]


def animation_places(clock, count):
    """Places that the machine reaches at equal times, the end for the last."""
    last = max(count - 1, 1)
    return [clock.place_at(clock.seconds * index / last) if index < last else float(len(clock))
            for index in range(count)]


def write_animation(session, progress, folder, view, count, report):
    """In the engine's thread: frames into a folder, then the video -> the path that was made."""
    session.write_frames(folder, view, animation_places(session.clock, count), progress, report)
    path = os.path.join(folder, "swarf.mp4")
    command = video_command(folder, path)
    if command is None:
        return folder
    subprocess.run(command, check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
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
