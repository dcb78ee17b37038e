# SPDX-License-Identifier: LGPL-2.1-or-later
"""Videos by an encoder that is a script of the test: told of, broken off, failing."""

import os
import shutil
import subprocess

import pytest
from swarf_cam.core import video
from swarf_cam.core.errors import JobError

FAKE = """#!/bin/sh
while [ $# -gt 1 ]; do
    [ "$1" = -progress ] && told=$2
    shift
done
%s
"""


def make(folder, body):
    path = folder / "ffmpeg"
    path.write_text(FAKE % body)
    path.chmod(0o755)
    return str(path)


def test_progress_and_the_whole_file(tmp_path):
    told, seen = [], tmp_path / "seen"
    # what waits for a report that never comes ends after two minutes
    encoder = make(tmp_path, 'for n in 1 5 10; do echo frame=$n >>"$told"; k=0; '
                             'while [ $n = 5 -a ! -e "%s" ]; do k=$((k + 1)); [ $k -lt 12000 ] || exit 9; sleep 0.01; '
                             'done; done; echo video >"$1"' % seen)

    def report(done):
        told.append(done)
        if done == 0.5:
            seen.touch()
    target = str(tmp_path / "swarf.mp4")
    assert video.encode(encoder, str(tmp_path), target, 25, 10, lambda done: False, report)
    assert (tmp_path / "swarf.mp4").read_text() == "video\n"
    assert told == sorted(told) and 0.5 in told and told[-1] <= 1.0
    assert sorted(os.listdir(tmp_path)) == ["ffmpeg", "seen", "swarf.mp4"]


def test_broken_off_nothing_is_left(tmp_path):
    encoder = make(tmp_path, 'echo half >"$1"; exec sleep 60')
    target = str(tmp_path / "swarf.mp4")
    assert not video.encode(encoder, str(tmp_path), target, 25, 10, lambda done: True, lambda done: None)
    assert os.listdir(tmp_path) == ["ffmpeg"]
    with pytest.raises(KeyError):
        def fails(_):
            raise KeyError("from the caller")
        video.encode(encoder, str(tmp_path), target, 25, 10, fails, lambda done: None)
    assert os.listdir(tmp_path) == ["ffmpeg"]


def test_the_words_of_an_encoder_that_fails(tmp_path):
    encoder = make(tmp_path, "echo no space left >&2; exit 3")
    with pytest.raises(JobError, match="ffmpeg ended with status 3: no space left.*frames are in"):
        video.encode(encoder, str(tmp_path), str(tmp_path / "swarf.mp4"), 25, 10, lambda done: False, lambda done: None)


@pytest.mark.skipif(not video.find_encoder(), reason="ffmpeg is not installed")
def test_a_real_encoder(tmp_path, swarf):
    stock = swarf.Stock.box((0, 0, 0), (4, 4, 4), 0.5)
    for number in range(3):
        stock.picture(str(tmp_path / ("frame-%05d.png" % number)), 64, 48)
    target = str(tmp_path / "swarf.mp4")
    assert video.encode(shutil.which("ffmpeg"), str(tmp_path), target, 25, 3, lambda done: False, lambda done: None)
    assert b"ftyp" in open(target, "rb").read(64)
    subprocess.run(["ffmpeg", "-v", "error", "-i", target, "-f", "null", "-"], check=True)
