# SPDX-License-Identifier: LGPL-2.1-or-later
"""Types of what the library takes and tells, for annotations."""
from __future__ import annotations

import os
from typing import Any, Callable, Literal, Optional, Sequence, Union

#: Called with the fraction done, a few dozen times a second; a true answer cancels (Cancelled), an exception cancels
#: and comes out unchanged. Signals such as Ctrl-C cancel too.
Progress = Optional[Callable[[float], Any]]
Path = Union[str, bytes, "os.PathLike[str]", "os.PathLike[bytes]"]
Point = Sequence[float]
#: Two corners, the low one first.
Box = tuple[Sequence[float], Sequence[float]]

Severity = Literal["note", "warning", "error"]
Dialect = Literal["linuxcnc", "grbl", "mach3", "fanuc"]
PartKind = Literal["flutes", "shank", "holder"]
View = Literal["isometric", "top", "bottom", "front", "rear", "left", "right"]
Colouring = Literal["material", "operation", "tool", "age", "feed", "deviation"]
Buffers = Literal["rgba", "depth", "normal", "position", "move", "seen"]
