# SPDX-License-Identifier: LGPL-2.1-or-later
"""Holders: the library, profiles of one's own, stickouts, and that a check meets them where they are."""
import math
import subprocess
import sys

import pytest

import swarf
from swarf import holders
from test_verify import DESIGN


def test_every_holder_of_the_library_holds_a_tool():
    names = holders.names()
    assert len(names) == len(set(names)) > 100
    for name in names:
        held, notes = holders.hold(swarf.Cutter("flat:d=6,l=20,sd=6,sl=30"), name, 30.0)
        low, high = held.extent("holder")
        assert math.isclose(low, 30.0) and high > 40 and held.radius("holder") >= 8, name
        assert not notes, name


def test_projection_and_shape():
    holder = holders.find("sk40-er32", 100)
    assert holder.name == "SK40-ER32" and math.isclose(sum(length for length, _, _ in holder.sections), 100)
    held, _ = holders.hold(swarf.Cutter("flat:d=6,l=20"), holder, 25)
    assert held.extent("holder") == pytest.approx((25, 125)) and held.extent("shank") == pytest.approx((20, 25))
    assert math.isclose(held.volume("holder"), math.pi * (25 ** 2 * (100 - 19.1) + 31.775 ** 2 * 19.1), rel_tol=1e-6)
    shrink = holders.find("HSK-A63-SHRINK12")
    length, lower, upper = shrink.sections[0]
    assert (lower, upper) == (24, 32) and math.isclose(length, 50.82, abs_tol=0.01)
    with pytest.raises(ValueError, match="projection of 30 mm"):
        holders.find("SK40-ER32", 30)
    for name in ("ER12", "SK41-ER32", "SK40-", "", "ER32-SK40"):
        with pytest.raises(ValueError, match="is not known"):
            holders.find(name)


def test_own_profile():
    held, _ = holders.hold(swarf.Cutter("ball:d=6,l=20"), "form:0/0:10/0:20/30:0/30", 40)
    assert held.extent("holder") == pytest.approx((40, 70)) and held.radius("holder") == pytest.approx(20)
    with pytest.raises(ValueError, match="tool 3"):
        holders.hold(swarf.Cutter("ball:d=6,l=20"), "form:0/0:10/x", 40, "tool 3")


def test_stickouts():
    mill = swarf.Cutter("flat:d=6,l=20,sd=6,sl=30")
    with pytest.raises(ValueError, match="tool 1: a holder needs its stickout"):
        holders.hold(mill, "ER16", None, "tool 1")
    for stickout in (0, -3, math.nan, math.inf):
        with pytest.raises(ValueError, match="stickout of"):
            holders.hold(mill, "ER16", stickout)
    held, notes = holders.hold(mill, "ER16", 15, "tool 1")
    assert len(notes) == 1 and "flutes are 20 mm long" in notes[0] and held.extent("flutes") == (0, 20)
    _, notes = holders.hold(swarf.Cutter("flat:d=12,l=20"), "ER16", 30)
    assert len(notes) == 1 and "up to 10 mm" in notes[0]
    again, _ = holders.hold(held, "ER32", 30)  # another holder takes the place of the first
    assert again.radius("holder") == 25 and again.extent("holder")[0] == 30


def test_a_check_meets_the_holder():
    """A pocket wall of 40 mm: with a stickout of 30 the nut is 10 below the top, at its own radius from the wall."""
    program = swarf.Program(start=(-30, 0, 60))
    program.add_operation("wall")
    program.set_section(tool=1, spindle="cw", spindle_rpm=8000)
    program.add_line((-30, 0, -40), kind="rapid", line=1)
    program.add_line((-3, 0, -40), feed_mm_min=400, line=2)

    def stock():
        return swarf.Stock.box((0, -20, -45), (20, 20, 0), 0.5)

    mill = swarf.Cutter("flat:d=6,l=20,sd=6,sl=60")
    assert not stock().check(program, {1: mill}).findings
    long, _ = holders.hold(mill, "ER32", 41)
    assert not stock().check(program, {1: long}).findings
    short, _ = holders.hold(mill, "ER32", 30)
    (found,) = stock().check(program, {1: short}).findings
    assert found.kind == "holder" and found.line == 2 and math.isclose(found.tip[0], -25, abs_tol=0.06)


def test_words():
    assert holders.parse("1=SK40-ER16,stickout=35") == (1, "SK40-ER16", 35.0, None)
    assert holders.parse("2=er32,stickout=40,projection=100") == (2, "er32", 40.0, 100.0)
    assert holders.parse("1=ER16") == (1, "ER16", None, None)
    for word in ("ER16", "x=ER16", "1=", "1=ER16,length=3", "1=ER16,stickout=x", "1=ER16,stickout=1,stickout=2",
                 "1=form:0/0:1/1,projection=3"):
        with pytest.raises(ValueError, match="holder"):
            holders.parse(word)


def test_command_line(tmp_path):
    program, design = tmp_path / "part.nc", tmp_path / "design.stl"
    program.write_text("G21 G90\nT1 M6\nM3 S8000\nG0 X20 Y15 Z5\nG1 Z-1 F200\nG0 Z50\nM2\n")
    DESIGN.write(str(design))

    def run(*words):
        return subprocess.run(
            [sys.executable, "-P", "-m", "swarf", "verify", str(program), "--design", str(design), "--voxel", "0.5",
             "--stock", "box:0,0,-10,40,30,0", "--tool", "1=flat:d=6,l=20", *words],
            capture_output=True, text=True, timeout=120, check=False)

    done = run("--holder", "1=ER16,stickout=15", "--excess", "10")
    assert done.returncode == 0 and "flutes are 20 mm long" in done.stderr
    done = run("--holder", "1=ER16")
    assert done.returncode == 2 and "needs its stickout" in done.stderr
    done = run("--holder", "7=ER16,stickout=30")
    assert done.returncode == 2 and "tool 7" in done.stderr
