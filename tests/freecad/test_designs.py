# SPDX-License-Identifier: LGPL-2.1-or-later
"""Designs in CAD files, from the command line's side: read through freecadcmd, or a clear word that it is missing."""
import importlib.metadata
import math
import subprocess

import pytest

swarf = pytest.importorskip("swarf")
from swarf import readers  # noqa: E402
from swarf.verify import CAD_SUFFIXES, read_design  # noqa: E402
from swarf_cam import reader  # noqa: E402
from swarf_cam.core.errors import JobError  # noqa: E402


@pytest.fixture
def step(tmp_path):
    try:
        program = reader.find_freecadcmd()
    except JobError as error:
        pytest.skip(str(error))
    path = tmp_path / "part.step"
    code = ("import Part, FreeCAD; Part.makeBox(40, 20, 10).cut(Part.makeCylinder(6, 30, "
            "FreeCAD.Vector(20, 10, -5))).exportStep(%r)" % str(path))
    subprocess.run([program, "-c", code], check=False, capture_output=True, timeout=120, stdin=subprocess.DEVNULL)
    assert path.exists()
    return path


def test_step(step):
    mesh = read_design(str(step), 0.02)
    assert mesh.closed
    # triangles no farther than a fifth of the tolerance from the hole's face
    assert math.isclose(mesh.volume, 8000 - math.pi * 36 * 10, abs_tol=0.004 * 2 * math.pi * 6 * 10)
    finer = read_design(str(step), 0.002)
    assert finer.triangle_count > mesh.triangle_count


def test_what_is_no_design(tmp_path):
    path = tmp_path / "broken.step"
    path.write_text("no STEP at all")
    try:
        reader.find_freecadcmd()
    except JobError as error:
        pytest.skip(str(error))
    with pytest.raises(ValueError, match="broken.step"):
        read_design(str(path))
    with pytest.raises(OSError):
        read_design(str(tmp_path / "missing.step"))
    document = tmp_path / "broken.FCStd"
    document.write_text("no document")
    with pytest.raises(ValueError, match="not a FreeCAD document"):
        read_design(str(document))


def test_without_freecad(tmp_path, monkeypatch):
    path = tmp_path / "part.step"
    path.write_text("ISO-10303-21;")
    monkeypatch.setenv("SWARF_FREECADCMD", "no-such-program")
    with pytest.raises(ValueError, match="no-such-program"):
        read_design(str(path))


def test_without_the_add_on(monkeypatch):
    assert set(readers.design_suffixes()) == set(CAD_SUFFIXES)
    monkeypatch.setattr(importlib.metadata, "entry_points", lambda group: ())
    for suffix in CAD_SUFFIXES:
        with pytest.raises(ValueError, match="through FreeCAD"):
            read_design("part" + suffix)
    with pytest.raises(ValueError, match="unknown suffix"):
        read_design("part.dxf")
