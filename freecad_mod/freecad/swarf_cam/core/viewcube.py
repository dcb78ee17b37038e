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


def _rotation(a, b):
    """(axis, angle) of the rotation that takes one set of axes to another."""
    matrix = [[sum(q[row] * p[column] for p, q in zip(a, b)) for column in range(3)] for row in range(3)]
    cosine = (matrix[0][0] + matrix[1][1] + matrix[2][2] - 1) / 2
    angle = math.acos(min(max(cosine, -1.0), 1.0))
    axis = (matrix[2][1] - matrix[1][2], matrix[0][2] - matrix[2][0], matrix[1][0] - matrix[0][1])
    if _dot(axis, axis) > 1e-12:
        return _unit(axis), angle
    if angle < 1.0:
        return (0.0, 0.0, 1.0), 0.0
    # Half a turn: (matrix + 1) / 2 is the axis times itself; its longest column is the most exact.
    column = max(range(3), key=lambda i: matrix[i][i])
    return _unit(tuple(matrix[row][column] + (row == column) for row in range(3))), angle


def between(camera_type, a, b, share):
    """A camera part of the way from one to the other by the shortest turn, gently at both ends."""
    share = share * share * (3 - 2 * share)
    axes_a = axes(a)
    axis, angle = _rotation(axes_a, axes(b))
    sine, cosine = math.sin(angle * share), math.cos(angle * share)

    def turn(vector):
        side, along = _cross(axis, vector), _dot(axis, vector) * (1 - cosine)
        return tuple(cosine * v + sine * s + along * n for v, s, n in zip(vector, side, axis))

    def mix(p, q):
        return p + (q - p) * share
    target = tuple(map(mix, a.target, b.target))
    distance = mix(math.dist(a.eye, a.target), math.dist(b.eye, b.target))
    eye = tuple(t + distance * v for t, v in zip(target, turn(axes_a[2])))
    return camera_type(eye, target, turn(axes_a[1]), perspective=b.perspective, height=mix(a.height, b.height),
                       fov=mix(a.fov, b.fov))
