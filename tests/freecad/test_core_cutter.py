# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sections of tools -> profiles in parts."""

import math
import random

import pytest
from swarf_cam.core import cutter
from swarf_cam.core.errors import JobError

QUARTER = math.tan(math.pi / 8)
BALL = [(0, 0, QUARTER), (3, 3, 0), (3, 20, 0), (0, 20, 0)]
FLAT = [(0, 0, 0), (3, 0, 0), (3, 20, 0), (2, 20, 0), (2, 40, 0), (0, 40, 0)]


def segments(nodes):
    return [(a[:2], b[:2], a[2]) for a, b in zip(nodes, nodes[1:])]


def closed(nodes):
    """The boundary of a chain as a cycle of edges, the axis among them."""
    return [[segment] for segment in segments(nodes)] + [[(nodes[-1][:2], nodes[0][:2], 0.0)]]


def turned(edge):
    return [(b, a, -bulge) for a, b, bulge in reversed(edge)]


def approx(nodes):
    return [tuple(pytest.approx(value, abs=1e-7) for value in node) for node in nodes]


@pytest.mark.parametrize("nodes", [BALL, FLAT])
def test_chain_does_not_depend_on_order_or_direction(nodes):
    source = random.Random(4)
    for _ in range(30):
        edges = [turned(edge) if source.random() < 0.5 else edge for edge in closed(nodes)]
        start = source.randrange(len(edges))
        edges = edges[start:] + edges[:start]
        if source.random() < 0.5:
            edges.reverse()
        assert cutter.chain(edges) == approx(nodes)


def test_chain_puts_the_tip_at_zero_and_joins_small_gaps():
    edges = [[((0, -50), (3, -50), 0)], [((3.0004, -50), (3, -20), 0)], [((3, -20), (0, -20), 0)],
             [((0, -20), (0, -50), 0)]]
    assert cutter.chain(edges)[0] == (0, 0, 0)
    assert cutter.chain(edges)[-1] == (0, 30, 0)


@pytest.mark.parametrize("edges,text", [
    ([[((1, 0), (2, 0), 0)], [((2, 0), (2, 5), 0)], [((2, 5), (1, 5), 0)], [((1, 5), (1, 0), 0)]], "hole"),
    ([[((0, 0), (3, 0), 0)], [((4, 0), (3, 9), 0)], [((3, 9), (0, 9), 0)], [((0, 9), (0, 0), 0)]], "closed"),
])
def test_chain_refuses(edges, text):
    with pytest.raises(JobError, match=text):
        cutter.chain(edges)


def test_fit_finds_arcs_and_lines():
    (start, end, bulge), = cutter.fit(lambda t: (3 * math.sin(t * math.pi / 2), 3 - 3 * math.cos(t * math.pi / 2)))
    assert (*start, *end, bulge) == pytest.approx((0, 0, 3, 3, QUARTER))
    (_, _, bulge), = cutter.fit(lambda t: (t, 2 * t))
    assert bulge == 0


def test_fit_stays_within_its_tolerance_on_an_ellipse():
    def ellipse(t):
        return 5 * math.sin(t * math.pi / 2), 2 - 2 * math.cos(t * math.pi / 2)

    pieces = cutter.fit(ellipse)
    assert 3 < len(pieces) < 40
    worst = 0.0
    for a, b, bulge in pieces:
        node = (*a, bulge)
        for i in range(1, 50):
            z = a[1] + (b[1] - a[1]) * i / 50
            r, _ = cutter._arc_at(node, b, z)
            exact = 5 * math.sqrt(1 - (1 - z / 2) ** 2)
            slope = abs(b[1] - a[1]) / math.dist(a, b)
            worst = max(worst, abs(r - exact) * slope)
    assert worst < 2 * cutter.FIT_TOLERANCE_MM


def test_volume_is_exact():
    assert cutter.volume(FLAT) == pytest.approx(math.pi * (9 * 20 + 4 * 20), rel=1e-14)
    assert cutter.volume(BALL) == pytest.approx(math.pi * (2 / 3 * 27 + 9 * 17), rel=1e-14)
    sphere = [(0, 0, 1), (0, 6, 0)]
    assert cutter.volume(sphere) == pytest.approx(4 / 3 * math.pi * 27, rel=1e-14)
    torus_groove = [(0, 0, 0), (5, 0, -1), (5, 4, 0), (0, 4, 0)]  # a half circle of radius 2 taken out
    half_torus = 2 * math.pi * (math.pi * 2) * (5 - 4 * 2 / (3 * math.pi))
    assert cutter.volume(torus_groove) == pytest.approx(math.pi * 100 - half_torus, rel=1e-14)


@pytest.mark.parametrize("nodes", [BALL, FLAT])
def test_split_keeps_the_volume(nodes):
    source = random.Random(9)
    for _ in range(200):
        height = source.choice([0.0, 3.0, 20.0, 40.0, source.uniform(-1, 41)])
        lower, upper = cutter.split(nodes, height)
        total = sum(cutter.volume(part) for part in (lower, upper) if part)
        assert total == pytest.approx(cutter.volume(nodes), rel=1e-12)
        if lower and upper:
            assert lower[-1][:2] == upper[0][:2] == (0.0, height)


def test_split_at_a_ledge_leaves_no_spike():
    umbrella = [(0, 0, 0), (1, 0, 0), (1, 10, 0), (4, 10, 0), (4, 12, 0), (0, 12, 0)]
    lower, upper = cutter.split(umbrella, 10)
    assert lower == [(0, 0, 0), (1, 0, 0), (1, 10, 0), (0, 10, 0)]
    assert upper == [(0, 10, 0), (4, 10, 0), (4, 12, 0), (0, 12, 0)]


@pytest.mark.parametrize("nodes,expected", [
    ([(0, 0, 0), (2.5, 0, 0), (2.5, 30, 0), (1.5, 29.99, 0), (1.5, 50, 0), (0, 50, 0)],  # FreeCAD's stock end mill
     [(0, 0, 0), (2.5, 0, 0), (2.5, 30, 0), (1.5, 30, 0), (1.5, 50, 0), (0, 50, 0)]),
    ([(0, 0.5, 0), (2, 0, 0), (2.5, 30, 0), (0, 30, 0)], [(0, 0, 0), (2, 0, 0), (2.5, 30, 0), (0, 30, 0)]),
    ([(0, 0, 0), (1, 0, 0), (1, 10, 0), (5, 8, 0), (5, 12, 0), (0, 12, 0)],
     [(0, 0, 0), (1, 0, 0), (1, 8, 0), (5, 8, 0), (5, 12, 0), (0, 12, 0)]),
    ([(0, 0, 0), (2, 0, 0), (2, 10, 0), (0, 4, 0)], [(0, 0, 0), (2, 0, 0), (2, 10, 0), (0, 10, 0)]),
])
def test_hollows_are_filled(nodes, expected):
    assert cutter.outer(nodes) == expected


def test_arc_that_sags_below_its_ends_is_filled():
    # a groove in the top of a disc: half a circle of radius 1 from r = 3 to r = 1, opening upwards
    disc = [(0, 0, 0), (3, 0, 0), (3, 5, -1), (1, 5, 0), (0, 5, 0)]
    heights = [z for _, z, _ in cutter.outer(disc)]
    assert heights == sorted(heights)
    assert cutter.volume(cutter.outer(disc)) == pytest.approx(math.pi * 45)


def kinds(result):
    return [(kind, nodes[0][1], nodes[-1][1]) for kind, nodes in result]


VBIT = [(0, 0, 0), (0.5, 0, 0), (5, 7.8, 0), (5, 8.8, 0), (2.5, 8.8, 0), (2.5, 20, 0), (0, 20, 0)]


@pytest.mark.parametrize("nodes,shape,parameters,expected", [
    (FLAT, "endmill", {"CuttingEdgeHeight": 15.0}, [("flutes", 0, 15), ("shank", 15, 40)]),
    (FLAT, "endmill", {}, [("flutes", 0, 40)]),
    (FLAT, "endmill", {"CuttingEdgeHeight": 99.0}, [("flutes", 0, 40)]),
    (FLAT, "Probe", {"CuttingEdgeHeight": 15.0}, [("shank", 0, 40)]),
    (VBIT, "v_bit", {"CuttingEdgeHeight": 1.0, "CuttingEdgeAngle": 60.0}, [("flutes", 0, 8.8), ("shank", 8.8, 20)]),
    (VBIT, "VBit", {"CuttingEdgeHeight": 9.0, "CuttingEdgeAngle": 60.0}, [("flutes", 0, 16.8), ("shank", 16.8, 20)]),
    (VBIT, "chamfer", {"CuttingEdgeHeight": 7.8, "CuttingEdgeAngle": 60.0}, [("flutes", 0, 7.8), ("shank", 7.8, 20)]),
    (VBIT, "Tap", {"CuttingEdgeLength": 1.0, "TipAngle": 60.0}, [("flutes", 0, 8.8), ("shank", 8.8, 20)]),
    (FLAT, "slittingsaw", {"BladeThickness": 3.0, "CapHeight": 2.0},
     [("shank", 0, 2), ("flutes", 2, 5), ("shank", 5, 40)]),
])
def test_what_cuts(nodes, shape, parameters, expected):
    result = cutter.parts(nodes, shape, parameters)
    assert kinds(result) == [(kind, pytest.approx(low), pytest.approx(high)) for kind, low, high in expected]
    assert sum(cutter.volume(part) for _, part in result) == pytest.approx(cutter.volume(nodes), rel=1e-12)
