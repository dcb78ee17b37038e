# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line, end to end."""
import contextlib
import json
import math
import os
import signal
import subprocess
import time

import pytest

import swarf
from swarf import readers
from conftest import GCODE, SLOT_MM3
from swarf.cli import main
from swarf.progress import Bar

STOCK = "box:0,0,-10,60,40,0"
TOOL = "1=flat:d=6,l=20"


@pytest.fixture
def program(tmp_path):
    path = tmp_path / "slot.nc"
    path.write_text(GCODE)
    return path


@pytest.fixture
def swarf_run(launcher, tmp_path):
    """Run the launcher from another folder; (status, stdout, stderr)."""

    def run(*words):
        done = subprocess.run([launcher, *map(str, words)], cwd=tmp_path, capture_output=True, text=True, timeout=120,
                              stdin=subprocess.DEVNULL, check=False)
        return done.returncode, done.stdout, done.stderr

    return run


@pytest.fixture
def refused(swarf_run, tmp_path):
    """Run and expect status 2, one line, these words in it, and no new file."""

    def run(*words, says):
        before = set(tmp_path.iterdir())
        status, out, err = swarf_run("simulate", *words)
        assert status == 2, err
        assert err.startswith("swarf: error: ") and err.count("\n") == 1 and not out
        for word in says:
            assert word in err
        assert set(tmp_path.iterdir()) == before

    return run


def test_everything_at_once(swarf_run, program, tmp_path):
    status, out, err = swarf_run(
        "simulate", program, "--stock", STOCK, "--tool", TOOL, "--voxel", "0.5", "--threads", "2",
        "--output", "s.stl", "--output", "s.ply", "--output", "s.obj", "--output", "s.vdb",
        "--picture", "s.png", "--report", "r.json")
    assert (status, out, err) == (0, "", "")
    report = json.loads((tmp_path / "r.json").read_text())
    keys = ("version input voxel_mm threads isa moves seconds volume_mm3 removed_mm3_by_operation memory_peak_mb "
            "bounding_box mesh findings operations tools").split()
    assert set(keys) <= set(report) and "comparison" not in report
    assert {"read", "stock", "cut", "mesh", "picture", "total"} <= set(report["seconds"])
    assert (report["voxel_mm"], report["threads"], report["findings"]) == (0.5, 2, [])
    volume = report["volume_mm3"]
    assert volume["initial"] == pytest.approx(24000, rel=1e-4)
    assert volume["removed"] == pytest.approx(SLOT_MM3, rel=1e-2)
    assert volume["final"] == pytest.approx(volume["initial"] - volume["removed"])
    assert sum(report["removed_mm3_by_operation"].values()) == pytest.approx(volume["removed"], rel=1e-6)
    assert report["mesh"]["closed"] and 100 < report["mesh"]["triangles"] < 5000
    assert (report["mesh"]["intersections_found"], report["mesh"]["split_edges"]) == (0, 0)
    assert report["tools"][0]["diameter_mm"] == 6
    for name in ("s.stl", "s.ply", "s.obj", "s.vdb", "s.png"):
        assert (tmp_path / name).stat().st_size > 1000


def test_result_is_the_next_stock(swarf_run, program, tmp_path):
    assert swarf_run("simulate", program, "--stock", STOCK, "--tool", TOOL, "--voxel", "0.5", "--output", "a.vdb",
                     "--output", "a.stl")[0] == 0
    # The voxels come back as they were; meshing and sampling the mesh
    # again moves the slot's 635 mm2 by up to a tenth of a voxel, 0.05 mm: 32 mm3, 3 %.
    for stock, more, left in (("a.vdb", (), 1e-4), ("a.stl", ("--resolution", "120"), 0.03)):
        status, _, err = swarf_run("simulate", program, "--stock", stock, "--tool", TOOL, *more, "--report", "b.json")
        assert status == 0, err
        report = json.loads((tmp_path / "b.json").read_text())
        assert report["voxel_mm"] == pytest.approx(0.5)
        assert report["volume_mm3"]["initial"] == pytest.approx(24000 - SLOT_MM3, rel=1e-2)
        assert report["volume_mm3"]["removed"] < left * SLOT_MM3


def test_cylinder_stock(swarf_run, program, tmp_path):
    status, _, err = swarf_run("simulate", program, "--stock", "cylinder:30,20,-10,30,10", "--tool", TOOL,
                               "--resolution", "100", "--report", "r.json")
    assert status == 0, err
    assert json.loads((tmp_path / "r.json").read_text())["volume_mm3"]["initial"] == pytest.approx(28274.3, rel=2e-3)


@pytest.mark.parametrize(
    "size, says",
    [
        (("--voxel", "0"), ["voxel"]),
        (("--voxel", "-1"), ["voxel"]),
        (("--voxel", "nan"), ["voxel"]),
        (("--voxel", "inf"), ["voxel"]),
        (("--voxel", "1e-9"), ["voxel", "fits"]),
        (("--voxel", "x"), ["--voxel"]),
        (("--resolution", "0"), ["resolution"]),
        (("--resolution", "nan"), ["resolution"]),
        (("--resolution", "10", "--voxel", "1"), ["not allowed with"]),
        (("--threads", "-1"), ["threads"]),
        (("--threads", "99999999999"), ["threads", "1024"]),
        (("--voxel", "1e300"), ["voxel", "possible"]),
    ],
)
def test_impossible_sizes(refused, program, size, says):
    refused(program, "--stock", STOCK, "--tool", TOOL, "--output", "s.stl", *size, says=says)


@pytest.mark.parametrize(
    "stock, says",
    [
        ("box:0,0,0,1,1", ["5 numbers"]),
        ("box:0,0,0,1,1,x", ["x"]),
        ("box:0,0,0,1,1,nan", ["finite"]),
        ("box:0,0,0,-1,1,1", ["corner"]),
        ("cylinder:0,0,0,0,10", ["radius"]),
        ("ball:3", ["box:"]),
        ("none.stl", ["none.stl"]),
        ("none.vdb", ["none.vdb"]),
        ("cut.stl", ["cut.stl"]),
        ("cut.vdb", ["cut.vdb"]),
        ("open.obj", ["open.obj", "not closed"]),
    ],
)
def test_impossible_stocks(refused, program, tmp_path, stock, says):
    (tmp_path / "cut.stl").write_bytes(b"\0" * 80 + b"\5\0\0\0" + b"\0" * 99)
    (tmp_path / "cut.vdb").write_bytes(b" BDV\0\0\0\0" + b"\0" * 20)
    (tmp_path / "open.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    refused(program, "--stock", stock, "--tool", TOOL, says=says)


@pytest.mark.parametrize(
    "tool",
    ["flat:d=3,l=18", "x=flat:d=3,l=18", "-1=flat:d=3,l=18", "1=cube:d=1", "1=", "1=flat:d=0,l=1",
     "1=form:0/0:5/0:2/5:5/3", "1=flat:d=1e9,l=5", "99999999999=flat:d=3,l=18"],
)
def test_impossible_tools(refused, program, tool):
    refused(program, "--stock", STOCK, f"--tool={tool}", says=["tool"])


def test_what_gcode_does_not_tell(refused, program):
    refused(program, "--stock", STOCK, says=["T1", "--tool 1="])
    refused(program, "--tool", TOOL, says=["--stock box:"])
    refused(program, "--tool", TOOL, "--tool", TOOL, "--stock", STOCK, says=["twice"])
    refused(program, "--tool", TOOL, "--stock", STOCK, "--job", "Job", says=["job"])


@pytest.mark.parametrize(
    "name, content, says",
    [
        ("none.nc", None, ["none.nc"]),
        ("empty.nc", b"", ["no moves"]),
        ("comment.nc", b"(nothing here)\n", ["no moves"]),
        ("bad.nc", b"G21\nG0 X1\nG999 Y2\n", ["bad.nc:3:"]),
        ("binary.nc", bytes(range(256)), ["binary.nc:1:"]),
        ("part.step", b"x", ["unknown suffix", ".nc"]),
        ("plain", b"x", ["unknown suffix"]),
        ("text.FCStd", b"this is no archive", ["text.FCStd"]),
    ],
)
def test_impossible_inputs(refused, tmp_path, name, content, says):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    refused(name, "--stock", STOCK, "--tool", TOOL, says=says)


@pytest.mark.parametrize(
    "words, says",
    [
        (("--output", "s.iges"), ["unknown suffix", ".stl", ".step"]),
        (("--output", "s"), ["unknown suffix"]),
        (("--picture", "s.jpg"), [".png"]),
        (("--report", "s.txt"), [".json"]),
        (("--output", "no/s.stl"), ["no/s.stl", "written"]),
        (("--report", "/proc/r.json"), ["/proc/r.json"]),
        (("--output", "folder.stl"), ["regular file"]),
        (("--output", "n" * 252 + ".stl"), ["n.stl: cannot be written: File name too long"]),
        (("--output", "round.stl"), ["round.stl: cannot be written: Too many levels of symbolic links"]),
        (("--output", "nowhere.stl"), ["nowhere.stl: cannot be written: No such file"]),
        (("--output", "s.stl", "--output", "./s.stl"), ["two outputs"]),
        (("--stock", "old.stl", "--output", "old.stl"), ["old.stl: is read, too"]),
        (("--then", "old.nc", "--output", "s.stl", "--report", "old.json", "--machine", "old.json"), ["is read, too"]),
    ],
)
def test_outputs_are_checked_first(refused, program, tmp_path, words, says):
    (tmp_path / "folder.stl").mkdir()
    (tmp_path / "round.stl").symlink_to("round.stl")
    (tmp_path / "nowhere.stl").symlink_to("none/part.stl")
    for name in ("old.stl", "old.json", "old.nc"):
        (tmp_path / name).write_text("old")
    # A voxel that takes minutes: the refusal must come before the work.
    refused(program, "--stock", STOCK, "--tool", TOOL, "--voxel", "0.005", *words, says=says)


def test_outputs_do_not_replace_what_a_project_or_a_document_reads(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "program.json").write_text(GCODE)
    (tmp_path / "project.camotics").write_text(json.dumps({
        "files": ["program.json"], "tools": {"1": {"diameter": 6, "length": 20}},
        "workpiece": {"bounds": {"min": [0, 0, -10], "max": [60, 40, 0]}}}))
    stock = swarf.Stock.box((0, 0, -10), (60, 40, 0), 2.0)
    stock.write("kept.vdb")
    swarf.Mesh.from_stock(stock).write("part.stl")
    files = {path: path.read_bytes() for path in tmp_path.iterdir()}
    words = ["project.camotics", "--resolution", "30", "--report", "./program.json"]
    for command in (["simulate", *words], ["verify", *words, "--design", "part.stl"]):
        assert main(command) == 2 and "program.json: is read, too" in capsys.readouterr().err

    def read(path, job=None, progress=None):
        first = swarf.Job("first", swarf.Program.parse_gcode(GCODE), {1: swarf.Cutter("flat:d=6,l=20")},
                          stock={"kind": "box", "lo": (0, 0, -10), "hi": (60, 40, 0)})
        return swarf.Job("then", first.program, first.tools, stock={"kind": "result", "job": first, "path": "kept.vdb"})

    monkeypatch.setattr(readers, "readers",
                        lambda: {".part": type("Entry", (), {"value": "", "load": lambda self: read})()})
    assert main(["simulate", "a.part", "--output", str(tmp_path / "kept.vdb")]) == 2
    assert "kept.vdb: is read, too" in capsys.readouterr().err
    assert files == {path: path.read_bytes() for path in tmp_path.iterdir()}


def test_no_words(swarf_run):
    for words in ((), ("simulate",), ("mill",), ("simulate", "a.nc", "--nonsense")):
        status, out, err = swarf_run(*words)
        assert status == 2 and err.startswith("swarf: error: ") and err.count("\n") == 1 and not out


def test_streams_that_are_closed_swallow_what_is_said(launcher, program):
    words = f"'{launcher}' simulate '{program}' --stock {STOCK} --tool {TOOL} --voxel 2"
    for line, status in ((f"{words} >&-", 0), (f"{words} <&- >&- 2>&-", 0), (f"{words} --voxel 0 2>&-", 2)):
        done = subprocess.run(["sh", "-c", line], capture_output=True, text=True, timeout=120, check=False)
        assert (done.returncode, done.stdout, done.stderr) == (status, "", ""), line


@pytest.fixture(params=(False, True), ids=("buffered", "unbuffered"))
def environment(request):
    """That of a child whose standard output Python buffers, or not: buffered text fails only when it is flushed."""
    made = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    return {**made, "PYTHONUNBUFFERED": "1"} if request.param else made


def test_full_standard_output_is_an_error_like_all_others(launcher, program, tmp_path, environment):
    swarf.Mesh.from_stock(swarf.Stock.box((0, 0, -10), (60, 40, 0), 2.0)).write(tmp_path / "block.stl")
    (tmp_path / "wrong.nc").write_text("G1 X\n")
    for words in ("--help", "--version", "simulate --help", "moves slot.nc", "mesh block.stl --measure",
                  "check wrong.nc", f"verify slot.nc --stock {STOCK} --tool {TOOL} --voxel 2 --design block.stl"):
        done = subprocess.run(["sh", "-c", f"exec '{launcher}' {words} > /dev/full"], cwd=tmp_path, env=environment,
                              capture_output=True, text=True, timeout=120, check=False)
        error = "swarf: error: standard output: No space left on device"
        assert (done.returncode, done.stderr.splitlines()[-1:]) == (2, [error]), (words, done)
        assert "Exception ignored" not in done.stderr, words
    done = subprocess.run(["sh", "-c", f"exec '{launcher}' moves no.nc 2> /dev/full"], cwd=tmp_path, env=environment,
                          timeout=120, check=False)
    assert done.returncode == 2


def test_a_reader_of_standard_output_that_has_gone_changes_nothing(launcher, program, tmp_path, environment):
    (tmp_path / "wrong.nc").write_text("G1 X\n")
    for words, status in ((["moves", "slot.nc"], 0), (["check", "wrong.nc"], 1), (["--help"], 0)):
        read, write = os.pipe()
        os.close(read)
        try:
            done = subprocess.run([launcher, *words], cwd=tmp_path, env=environment, stdout=write,
                                  stderr=subprocess.PIPE, text=True, timeout=120, check=False)
        finally:
            os.close(write)
        assert (done.returncode, done.stderr) == (status, ""), words


def test_errors_name_the_file_or_the_word_and_what_would_be_right(tmp_path, program, capsys):
    for name in ("folder.json", "folder.camotics"):
        (tmp_path / name).mkdir()
    (tmp_path / "no.camotics").write_text("{}")
    (tmp_path / "no.var").write_text("this is no parameter\n")
    (tmp_path / "empty.var").write_text("\n")
    (tmp_path / "deep.json").write_text("[" * 100000)
    (tmp_path / "open.stl").write_text("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                                       "vertex 0 1 0\nendloop\nendfacet\nendsolid\n")
    part = str(tmp_path / "part-1.stl")
    swarf.Mesh.from_stock(swarf.Stock.box((0, 0, -10), (60, 40, 0), 1.0)).write(part)
    part3 = str(tmp_path / "part.3mf")
    swarf.Mesh.read(part).write(part3)
    swarf.Mesh.read(part).write(tmp_path / "part.glb")
    (tmp_path / "far.obj").write_text("v 0 0 0\nv 9e8 0 0\nv 0 9e8 0\nv 0 0 9e8\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
    size = os.path.getsize(part)
    cut = [str(program), "--stock", STOCK, "--tool", TOOL, "--voxel", "2"]
    held = ["verify", *cut, "--design", part]
    for words, says in (
            ([*held, "--accept", str(tmp_path / "folder.json")], "folder.json: Is a directory"),
            (["simulate", str(tmp_path / "folder.camotics")], "folder.camotics: Is a directory"),
            (["simulate", *cut, "--colours", "operation", "--output", str(tmp_path / "a.stl")],
             "--colours: no --output has colours; .ply, .obj"),
            (["mesh", part, "--thickness", "--output", str(tmp_path / "a.stl")],
             "--thickness: no --output has colours"),
            (["simulate", str(tmp_path / "no.camotics")], "is no CAMotics project: it has no 'files'"),
            (["simulate", *cut, "--parameters", str(tmp_path / "no.var")], "no.var: no line of it is a parameter"),
            (["simulate", *cut, "--machine", str(tmp_path / "deep.json")], "deep.json: is no JSON: "),
            ([*held, "--accept", "/proc/self/mem"], "swarf: error: /proc/self/mem: "),
            (["verify", *cut, "--design", str(tmp_path / "open.stl")], "design: mesh: not closed"),
            ([*held, "--fixture", part, "--fixture", str(tmp_path / "open.stl")], "fixture 2: mesh: not closed"),
            (["mesh", str(tmp_path / "open.stl"), "--split-at", "z=0", "--output", str(tmp_path / "a.stl")],
             "open.stl: mesh: only closed meshes can be split; 3 edges are open"),
            (["mesh", str(tmp_path / "open.stl"), "--split", "--output", str(tmp_path / "a.stl")],
             "open.stl: none of its pieces is closed"),
            (["mesh", str(tmp_path / "open.stl"), "--section", "z=0", "--output", str(tmp_path / "a.svg")],
             "open.stl: sections are of closed meshes; 3 edges are open"),
            (["mesh", str(tmp_path / "far.obj"), "--thickness", "--measure"], "far.obj: mesh: coordinates up to 9e+08"),
            (["mesh", part3, "--measure"], "part.3mf: neither STL, PLY nor OBJ, of which meshes are read; 3MF "),
            (["mesh", str(tmp_path / "part.glb"), "--measure"], "3MF and glTF are only written"),
            (["simulate", *cut[:2], part3, *cut[3:]], "part.3mf': wanted box:"),
            (["mesh", "", "--measure"], "nothing stands after mesh: a name or a value"),
            (["mesh", part, "--output", ""], "nothing stands after --output: "),
            (["simulate", *cut, "--then", ""], "nothing stands after --then: "),
            (["simulate", *cut, "--output="], "nothing stands after --output=: "),
            (["mesh", part, "--output=a="], "a=: unknown suffix"),
            ([*held, "--allowance", "1e300"], "an allowance of 1e+300 mm; -1e+06 to 1e+06 are possible"),
            ([*held, "--tolerance", "1e300"], "a tolerance of 1e+300 mm"),
            ([*held, "--clearance", "1e300"], "a clearance of 1e+300 mm; 0 to 1000 are possible"),
            (["mesh", part, "--split-at", "q=3", "--output", part], "plane 'q=3': wanted "),
            (["mesh", part, "--split", "--output", str(tmp_path / "part.stl")], "part-1.stl: is the input")):
        try:
            status = main(words)
        except SystemExit as ended:  # the parser's own
            status = ended.code
        told = capsys.readouterr()
        assert status == 2 and told.err.count("\n") == 1 and says in told.err, (words, told.err)
    assert os.path.getsize(part) == size
    assert main(["simulate", *cut, "--parameters", str(tmp_path / "empty.var")]) == 0


def test_names_as_long_as_the_system_takes_and_links(program, tmp_path):
    (tmp_path / "away").mkdir()
    long = [tmp_path / ("n" * (255 - len(suffix)) + suffix) for suffix in (".stl", ".vdb", ".png", ".json")]
    linked = [tmp_path / ("part" + path.suffix) for path in long]
    for path in linked:
        path.symlink_to(tmp_path / "away" / path.name)
    for stl, vdb, png, report in (long, linked):
        assert main(["simulate", str(program), "--stock", STOCK, "--tool", TOOL, "--voxel", "2", "--output", str(stl),
                     "--output", str(vdb), "--picture", str(png), "--report", str(report)]) == 0
    assert all(path.is_symlink() for path in linked) and len(list((tmp_path / "away").iterdir())) == 4
    assert all(path.stat().st_size for path in long + linked)


def test_standard_error_that_has_gone_changes_nothing(launcher, program, tmp_path):
    """The result is told by files and the exit status."""
    read, write = os.pipe()
    os.close(read)
    try:
        swarf.Stock.box((0, 0, 0), (4, 4, 4), 1.0).write(tmp_path / "block.vdb")
        done = subprocess.run([launcher, "mesh", "block.vdb", "--output", "block.step"], cwd=tmp_path, stderr=write,
                              timeout=120, check=False)
    finally:
        os.close(write)
    assert done.returncode == 0 and (tmp_path / "block.step").stat().st_size


def test_a_terminal_that_is_closed_stops_no_work():
    keyboard, screen = os.openpty()
    with open(screen, "w", encoding="utf-8") as stream:
        bar = Bar(stream)
        bar("cut", 0.1)
        assert bar.active and os.read(keyboard, 99).startswith(b"\rcut")
        os.close(keyboard)
        bar("cut", 0.5)
        bar.close()
        assert not bar.active


def test_help_and_version(swarf_run):
    assert swarf_run("--version")[1].startswith("swarf 0.")
    status, out, _ = swarf_run("simulate", "--help")
    assert status == 0
    for option in "stock tool voxel resolution threads output picture report job".split():
        assert f"--{option}" in out


def open_once_read(fifo):
    """The fifo for writing, None while nobody has it open for reading."""
    try:
        handle = os.open(fifo, os.O_WRONLY | os.O_NONBLOCK)
    except OSError:
        return None
    os.set_blocking(handle, True)
    return open(handle, "w", encoding="ascii")


def answer(number, how):
    """What a process does at its start, so that it does not hang on what this one was started with."""
    return lambda: signal.signal(number, how)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_signals_end_it_like_an_error(launcher, tmp_path, number):
    fifo = tmp_path / "job.nc"
    os.mkfifo(fifo)
    command = [launcher, "simulate", "job.nc", "--stock", STOCK, "--tool", TOOL, "--output", "s.stl"]
    with subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True,
                          preexec_fn=answer(number, signal.SIG_DFL)) as running:
        while (pipe := open_once_read(fifo)) is None:  # the command waits for our words from there on
            assert running.poll() is None
            time.sleep(0.01)
        running.send_signal(number)
        with contextlib.suppress(BrokenPipeError), pipe:  # it may be gone before it has read them
            pipe.write(GCODE)
        _, err = running.communicate(timeout=120)
    assert (running.returncode, err) == (2, "swarf: error: interrupted\n")
    assert [path.name for path in tmp_path.iterdir()] == ["job.nc"]


def test_ctrl_c_before_it_has_begun_ends_it_quietly(launcher, tmp_path):
    """A module that it imports waits, to be met there."""
    (tmp_path / "argparse.py").write_text("import time\nprint('importing', flush=True)\ntime.sleep(60)\n")
    for how, ended in ((signal.SIG_DFL, -signal.SIGINT), (signal.SIG_IGN, -signal.SIGTERM)):
        with subprocess.Popen([launcher, "--version"], cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(tmp_path)},
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              preexec_fn=answer(signal.SIGINT, how)) as running:
            assert running.stdout.readline() == "importing\n"
            running.send_signal(signal.SIGINT)
            if how == signal.SIG_IGN:
                running.terminate()
            _, err = running.communicate(timeout=120)
        assert (running.returncode, err) == (ended, "")


def test_a_report_that_cannot_be_written_is_named(tmp_path):
    from swarf import report

    with pytest.raises(OSError, match="none/r.json: cannot write"):
        report.write({}, str(tmp_path / "none/r.json"))


def test_a_package_of_this_name_in_the_working_folder_is_not_run(swarf_run, tmp_path):
    (tmp_path / "swarf.py").write_text("raise SystemExit(9)")
    assert swarf_run("--version")[0] == 0


def test_findings_of_class_error_give_status_1(monkeypatch, program, tmp_path, capsys):
    """A registered reader's job with a tool that is missing."""
    import swarf
    from swarf import cli, readers

    class Entry:
        value = "test"

        @staticmethod
        def load():
            def read(path, job=None, progress=None):
                assert job == "Job1"
                return swarf.Job(f"{job}", swarf.Program.read_gcode(program),
                                 stock={"kind": "box", "lo": (0, 0, -10), "hi": (60, 40, 0)},
                                 design=swarf.Mesh.from_stock(swarf.Stock.box((0, 0, -10), (60, 40, 0), 1)))
            return read

    monkeypatch.setattr(readers, "readers", lambda: {".part": Entry})
    report = tmp_path / "r.json"
    assert cli.main(["simulate", "a.part", "--job", "Job1", "--resolution", "60", "--report", str(report)]) == 1
    made = json.loads(report.read_text())
    assert made["findings"][0]["severity"] == "error"
    assert set(made["comparison"]) == {"design_mm3", "stock_mm3", "excess_mm3", "gouge_mm3"}
    assert "swarf: error: line" in capsys.readouterr().err


def test_a_tool_that_the_program_does_not_name_has_its_own_number(tmp_path, capsys):
    program, report = tmp_path / "bare.nc", tmp_path / "report.json"
    program.write_text("G21 G90 F300\nG0 X10 Y20 Z5\nG1 Z-2\nX40\nG0 Z5\nM2\n")
    words = [str(program), "--stock", STOCK, "--tool", "3=flat:d=6,l=20", "--voxel", "1"]
    assert main(["simulate", *words, "--report", str(report)]) == 0
    assert "the program names no tool: tool 3 is used" in capsys.readouterr().err
    made = json.loads(report.read_text())
    assert [tool["number"] for tool in made["tools"]] == [3] and list(made["machine_seconds_by_tool"]) == ["3"]
    # one that cannot cut is called by that number, too
    pin = swarf.Cutter.from_parts([("shank", [(0, 0, 0), (3, 0, 0), (3, 20, 0), (0, 20, 0)])])
    job = swarf.Job("bare", swarf.Program.read_gcode(program), {3: pin, -1: pin},
                    stock={"kind": "box", "lo": (0, 0, -10), "hi": (60, 40, 0)})
    block = swarf.Mesh.from_stock(swarf.Stock.box((0, 0, -10), (60, 40, 0), 1.0))
    texts = [finding.text for finding in swarf.verify(job, block, voxel=1.0).findings]
    assert "tool T3 has no flutes" in texts


def test_fine_edges_where_they_are_asked_for(swarf_run, tmp_path):
    (tmp_path / "thread.nc").write_text("G21 G90 T1 M6\nG0 X11 Y-5 Z-4\nG1 Y13 F100\nM2\n")
    words = ("simulate", "thread.nc", "--stock", "box:0,0,-6,20,8,0", "--tool",
             "1=threadmill:d=4,n=2.4,p=1,k=3,l=5", "--voxel", "0.23")
    slot = 8 * 2 * (1.2 * 4 + 3 * 0.8 ** 2 * math.tan(math.pi / 6))
    off = {}
    for suffix in (".stl", ".ply"):  # streamed, and made as a whole
        for fine in ((), ("--fine",)):
            status, _, err = swarf_run(*words, *fine, "--output", "part" + suffix)
            assert status == 0, err
            mesh = swarf.Mesh.read(tmp_path / ("part" + suffix))
            assert mesh.closed
            off[suffix, bool(fine)] = abs(mesh.volume - (20 * 8 * 6 - slot))
        assert off[suffix, True] < 0.5 * off[suffix, False], off


def test_volume_is_kept_where_it_is_asked_for(swarf_run, tmp_path):
    (tmp_path / "groove.nc").write_text("G21 G90 T1 M6\nG0 X-9 Y10 Z-5\nG1 X39 F100\nM2\n")
    words = ("simulate", "groove.nc", "--stock", "box:0,0,-8,30,20,0", "--tool", "1=ball:d=10,l=20", "--voxel", "0.15")
    volume = 30 * (20 * 8 - math.pi * 5 ** 2 / 2)
    off = {}
    for kept in ((), ("--keep-volume",)):
        status, _, err = swarf_run(*words, *kept, "--output", "part.ply", "--output", "part.vdb")
        assert status == 0, err
        off["simulate", bool(kept)] = abs(swarf.Mesh.read(tmp_path / "part.ply").volume - volume)
        for suffix in (".stl", ".obj"):  # streamed, and made as a whole
            status, _, err = swarf_run("mesh", "part.vdb", *kept, "--output", "again" + suffix)
            assert status == 0, err
            off[suffix, bool(kept)] = abs(swarf.Mesh.read(tmp_path / ("again" + suffix)).volume - volume)
    assert off["simulate", True] < 1e-5 * volume < 0.1 * off["simulate", False], off
    assert off[".stl", True] < 0.7 * off[".stl", False] and off[".obj", True] < 0.7 * off[".obj", False], off
    status, _, err = swarf_run("mesh", "part.ply", "--keep-volume", "--output", "again.ply")
    assert status == 2 and "--keep-volume are for stocks" in err


@pytest.fixture
def groove(tmp_path):
    """Words that cut a ball's groove through a block, 30 mm long."""
    (tmp_path / "groove.nc").write_text("G21 G90 T1 M6\nG0 X-9 Y10 Z-5\nG1 X39 F100\nM2\n")
    return ("simulate", "groove.nc", "--stock", "box:0,0,-8,30,20,0", "--tool", "1=ball:d=10,l=20", "--voxel", "0.5")


def groove_distance(point):
    """How far a point is from the surface that the groove leaves, mm."""
    x, y, z = point
    out = math.hypot(y - 10, z)
    return min(abs(x), abs(x - 30), abs(y), abs(y - 20), abs(z), abs(z + 8), abs(out - 5))


@pytest.mark.parametrize("suffix", [".stl", ".ply"])  # streamed, and made as a whole
def test_a_mesh_is_within_the_error_that_is_asked_for(swarf_run, groove, tmp_path, suffix):
    count = {}
    for error in (0.01, 0.3):
        status, _, err = swarf_run(*groove, "--error", error, "--output", "part" + suffix)
        assert (status, err) == (0, "")
        mesh = swarf.Mesh.read(tmp_path / ("part" + suffix))
        points, count[error] = mesh.vertices.tolist(), mesh.triangle_count
        assert mesh.closed
        for corners in mesh.triangles.tolist():
            middle = [sum(points[i][axis] for i in corners) / 3 for axis in range(3)]
            assert groove_distance(middle) <= error + 0.01 * 0.5
    assert count[0.3] < 0.7 * count[0.01]


def test_a_budget_of_triangles_is_met_or_what_is_possible_is_said(swarf_run, groove, tmp_path):
    words = (*groove, "--error", "0.5", "--output", "part.stl")
    status, _, err = swarf_run(*words)
    assert (status, err) == (0, "")
    fewest = swarf.Mesh.read(tmp_path / "part.stl").triangle_count
    status, _, err = swarf_run(*words, "--budget", 2 * fewest, "--report", "r.json")
    assert (status, err) == (0, "")
    assert fewest < swarf.Mesh.read(tmp_path / "part.stl").triangle_count <= 2 * fewest
    told = json.loads((tmp_path / "r.json").read_text())["mesh"]
    assert 0 < told["error_mm"] < 0.5 and told["budget_met"] is True
    for report in ((), ("--report", "r.json")):  # with one .stl file, and a mesh for the report as well
        status, _, err = swarf_run(*words, "--budget", "9", *report)
        assert status == 1 and err.count("\n") == 1
        left = swarf.Mesh.read(tmp_path / "part.stl").triangle_count
        assert f"warning: {left} triangles are more than 9: an error of 0.5 mm leaves no fewer; allow" in err
    assert json.loads((tmp_path / "r.json").read_text())["mesh"]["budget_met"] is False


@pytest.mark.parametrize("words, says", [
    (("--error", "-1"), "error -1: not a length"),
    (("--error", "nan"), "error nan: not a length"),
    (("--error", "1e100"), "error 1e+100: not a length"),
    (("--error", "fine"), "fine"),
    (("--budget", "-1"), "budget -1: not a number of triangles"),
    (("--budget", str(1 << 32)), "not a number of triangles"),
    (("--budget", "many"), "many"),
    (("--budget", "9", "--error", "0"), "a budget of 9 triangles needs an error"),
])
def test_errors_and_budgets_that_cannot_be(refused, program, words, says):
    refused(program, "--stock", STOCK, "--tool", TOOL, "--output", "s.stl", *words, says=[says])


@pytest.mark.parametrize("words, says", [
    (("--fine",), "--fine: nothing that is made heeds it; give --output with .stl, .ply"),
    (("--keep-volume", "--output", "s.vdb"), "--keep-volume: nothing that is made heeds it"),
    (("--error", "0.1", "--picture", "s.png"), "--error: nothing that is made heeds it"),
    (("--error", "0.1", "--budget", "9"), "--error and --budget: nothing that is made heeds it"),
    (("--error", "0.1", "--budget", "9", "--output", "s.step"), "error: --budget: nothing that is made heeds it"),
])
def test_options_of_meshes_without_one_are_refused(refused, program, words, says):
    refused(program, "--stock", STOCK, "--tool", TOOL, "--voxel", "0.005", *words, says=[says])


def test_options_of_meshes_are_for_reports_and_errors_for_solids(swarf_run, groove, tmp_path):
    status, _, err = swarf_run(*groove, "--error", "0.5", "--budget", "999", "--fine", "--report", "r.json")
    assert (status, err) == (0, "")
    assert json.loads((tmp_path / "r.json").read_text())["mesh"]["triangles"] <= 999
    status, _, err = swarf_run(*groove, "--error", "0.5", "--output", "s.step")
    assert (status, err) == (0, "")


def test_a_stock_without_its_loose_pieces_does_not_have_the_error_of_the_mesh(swarf_run, groove, tmp_path):
    (tmp_path / "groove.nc").write_text("G21 G90 T1 M6\nG0 X-9 Y10 Z-5\nG1 X39 F100\nG0 Z9\n"
                                        "T2 M6\nG0 X24 Y-5\nG0 Z-9\nG1 Y25 F100\nM2\n")
    kept = 22 * (20 * 8 - math.pi * 5 ** 2 / 2)
    for error in (0.02, 0.9):
        status, _, err = swarf_run(*groove, "--tool", "2=flat:d=4,l=20", "--error", error, "--loose", "drop",
                                   "--output", "part.vdb", "--output", "part.ply")
        assert status == 0, err
        assert swarf.Stock.read(tmp_path / "part.vdb").volume() == pytest.approx(kept, rel=3e-3)
    assert swarf.Mesh.read(tmp_path / "part.ply").volume != pytest.approx(kept, rel=5e-3)


def test_a_stock_of_which_nothing_is_left_is_told(swarf_run, tmp_path):
    (tmp_path / "all.nc").write_text("G21 G90 T1 M6\nG0 X-9 Y2 Z-1\nG1 X9 F100\nM2\n")
    words = ("simulate", "all.nc", "--stock", "box:0,0,0,4,4,2", "--tool", "1=flat:d=12,l=9", "--voxel", "0.5")
    status, _, err = swarf_run(*words, "--output", "z.vdb")
    assert (status, err) == (0, "")
    for outputs in (("z.stl",), ("z.stl", "z.ply")):
        told = f"swarf: warning: nothing is left of the stock: no triangles in {', '.join(outputs)}\n"
        chosen = [word for path in outputs for word in ("--output", path)]
        for command in (words, ("mesh", "z.vdb")):
            status, _, err = swarf_run(*command, *chosen)
            assert (status, err) == (0, told)
            assert swarf.Mesh.read(tmp_path / "z.stl").triangle_count == 0
    assert swarf_run("mesh", "z.vdb", "--measure")[2] == "swarf: warning: nothing is left of the stock\n"


def test_a_stock_of_which_only_a_thin_floor_is_left_is_told(swarf_run, tmp_path):
    (tmp_path / "all.nc").write_text("G21 G90 T1 M6\nG0 X-9 Y2 Z0.2\nG1 X13 F100\nM2\n")
    status, _, err = swarf_run("simulate", "all.nc", "--stock", "box:0,0,0,4,4,2", "--tool", "1=flat:d=12,l=9",
                               "--voxel", "0.5", "--output", "z.stl")
    assert status == 0
    assert "warning: what is left of the stock is thinner than a voxel: no triangles in z.stl\n" in err


def test_a_volume_that_could_not_be_kept_is_told(swarf_run, groove, tmp_path):
    """With few voxels a fifth of the error is not enough; a stream and a mesh say the same, the report too."""
    words = ("--error", "0.2", "--keep-volume")
    outputs = (("--output", "part.stl"), ("--output", "part.ply", "--output", "part.vdb", "--report", "r.json"))
    (status, _, streamed), (_, _, whole) = [swarf_run(*groove, "--voxel", "2", *words, *chosen) for chosen in outputs]
    mesh = json.loads((tmp_path / "r.json").read_text())["mesh"]
    volume, surface = swarf.Mesh.read(tmp_path / "part.stl").volume, mesh["surface_mm3"]
    assert mesh["volume_mm3"] == pytest.approx(volume, rel=1e-7)
    assert mesh["volume_off"] == pytest.approx((volume - surface) / surface, rel=1e-3) and mesh["volume_off"] > 1e-3
    assert status == 0 and streamed == whole == (
        f"swarf: warning: the mesh has {volume:.8g} mm3, the surface it stands for {surface:.8g}, "
        f"{mesh['volume_off']:.1e} of it apart: --keep-volume may shift vertices no farther\n")
    for output in ("again.stl", "again.ply"):
        status, _, err = swarf_run("mesh", "part.vdb", *words, "--output", output)
        assert status == 0 and f"the mesh has {swarf.Mesh.read(tmp_path / output).volume:.8g} mm3" in err
        assert swarf_run("mesh", "part.vdb", *words[:2], "--output", output) == (0, "", "")
    assert swarf_run(*groove, *words, "--output", "part.stl") == (0, "", "")


def test_notes_of_the_program_say_their_kind_once(swarf_run, program):
    program.write_text(GCODE.replace("M2", ""))
    status, _, err = swarf_run("simulate", program, "--stock", STOCK, "--tool", TOOL, "--voxel", "1")
    assert status == 0 and err.startswith(f"swarf: {program}:") and err.count("warning") == 1
