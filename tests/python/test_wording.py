# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is said of findings: the library's own words, and the same in another language."""
import ast
import copy
import pathlib
import pickle
import string

import pytest

import swarf
from swarf import loads, wording
from swarf.job import Job
from swarf.verify import _UNITS, check_text, place_text, uncut_text

PLATE = ((0.0, 0.0, -10.0), (60.0, 40.0, 0.0))


def wrong():
    """A program that does about all that it must not."""
    program = swarf.Program(start=(5, 5, -1))
    program.add_operation("all wrong")
    for tool, spindle, points in (
            (1, "off", [("rapid", (20, 5, -1)), ("rapid", (22, 5, -1)), ("feed", (20, 5, -8)), ("feed", (30, 5, -8))]),
            (1, "ccw", [("feed", (30, 5, -25))]), (-1, "cw", [("feed", (31, 5, -25))]),
            (9, "cw", [("feed", (40, 5, -25))]), (3, "cw", [("feed", (41, 5, 5))]),
            (2, "cw", [("rapid", (70, 5, 5)), ("rapid", (70, 5, -19)), ("feed", (56, 5, -19)), ("feed", (56, 5, -30)),
                       ("feed", (10, 5, -30))])):
        program.set_section(tool=tool, spindle=spindle, spindle_rpm=100)
        for kind, point in points:
            program.add_line(point, kind=kind, feed_mm_min=0.0 if point[2] == -8 else 100.0)
    return program


def cube(lo, hi, voxel=1.0):
    return swarf.Mesh.from_stock(swarf.Stock.box(lo, hi, voxel))


def job_of(program):
    part = [(0, 0), (3, 0), (3, 4), (0, 4)]
    tools = {1: swarf.Cutter("flat:d=6,l=6"), 2: swarf.Cutter.from_parts([
        ("flutes", [(0, 0, 0), (3, 0, 0), (3, 6, 0), (0, 6, 0)]),
        ("shank", [(0, 6, 0), (4, 6, 0), (4, 20, 0), (0, 20, 0)]),
        ("holder", [(0, 20, 0), (9, 20, 0), (9, 40, 0), (0, 40, 0)])]),
        3: swarf.Cutter.from_parts([("shank", [(r, z, 0) for r, z in part])])}
    return Job("job", program, tools)


def test_checks_are_told_in_the_librarys_own_words():
    job = job_of(wrong())
    stock = swarf.Stock.box(*PLATE, 0.5)
    clamp, design = swarf.Solid(cube((8, 2, -12), (30, 8, 30))), swarf.Solid(cube((0, 0, -10), (60, 40, -2)))
    checked = stock.check(job.program, job.tools, fixtures=[clamp], design=design, clearance=1.5)
    told = {}
    for found in checked.findings:
        text = check_text(found, job, 1.5)
        assert text == found.text and isinstance(text, wording.Said)
        told[text.key] = text
    assert {"start", "rapid", "shank", "holder", "depth", "spindle stopped", "spindle backwards", "feed", "tool none",
            "tool missing", "tool blunt", "fixture flutes", "fixture shank", "fixture holder", "design flutes",
            "near"} <= set(told), sorted(told)
    assert all(uncut_text(found, job) == found.text for found in checked.simulation.findings)
    assert {found.kind for found in checked.simulation.findings} == {"no tool", "unknown tool", "no flutes"}


def test_moves_without_a_tool_are_not_of_a_tool_minus_one():
    bare = swarf.Program(start=(5, 5, 5))
    bare.add_operation("bare")
    bare.add_line((5, 5, -1), feed_mm_min=100)
    job = job_of(bare)
    job.stock = {"kind": "box", "lo": PLATE[0], "hi": PLATE[1]}
    done = swarf.verify(job, cube(*PLATE), voxel=1.0, loads=False)
    texts = [found.text for found in done.findings if found.kind in ("tool", "uncut")]
    assert texts == ["moves before any tool is loaded"]


def test_long_names_of_operations_are_cut_between_characters():
    for name in ("ä" * 60, "x" + "ä" * 60, "xy" + "\u20ac" * 40, "x" * 77 + "\U0001f600", "x" * 80, "x" * 81,
                 "x" * 79 + "ä"):
        for tool, point, kind in ((-1, (9, 5, 5), "no tool"), (9, (9, 5, 5), "unknown tool"),
                                  (3, (9, 5, 5), "no flutes"), (1, (9, 5, 50), "idle")):
            program = swarf.Program(start=(5, 5, 50))
            program.set_section(tool=tool, operation=program.add_operation(name))
            program.add_line(point, feed_mm_min=100)
            job = job_of(program)
            (found,) = swarf.Stock.box(*PLATE, 2.0).simulate(job.program, job.tools).findings
            assert found.kind == kind and uncut_text(found, job) == found.text and "\ufffd" not in found.text
            assert (name in found.text) == (len(name.encode()) <= 80) and name[:20] in found.text


def test_moves_that_are_not_simulated_are_told_in_the_librarys_own_words():
    bare = swarf.Program(start=(0, 0, 0))
    bare.add_operation("bare")
    bare.add_line((1, 0, 0), feed_mm_min=100)
    turned, away = (swarf.Program.parse_gcode("G21 G90\nT1 M6\n" + text, start=(0, 0, 5)) for text in (
        "G1 X5 A30 F9\n", "G0 X-50\nG1 X-60 F9\n"))
    for program, kinds in ((bare, {"no tool"}), (turned, {"axis"}), (away, {"idle"})):
        job = job_of(program)
        found = swarf.Stock.box(*PLATE, 1.0).simulate(job.program, job.tools).findings
        assert {item.kind for item in found} == kinds
        assert [uncut_text(item, job) for item in found] == [item.text for item in found]


def test_places_of_designs_are_told_in_the_librarys_own_words():
    first = swarf.Stock.box(*PLATE, 1.0)
    gone = swarf.Stock.box(*PLATE, 2.0)
    plunge = swarf.Program(start=(30, 20, 5))
    plunge.add_line((30, 20, -30), feed_mm_min=100)
    gone.cut(swarf.Cutter("flat:d=200,l=50"), plunge)
    scaled = [((0, 0, 0), (60 * factor, 40 * factor, 10 * factor), "unit", first)
              for factor in (25.4, 1 / 25.4, 10.0, 0.1, 1000.0, 0.001)]
    told = set()
    for lo, hi, key, stock in (((100, 0, -10), (160, 40, 0), "beside", first),
                               ((0, 0, -10), (60, 40, 20), "out", first),
                               ((0, 0, -10), (60, 40, 0), "empty", gone), *scaled):
        mesh = cube(lo, hi, max(hi) / 30)
        kind, value, factor, text = swarf.compare_place(stock, swarf.Solid(mesh))
        said = place_text(kind, value, factor, stock, mesh)
        assert kind == key and said == text
        told.add(said.values.get("units"))
    assert len(told) == 7  # six of units, and none


def test_another_language_has_the_same_values():
    german = {"excess": "Material übrig: {amount}", "amount": "{value:.3f} mm, {area:.4g} mm2 ({volume:.4g} mm3)"}
    forms = {wording.FORMS[key]: text for key, text in german.items()}
    amount = wording.Said("amount", value=0.125, area=12.5, volume=3.0)
    said = wording.Said("excess", amount=amount)
    assert said == "material left: 0.125 mm, 12.5 mm2, 3 mm3"
    assert said.translated(forms.get, ",") == "Material übrig: 0,125 mm, 12,5 mm2 (3 mm3)"
    for copied in (copy.deepcopy(said), pickle.loads(pickle.dumps(said))):
        assert copied == said and (copied.key, copied.values) == (said.key, said.values)
    assert wording.Said("set-up", job="{x}", text=said).translated(lambda form: form) == f"set-up '{{x}}': {said}"


PARTS, UNCUT = ("flutes", "shank", "holder"), ("no tool", "unknown tool", "no flutes", "axis", "idle")

#: Keys that are made when they are said, by file, function and expression: all that may come of it.
MADE = {
    ("brep.py", "fail", "key"): (),  # which is looked at where it is called
    ("brep.py", "solve", "lost"): ("edge lost", "corner lost"),
    ("native.py", "said", "key"): (),  # so is this
    ("loads.py", "text", "name"): [entry[2] for entry in loads.KINDS.values()],
    ("loads.py", "text", "unit"): [entry[1] for entry in loads.KINDS.values()],
    ("verify.py", "_idle_text", "key"): ("of tolerance", "of allowance", "of both"),
    ("verify.py", "check_text", "key"): (
        "rapid", "start", "depth", "near", "shank", "holder", "feed", "spindle stopped", "spindle backwards",
        "tool none", "tool missing", "tool blunt", *(f"fixture {part}" for part in PARTS),
        *(f"design {part}" for part in PARTS)),
    ("verify.py", "uncut_text", "f'uncut {found.kind}'"): [f"uncut {kind}" for kind in UNCUT],
    ("verify.py", "place_text", "f'place {kind}'"): ("place empty", "place out"),
    ("verify.py", "place_text", "units"): [words for _, words in _UNITS],
    ("verify.py", "_cluster_finding", "key"): ("gouge", "gouge of no move", "excess", "excess away", "not reached"),
}


def sentences(node, path, function=""):
    """(key, or the place in MADE where it is made; names of the values, None: not to be seen) of what a file says."""
    inner = node.name if isinstance(node, ast.FunctionDef) else function
    for child in ast.iter_child_nodes(node):
        yield from sentences(child, path, inner)
    called = getattr(node, "func", None)
    called = getattr(called, "attr", getattr(called, "id", None))
    if called not in ("Said", "said") and not (called == "fail" and path.name == "brep.py"):
        return
    names = {keyword.arg for keyword in node.keywords}
    key = node.args[0]
    for one in (key.body, key.orelse) if isinstance(key, ast.IfExp) else (key,):
        made = one.value if isinstance(one, ast.Constant) else (path.name, function, ast.unparse(one))
        yield made, None if None in names else names


def test_all_that_is_said_has_a_form_and_all_forms_are_said():
    sources = pathlib.Path(__file__).parents[2]
    said = [found for folder in ("bindings/swarf", "freecad_mod/freecad")
            for path in sorted((sources / folder).rglob("*.py"))
            for found in sentences(ast.parse(path.read_text(encoding="utf-8")), path)]
    assert {made for made, _ in said if isinstance(made, tuple)} == set(MADE)
    seen = set()
    for made, values in said:
        for key in MADE[made] if isinstance(made, tuple) else (made,):
            assert key in wording.FORMS, (made, key)
            wanted = {field for _, field, _, _ in string.Formatter().parse(wording.FORMS[key]) if field}
            assert values is None or wanted <= values, (made, key, wanted - values)
            seen.add(key)
    assert seen == set(wording.FORMS)


def test_what_has_no_form_is_no_lookup_error():
    """Those have meanings: brep takes one for borders that do not lead on."""
    for key, values in (("no such", {}), ("hit", {"depth": 1.0}), ("rapid", {})):
        with pytest.raises(TypeError, match=f"no sentence {key!r}"):
            wording.Said(key, **values)


def test_no_two_sentences_are_one():
    assert len(set(wording.FORMS.values())) == len(wording.FORMS)
    for form in wording.FORMS.values():
        assert all(name is None or name.isidentifier() for _, name, _, _ in string.Formatter().parse(form)), form
