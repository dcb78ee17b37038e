# SPDX-License-Identifier: LGPL-2.1-or-later
"""Puts the add-on's package on the path; what needs FreeCAD or the native module is skipped with a notice."""

import os
import shutil
import sys

import pytest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ADDON = os.path.join(ROOT, "freecad_mod")
sys.path.insert(0, os.path.join(ADDON, "freecad"))

# These run inside FreeCAD, see CMakeLists.txt.
collect_ignore = ["inside", "gui.py", "gui_panel.py", "gui_support.py"]


@pytest.fixture
def swarf():
    """The native module, from PYTHONPATH."""
    try:
        import swarf as module
    except ImportError as error:
        pytest.skip("the native module is not on PYTHONPATH: %s" % error)
    return module


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
