# SPDX-License-Identifier: LGPL-2.1-or-later
"""The example job, made by freecadcmd and read back; with the native module it is simulated too."""

import json
import os
import subprocess
import sys

import pytest
from conftest import ROOT, check_meshes
from swarf_cam import reader


def make_example(script, folder, **variables):
    """Path of the document that an example's script makes in a folder, and what it printed."""
    import shutil

    program = shutil.which(os.environ.get("SWARF_FREECADCMD", "freecadcmd"))
    if not program:
        pytest.skip("freecadcmd is not installed")
    path = folder / "job.FCStd"
    home = folder / "home"
    home.mkdir()
    environment = dict(os.environ, SWARF_EXAMPLE_OUT=str(path), FREECAD_USER_HOME=str(home), **variables)
    done = subprocess.run([program, os.path.join(ROOT, "examples", script)], env=environment,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=300)
    text = done.stdout.decode(errors="replace")
    assert done.returncode == 0, text[-2000:]
    assert path.exists()
    return path, text


@pytest.fixture(scope="module")
def example(tmp_path_factory):
    """Path of the example's document."""
    return make_example("make_job.py", tmp_path_factory.mktemp("example"))[0]


def test_a_failing_example_says_so(freecadcmd, tmp_path):
    """freecadcmd itself would exit with 0."""
    (tmp_path / "file").write_text("")
    environment = dict(os.environ, SWARF_EXAMPLE_OUT=str(tmp_path / "file" / "job.FCStd"),
                       FREECAD_USER_HOME=str(tmp_path))
    done = subprocess.run([freecadcmd, os.path.join(ROOT, "examples", "make_job.py")], env=environment,
                          stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=300)
    assert done.returncode == 1


def test_read(example):
    data = reader.read_data(example)
    assert data.moves.operations[:6] == ["Facing", "Pocket", "Step", "Outline", "Drilling", "PeckDrilling"]
    assert data.stock == {"kind": "box", "lo": [-3.0, -3.0, 0.0], "hi": [83.0, 63.0, 16.0]}
    holes = {"Drilling": set(), "PeckDrilling": set()}
    for index in range(len(data.moves)):
        row = data.moves.row(index)
        operation = data.moves.operations[data.moves.sections[int(row[2])][1]]
        if operation in holes and row[7] < 0:
            holes[operation].add((round(row[5], 3), round(row[6], 3)))
    assert holes == {"Drilling": {(6, 54)}, "PeckDrilling": {(6, 6), (74, 6)}}


def test_simulate(example, swarf, tmp_path):
    report = tmp_path / "report.json"
    done = subprocess.run([sys.executable, "-m", "swarf", "simulate", str(example), "--voxel", "0.25", "--report",
                           str(report), "--output", str(tmp_path / "stock.stl")], timeout=300)
    assert done.returncode == 0
    result = json.loads(report.read_text())
    removed = result["removed_mm3_by_operation"]
    assert removed["Facing"] == pytest.approx(86 * 66, rel=0.01)
    # the pocket as drawn, less what a mill of 5 mm cannot reach, which is nothing: its corners have 5 mm
    assert removed["Pocket"] == pytest.approx((30 * 22 - (4 - 3.14159) * 25) * 6, rel=0.01)
    # through what facing left: 15 mm
    assert removed["Drilling"] == pytest.approx(3.14159 * 2.5 ** 2 * 15, rel=0.01)
    assert removed["PeckDrilling"] == pytest.approx(2 * removed["Drilling"], rel=0.001)
    assert result["mesh"]["closed"]
    check_meshes(tmp_path / "stock.stl")


def test_two_sides(swarf, tmp_path):
    """Milled from above, turned over, milled from below: the part comes out as designed, in FreeCAD and from its
    document by the command line."""
    path, text = make_example("make_two_sided.py", tmp_path, SWARF_EXAMPLE_VOXEL="0.3")
    assert "out of date" not in text and "0 errors" in text
    report = tmp_path / "report.json"
    done = subprocess.run([sys.executable, "-m", "swarf", "simulate", str(path), "--job", "Bottom", "--voxel", "0.3",
                           "--report", str(report), "--output", str(tmp_path / "part.stl")], timeout=300)
    assert done.returncode == 0
    result = json.loads(report.read_text())
    assert [entry["job"] for entry in result["set_ups_before"]] == ["Top"]
    design = result["comparison"]["design_mm3"]
    assert result["comparison"]["excess_mm3"] < 3e-4 * design and result["comparison"]["gouge_mm3"] < 3e-4 * design
    mine, theirs = (swarf.Mesh.read(file) for file in (tmp_path / "part.stl", tmp_path / "result.stl"))
    assert mine.closed and mine.volume == pytest.approx(design, rel=3e-4)
    assert theirs.volume == pytest.approx(mine.volume, rel=1e-5)  # paths are saved with six decimals
    check_meshes(tmp_path / "part.stl", tmp_path / "result.stl")
