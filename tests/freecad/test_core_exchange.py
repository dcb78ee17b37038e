# SPDX-License-Identifier: LGPL-2.1-or-later
"""The exchange folder, the signature, and the reader of .FCStd files up to FreeCAD's door."""

import array
import json
import os
import stat
import time

import pytest
from swarf_cam import reader
from swarf_cam.core import exchange, moves, signature
from swarf_cam.core.errors import JobError
from swarf_cam.core.job import JobData


def sample(stock=None):
    table = moves.MoveTable()
    table.add_operation("Öffnung")
    table.set_section(3, 0, moves.SPINDLE_CW, moves.COOLANT_FLOOD, 1200.0)
    table.add_line(moves.RAPID, (0.1, 0.2, 0.3), 0, 1)
    table.add_arc((1, 2, 3), (0, 0, 0), moves.PLANE_YZ, False, 2, 90.0, 7)
    mesh = (array.array("d", [0, 0, 0, 1, 0, 0, 0, 1, 0.1]), array.array("I", [0, 1, 2]))
    tools = {3: ("Fräser", [("flutes", [(0.0, 0.0, 0.0), (3.0, 0.0, 0.1), (0.0, 9.0, 0.0)])])}
    return JobData("Jöb", table, tools, stock or {"kind": "mesh", "mesh": mesh}, mesh, ["a note"], teeth={3: 4},
                   holders={3: ("ER16", 35.5)}, accepted=[{"reason": "so", "line": 3}])


def test_round_trip(tmp_path):
    job = sample()
    exchange.write(str(tmp_path), job)
    again = exchange.read(str(tmp_path))
    assert again.moves.rows == job.moves.rows
    assert again.moves.sections == job.moves.sections and again.moves.operations == job.moves.operations
    assert (again.name, again.tools, again.stock, again.design, again.notes, again.teeth,
            again.holders, again.accepted) == (
        job.name, job.tools, job.stock, job.design, job.notes, job.teeth, job.holders, job.accepted)


def test_box_without_design(tmp_path):
    job = sample({"kind": "box", "lo": (0.1, 0, 0), "hi": (1, 2, 3)})
    job.design = None
    exchange.write(str(tmp_path), job)
    again = exchange.read(str(tmp_path))
    assert again.design is None
    assert tuple(again.stock["lo"]) == (0.1, 0, 0)


def test_errors_come_across(tmp_path):
    exchange.write_error(str(tmp_path), "the job has no stock")
    with pytest.raises(JobError, match="the job has no stock"):
        exchange.read(str(tmp_path))


def test_other_version_and_silence(tmp_path):
    with pytest.raises(JobError, match="without an answer"):
        exchange.read(str(tmp_path))
    exchange.write(str(tmp_path), sample())
    file = tmp_path / "job.json"
    document = json.loads(file.read_text())
    document["version"] = 99
    file.write_text(json.dumps(document))
    with pytest.raises(JobError, match="version 99"):
        exchange.read(str(tmp_path))


def test_signature_sees_every_input_and_no_rounding():
    inputs = [["Op", "hash", 1.0], {"TC": ["endmill", {"Diameter": 5.0}]}, [0.0, 1.0], [1.5], 0.1]
    base = signature.signature(*inputs)
    assert signature.signature(["Op", "hash", 1.0 + 1e-12], *inputs[1:]) == base
    assert signature.signature(*inputs[:2], [-0.0, 1.0], *inputs[3:]) == base
    changed = [["Op", "hash", 1.001], {"TC": ["endmill", {"Diameter": 5.1}]}, [0.0, 1.1], [], 0.2]
    for index, value in enumerate(changed):
        assert signature.signature(*inputs[:index], value, *inputs[index + 1:]) != base


def document(tmp_path):
    """A file that is a zip, as .FCStd files are."""
    import zipfile

    path = tmp_path / "x.FCStd"
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("Document.xml", "<Document/>")
    return path


def fake_freecadcmd(tmp_path, monkeypatch, script):
    program = tmp_path / "fakecmd"
    program.write_text("#!/bin/sh\n" + script)
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("SWARF_FREECADCMD", str(program))


def test_no_freecadcmd(tmp_path, monkeypatch):
    monkeypatch.delenv("SWARF_FREECADCMD", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(JobError, match="apt install freecad.*SWARF_FREECADCMD"):
        reader.read_data(document(tmp_path))
    monkeypatch.setenv("SWARF_FREECADCMD", "nonsense")
    with pytest.raises(JobError, match="'nonsense', which is not a program"):
        reader.read_data(document(tmp_path))


def test_no_document(tmp_path):
    with pytest.raises(OSError):
        reader.read_data(tmp_path / "missing.FCStd")
    cut = document(tmp_path)
    cut.write_bytes(cut.read_bytes()[:-10])
    with pytest.raises(JobError, match="cut off"):
        reader.read_data(cut)


def test_freecadcmd_that_dies_is_told_with_its_last_words(tmp_path, monkeypatch):
    fake_freecadcmd(tmp_path, monkeypatch, "echo last words\nexit 3\n")
    with pytest.raises(JobError, match="status 3.*last words"):
        reader.read_data(document(tmp_path))


@pytest.mark.parametrize("answer", ["true", "raise"])
def test_cancel_stops_freecadcmd(tmp_path, monkeypatch, answer):
    fake_freecadcmd(tmp_path, monkeypatch, "exec sleep 600\n")

    def progress(fraction):
        if answer == "raise":
            raise KeyboardInterrupt
        return True

    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt if answer == "raise" else JobError):
        reader.read_data(document(tmp_path), progress=progress)
    assert time.monotonic() - begin < 300


def read_and_compare(path, job=None):
    before = os.stat(path), path.read_bytes()
    data = reader.read_data(path, job)
    after = os.stat(path), path.read_bytes()
    assert before[1] == after[1] and before[0].st_mtime_ns == after[0].st_mtime_ns, "the user's file was touched"
    return data


@pytest.mark.parametrize("version", ["0.20", "1.0", "1.1"])
def test_sample_jobs(version, freecadcmd, shared_freecad, tmp_path):
    source = os.path.join(shared_freecad, "job-%s.FCStd" % version)
    if not os.path.exists(source):
        pytest.skip("job-%s.FCStd is not here" % version)
    path = tmp_path / "job.FCStd"
    with open(source, "rb") as file:
        path.write_bytes(file.read())
    data = read_and_compare(path)
    assert len(data.moves.operations) == 7
    assert sorted(data.tools) == [1, 2, 3]
    assert data.stock == {"kind": "box", "lo": [-2.0, -2.0, 0.0], "hi": [102.0, 82.0, 26.0]}
    assert len(data.moves) > 7000
    kinds = [[kind for kind, _ in parts] for _, parts in data.tools.values()]
    assert kinds == [["flutes", "shank"], ["flutes"], ["flutes", "shank"]]
    points = data.design[0]
    assert [(min(points[i::3]), max(points[i::3])) for i in range(3)] == [
        (pytest.approx(0, abs=1e-6), pytest.approx(top)) for top in (100, 80, 25)]
    with pytest.raises(JobError, match="no job 'Nope'; the document holds 'Job'"):
        reader.read_data(path, "Nope")
