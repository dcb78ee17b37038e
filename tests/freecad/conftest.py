# SPDX-License-Identifier: LGPL-2.1-or-later
"""Puts the add-on's package on the path; what needs FreeCAD or the native module is skipped with a notice."""

import os
import shutil
import subprocess
import sys

import pytest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ADDON = os.path.join(ROOT, "freecad_mod")
sys.path[:0] = [os.path.join(ADDON, "freecad"), os.path.join(ROOT, "tests", "support")]

# These run inside FreeCAD, see CMakeLists.txt.
collect_ignore = ["inside", "gui.py", "gui_panel.py", "gui_support.py"]


def check_meshes(*paths):
    """CGAL finds the meshes closed, oriented and free of triangles that cut each other ($SWARF_MESH_CHECK, which the
    build sets where CGAL is; else nothing is checked)."""
    program = os.environ.get("SWARF_MESH_CHECK")
    if not program:
        return
    done = subprocess.run([program, *map(str, paths)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=300)
    assert done.returncode == 0, done.stdout.decode(errors="replace")


@pytest.fixture
def swarf():
    """The native module, from PYTHONPATH."""
    try:
        import swarf as module
    except ImportError as error:
        pytest.skip("the native module is not on PYTHONPATH: %s" % error)
    import telling

    telling.nothing_by_time()
    return module


@pytest.fixture
def every_piece(swarf):
    """Each piece of native work tells its progress."""
    import telling

    with telling.every_piece():
        yield


@pytest.fixture
def freecadcmd():
    """FreeCAD's command line program."""
    found = shutil.which(os.environ.get("SWARF_FREECADCMD", "freecadcmd"))
    if not found:
        pytest.skip("freecadcmd is not installed")
    return found


@pytest.fixture
def shared_freecad():
    """Folder of the sample jobs: $SWARF_SHARED/freecad, or ../shared/freecad beside the checkout."""
    shared = os.environ.get("SWARF_SHARED") or os.path.join(os.path.dirname(ROOT), "shared")
    folder = os.path.join(shared, "freecad")
    if not os.path.isdir(folder):
        pytest.skip("the sample jobs are not here: set SWARF_SHARED")
    return folder
