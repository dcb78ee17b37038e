# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frames into a video by ffmpeg, where it is installed."""

import os
import shutil
import subprocess
import tempfile

from .errors import JobError

# How often a running encoder is looked at, seconds.
POLL_SECONDS = 0.1


def find_encoder():
    """Path of the encoder, None when there is none."""
    return shutil.which("ffmpeg")


def places(clock, count):
    """Places that the machine reaches at equal times, the end for the last."""
    last = max(count - 1, 1)
    return [clock.place_at(clock.seconds * index / last) if index < last else float(len(clock))
            for index in range(count)]


def _frames_done(path):
    """The number in the last "frame=" line of what ffmpeg's -progress has written so far."""
    try:
        with open(path, encoding="ascii", errors="replace") as file:
            found = [line[6:].strip() for line in file if line.startswith("frame=")]
    except FileNotFoundError:
        return 0
    return int(found[-1]) if found and found[-1].isdecimal() else 0


def encode(encoder, folder, path, frames_per_second, count, progress, report):
    """frame-00000.png ... in a folder -> a video at path; whether it was made, not ended by a true answer of
    progress(fraction). JobError with the encoder's own words. Nothing is left at path unless it is whole."""
    partial = os.path.join(folder, "partial-" + os.path.basename(path))
    with tempfile.TemporaryDirectory(prefix="swarf-") as own, tempfile.TemporaryFile() as failed:
        told = os.path.join(own, "progress")
        command = [encoder, "-y", "-nostdin", "-loglevel", "error", "-progress", told, "-framerate",
                   str(frames_per_second), "-i", os.path.join(folder, "frame-%05d.png"), "-pix_fmt", "yuv420p", partial]
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=failed)
        try:
            while process.poll() is None:
                try:
                    process.wait(POLL_SECONDS)
                except subprocess.TimeoutExpired:
                    pass
                done = min(_frames_done(told) / max(count, 1), 1.0)
                report(done)
                if progress(done):
                    return False
            if process.returncode:
                failed.seek(0)
                words = failed.read().decode(errors="replace").strip().splitlines()
                raise JobError("%s ended with status %d: %s The frames are in %s." % (
                    os.path.basename(encoder), process.returncode, words[-1] if words else "", folder))
            os.replace(partial, path)
            return True
        finally:
            if process.poll() is None:
                process.kill()
                process.wait()
            if os.path.exists(partial):
                os.remove(partial)
