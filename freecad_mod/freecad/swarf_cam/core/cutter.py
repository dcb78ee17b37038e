# SPDX-License-Identifier: LGPL-2.1-or-later
"""The meridian of a tool: from the edges of its section to nodes in parts (flutes, shank).

A node is (r, z, bulge) in mm; bulge is tan(angle / 4) of the arc from this node to the next, 0 for a straight line,
positive when it turns counter-clockwise in the (r, z) plane. A chain of nodes runs from the axis at the tool's tip
up and back to the axis, tip at z = 0.
"""

import math

from .errors import JobError

FLUTES, SHANK = "flutes", "shank"

# Greatest distance of a fitted arc from the curve of the solid: a hundredth of the finest voxel in use, 0.01 mm.
FIT_TOLERANCE_MM = 1e-4

# Ends closer than this are one point: CAD kernels leave gaps up to their confusion limits.
JOIN_TOLERANCE_MM = 1e-3

# Coordinates are rounded to this many decimals so that what is level in the solid is level in the profile.
DECIMALS = 8


def _circle(a, b, c):
    """Centre of the circle through three points, None when they lie on a line."""
    bx, by, cx, cy = b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]
    cross = 2 * (bx * cy - by * cx)
    if abs(cross) < 1e-12 * (bx * bx + by * by + cx * cx + cy * cy):
        return None
    b2, c2 = bx * bx + by * by, cx * cx + cy * cy
    return a[0] + (cy * b2 - by * c2) / cross, a[1] + (bx * c2 - cx * b2) / cross


def _bulge(a, b, centre, through):
    """Bulge of the arc from a to b about centre that passes through a third point."""
    start = math.atan2(a[1] - centre[1], a[0] - centre[0])
    turn = (math.atan2(b[1] - centre[1], b[0] - centre[0]) - start) % (2 * math.pi)
    middle = (math.atan2(through[1] - centre[1], through[0] - centre[0]) - start) % (2 * math.pi)
    if middle > turn:
        turn -= 2 * math.pi
    return math.tan(turn / 4)


def fit(point_at, tolerance_mm=FIT_TOLERANCE_MM):
    """Segments [(start, end, bulge)] along a curve, point_at(0..1) -> (r, z), within the tolerance at 16 samples of
    each segment; arcs where three points make one, straight lines otherwise."""
    segments = []

    def cover(t0, t1, depth):
        a, m, b = point_at(t0), point_at((t0 + t1) / 2), point_at(t1)
        samples = [point_at(t0 + (t1 - t0) * (i + 0.5) / 16) for i in range(16)]
        centre = _circle(a, m, b)
        if centre is None:
            length = math.dist(a, b)
            off = (math.dist(a, p) if length == 0.0 else
                   abs((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])) / length for p in samples)
            bulge = 0.0
        else:
            radius = math.dist(a, centre)
            off = (abs(math.dist(p, centre) - radius) for p in samples)
            bulge = _bulge(a, b, centre, m)
        if max(off) <= tolerance_mm or depth == 12:
            segments.append((a, b, bulge))
        else:
            cover(t0, (t0 + t1) / 2, depth + 1)
            cover((t0 + t1) / 2, t1, depth + 1)

    cover(0.0, 1.0, 0)
    return segments


def _reversed(segments):
    return [(b, a, -bulge) for a, b, bulge in reversed(segments)]


def chain(edges):
    """Nodes of a closed boundary in the half plane r >= 0, given as a cycle of edges.

    edges: lists of segments (start, end, bulge), each in either direction, in order around the boundary. Those on
    the axis are left out. JobError when the boundary does not meet the axis, or the rest is not one chain.
    """
    def on_axis(edge):
        return all(abs(p[0]) < JOIN_TOLERANCE_MM for segment in edge for p in segment[:2])

    flags = [on_axis(edge) for edge in edges]
    if not any(flags):
        raise JobError("it has a hole along its axis")
    first = flags.index(True)
    open_edges = [edge for edge, flag in zip(edges[first:] + edges[:first], flags[first:] + flags[:first]) if not flag]
    if not open_edges:
        raise JobError("its section is empty")
    if open_edges[0][0][0][0] > JOIN_TOLERANCE_MM:  # the first edge starts on the axis, or is turned round
        open_edges[0] = _reversed(open_edges[0])
    segments = list(open_edges[0])
    for edge in open_edges[1:]:
        end = segments[-1][1]
        if math.dist(edge[0][0], end) > math.dist(edge[-1][1], end):
            edge = _reversed(edge)
        if math.dist(edge[0][0], end) > JOIN_TOLERANCE_MM:
            raise JobError("its section is not one closed outline")
        segments += edge
    if max(segments[0][0][0], segments[-1][1][0]) > JOIN_TOLERANCE_MM:
        raise JobError("its section does not end on the axis")
    if segments[0][0][1] > segments[-1][1][1]:
        segments = _reversed(segments)
    return outer(_nodes(segments))


def _nodes(segments):
    tip = min(min(a[1], b[1]) for a, b, _ in segments)
    nodes = []
    for a, _, bulge in segments:
        nodes.append((round(max(a[0], 0.0), DECIMALS), round(a[1] - tip, DECIMALS), bulge + 0.0))  # no -0.0
    end = segments[-1][1]
    nodes.append((round(max(end[0], 0.0), DECIMALS), round(end[1] - tip, DECIMALS), 0.0))
    nodes[0] = (0.0,) + nodes[0][1:]
    nodes[-1] = (0.0,) + nodes[-1][1:]
    return [node for i, node in enumerate(nodes) if i == 0 or node[:2] != nodes[i - 1][:2]]


def _arc_circle(a, b):
    """Centre and radius of the arc from node a to node b."""
    lift = (1 - a[2] * a[2]) / (4 * a[2])  # the centre's distance from the chord, in chords, to the left
    centre = ((a[0] + b[0]) / 2 - (b[1] - a[1]) * lift, (a[1] + b[1]) / 2 + (b[0] - a[0]) * lift)
    return centre, math.dist(a[:2], centre)


def _arc_at(a, b, height):
    """Where the arc from node a to node b passes a height: (r, share of its angle), None where it does not."""
    turn = 4 * math.atan(a[2])
    centre, radius = _arc_circle(a, b)
    sine = (height - centre[1]) / radius
    if abs(sine) > 1:
        return None
    start = math.atan2(a[1] - centre[1], a[0] - centre[0])
    best = None
    for angle in (math.asin(sine), math.pi - math.asin(sine)):
        delta = (angle - start) % (2 * math.pi)
        share = delta / turn if turn > 0 else (delta - 2 * math.pi) / turn if delta else 0.0
        if 0 <= share <= 1 and (best is None or share < best[1]):
            best = (centre[0] + radius * math.cos(angle), share)
    return best


def _part_of_arc(bulge, share):
    """Bulge of the first `share` of an arc."""
    return math.tan(math.atan(bulge) * share)


def _split_arcs(nodes):
    """The chain with nodes added where an arc turns from rising to falling or back."""
    result = []
    for a, b in zip(nodes, nodes[1:]):
        result.append(a)
        if a[2] == 0.0:
            continue
        turn = 4 * math.atan(a[2])
        centre, radius = _arc_circle(a, b)
        start = math.atan2(a[1] - centre[1], a[0] - centre[0])
        shares = []
        for extreme in (math.pi / 2, -math.pi / 2):
            delta = (extreme - start) % (2 * math.pi)
            share = (delta if turn > 0 else delta - 2 * math.pi) / turn
            if 1e-6 < share < 1 - 1e-6:
                shares.append((share, (centre[0], centre[1] + radius * math.sin(extreme))))
        begin = 0.0
        for share, point in sorted(shares):
            result[-1] = result[-1][:2] + (_part_of_arc(a[2], share - begin),)
            result.append((round(point[0], DECIMALS), round(point[1], DECIMALS), 0.0))
            begin = share
        result[-1] = result[-1][:2] + (_part_of_arc(a[2], 1 - begin),)
    result.append(nodes[-1])
    return result


def _climb(nodes):
    """The chain without the parts that sink behind a ledge, seen from outside: where it turns down and inwards, it
    goes on level to where it comes up again."""
    result = [nodes[0]]
    i = 1
    while i < len(nodes):
        top, node = result[-1], nodes[i]
        if node[1] >= top[1] or node[0] > top[0]:
            result.append(node)
            i += 1
            continue
        while i < len(nodes) and nodes[i][1] < top[1]:
            i += 1
        result[-1] = top[:2] + (0.0,)
        if i == len(nodes):
            result.append((0.0, top[1], 0.0))
        elif nodes[i][1] > top[1]:
            a, b = nodes[i - 1], nodes[i]
            if a[2] == 0.0:
                r, share = a[0] + (b[0] - a[0]) * (top[1] - a[1]) / (b[1] - a[1]), 0.0
            else:
                r, share = _arc_at(a, b, top[1]) or (b[0], 1.0)
            result.append((r, top[1], _part_of_arc(a[2], 1 - share)))
    return result


def _upside_down(nodes):
    """The chain mirrored in z and walked from its other end; arcs keep their bulge."""
    bulges = [node[2] for node in nodes[:-1]]
    return [(r, -z, bulge) for (r, z, _), bulge in zip(reversed(nodes), bulges[::-1] + [0.0])]


def outer(nodes):
    """The chain with one radius at each height, the greatest: what turns about the axis shows no hollows."""
    filled = _upside_down(_climb(_upside_down(_climb(_split_arcs(nodes)))))
    return [(r, z + 0.0, bulge) for r, z, bulge in filled]


def split(nodes, height):
    """The chain below and above a height, each closed at the axis; None for a side that has nothing.

    The chain must not turn back downwards (a part has one radius at each height).
    """
    if height <= nodes[0][1]:
        return None, list(nodes)
    if height >= nodes[-1][1]:
        return list(nodes), None
    lower, upper = [], []
    for a, b in zip(nodes, nodes[1:]):
        if b[1] <= height:
            lower.append(a)
            continue
        if a[1] >= height:
            if not upper:  # the height is that of a node: the part above starts as wide as that node
                lower.append((a[0], height, 0.0))
                upper.append((0.0, height, 0.0))
            upper.append(a)
            continue
        if a[2] == 0.0:
            r, share = a[0] + (b[0] - a[0]) * (height - a[1]) / (b[1] - a[1]), 0.0
        else:
            r, share = _arc_at(a, b, height) or (b[0], 1.0)
        lower += [(a[0], a[1], _part_of_arc(a[2], share)), (r, height, 0.0)]
        upper += [(0.0, height, 0.0), (r, height, _part_of_arc(a[2], 1 - share))]
    upper.append(nodes[-1])
    while len(lower) > 1 and lower[-1][1] == lower[-2][1] == height:  # a ledge at the height adds nothing below it
        lower.pop()
    lower.append((0.0, height, 0.0))
    return _tidy(lower), _tidy(upper)


def _tidy(nodes):
    return [node for i, node in enumerate(nodes) if i + 1 == len(nodes) or node[:2] != nodes[i + 1][:2]]


def volume(nodes):
    """Volume of the body that a chain describes, mm3 (Pappus, each arc exact)."""
    total = 0.0
    for (r0, z0, bulge), (r1, z1, _) in zip(nodes, nodes[1:]):
        total += math.pi * (z1 - z0) * (r0 * r0 + r0 * r1 + r1 * r1) / 3
        if bulge:
            turn = 4 * math.atan(bulge)
            chord = math.dist((r0, z0), (r1, z1))
            centre, radius = _arc_circle((r0, z0, bulge), (r1, z1))
            area = radius * radius * (abs(turn) - math.sin(abs(turn))) / 2
            # the segment's centroid lies on the arc's bisector
            out = 4 * radius * math.sin(abs(turn) / 2) ** 3 / (3 * (abs(turn) - math.sin(abs(turn))))
            side = math.copysign(1.0, bulge) * (z1 - z0) / chord
            total += math.copysign(1.0, bulge) * 2 * math.pi * area * (centre[0] + side * out)
    return total


def _cone_top(nodes):
    """Height at which the first widening flank ends, 0 when there is none."""
    for a, b in zip(nodes, nodes[1:]):
        if b[1] > a[1]:
            return b[1] if b[0] > a[0] and a[2] == 0.0 else 0.0
    return 0.0


def parts(nodes, shape_type="", parameters=None):
    """[(kind, nodes)] of a tool from the chain of its whole solid and what its parameters mean.

    shape_type: FreeCAD's name of the shape in any spelling ("v_bit", "VBit", "slittingsaw"). parameters: name -> mm
    or degrees. Everything cuts below CuttingEdgeHeight, the shank begins above; a V-bit's is measured from the top of
    its cone, and so is a tap's CuttingEdgeLength. A slitting saw cuts with its blade only. A probe cuts nothing.
    Without that parameter all of it cuts.
    """
    parameters = parameters or {}
    kind = shape_type.lower().replace("_", "").replace("-", "").replace(" ", "")
    if "probe" in kind:
        return [(SHANK, list(nodes))]
    cuts_from, cuts_to = 0.0, nodes[-1][1]
    edge = parameters.get("CuttingEdgeHeight", 0.0)
    if edge > 0.0:
        cone = _cone_top(nodes) if "CuttingEdgeAngle" in parameters else 0.0
        cuts_to = edge + cone if kind == "vbit" or edge < cone - JOIN_TOLERANCE_MM else edge
    elif parameters.get("CuttingEdgeLength", 0.0) > 0.0:
        cuts_to = _cone_top(nodes) + parameters["CuttingEdgeLength"]
    elif "BladeThickness" in parameters:
        cuts_from = parameters.get("CapHeight", 0.0)
        cuts_to = cuts_from + parameters["BladeThickness"]
    result = []
    below, rest = split(nodes, cuts_from)
    if below:
        result.append((SHANK, below))
    flutes, above = split(rest, cuts_to) if rest else (None, None)
    if flutes:
        result.append((FLUTES, flutes))
    if above:
        result.append((SHANK, above))
    return result
