# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is said of findings, at one home: each sentence has a key and names the values in it, so that it can be said in
another language as well. English is what reports, files and the command line have.

The add-on has translations of these forms (freecad_mod/translate takes them from here).
"""
from __future__ import annotations

from typing import Any, Callable, Optional

#: Key -> what is said, with the values as str.format() wants them.
FORMS = {
    # what a tool does that it must not
    "rapid": "rapid through material, {depth:.3g} mm deep",
    "start": "the tool starts inside the stock",
    "depth": "cuts deeper than the flutes are long",
    "near": "holder closer to the stock than {clearance:g} mm",
    "shank": "shank hits the stock, {depth:.3g} mm deep",
    "holder": "holder hits the stock, {depth:.3g} mm deep",
    "fixture flutes": "flutes hit a fixture, {depth:.3g} mm deep",
    "fixture shank": "shank hits a fixture, {depth:.3g} mm deep",
    "fixture holder": "holder hits a fixture, {depth:.3g} mm deep",
    "design flutes": "flutes cut into the design, {depth:.3g} mm deep",
    "design shank": "shank hits the design, {depth:.3g} mm deep",
    "design holder": "holder hits the design, {depth:.3g} mm deep",
    "spindle stopped": "cuts with the spindle stopped",
    "spindle backwards": "cuts with the spindle turning backwards (M4)",
    "feed": "a feed move without feed",
    "tool none": "moves before any tool is loaded",
    "tool missing": "tool T{tool} is not in the tool table",
    "tool blunt": "tool T{tool} has no flutes",
    # what was not simulated
    "uncut no tool": "operation '{operation}' moves before any tool is loaded; nothing was cut",
    "uncut unknown tool": "operation '{operation}': tool T{tool} is not in the tool table; nothing was cut",
    "uncut no flutes": "operation '{operation}': tool T{tool} has no flutes; nothing was cut",
    "uncut axis": "operation '{operation}': axis {axis} moves to {value:.6g}; turned and shifted poses are not "
                  "simulated, they cut nothing",
    "uncut idle": "operation '{operation}' removes nothing: its moves do not meet what is left of the stock",
    # the design and the fixtures
    "place unit": "the design is {value:.4g} times as large as the stock: is it in {units}?",
    "inch in mm": "mm instead of inches",
    "mm in inch": "inches instead of mm",
    "cm in mm": "mm instead of cm",
    "mm in cm": "cm instead of mm",
    "m in mm": "mm instead of m",
    "mm in m": "m instead of mm",
    "place empty": "nothing is left of the stock",
    "place beside": "the design ({design}) lies beside the stock ({stock}): is it in another place?",
    "box": "{a:.6g}, {b:.6g}, {c:.6g} .. {d:.6g}, {e:.6g}, {f:.6g} mm",
    "place out":
        "the design reaches {value:.4g} mm out of what is left of the stock: is it in the same place and unit?",
    "design open": "the design is not closed: {open} open edges, {turned} between triangles turned different ways; the "
                   "holes have at most {hole:.3g} mm2 and inside is told by the winding number",
    "design crossing": "{crossing} of the design's {all} triangles cross or touch others; it is taken as the union of "
                       "what they enclose",
    "fixture of job": "fixture {number} of the job",
    "fixture given": "fixture {number}",
    "fixture inside": "{fixture} reaches into the stock before anything is cut, at least {depth:.3g} mm deep: "
                      "fixture or stock are not where they should be",
    # the deviation
    "amount": "{value:.3f} mm, {area:.4g} mm2, {volume:.4g} mm3",
    "amount at least": "at least {value:.3f} mm, {area:.4g} mm2, {volume:.4g} mm3",
    "gouge": "gouge: {amount} missing",
    "gouge of no move": "gouge: {amount} missing; no move made it: the stock is too small here",
    "excess": "material left: {amount}",
    "excess away": "material left: {amount}; the nearest cut stays {away:.3f} mm away",
    "not reached": "not reached: {amount} left where no move went",
    # loads
    "load": "{load} {value:.4g} {unit} exceeds the limit of {most:g} {unit}",
    "loads": "{load} {value:.4g} {unit} exceeds the limit of {most:g} {unit}; {count} moves exceed it, this one most",
    "engagement": "engagement",
    "axial depth": "axial depth",
    "radial width": "radial width",
    "chip thickness": "chip thickness",
    "removal rate": "removal rate",
    "deg": "deg",
    "mm": "mm",
    "mm3/s": "mm3/s",
    # pieces
    "loose": "a piece of {volume:.4g} mm3 at {x:.4g}, {y:.4g}, {z:.4g} is loose; this move frees it",
    "loose before":
        "a piece of {volume:.4g} mm3 at {x:.4g}, {y:.4g}, {z:.4g} is loose; it was before the program began",
    # set-ups and acceptances
    "set-up": "set-up '{job}': {text}",
    "set-up line": "set-up '{job}', line {line}: {text}",
    "set-up kept": "set-up '{job}': its outcome is that of {path}; its moves are not checked here",
    "idle acceptance": "nothing is found any more of what is accepted because '{reason}'",
    "idle acceptance of": "nothing is found now of what is accepted, with {circumstances}, because '{reason}'",
    "of tolerance": "a tolerance of {tolerance:g} mm",
    "of allowance": "an allowance of {allowance:g} mm",
    "of both": "a tolerance of {tolerance:g} mm and an allowance of {allowance:g} mm",
    # what a mesh has not
    "unseen": "about {volume:.3g} mm3, {percent:.2g} % of what is left, is thinner than a voxel and not in the mesh; "
              "smaller voxels have it",
    # why a solid has facets
    "too many shapes": "it has faces of more than {most} shapes",
    "loops open": "the edges of a face do not close",
    "unknown surface": "{percent:.1f} % of the surface is on planes, cylinders, cones, spheres and tori, but not what "
                       "is near ({x:.2f}, {y:.2f}, {z:.2f})",
    "hollow": "there is a hollow that is in no solid",
    "faces apart": "its faces do not hang together",
    "edge lost": "an edge is not found near ({x:.3f}, {y:.3f}, {z:.3f})",
    "corner lost": "a corner is not found near ({x:.3f}, {y:.3f}, {z:.3f})",
    "curve touched": "two faces touch along a curve that is no line and no circle",
    "curve rough": "an edge is no smooth curve near ({x:.3f}, {y:.3f}, {z:.3f})",
    "solid off": "it would be off by {off:.3g} mm near ({x:.3f}, {y:.3f}, {z:.3f})",
    "narrow missing": "a narrow face is missing near ({x:.3f}, {y:.3f}, {z:.3f}); there it is off by {off:.2g} mm",
    "face without edge": "a face without any edge",
    "face is point": "a face that is a point",
    "edge twice": "an edge is used twice",
    "edge one side": "an edge has no face on one side",
    "too many triangles": "its mesh has {triangles} triangles, and faces are told of {most} at most",
    "no mesh": "a solid is made of a closed mesh",
    "solid unsound": "FreeCAD finds the solid not valid",
    "volume off": "its volume is off by {off:.3g} mm3",
}


#: Bytes of UTF-8 that the library has room for in its texts, of an operation's name.
MOST_NAME = 80


def shortened(name: str) -> str:
    """An operation's name as the library's texts have it."""
    return name.encode("utf-8", "replace")[:MOST_NAME].decode("utf-8", "ignore")


class Said(str):
    """A sentence in English that can be said in another language: ``key`` of FORMS, ``values`` of it, which may hold
    others. A text like any other. TypeError where there is no such sentence, as of a function that is called
    wrongly."""

    key: str
    values: dict[str, Any]

    def __new__(cls, key: str, **values: Any) -> Said:
        try:
            self = super().__new__(cls, FORMS[key].format(**values))
        except LookupError as error:
            raise TypeError(f"no sentence {key!r} of {', '.join(values) or 'no values'}: {error} is missing") from None
        self.key, self.values = key, values
        return self

    def __getnewargs_ex__(self) -> tuple[tuple[str], dict[str, Any]]:
        return (self.key,), self.values

    def translated(self, translate: Callable[[str], str], point: str = ".") -> str:
        """In another language: ``translate`` gives its form for each of ours; ``point`` is that of decimals."""
        def other(value: Any) -> Any:
            if isinstance(value, Said):
                return value.translated(translate, point)
            return _Pointed(value, point) if isinstance(value, float) else value

        return translate(FORMS[self.key]).format(**{name: other(value) for name, value in self.values.items()})


class _Pointed:
    """A number that is written with another decimal point."""

    def __init__(self, value: float, point: str) -> None:
        self.value, self.point = value, point

    def __format__(self, spec: str) -> str:
        return format(self.value, spec).replace(".", self.point)


#: Of all material; less of it is not worth a word.
UNSEEN_SHARE = 1e-3


def unseen_note(contour: Any) -> Optional[Said]:
    """What to say of material that a mesh has not (a Contour), None: of too little of it."""
    thin, whole = contour.unseen_mm3, contour.unseen_mm3 + contour.surface_mm3
    if thin <= UNSEEN_SHARE * whole:
        return None
    return Said("unseen", volume=thin, percent=100 * thin / whole)
