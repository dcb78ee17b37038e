# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cube in the corner that shows how one looks at the part, and turns the view when it is clicked: which of its
26 places (faces, edges, corners) is where, and the camera for each. Flat places: x to the right and y upwards."""

import math

FACES = {"front": (0, -1, 0), "rear": (0, 1, 0), "left": (-1, 0, 0), "right": (1, 0, 0), "top": (0, 0, 1),
         "bottom": (0, 0, -1)}

# A click within this part of a half edge from an edge of the cube means the edge, not the face.
EDGE = 0.62


def _cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def _unit(a):
    length = math.sqrt(_dot(a, a))
    return tuple(value / length for value in a)


def axes(camera):
    """(right, up, towards the viewer) of a camera, unit vectors."""
    back = _unit([a - b for a, b in zip(camera.eye, camera.target)])
    right = _unit(_cross(camera.up, back))
    return right, _cross(back, right), back


def faces(camera):
    """Faces that are seen: (name, four corners in the picture of a cube of half edge 1, brightness 0 .. 1), the one
    that is turned most to the viewer last."""
    right, up, back = axes(camera)
    result = []
    for name, normal in FACES.items():
        facing = _dot(normal, back)
        if facing <= 0.02:
            continue
        u, v = _face_axes(normal)
        corners = [tuple(n + a * s + b * t for n, a, b in zip(normal, u, v))
                   for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        result.append((facing, name, [(_dot(c, right), _dot(c, up)) for c in corners]))
    return [(name, corners, facing) for facing, name, corners in sorted(result)]


def _face_axes(normal):
    """Right and up of the text on a face, as it is read when one looks at it."""
    if abs(normal[2]) > 0.5:
        return (1, 0, 0), ((0, 1, 0) if normal[2] > 0 else (0, -1, 0))
    return _cross((0, 0, 1), normal), (0, 0, 1)


def label_transform(camera, name):
    """(centre, right, up) of a face's text in the picture."""
    right, up, _ = axes(camera)
    normal = FACES[name]
    return tuple((_dot(vector, right), _dot(vector, up)) for vector in (normal, *_face_axes(normal)))


def pick(camera, x, y):
    """Where a click at a place of the cube's picture wants to look from: a vector of -1, 0, 1, or None outside."""
    right, up, back = axes(camera)
    origin = [a * x + b * y for a, b in zip(right, up)]
    best = None
    for axis in range(3):
        if abs(back[axis]) < 1e-9:
            continue
        side = math.copysign(1.0, back[axis])
        along = (side - origin[axis]) / back[axis]
        point = [o + along * b for o, b in zip(origin, back)]
        point[axis] = side
        if all(abs(value) <= 1.0 + 1e-9 for value in point) and (best is None or along > best[0]):
            best = along, point
    if best is None:
        return None
    return tuple(int(math.copysign(1, value)) if abs(value) > EDGE else 0 for value in best[1])


def look_from(camera_type, camera, towards):
    """A camera that looks from one of the 26 places, same target, scale and kind of rays as this one."""
    back = _unit(towards)
    if towards[0] == 0 and towards[1] == 0:
        up = (0, 1, 0) if towards[2] > 0 else (0, -1, 0)
    else:
        up = (0, 0, 1)
    distance = math.dist(camera.eye, camera.target)
    eye = tuple(t + distance * b for t, b in zip(camera.target, back))
    return camera_type(eye, camera.target, up, perspective=camera.perspective, height=camera.height, fov=camera.fov)


def between(camera_type, a, b, share):
    """A camera part of the way from one to the other, for turning the view so that the eye can follow."""
    share = share * share * (3 - 2 * share)
    axes_a, axes_b = axes(a), axes(b)

    def mix(p, q):
        return tuple(x + (y - x) * share for x, y in zip(p, q))
    back = mix(axes_a[2], axes_b[2])
    if _dot(back, back) < 1e-3:  # from opposite sides: over the right
        back = mix(back, axes_a[0])
    up = mix(axes_a[1], axes_b[1])
    if math.sqrt(_dot(_cross(up, back), _cross(up, back))) < 1e-3:
        up = mix(up, axes_b[0])
    target = mix(a.target, b.target)
    da, db = math.dist(a.eye, a.target), math.dist(b.eye, b.target)
    distance = da + (db - da) * share
    eye = tuple(t + distance * v for t, v in zip(target, _unit(back)))
    return camera_type(eye, target, up, perspective=b.perspective,
                       height=a.height + (b.height - a.height) * share, fov=a.fov + (b.fov - a.fov) * share)
