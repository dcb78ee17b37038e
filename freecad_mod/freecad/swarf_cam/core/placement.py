# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rigid placements: a rotation as three rows and a translation, in mm."""

# A rotated axis counts as an axis when it is this close to one: a micrometre at 1 m from the origin.
AXIS_TOLERANCE = 1e-9


class Placement:
    """Maps operation coordinates to those of the document: p -> rotation * p + base."""

    def __init__(self, rotation=((1, 0, 0), (0, 1, 0), (0, 0, 1)), base=(0, 0, 0)):
        self.rotation = tuple(tuple(float(value) for value in row) for row in rotation)
        self.base = tuple(float(value) for value in base)
        self.is_identity = self.base == (0.0, 0.0, 0.0) and self.rotation == ((1, 0, 0), (0, 1, 0), (0, 0, 1))

    def point(self, p):
        """A point in document coordinates."""
        if self.is_identity:
            return tuple(p)
        return tuple(sum(row[i] * p[i] for i in range(3)) + base for row, base in zip(self.rotation, self.base))

    def inverse_point(self, p):
        """A document point in the operation's coordinates."""
        if self.is_identity:
            return tuple(p)
        d = [p[i] - self.base[i] for i in range(3)]
        return tuple(sum(self.rotation[k][i] * d[k] for k in range(3)) for i in range(3))

    def axis(self, index):
        """Where coordinate axis `index` points: (axis, sign) when it is a coordinate axis again, else None."""
        column = [row[index] for row in self.rotation]
        for k in range(3):
            if abs(abs(column[k]) - 1.0) < AXIS_TOLERANCE:
                return k, 1 if column[k] > 0 else -1
        return None
