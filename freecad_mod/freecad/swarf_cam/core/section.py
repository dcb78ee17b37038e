# SPDX-License-Identifier: LGPL-2.1-or-later
"""A plane across one of the axes that opens the stock: where it lies and which side of it is taken away."""

from dataclasses import dataclass

AXES = "XYZ"

# The side that is taken away at first is the one in front when one looks from the corner as FreeCAD does.
NEAR_SIDE = (1.0, -1.0, 1.0)


@dataclass
class Section:
    """axis: 0 .. 2. share: 0 at the box's low side, 1 at its high one. flipped: take the other side away."""

    axis: int = 1
    share: float = 0.5
    flipped: bool = False

    def position(self, box):
        """Where it lies on its axis, mm."""
        lo, hi = box[0][self.axis], box[1][self.axis]
        return lo + self.share * (hi - lo)

    def move_to(self, box, position):
        """Lie at a position (mm), within the box."""
        lo, hi = box[0][self.axis], box[1][self.axis]
        self.share = min(max((position - lo) / (hi - lo), 0.0), 1.0) if hi > lo else 0.5

    def planes(self, box):
        """((point, normal),) as Scene.render takes it: what the normal points to is taken away."""
        point, normal = [0.5 * (a + b) for a, b in zip(*box)], [0.0] * 3
        point[self.axis] = self.position(box)
        normal[self.axis] = -NEAR_SIDE[self.axis] if self.flipped else NEAR_SIDE[self.axis]
        return ((tuple(point), tuple(normal)),)
