# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the mouse does to a camera, after the habits of FreeCAD's navigation styles.

Places in the picture are x to the right and y upwards, -1 .. 1 at its borders, as swarf.Camera has them. Buttons are
a set of "left", "middle", "right"; modifiers a set of "shift", "ctrl", "alt".
"""

import math

ORBIT, PAN, ZOOM, NONE = "orbit", "pan", "zoom", None

# What each style does while these buttons and modifiers are held; the first that fits counts. FreeCAD's names of the
# styles are Gui::<key>NavigationStyle.
STYLES = {
    "CAD": ((("middle", "left"), (), ORBIT), (("middle", "right"), (), ORBIT), (("middle",), ("ctrl",), PAN),
            (("middle",), ("shift",), ORBIT), (("middle",), (), PAN)),
    "OpenInventor": ((("middle", "left"), (), ZOOM), (("left",), ("ctrl", "shift"), ZOOM), (("left",), ("ctrl",), PAN),
                     (("middle",), (), PAN), (("left",), (), ORBIT)),
    "Revit": ((("middle", "left"), (), ORBIT), (("middle", "right"), (), ORBIT), (("middle",), ("shift",), ORBIT),
              (("middle",), (), PAN)),
    "Blender": ((("left", "right"), (), PAN), (("middle",), ("shift",), PAN), (("middle",), ("ctrl",), ZOOM),
                (("middle",), (), ORBIT)),
    "SolidWorks": ((("middle",), ("ctrl",), PAN), (("middle",), ("shift",), ZOOM), (("middle",), (), ORBIT)),
    "MayaGesture": ((("left",), ("alt",), ORBIT), (("middle",), ("alt",), PAN), (("right",), ("alt",), ZOOM),
                    (("left",), (), ORBIT), (("right",), (), PAN)),
    "Touchpad": ((("left",), ("shift", "ctrl"), ZOOM), (("left",), ("shift",), PAN), (("left",), ("alt",), ORBIT)),
    "Gesture": ((("left", "right"), (), PAN), (("left",), (), ORBIT), (("right",), (), PAN), (("middle",), (), ORBIT)),
    "OpenCascade": ((("middle",), ("ctrl",), PAN), (("left",), ("ctrl",), ZOOM), (("right",), ("ctrl",), ORBIT),
                    (("middle", "right"), (), ORBIT), (("middle",), (), PAN)),
    "TinkerCAD": ((("right",), (), ORBIT), (("middle",), (), PAN)),
}

# Nothing else is done by dragging in this view, so buttons that a style leaves free steer too.
FREE = ((("left",), ("shift",), PAN), (("left",), ("ctrl",), ZOOM), (("left",), (), ORBIT), (("right",), (), PAN),
        (("middle",), (), PAN))

# Degrees for dragging from one border of the picture to the other, as in FreeCAD's trackball.
DEGREES_PER_PICTURE = 180.0

# What one notch of the wheel and one key press do.
WHEEL_FACTOR = 1.2
KEY_DEGREES = 15.0

# How large what is shown whole is, of as large as it could be.
WHOLE = 0.9


def action(style, buttons, modifiers):
    """What dragging does: ORBIT, PAN, ZOOM or NONE. style: FreeCAD's name of it, or its key here."""
    key = style.replace("Gui::", "").replace("NavigationStyle", "")
    buttons, modifiers = frozenset(buttons), frozenset(modifiers)
    for held, keys, result in STYLES.get(key, ()) + FREE:
        if buttons == frozenset(held) and frozenset(keys) <= modifiers:
            return result
    return NONE


def fit(camera, box, aspect):
    """Show a box whole, from where the camera looks."""
    camera.fit(box, aspect)
    camera.zoom(WHOLE)


def shows_whole(camera, box, aspect):
    """Whether fit() would leave the camera as it is."""
    fitted, near = camera.copy(), 1e-6 * math.dist(*box)
    fit(fitted, box, aspect)
    return (math.dist(camera.eye, fitted.eye) < near and math.dist(camera.target, fitted.target) < near
            and abs(camera.height - fitted.height) < near)


def direction(camera):
    """Unit vector in which a camera looks."""
    vector = [b - a for a, b in zip(camera.eye, camera.target)]
    length = math.sqrt(sum(value * value for value in vector))
    return tuple(value / length for value in vector)


def point_at(camera, x, y, aspect, depth):
    """The point seen at a place of the picture at a depth along the view; at the target's where the depth is not
    finite."""
    forward = direction(camera)
    if not math.isfinite(depth):
        depth = math.dist(camera.eye, camera.target)
    origin, ray = camera.ray(x, y, aspect)
    begin = sum(f * (o - e) for f, o, e in zip(forward, origin, camera.eye))
    along = (depth - begin) / sum(f * r for f, r in zip(forward, ray))
    return tuple(o + along * r for o, r in zip(origin, ray))


def drag(camera, what, dx, dy, aspect, pivot, turntable=False):
    """Apply a drag by dx to the right and dy upwards (places of the picture) about or at a point."""
    if what == ORBIT:
        camera.orbit(pivot, dx / 2 * DEGREES_PER_PICTURE, dy / 2 * DEGREES_PER_PICTURE, turntable=turntable)
    elif what == PAN:
        camera.pan(dx / 2 * aspect, dy / 2, pivot)
    elif what == ZOOM:
        camera.zoom(WHEEL_FACTOR ** (8 * dy / 2), pivot)


def shown_height(camera, point):
    """mm from the bottom to the top of the picture, as deep as a point."""
    if not camera.perspective:
        return camera.height
    depth = sum(f * (p - e) for f, p, e in zip(direction(camera), point, camera.eye))
    return 2 * max(depth, 0.0) * math.tan(math.radians(camera.fov) / 2)


def approach(camera, point, aspect, height):
    """Bring a point to the middle, so near that the picture is not higher than this, mm."""
    centre(camera, point, aspect)
    camera.zoom(max(shown_height(camera, point) / height, 1.0), point)


def centre(camera, point, aspect):
    """Move so that a point comes to the middle."""
    x, y, _ = camera.project(point, aspect)
    if math.isfinite(x):
        camera.pan(-x / 2 * aspect, -y / 2, point)
