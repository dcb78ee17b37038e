# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the tests share: a small job in closed form."""
import math
import os
import pathlib
import sys

import hypothesis
import pytest

import swarf

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "support"))
import telling  # noqa: E402

# The machine may be shared and a sanitizer slows everything: deadlines would test the machine.
hypothesis.settings.register_profile("swarf", deadline=None, max_examples=60, database=None)
hypothesis.settings.load_profile("swarf")
telling.nothing_by_time()

LO, HI, VOXEL = (0.0, 0.0, -10.0), (60.0, 40.0, 0.0), 0.5
TOOL = "flat:d=6,l=20"
#: Removed by slot(): 40 x 6 and two half discs, 4 deep.
SLOT_MM3 = (40 * 6 + math.pi * 9) * 4

GCODE = """\
G21 G90
T1 M6
S8000 M3
G0 X10 Y20 Z5
G1 Z-4 F200
G1 X50 F600
G0 Z5
M2
"""


def make_slot(depth=4.0, steps=1):
    """A slot along X at Y 20, in `steps` moves."""
    program = swarf.Program(start=(10, 20, 5))
    program.add_operation("slot")
    program.set_section(tool=1, spindle="cw", spindle_rpm=8000)
    program.add_line((10, 20, -depth), feed_mm_min=200, line=1)
    for step in range(steps):
        program.add_line((10 + 40 * (step + 1) / steps, 20, -depth), feed_mm_min=600, line=2 + step)
    return program


def make_zigzag(moves=4000):
    """Enough work to be still running when a test wants to meet it."""
    program = swarf.Program(start=(2, 2, 1))
    program.add_operation("zigzag")
    program.set_section(tool=1)
    for i in range(moves):
        program.add_line((2 + 56 * (i % 2), 2 + 36 * i / moves, -9 * i / moves), feed_mm_min=600, line=i + 1)
    return program


@pytest.fixture
def every_piece():
    """Each piece of native work tells its progress."""
    with telling.every_piece():
        yield


@pytest.fixture
def slot():
    return make_slot()


@pytest.fixture
def stock():
    return swarf.Stock.box(LO, HI, VOXEL)


@pytest.fixture
def cutter():
    return swarf.Cutter(TOOL)


@pytest.fixture
def launcher():
    """Path of build/swarf."""
    folder = os.environ.get("SWARF_BUILD_DIR")
    if not folder:
        folder = pathlib.Path(swarf._native.__file__).parents[2]
    return pathlib.Path(folder) / "swarf"


def resident_kib():
    """Resident memory of this process now."""
    with open("/proc/self/statm", encoding="ascii") as stream:
        return int(stream.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") // 1024
