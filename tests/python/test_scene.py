# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cameras, pictures and picks: what they show is where it is."""
import math

import pytest
import swarf


@pytest.fixture(scope="module")
def stock():
    return swarf.Stock.box((0, 0, -10), (60, 40, 0), 0.5)


def camera_of(stock, perspective=False):
    return swarf.Camera.view("isometric", stock.bounding_box(), 1.5, perspective=perspective)


@pytest.mark.parametrize("perspective", [False, True])
def test_zooming_to_a_point_keeps_its_place(stock, perspective):
    camera = camera_of(stock, perspective)
    point = (50, 5, 0)
    x, y, _ = camera.project(point, 1.5)
    before = camera.project((40, 5, 0), 1.5)
    camera.zoom(3, point)
    assert camera.project(point, 1.5)[:2] == pytest.approx((x, y), abs=1e-9)
    after = camera.project((40, 5, 0), 1.5)
    assert math.dist(after[:2], (x, y)) > 2 * math.dist(before[:2], (x, y))


@pytest.mark.parametrize("turntable", [False, True])
def test_orbit_keeps_the_pivot_and_its_distance(stock, turntable):
    camera = camera_of(stock, True)
    pivot = (30, 20, -2)
    before = camera.project(pivot, 1.5)
    for _ in range(50):
        camera.orbit(pivot, 13, 7, turntable=turntable)
        assert camera.project(pivot, 1.5) == pytest.approx(before, abs=1e-4 if turntable else 1e-9)
    if turntable:
        assert camera.up == (0, 0, 1)


def test_dragging_to_the_right_moves_the_near_side_to_the_right(stock):
    for turntable in (False, True):
        camera = swarf.Camera.view("front", stock.bounding_box())
        near = (30, 0, -5)
        x, y, _ = camera.project(near)
        camera.orbit(camera.target, 10, 10, turntable=turntable)
        moved = camera.project(near)
        assert moved[0] > x + 0.01 and moved[1] > y + 0.01


def test_pan_moves_by_heights_of_the_picture(stock):
    for perspective in (False, True):
        camera = camera_of(stock, perspective)
        point = (10, 10, -3)
        x, y, _ = camera.project(point, 1.5)
        camera.pan(0.25, -0.1, point)
        assert camera.project(point, 1.5)[:2] == pytest.approx((x + 0.5 / 1.5, y - 0.2), abs=1e-9)


def test_perspective_and_back_keeps_the_size_at_the_target(stock):
    camera = camera_of(stock)
    height = camera.height
    camera.set_perspective(True)
    camera.set_perspective(False)
    assert camera.height == pytest.approx(height)


def test_buffers_agree_with_the_camera_and_with_picks(stock):
    scene = swarf.Scene(stock)
    camera = swarf.Camera.view("top", stock.bounding_box(), 1.5)
    picture = scene.render(camera, 90, 60, buffers=("rgba", "depth", "normal", "position", "move", "seen"))
    assert (picture.width, picture.height) == (90, 60)
    middle = 30 * 90 + 45
    assert picture.seen[30, 45] == 1 and picture.move[30, 45] == -1 and picture.seen[0, 0] == 0
    assert picture.depth[0, 0] == math.inf and math.isnan(picture.position[0, 0])
    assert picture.position[middle, 2] == pytest.approx(0, abs=1e-6)
    assert picture.normal[middle, 2] == pytest.approx(1)
    place = ((45 + 0.5) / 45 - 1, 1 - (30 + 0.5) / 30)
    pick = scene.pick(camera, *place, 90, 60)
    assert pick.seen == "stock" and pick.point == pytest.approx([picture.position[middle, i] for i in range(3)])
    assert pick.depth == pytest.approx(picture.depth[30, 45])
    assert camera.project(pick.point, 1.5)[:2] == pytest.approx(place, abs=1e-9)
    assert scene.pick(camera, -1, 1, 90, 60) is None
    assert scene.render(camera, 9, 6, buffers=("seen",)).rgba is None


def test_coarse_pictures_have_the_size_asked_for(stock):
    scene = swarf.Scene(stock)
    camera = swarf.Camera.view("top", stock.bounding_box(), 1.5)
    for coarse in (2, 7, 16):
        assert scene.render(camera, 91, 61, coarse=coarse).rgba.shape == (91 * 61, 4)
    assert scene.render(camera, 91, 61, budget_ms=1e-3).rgba.shape == (91 * 61, 4)


def test_parallel_rays_see_what_is_behind_the_eye(stock):
    scene = swarf.Scene(stock)
    camera = swarf.Camera((30, 20, -5), (30, 20, -6), (0, 1, 0), height=60)
    assert scene.pick(camera, 0, 0).point == pytest.approx((30, 20, 0), abs=1e-6)


def test_a_scene_follows_its_stock():
    stock = swarf.Stock.box((0, 0, -10), (60, 40, 0), 0.5)
    scene = swarf.Scene(stock)
    camera = swarf.Camera.view("top", stock.bounding_box())
    program = swarf.Program(start=(30, 20, 5))
    program.add_operation("hole")
    program.set_section(tool=1)
    program.add_line((30, 20, -4), feed_mm_min=100)
    stock.cut(swarf.Cutter("flat:d=10,l=20"), program)
    scene.update()
    assert scene.pick(camera, 0, 0).point[2] == pytest.approx(-4, abs=1e-5)


def test_refusals(stock, every_piece):
    scene = swarf.Scene(stock)
    camera = camera_of(stock)
    with pytest.raises(ValueError, match="same point"):
        swarf.Camera((1, 2, 3), (1, 2, 3), (0, 0, 1))
    with pytest.raises(ValueError, match="up is along"):
        swarf.Camera((1, 2, 3), (1, 2, 4), (0, 0, 1))
    with pytest.raises(ValueError, match="none of isometric"):
        swarf.Camera.view("inside", None)
    with pytest.raises(ValueError, match="zoom"):
        camera.zoom(0)
    with pytest.raises(ValueError, match="pixels per ray"):
        scene.render(camera, coarse=17)
    with pytest.raises(ValueError, match="buffers"):
        scene.render(camera, 8, 8, buffers=("colour",))
    with pytest.raises(ValueError, match="rgba"):
        scene.render(camera, 8, 8, buffers=("depth",)).write("never.png")
    with pytest.raises(swarf.Cancelled):
        scene.render(camera, progress=lambda fraction: True)


def slotted():
    """(the block before, program, tools, scene of the block after): a plunge and a slot along x."""
    first = swarf.Stock.box((0, 0, -10), (60, 40, 0), 0.5)
    stock = first.copy()
    program = swarf.Program(start=(10, 20, 5))
    program.add_operation("slot")
    program.set_section(tool=1)
    program.add_line((10, 20, -4), feed_mm_min=100)
    program.add_line((50, 20, -4), feed_mm_min=100)
    tools = {1: swarf.Cutter("flat:d=10,l=20")}
    stock.simulate(program, tools)
    return first, program, tools, swarf.Scene(stock)


def test_the_exact_surface_knows_its_moves():
    first, program, tools, scene = slotted()
    camera = swarf.Camera((30, 20, 50), (30, 20, 0), (0, 1, 0), height=60)
    with pytest.raises(ValueError, match="no surface"):
        scene.set_moves(1)
    scene.set_surface(first, program, tools)
    assert scene.pick(camera, 0, 0).move == 1
    assert scene.pick(camera, 0, 0.5).move == -1
    # Right at the edge, where the field is rounded: not the width of a hundredth of a voxel off.
    edge = camera.project((30, 25 - 1e-3, 0))
    assert scene.pick(camera, edge[0], edge[1]).point[2] == pytest.approx(-4, abs=1e-6)
    picture = scene.render(camera, 60, 60, buffers=("rgba", "move"), colouring="operation", program=program)
    assert picture.move[30, 30] == 1 and picture.rgba[30 * 60 + 30, 0] != picture.rgba[5 * 60 + 30, 0]
    plain, marked = (scene.render(camera, 60, 60, program=program, selected=selected).rgba
                     for selected in (None, (1, 2)))
    red, blue = marked[30 * 60 + 30, 0], marked[30 * 60 + 30, 2]
    assert red > blue + 80 and plain[30 * 60 + 30, 0] < plain[30 * 60 + 30, 2] + 40  # the slot's floor stands out
    assert bytes(marked)[4 * (5 * 60 + 30):][:3] == bytes(plain)[4 * (5 * 60 + 30):][:3]  # the top does not
    for wrong in ((2, 1), (-1, 2), 3):
        with pytest.raises(ValueError, match="selected"):
            scene.render(camera, 60, 60, program=program, selected=wrong)
    scene.set_moves(None)
    with pytest.raises(BufferError):
        program.add_line((0, 0, 0))
    with pytest.raises(ValueError):
        scene.set_moves(3)
    with pytest.raises(ValueError, match="part 1.5"):
        scene.set_moves(1, 1.5)


def test_what_is_shown_stays_while_a_picture_is_made():
    first, program, tools, scene = slotted()
    scene.set_surface(first, program, tools)
    camera = swarf.Camera((30, -40, 60), (30, 20, 0), (0, 0, 1), height=60)
    calm = bytes(scene.render(camera, 200, 150, samples=2).rgba)
    surface, refused = swarf.Surface(first, program, tools), []

    def meddle(_fraction):
        for change in (lambda: scene.set_moves(0), lambda: scene.set_fixtures([]),
                       lambda: scene.show_surface(surface)):
            with pytest.raises(swarf.BusyError):
                change()
            refused.append(change)

    scene.set_moves(0)  # and back, so that nothing is known of the picture before
    scene.set_moves(None)
    assert bytes(scene.render(camera, 200, 150, samples=2, progress=meddle).rgba) == calm and refused
    scene.set_moves(0)
    assert bytes(scene.render(camera, 200, 150, samples=2).rgba) != calm
    scene.set_moves(None)
    assert bytes(scene.render(camera, 200, 150, samples=2).rgba) == calm


def test_corners_are_not_lighter_than_the_floor_beside_them():
    first, program, tools, scene = slotted()
    scene.set_surface(first, program, tools)
    camera = swarf.Camera((30, 20, 50), (30, 20, 0), (0, 1, 0), height=12)
    rgba = scene.render(camera, 20, 240, samples=1, edges=False).rgba
    floor = [rgba[y * 20 + 10, 1] for y in range(20, 220)]  # ten pixels a voxel, from wall to wall
    assert max(floor[:20] + floor[-20:]) < min(floor[60:140]) - 10, floor
    for side in (floor, floor[::-1]):
        assert all(side[i] <= side[i + 4] + 2 for i in range(60)), side


def test_the_exact_surface_of_the_set_up_before():
    """A slot of the set-up before has sharp edges in the next one, whose voxels round them."""
    first = swarf.Stock.box((0, 0, -10), (60, 40, 0), 0.5)
    program, after = swarf.Program(start=(-10, 20, -4)), swarf.Program(start=(-10, 20, 5))
    for moves, end in ((program, (70, 20, -4)), (after, (-10, 20, 6))):
        moves.add_operation("slot")
        moves.set_section(tool=1)
        moves.add_line(end, feed_mm_min=100)
    tools = {1: swarf.Cutter("flat:d=10,l=20")}
    stay = ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0))
    surface = swarf.Surface(first, program, tools).next(stay, after, tools)
    first.simulate(program, tools)
    scene = swarf.Scene(first)
    with pytest.raises(ValueError, match="2 moves|moves"):
        scene.show_surface(surface, 2)
    scene.show_surface(surface)
    del surface
    camera = swarf.Camera((30, 20, 50), (30, 20, 0), (0, 1, 0), height=60)
    for y, depth in ((25 - 1e-3, -4), (25 + 1e-3, 0)):
        edge = camera.project((30, y, 0))
        assert scene.pick(camera, edge[0], edge[1]).point[2] == pytest.approx(depth, abs=1e-6)
    for changed in (program, after):
        with pytest.raises(BufferError):
            changed.add_line((0, 0, 0))
    del scene
    after.add_line((0, 0, 5))


# Linear colours of 0, 1/4 ... 1: from blue over green to red, dark enough to be shaded.
RAMP = ((0.05, 0.12, 0.62), (0.02, 0.45, 0.60), (0.10, 0.55, 0.16), (0.80, 0.62, 0.06), (0.70, 0.08, 0.03))


def ramp(part):
    place = 4 * part
    low = min(int(place), 3)
    return [a + (place - low) * (b - a) for a, b in zip(RAMP[low], RAMP[low + 1])]


def shown_from_above(base):
    """sRGB of a level face below an open sky: Gooch's formula for the light from (-0.36, 0.76, 0.46) of the camera."""
    warmth = 0.5 + 0.5 * 0.46 / math.sqrt(0.36 ** 2 + 0.76 ** 2 + 0.46 ** 2)
    rgb = []
    for channel, value in enumerate(base):
        warm = 0.86 * value + (0.10 if channel < 2 else 0)
        cool = (0.22 if channel < 2 else 0.36) * value
        rgb.append(255 * (1.055 * (warmth * warm + (1 - warmth) * cool) ** (1 / 2.4) - 0.055))
    return rgb


def test_colours_of_age_and_feed():
    first = swarf.Stock.box((0, 0, -10), (60, 50, 0), 0.5)
    stock = first.copy()
    feeds = (300, 100, 500, 200, 400)
    program = swarf.Program(start=(10, 5, 5))
    program.add_operation("slots")
    program.set_section(tool=1)
    for number, feed in enumerate(feeds):
        y = 5 + 10 * number
        program.add_line((10, y, 5), kind="rapid")
        program.add_line((10, y, -4), feed_mm_min=feed)
        program.add_line((50, y, -4), feed_mm_min=feed)
        program.add_line((50, y, 5), kind="rapid")
    tools = {1: swarf.Cutter("flat:d=6,l=20")}
    stock.simulate(program, tools)
    scene = swarf.Scene(stock)
    scene.set_surface(first, program, tools)
    camera = swarf.Camera((30, 25, 90), (30, 25, 0), (0, 1, 0), height=60)
    parts = {"age": [(4 * number + 2) / 20 for number in range(5)], "feed": [(feed - 100) / 400 for feed in feeds]}
    for colouring, expected in parts.items():
        picture = scene.render(camera, 60, 60, samples=1, edges=False, occlusion=False, colouring=colouring,
                               program=program, moves_done=20, buffers=("rgba", "move"))
        for number, part in enumerate(expected):
            row = 30 - (5 + 10 * number - 25)
            assert picture.move[row, 30] == 4 * number + 2
            seen = [picture.rgba[row * 60 + 30, channel] for channel in range(3)]
            assert seen == pytest.approx(shown_from_above(ramp(part)), abs=1.5), (colouring, number)
        assert picture.move[25, 30] == -1
        top = [picture.rgba[25 * 60 + 30, channel] for channel in range(3)]
        assert top == pytest.approx(shown_from_above((0.63, 0.62, 0.62)), abs=1.5)


def block(lo, hi):
    """A Mesh of a box."""
    corners = [(x, y, z) for x in (lo[0], hi[0]) for y in (lo[1], hi[1]) for z in (lo[2], hi[2])]
    quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    return swarf.Mesh(corners, [half for a, b, c, d in quads for half in ((a, b, c), (a, c, d))])


def test_deviation_is_shown_where_the_stock_is_seen(stock):
    design = swarf.Solid(block((0, 0, -10), (60, 40, -0.3)))
    camera = swarf.Camera.view("top", stock.bounding_box(), 1.5)
    cutter = swarf.Cutter("flat:d=6,l=20")
    picture = swarf.Scene(stock).render(camera, 150, 100, samples=1, buffers=("rgba", "position", "seen"),
                                        cutter=(cutter, (30, 20, 5)))
    before = picture.rgba
    plain = bytes(before)
    values = picture.show_deviation(design, 0.1)
    assert values.shape == (100, 150) and values.readonly
    kinds = set()
    for row in range(100):
        for column in range(150):
            kind, value = picture.seen[row, column], values[row, column]
            kinds.add(kind)
            assert value == pytest.approx(0.3, abs=0.01) if kind == 1 else math.isnan(value)
    assert kinds >= {0, 1, 3}
    assert bytes(before) == plain, "a view of the picture as it was stays"
    shown = swarf.Scene(swarf.Stock.box((0, 0, -10), (60, 40, -0.3), 0.5)).render(
        camera, 150, 100, samples=1, buffers=("rgba", "position", "seen"))
    other = shown.show_deviation(stock, 0.1, allowance=0.05)
    for row in range(100):
        for column in range(150):
            kind, value = shown.seen[row, column], other[row, column]
            x, y = (shown.position[row * 150 + column, axis] for axis in range(2))
            if kind == 1 and 2 < x < 58 and 2 < y < 38:
                assert value == pytest.approx(0.25, abs=0.005)
            assert math.isnan(value) == (kind != 1)
    deep = swarf.Scene(swarf.Stock.box((0, 0, -10), (60, 40, -5), 0.5)).render(
        camera, 60, 40, samples=1, buffers=("rgba", "position", "seen"))
    assert deep.show_deviation(stock, 0.1)[20, 30] == math.inf
    before_cancel = bytes(shown.rgba)
    for progress in (lambda fraction: True, lambda fraction: 1 / 0):
        with pytest.raises((swarf.Cancelled, ZeroDivisionError)):
            shown.show_deviation(stock, 0.1, progress=progress)
        assert bytes(shown.rgba) == before_cancel
    with pytest.raises(TypeError, match="Solid"):
        deep.show_deviation(camera, 0.1)
    at = 4 * (50 * 150 + 20)
    told = swarf.deviation_colours([[values[50, 20]]], plain[at:at + 4], 0.1)
    assert bytes(picture.rgba)[at:at + 4] == told != plain[at:at + 4]
    flutes = 4 * (50 * 150 + 75)
    assert bytes(picture.rgba)[flutes:flutes + 4] == plain[flutes:flutes + 4], "the cutter keeps its colours"
    less = picture.show_deviation(design, 0.1, allowance=0.25)
    assert less[50, 20] == pytest.approx(values[50, 20] - 0.25, abs=1e-12)


def test_deviation_needs_its_buffers_and_a_tolerance(stock, tmp_path):
    design = swarf.Solid(block((0, 0, -10), (60, 40, -0.3)))
    camera = camera_of(stock)
    scene = swarf.Scene(stock)
    with pytest.raises(ValueError, match="position"):
        scene.render(camera, 30, 20).show_deviation(design, 0.1)
    picture = scene.render(camera, 30, 20, buffers=("rgba", "position", "seen"))
    plain = bytes(picture.rgba)
    with pytest.raises(ValueError, match="tolerance"):
        picture.show_deviation(design, 0.0)
    assert bytes(picture.rgba) == plain, "what fails changes nothing"
    picture.show_deviation(design, 0.1)
    picture.write(tmp_path / "deviation.png")
    assert (tmp_path / "deviation.png").stat().st_size > 100
