# SPDX-License-Identifier: LGPL-2.1-or-later
"""Milling simulation: the face of libswarf. Lengths in mm. Import the package swarf instead."""
from __future__ import annotations

from typing import Any, Final, Iterable, Literal, Mapping, Optional, Protocol, Sequence, Union, final

from _typeshed import ReadableBuffer, structseq

from .aliases import Box, Buffers, Colouring, Dialect, PartKind, Path, Point, Progress, Severity, View

class _Array(Protocol):
    """Arrays of NumPy: buffers, which type checkers know from Python 3.12 on."""

    @property
    def __array_interface__(self) -> Any: ...

_Buffer = Union[ReadableBuffer, _Array]
#: A table of n rows: a buffer of two dimensions (any number format in native byte order, strided or not), or rows.
_Table = Union[_Buffer, Sequence[Sequence[float]]]

class Error(Exception):
    """Something libswarf could not do; base of its own exceptions."""

class FormatError(Error):
    """A file or text is not what it should be; the text says where."""

class GeometryError(Error):
    """A shape that cannot be worked with, e.g. an open mesh."""

class Cancelled(Error):
    """The progress callback asked to stop; the objects stay valid."""

class BusyError(Error):
    """The object is in use by another call."""

def version() -> str:
    """Version of libswarf, e.g. "0.1.0"."""

def threads() -> int:
    """Number of threads the library uses."""

def set_threads(count: int) -> None:
    """Set how many threads the library may use in this process, 1 .. 1024; 0: one per core.
    Results never depend on it."""

def set_progress_interval(milliseconds: int) -> None:
    """Set how many milliseconds at least pass between two reports of one loop in this process, 25 at first.
    With 0 each piece of work done by the calling thread is reported: with one thread the same on any machine."""

def isa() -> str:
    """Instruction set in use: "scalar", "avx2" or "avx512"."""

def memory_peak() -> int:
    """Peak resident memory of this process in bytes, 0 where the system does not tell."""

@final
class Cutter:
    """A cutter: a body of revolution about +z, tip at z = 0, from text such as "flat:d=3,l=18" or
    "bull:d=6,r=1,l=20,sd=6,sl=30" (mm and degrees). FormatError names the word that is wrong. Any thread."""

    def __new__(cls, text: str) -> Cutter: ...
    @classmethod
    def from_parts(cls, parts: Iterable[tuple[PartKind, _Table]], /) -> Cutter:
        """A cutter from (kind, nodes) pairs: nodes an (n, 3) table of r, z (mm) and bulge (tan of a quarter of the
        arc's angle to the next node, 0 for a line), from the axis at the lowest height up and back to the axis.
        ValueError, or GeometryError for an impossible meridian."""
    @property
    def parts(self) -> tuple[tuple[PartKind, memoryview], ...]:
        """Tuple of (kind, read-only (n, 3) float64 view of r, z, bulge)."""
    def radius(self, kind: PartKind = "flutes") -> float:
        """Greatest radius of the parts of one kind, mm; 0 if it has none."""
    def extent(self, kind: PartKind = "flutes") -> tuple[float, float]:
        """Lowest and highest z of the parts of one kind, mm; (0, 0) if it has none."""
    def volume(self, kind: PartKind = "flutes") -> float:
        """Volume of the parts of one kind, mm3, exact (Pappus)."""
    def radius_at(self, z: float, kind: PartKind = "flutes") -> float:
        """Radius of the parts of one kind at height z, mm; -1 outside."""

@final
class Program:
    """What a machine does: a flat array of moves in mm, in the coordinates of the stock, from where the tool stands
    first (three numbers; None: unknown). One thread builds, many may read; building while a call reads raises
    BusyError, while a view lives BufferError. len() is the number of moves."""

    def __new__(cls, start: Optional[Point] = None) -> Program: ...
    @classmethod
    def read_gcode(
        cls,
        path: Path,
        *,
        start: Optional[Point] = None,
        dialect: Dialect = "linuxcnc",
        tools: Union[None, Path, Iterable[tuple[int, float, float]]] = None,
        diameters: Optional[Mapping[int, float]] = None,
        parameters: Optional[Path] = None,
        machine_unit: Literal["mm", "inch"] = "mm",
        search: Optional[str] = None,
        block_delete: bool = False,
        line_limit: int = 0,
        progress: Progress = None,
    ) -> Program:
        """Program from a G-code file. ``start`` is where the tool stands first; ``tools`` a LinuxCNC tool table file,
        or (number, diameter, length) rows in mm; ``diameters`` maps numbers of tools to diameters in mm, for cutter
        compensation where no table tells; ``parameters`` a LinuxCNC parameter file; ``machine_unit`` is what the
        lengths in the two files are in; ``search`` folders of subroutine files, ':' between them; ``block_delete``
        leaves out lines that begin with '/'; ``line_limit`` bounds what loops execute (0: 20 million lines). OSError,
        or FormatError "file:line:column: error: 'word' ...". Any thread."""
    @classmethod
    def parse_gcode(
        cls,
        text: Union[str, bytes],
        *,
        name: str = "text",
        start: Optional[Point] = None,
        dialect: Dialect = "linuxcnc",
        tools: Union[None, Path, Iterable[tuple[int, float, float]]] = None,
        diameters: Optional[Mapping[int, float]] = None,
        parameters: Optional[Path] = None,
        machine_unit: Literal["mm", "inch"] = "mm",
        search: Optional[str] = None,
        block_delete: bool = False,
        line_limit: int = 0,
        progress: Progress = None,
    ) -> Program:
        """The same from text; ``name`` stands for the file in errors."""
    @classmethod
    def check_gcode(
        cls,
        path: Path,
        *,
        start: Optional[Point] = None,
        dialect: Dialect = "linuxcnc",
        tools: Union[None, Path, Iterable[tuple[int, float, float]]] = None,
        diameters: Optional[Mapping[int, float]] = None,
        parameters: Optional[Path] = None,
        machine_unit: Literal["mm", "inch"] = "mm",
        search: Optional[str] = None,
        block_delete: bool = False,
        line_limit: int = 0,
        progress: Progress = None,
    ) -> tuple[tuple[str, str, int, int, str], ...]:
        """What read_gcode() has to say of a file, as its notes: the first error, after which nothing is read, and the
        warnings and messages before it. No FormatError."""
    def add_operation(self, name: str) -> int:
        """Add an operation, make it current and return its index."""
    def set_section(
        self,
        *,
        tool: int = -1,
        operation: int = ...,
        spindle: Literal["off", "cw", "ccw"] = "off",
        spindle_rpm: float = 0.0,
        coolant: int = 0,
        work_offset: int = 0,
    ) -> None:
        """What the moves that follow share: tool number (-1: none), index of the operation (the one added
        last), spindle, coolant (bit 0 mist, bit 1 flood), work offset (0 machine, 1 G54 ...)."""
    def add_line(
        self,
        end: Point,
        *,
        kind: Literal["rapid", "feed", "dwell", "tool_change", "probe", "position"] = "feed",
        feed_mm_min: float = 0.0,
        line: int = 0,
    ) -> None:
        """Add a straight move to ``end`` (three numbers, mm); kind "feed", "rapid", "probe" or "position"."""
    def add_arc(
        self,
        end: Point,
        centre: Point,
        *,
        plane: Literal["xy", "zx", "yz"] = "xy",
        ccw: bool = True,
        turns: int = 1,
        feed_mm_min: float = 0.0,
        line: int = 0,
    ) -> None:
        """Add an arc or helix about ``centre``; ``turns`` counts the passes, end equal to the start gives a full
        circle. ValueError when the radii of start and end do not fit."""
    def add_dwell(self, seconds: float, *, line: int = 0) -> None:
        """Add a pause at the current position."""
    def add_tool_change(self, *, line: int = 0) -> None:
        """Add a change to the tool of the current section."""
    def seconds(self, rapid_mm_min: float = 5000.0) -> float:
        """Seconds that the moves take at their feeds, rapids at ``rapid_mm_min``, without acceleration."""
    def times(
        self,
        *,
        rapid_mm_min: Union[float, Point] = 5000.0,
        feed_mm_min: Union[float, Point] = 5000.0,
        acceleration_mm_s2: Union[float, Point] = 500.0,
        junction_mm: float = 0.01,
        rotary_deg_min: float = 3600.0,
        tool_change_s: float = 0.0,
    ) -> memoryview:
        """Seconds of each move as a read-only float64 view: with the rapid rate, greatest feed and acceleration of
        each axis (a number, or three for X, Y, Z), corners passed at the speed at which an arc that strays from them
        by ``junction_mm`` holds the acceleration."""
    @property
    def moves(self) -> memoryview:
        """Read-only view of the moves: records end (3 float64), feed_mm_min (float32), line (uint32), arc (int32,
        -1: straight), section_kind (uint32: section * 8 + kind). While a view lives the program cannot grow."""
    @property
    def arcs(self) -> memoryview:
        """Read-only view of the arcs: records centre (3 float64), angle_rad, plane (int32), reserved."""
    @property
    def sections(self) -> memoryview:
        """Read-only view of the sections: records tool, operation, spindle, coolant (int32), spindle_rpm (float64),
        work_offset, source (int32)."""
    @property
    def axes(self) -> memoryview:
        """Read-only view of where A, B, C (degrees), U, V, W (mm) stand: records first (uint64, the move from which
        on), value (6 float64). Empty while they stand at 0."""
    @property
    def notes(self) -> tuple[tuple[str, str, int, int, str], ...]:
        """What the reader had to say: (kind, source, line, column, text) each; kind "warning" or "message"."""
    @property
    def sources(self) -> tuple[str, ...]:
        """Names of the files the moves come from; sections point to them."""
    @property
    def operations(self) -> tuple[str, ...]:
        """Names of the operations."""
    @property
    def tools(self) -> tuple[int, ...]:
        """Numbers of the tools that feed moves use, sorted; -1: no tool loaded."""
    def __len__(self) -> int: ...

@final
class Stock:
    """What is being milled: a narrow-band level set in mm. Made by Stock.box(), cylinder(), from_mesh() or read().
    Long calls use all cores, take a progress callback and leave a consistent stock. A stock that is in use by another
    call raises BusyError."""

    @classmethod
    def box(cls, lo: Point, hi: Point, voxel: float, *, memory_limit: int = 0) -> Stock:
        """A block between two corners. MemoryError, before any work, when the estimate exceeds ``memory_limit`` bytes
        (0: 80 % of what is free); its text names a voxel size that would fit."""
    @classmethod
    def cylinder(cls, base: Point, axis: Point, radius: float, voxel: float, *, memory_limit: int = 0) -> Stock:
        """A round bar from the centre of one end along the vector ``axis``, whose length is the bar's."""
    @classmethod
    def from_mesh(cls, mesh: Mesh, voxel: float, *, memory_limit: int = 0, progress: Progress = None) -> Stock:
        """The inside of a closed Mesh. GeometryError when it is open or not oriented outwards."""
    @classmethod
    def read(cls, path: Path, *, progress: Progress = None) -> Stock:
        """From the first level set of a .vdb file, with its voxel size. OSError, FormatError."""
    @classmethod
    def estimate(cls, lo: Point, hi: Point, voxel: float) -> int:
        """Bytes that a stock filling this box may need while it is cut."""
    def lumps(
        self, points: _Table = (), *, progress: Progress = None
    ) -> tuple[tuple[Lump, ...], tuple[Optional[int], ...]]:
        """What hangs together, by voxels with a common face: Lumps, the largest first, and for each of an (n, 3) table
        of points the place of the lump that holds it, None in the air."""
    def placed(
        self,
        placement: _Table,
        *,
        voxel: Optional[float] = None,
        surface: Optional[Surface] = None,
        moves: Optional[int] = None,
        memory_limit: int = 0,
        progress: Progress = None,
    ) -> Stock:
        """The stock turned and moved, as a new Stock: ``placement`` is three rows of rotation and shift (mm), (3, 4).
        Quarter turns with any shift keep every voxel. Any other turn, or another ``voxel`` (mm), goes by the mesh with
        the Surface of which the stock has seen the first ``moves`` (None: all), without loss to speak of. Else new
        voxels are made from the old ones: edges move by less than a tenth of a voxel, corners by up to 0.3;
        edges too where voxels become larger. ValueError: not a rotation; GeometryError: nothing is left of the
        stock."""
    def write(self, path: Path, *, progress: Progress = None) -> None:
        """To a .vdb file; beside the target and renamed, so a failure loses nothing."""
    def copy(self, /) -> Stock:
        """A stock of its own with the same content."""
    @property
    def voxel(self) -> float:
        """Edge of a voxel, mm."""
    def bounding_box(self, /) -> Optional[tuple[tuple[float, float, float], tuple[float, float, float]]]:
        """((x, y, z), (x, y, z)) of the material in mm, to half a voxel; None when nothing is left."""
    def volume(self, /) -> float:
        """Volume of the material, mm3."""
    def hash(self, /) -> int:
        """64-bit hash of the content, the same whatever the threads or kernels."""
    def size(self, /) -> tuple[int, int]:
        """(leaves of 8x8x8 voxels, bytes held)."""
    def sample(self, points: _Table, /) -> memoryview:
        """Signed distance (mm, negative inside, trilinear) at an (n, 3) table of points: read-only float32 view.
        Beyond the narrow band +-3 voxels."""
    def cut(
        self,
        cutter: Cutter,
        program: Program,
        first: int = 0,
        *,
        count: Optional[int] = None,
        progress: Progress = None,
    ) -> None:
        """Cut with the flutes of one cutter along moves first .. first + count - 1 of a program, whatever their tool,
        all at once. Cancelling leaves some moves cut."""
    def simulate(
        self,
        program: Program,
        tools: dict[int, Cutter],
        *,
        first: int = 0,
        count: Optional[int] = None,
        batch: int = 0,
        removed_per_move: bool = False,
        progress: Progress = None,
    ) -> Simulation:
        """Play moves first .. first + count - 1 of a program with tools {number: Cutter}. ``batch`` moves are cut at
        once: 0 as many as share a tool and an operation, 1 move by move. A tool that is missing or has no flutes is a
        finding of class "error". Cancelling leaves the moves so far cut."""
    def check(
        self,
        program: Program,
        tools: dict[int, Cutter],
        *,
        fixtures: Sequence[Solid] = (),
        design: Optional[Solid] = None,
        tolerance: float = 0.05,
        clearance: float = 0.0,
        travel: Optional[Box] = None,
        no_plunge: Sequence[int] = (),
        teeth: dict[int, int] = {},
        loads: bool = False,
        stop: bool = False,
        progress: Progress = None,
    ) -> Check:
        """Play a program as simulate() does, and look at each move before it is cut. ``fixtures`` are Solids that
        nothing may touch, ``design`` a Solid that shank and holder may not touch and flutes by no more than
        ``tolerance``; ``clearance`` (mm) is wanted between holder and stock; ``travel`` is a box that the tip has to
        stay in; ``no_plunge`` are tools that cannot plunge; ``loads`` measures what each move asks of its tool, of
        which ``teeth`` are {number: cutting edges around it}; ``stop`` ends with the first error."""
    def union(self, other: Stock, /) -> None:
        """Add another stock of the same voxels to this one."""
    def intersection(self, other: Stock, /) -> None:
        """Keep what is in another stock of the same voxels too."""
    def difference(self, other: Stock, /) -> None:
        """Take another stock of the same voxels away from this one."""
    def picture(
        self,
        path: Optional[Path] = None,
        width: int = 1024,
        height: int = 768,
        *,
        view: View = "isometric",
        samples: int = 3,
        perspective: bool = False,
        progress: Progress = None,
    ) -> Optional[bytes]:
        """A shaded picture, samples x samples rays per pixel at edges. With a path it is written as PNG and None is
        returned; else RGBA bytes, 4 x width x height, rows from the top."""
    def cast(self, origins: _Table, directions: _Table) -> tuple[memoryview, memoryview]:
        """First hits of rays, (n, 3) tables in mm -> (distances: float64 view, in lengths of the direction, inf for
        none; normals: (n, 3) float32 view)."""

@final
class Camera:
    """From where and how a scene is looked at, in mm and degrees; its methods change it in place. Places in a picture
    are x to the right and y upwards, -1 .. 1 at its borders; its aspect is width / height. Parallel rays show what is
    before and behind the eye. ValueError for a camera that sees nothing."""

    def __new__(
        cls,
        eye: Point,
        target: Point,
        up: Point,
        *,
        perspective: bool = False,
        height: float = 100.0,
        fov: float = 30.0,
    ) -> Camera: ...
    @classmethod
    def view(cls, name: View, box: Optional[Box], aspect: float = 1.0, *, perspective: bool = False) -> Camera:
        """The whole of a box seen from one of its sides."""
    def copy(self, /) -> Camera:
        """A camera of its own that looks the same way."""
    def fit(self, box: Optional[Box], aspect: float = 1.0) -> None:
        """Show the whole box from the direction the camera looks in."""
    def set_perspective(self, on: bool, /) -> None:
        """Parallel rays instead of perspective or back; what lies at the target keeps its size."""
    def turn(self, pivot: Point, axis: Point, angle_deg: float) -> None:
        """Turn counter-clockwise about the line through ``pivot`` along ``axis``."""
    def orbit(self, pivot: Point, right_deg: float, up_deg: float, *, turntable: bool = False) -> None:
        """Turn about ``pivot`` as if the part were dragged to the right and upwards by these angles: about the
        camera's own axes, or with ``turntable`` about the vertical and up to the poles."""
    def pan(self, x: float, y: float, depth_of: Optional[Point] = None) -> None:
        """Move so that what lies as deep as ``depth_of`` (the target) goes x to the right and y upwards, in heights
        of the picture."""
    def zoom(self, factor: float, toward: Optional[Point] = None) -> None:
        """Show things ``factor`` times as large; the point ``toward`` (the target) stays at its place in the
        picture."""
    def ray(
        self, x: float, y: float, aspect: float = 1.0
    ) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """(origin, unit direction) of the ray through a place of the picture."""
    def project(self, point: Point, aspect: float = 1.0) -> tuple[float, float, float]:
        """(x, y, depth in mm) at which a point appears; x and y are NaN for what is behind a perspective eye."""
    @property
    def eye(self) -> tuple[float, float, float]:
        """Where the camera stands, mm."""
    @property
    def target(self) -> tuple[float, float, float]:
        """The point in the middle of the picture, mm."""
    @property
    def up(self) -> tuple[float, float, float]:
        """What is upwards in the picture."""
    @property
    def perspective(self) -> bool:
        """Whether rays meet in the eye; else they are parallel."""
    @property
    def height(self) -> float:
        """Parallel rays: mm from the bottom to the top of the picture."""
    @property
    def fov(self) -> float:
        """Perspective: vertical opening angle, degrees."""

@final
class Picture:
    """A picture of a scene. Its views are read-only; those that were not asked for are None."""

    def show_deviation(
        self, other: Union[Solid, Stock], tolerance: float, *, allowance: float = 0.0, progress: Progress = None
    ) -> memoryview:
        """Tint what shows the stock by its deviation from a design Solid, as deviation_colours() does -> the deviations
        (mm, less what is meant to be left), a read-only (height, width) float64 view, NaN elsewhere. Of a picture of
        the design, by that of a Stock from it: on faces to 0.01 voxel up to two voxels, +-inf beyond three. Needs the
        buffers rgba, position and seen; ValueError without them. rgba is a new view, which write() writes."""
    def write(self, path: Path, /) -> None:
        """Write the colours as PNG. OSError."""
    @property
    def width(self) -> int:
        """Pixels."""
    @property
    def height(self) -> int:
        """Pixels."""
    @property
    def rgba(self) -> Optional[memoryview]:
        """(height * width, 4) uint8 view, sRGB, rows from the top."""
    @property
    def depth(self) -> Optional[memoryview]:
        """(height, width) float32 view: mm along the view from the eye, inf where nothing is seen."""
    @property
    def normal(self) -> Optional[memoryview]:
        """(height * width, 3) float32 view: unit normals, zero where nothing is seen."""
    @property
    def position(self) -> Optional[memoryview]:
        """(height * width, 3) float64 view: points in mm, NaN where nothing is seen."""
    @property
    def move(self) -> Optional[memoryview]:
        """(height, width) int32 view: the move that made the surface; -1: the stock as it was, or not known."""
    @property
    def seen(self) -> Optional[memoryview]:
        """(height, width) uint8 view: what is seen, 0 nothing, 1 stock, 2 section, 3 flutes, 4 shank, 5 holder,
        6 fixture."""

@final
class Pick(
    structseq[Any],
    tuple[
        Literal["stock", "section", "flutes", "shank", "holder", "fixture"], tuple[float, float, float],
        tuple[float, float, float], int, float
    ],
):
    """What is seen at a place of a picture."""

    __match_args__: Final = ("seen", "point", "normal", "move", "depth")
    @property
    def seen(self) -> Literal["stock", "section", "flutes", "shank", "holder", "fixture"]: ...
    @property
    def point(self) -> tuple[float, float, float]: ...
    @property
    def normal(self) -> tuple[float, float, float]: ...
    @property
    def move(self) -> int: ...
    @property
    def depth(self) -> float: ...

@final
class Scene:
    """What is shown of a Stock; it follows the stock's changes. BusyError while another call is in the stock."""

    def __new__(cls, stock: Stock) -> Scene: ...
    def update(self, /) -> None:
        """Take over what changed in the stock. Without it the next picture does."""
    def set_surface(
        self,
        first: Stock,
        program: Program,
        tools: dict[int, Cutter],
        moves: Optional[int] = None,
        *,
        progress: Progress = None,
    ) -> None:
        """Show the exact surface that the first moves (None: all) of a program make of the stock ``first``, which the
        scene's stock must have seen: sharp edges, true normals, and the moves that made them."""
    def show_surface(self, surface: Surface, moves: Optional[int] = None) -> None:
        """Show a Surface after the first moves (None: all) of its program, as set_surface() does."""
    def set_moves(self, count: Optional[int], fraction: float = 0.0, /) -> None:
        """How many moves of the surface stand now, and what part, 0 .. 1, of the next one's path; None: all."""
    def set_fixtures(self, meshes: Sequence[Mesh], /) -> None:
        """Show these Mesh objects beside the stock, in place of those before."""
    def render(
        self,
        camera: Camera,
        width: int = 1280,
        height: int = 960,
        *,
        samples: int = 3,
        coarse: int = 1,
        budget_ms: float = 0.0,
        buffers: Optional[Sequence[Buffers]] = None,
        exact: bool = True,
        edges: bool = True,
        occlusion: bool = True,
        shadow: bool = False,
        colour: Optional[Sequence[float]] = None,
        background: Optional[Sequence[float]] = None,
        background_top: Optional[Sequence[float]] = None,
        colouring: Colouring = "material",
        values: Optional[_Buffer] = None,
        value_range: float = 0.1,
        sections: Optional[Sequence[tuple[Point, Point]]] = None,
        cutter: Optional[tuple[Cutter, Point]] = None,
        program: Optional[Program] = None,
        moves_done: float = 0.0,
        path: bool = False,
        selected: Optional[tuple[int, int]] = None,
        outline: Optional[Box] = None,
        axes: float = 0.0,
        progress: Progress = None,
    ) -> Picture:
        """A Picture. At edges samples x samples rays per pixel (1 .. 4); one ray for coarse x coarse pixels (1 .. 16),
        as many as it takes to be done in about budget_ms when that is given. buffers: what is wanted (None: rgba).
        exact: the surface of set_surface(); edges: dark lines; occlusion: dark corners; shadow: of the light. Colours
        are linear, 0 .. 1: RGB of the material, RGBA of the background. colouring: by the program's moves, or
        deviation from ``values``, width * height float32 in mm, +-value_range. sections: up to 6 (point, normal); what
        lies where a normal points to is taken away. cutter: (Cutter, tip). program, moves_done: what is played, and how
        far; path: show it.
        surfaces and path of the moves ``selected`` = (first, end) stand out. outline: a box; axes: mm of x, y, z."""
    def pick(
        self,
        camera: Camera,
        x: float,
        y: float,
        width: int = 1280,
        height: int = 960,
        *,
        sections: Optional[Sequence[tuple[Point, Point]]] = None,
        cutter: Optional[tuple[Cutter, Point]] = None,
    ) -> Optional[Pick]:
        """The Pick at a place of the picture (x to the right and y upwards, -1 .. 1), or None where nothing is."""

@final
class Held(structseq[Any], tuple[int, int, int, int, int, int, int]):
    """What a History holds, in bytes."""

    __match_args__: Final = (
        "bytes", "first_bytes", "record_bytes", "keyframe_bytes", "record_count", "keyframe_count", "oldest"
    )
    @property
    def bytes(self) -> int: ...
    @property
    def first_bytes(self) -> int: ...
    @property
    def record_bytes(self) -> int: ...
    @property
    def keyframe_bytes(self) -> int: ...
    @property
    def record_count(self) -> int: ...
    @property
    def keyframe_count(self) -> int: ...
    @property
    def oldest(self) -> int: ...

@final
class History:
    """A stock that can stand at any move of a program, forward by cutting, back by undoing; tools as in
    Stock.simulate(). It stands before the first move. A position has one content, to the bit, whichever way it is
    reached. memory_limit: bytes for what is kept, besides a copy of the first stock; 0: a quarter of what is free. The
    program cannot be changed while the history lives. A second thread gets BusyError."""

    def __new__(
        cls, stock: Stock, program: Program, tools: dict[int, Cutter], *, memory_limit: int = 0
    ) -> History: ...
    def seek(self, move: int, fraction: float = 0.0, *, progress: Progress = None) -> None:
        """Make the stock what it is after the first ``move`` moves and a part, 0 .. 1, of the next one's path.
        Cancelling leaves it between moves, where ``move`` says. ValueError: no such position, or the stock was changed
        by others."""
    def approach(self, move: int, fraction: float = 0.0, *, progress: Progress = None) -> bool:
        """Go on towards there by one batch of at most 4096 moves -> whether it is there."""
    def held(self, /) -> Held:
        """What it holds: a Held."""
    @property
    def stock(self) -> Stock:
        """The Stock: read it, draw it, measure it, and let nothing else cut it."""
    @property
    def move(self) -> int:
        """Moves that are done."""
    @property
    def fraction(self) -> float:
        """Part of the next move that is done, 0 .. 1."""

@final
class Finding(
    structseq[Any],
    tuple[
        Severity, int, int, int, int, str, Literal["no tool", "unknown tool", "no flutes", "axis", "idle"], str, float
    ],
):
    """Something the simulation noticed."""

    __match_args__: Final = ("severity", "operation", "move", "line", "tool", "text", "kind", "axis", "value")
    @property
    def severity(self) -> Severity: ...
    @property
    def operation(self) -> int: ...
    @property
    def move(self) -> int: ...
    @property
    def line(self) -> int: ...
    @property
    def tool(self) -> int: ...
    @property
    def text(self) -> str: ...
    @property
    def kind(self) -> Literal["no tool", "unknown tool", "no flutes", "axis", "idle"]: ...
    @property
    def axis(self) -> str: ...
    @property
    def value(self) -> float: ...

@final
class Simulation:
    """What Stock.simulate() came to. Immutable, any thread."""

    @property
    def removed_by_operation(self) -> tuple[float, ...]:
        """mm3 removed by each operation of the program, in its order."""
    @property
    def removed_per_move(self) -> Optional[memoryview]:
        """Read-only float64 view of the mm3 that each played move removed; None unless asked for."""
    @property
    def findings(self) -> tuple[Finding, ...]:
        """Tuple of Finding, in the order of the moves."""
    @property
    def volume_initial(self) -> float:
        """Volume before, mm3."""
    @property
    def volume_final(self) -> float:
        """Volume after, mm3."""

@final
class Surface:
    """The surface that a program makes of the stock ``first`` (as it is now, not kept), exactly: the first shape and
    the sweeps of the cutters in ``tools``. The program can no longer be added to while the surface lives. Immutable,
    any thread."""

    def __new__(
        cls, first: Stock, program: Program, tools: dict[int, Cutter], *, progress: Progress = None
    ) -> Surface: ...
    def next(
        self,
        placement: _Table,
        program: Program,
        tools: dict[int, Cutter],
        *,
        moves: Optional[int] = None,
        progress: Progress = None,
    ) -> Surface:
        """The Surface of the next set-up: this one after its first ``moves`` (None: all), turned and moved by
        ``placement``, is the first shape of ``program``. Nothing is lost."""

@final
class Mesh:
    """Triangles: vertices an (n, 3) table in mm, triangles an (m, 3) table of vertex numbers, counter-clockwise seen
    from outside. Immutable, any thread. ValueError for numbers out of range."""

    def __new__(cls, vertices: _Table, triangles: _Table) -> Mesh: ...
    @classmethod
    def read(cls, path: Path) -> Mesh:
        """Mesh from a .stl (welded), .ply or .obj file, by its content. OSError, FormatError."""
    @classmethod
    def from_stock(
        cls,
        stock: Stock,
        error: float = 0.0,
        *,
        budget: int = 0,
        surface: Optional[Surface] = None,
        moves: Optional[int] = None,
        fine: bool = False,
        keep_volume: bool = False,
        progress: Progress = None,
    ) -> Mesh:
        """The surface of a stock with its edges: closed, oriented outwards, no triangles that cut each other. Vertices
        are left out while the mesh stays within ``error`` mm of the full one, until at most ``budget`` triangles are
        left (0: as few as the error allows). Vertices lie exactly on the Surface of which the stock has seen the first
        ``moves`` (None: all), edges as sharp as they are; without one they come from the voxels. ``fine``: triangles
        that leave the Surface, beside edges closer to each other than a voxel, are split; that takes longer.
        ``keep_volume``: vertices are shifted, by a fifth of the error at most (a hundredth of a voxel where it is 0),
        until the mesh has the volume of the surface, ``contour.surface_mm3``, or is as near to it as that allows.
        What it came to is in ``contour``."""
    @classmethod
    def stream(
        cls,
        stock: Stock,
        path: Path,
        error: float = 0.0,
        *,
        surface: Optional[Surface] = None,
        moves: Optional[int] = None,
        fine: bool = False,
        keep_volume: bool = False,
        memory_limit: int = 0,
        progress: Progress = None,
    ) -> Contour:
        """The mesh of from_stock() straight to a binary .stl file; its Contour. One that would not fit into
        ``memory_limit`` (bytes; 0: 80 % of what is free now) is made and written band by band along x, with small
        triangles along the planes between them; a pipe gets the whole one however much memory that takes."""
    def write(self, path: Path, *, colours: Optional[_Table] = None, progress: Progress = None) -> None:
        """Write .stl or .ply (binary), .obj, .3mf or .glb by the suffix; beside the target and renamed, so a failure
        loses nothing. ``colours`` is an (m, 3) table of 0 .. 255, a row per triangle; .stl has no place for it."""
    def measure(self) -> Shell:
        """All shells as one Shell; cavities count against the solids."""
    def shells(self) -> tuple[Shell, ...]:
        """Tuple of a Shell per piece that hangs together by its edges."""
    def keep_shells(self, shells: Sequence[int], /) -> Mesh:
        """A Mesh of these shells alone, by their places in shells()."""
    def split_shells(self, groups: Sequence[Sequence[int]], *, progress: Progress = None) -> tuple[Mesh, ...]:
        """A tuple of a Mesh per group of shells, each group a sequence of their places in shells(); a shell is in one
        group at most. All are made in one pass: many take no longer than few."""
    def split(self, point: Point, normal: Point) -> tuple[Mesh, Mesh]:
        """The closed mesh cut by the plane through ``point``: (what lies against ``normal``, what lies along it), two
        closed Meshes with caps, empty where there is nothing. GeometryError: the mesh is open."""
    def thickness(self, *, progress: Progress = None) -> memoryview:
        """Thickness of the wall behind each triangle, mm: a read-only float32 view, the least of four rays straight
        into the material, from the triangle's middle and near its corners, to a face within 60 degrees of opposite; inf
        where there is none. GeometryError: longer or farther away than 1e6 mm."""
    def placed(self, placement: _Table, /) -> Mesh:
        """The mesh turned and moved, as a new Mesh: ``placement`` is three rows of rotation and shift (mm)."""
    def origins(
        self, surface: Surface, *, moves: Optional[int] = None, reach: float = 0.0, progress: Progress = None
    ) -> memoryview:
        """What made each triangle: a read-only (m, 4) int32 view of set-up (0: the Surface's own, 1: the one before
        ...), move (-1: the first shape, -2: not known), piece of the cutter or the first shape, and kind of face: 0
        other, 1 plane, 2 cylinder, 3 cone, 4 sphere, 5 torus. Looked for within ``reach`` mm (0: a voxel) of the
        triangle, beside its middle."""
    def faces(
        self, surface: Surface, *, moves: Optional[int] = None, reach: float = 0.0, progress: Progress = None
    ) -> memoryview:
        """The endless face that each triangle is on: a read-only (m, 9) float64 view of kind (as in origins()), point
        (x, y, z), axis (unit), radius, and second number. Plane: a point, the normal out of the material; cylinder:
        axis and radius; cone: apex, axis, second = tangent of the angle between axis and face; sphere: centre, radius;
        torus: centre, axis, radius to the middle of the tube, second = radius of the tube. Looked for as origins()
        does."""
    def section(self, point: Point, normal: Point) -> tuple[tuple[tuple[float, float, float], ...], ...]:
        """Where the plane through ``point`` cuts the mesh: a tuple of polylines, each a tuple of (x, y, z) in mm,
        material on the left seen against ``normal``. In a closed mesh each goes on from its last point to its
        first."""
    @property
    def contour(self) -> Optional[Contour]:
        """Contour: what Mesh.from_stock() came to; None for other meshes."""
    @property
    def vertices(self) -> memoryview:
        """Read-only (n, 3) float32 view, mm."""
    @property
    def triangles(self) -> memoryview:
        """Read-only (n, 3) uint32 view of vertex numbers, outwards."""
    @property
    def vertex_count(self) -> int:
        """Number of vertices."""
    @property
    def triangle_count(self) -> int:
        """Number of triangles."""
    @property
    def closed(self) -> bool:
        """Whether every edge is balanced: the surface bounds a volume."""
    @property
    def volume(self) -> float:
        """Signed volume, mm3; positive when oriented outwards."""
    @property
    def area(self) -> float:
        """Area, mm2."""
    @property
    def bounding_box(self) -> Optional[tuple[tuple[float, float, float], tuple[float, float, float]]]:
        """((x, y, z), (x, y, z)) in mm, None when empty."""
    @property
    def boundary_edges(self) -> int:
        """Edges of one triangle only."""
    @property
    def nonmanifold_edges(self) -> int:
        """Edges of more than two triangles."""
    @property
    def misoriented_edges(self) -> int:
        """Edges that two triangles use in one direction."""
    @property
    def degenerate(self) -> int:
        """Triangles with a repeated vertex."""

@final
class Shell(
    structseq[Any],
    tuple[
        int, int, int, int, int, int, float, float, tuple[float, float, float],
        tuple[tuple[float, float, float], tuple[float, float, float], tuple[float, float, float]],
        tuple[float, float, float],
        tuple[tuple[float, float, float], tuple[float, float, float], tuple[float, float, float]],
        Optional[tuple[tuple[float, float, float], tuple[float, float, float]]]
    ],
):
    """A piece of surface that hangs together by its edges, measured."""

    __match_args__: Final = (
        "triangles", "vertices", "edges", "open_edges", "euler", "genus", "volume_mm3", "area_mm2", "centre",
        "inertia", "moments", "axes", "bounding_box"
    )
    @property
    def triangles(self) -> int: ...
    @property
    def vertices(self) -> int: ...
    @property
    def edges(self) -> int: ...
    @property
    def open_edges(self) -> int: ...
    @property
    def euler(self) -> int: ...
    @property
    def genus(self) -> int: ...
    @property
    def volume_mm3(self) -> float: ...
    @property
    def area_mm2(self) -> float: ...
    @property
    def centre(self) -> tuple[float, float, float]: ...
    @property
    def inertia(self) -> tuple[tuple[float, float, float], tuple[float, float, float], tuple[float, float, float]]: ...
    @property
    def moments(self) -> tuple[float, float, float]: ...
    @property
    def axes(self) -> tuple[tuple[float, float, float], tuple[float, float, float], tuple[float, float, float]]: ...
    @property
    def bounding_box(self) -> Optional[tuple[tuple[float, float, float], tuple[float, float, float]]]: ...

@final
class Lump(
    structseq[Any],
    tuple[
        int, float, tuple[float, float, float], tuple[tuple[float, float, float], tuple[float, float, float]]
    ],
):
    """Material of a stock that hangs together."""

    __match_args__: Final = ("voxels", "volume_mm3", "inside", "bounding_box")
    @property
    def voxels(self) -> int: ...
    @property
    def volume_mm3(self) -> float: ...
    @property
    def inside(self) -> tuple[float, float, float]: ...
    @property
    def bounding_box(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]: ...

@final
class Contour(structseq[Any], tuple[int, int, int, int, int, int, int, float, bool, float, float, int]):
    """What Mesh.from_stock() or Mesh.stream() came to."""

    __match_args__: Final = (
        "full_triangles", "triangles", "sharp_vertices", "exact_vertices", "parted_cells",
        "intersections_found", "intersections_left", "error_mm", "budget_met", "unseen_mm3",
        "surface_mm3", "split_edges"
    )
    @property
    def full_triangles(self) -> int: ...
    @property
    def triangles(self) -> int: ...
    @property
    def sharp_vertices(self) -> int: ...
    @property
    def exact_vertices(self) -> int: ...
    @property
    def parted_cells(self) -> int: ...
    @property
    def intersections_found(self) -> int: ...
    @property
    def intersections_left(self) -> int: ...
    @property
    def error_mm(self) -> float: ...
    @property
    def budget_met(self) -> bool: ...
    @property
    def unseen_mm3(self) -> float: ...
    @property
    def surface_mm3(self) -> float: ...
    @property
    def split_edges(self) -> int: ...

@final
class Comparison(structseq[Any], tuple[float, float, float, float]):
    """Stock and design by volume, mm3."""

    __match_args__: Final = ("design_mm3", "stock_mm3", "excess_mm3", "gouge_mm3")
    @property
    def design_mm3(self) -> float: ...
    @property
    def stock_mm3(self) -> float: ...
    @property
    def excess_mm3(self) -> float: ...
    @property
    def gouge_mm3(self) -> float: ...

def compare_volume(stock: Stock, design: Mesh, *, progress: Progress = None) -> Comparison:
    """Compare a stock with a closed design Mesh by volume, on the stock's own voxels. The stock is unchanged.
    GeometryError when the design is open."""

@final
class Solid:
    """What a closed Mesh encloses, with exact signed distances. Small holes pass (see open_edges). GeometryError when
    it is open, inside out or encloses nothing. Immutable, any thread."""

    def __new__(cls, mesh: Mesh, *, progress: Progress = None) -> Solid: ...
    def distance(self, points: _Table, /) -> memoryview:
        """Signed distances (mm, negative inside, exact) of an (n, 3) table of points: read-only float64 view."""
    @property
    def volume(self) -> float:
        """Volume, mm3; what shells have in common counts once."""
    @property
    def bounding_box(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """((x, y, z), (x, y, z)) in mm."""
    @property
    def triangle_count(self) -> int:
        """Triangles that bound it."""
    @property
    def dropped_triangles(self) -> int:
        """Degenerate, duplicate and inner triangles."""
    @property
    def open_edges(self) -> int:
        """Edges where the mesh is open."""
    @property
    def turned_edges(self) -> int:
        """Edges between triangles turned different ways."""
    @property
    def crossing_triangles(self) -> int:
        """Triangles that cross or touch others."""
    @property
    def hole_mm2(self) -> float:
        """The holes have no greater area."""

@final
class Check:
    """What Stock.check() came to. Immutable, any thread."""

    @property
    def findings(self) -> tuple[CheckFinding, ...]:
        """Tuple of CheckFinding, in the order of the moves."""
    @property
    def simulation(self) -> Simulation:
        """What Stock.simulate() tells of the same moves: Simulation."""
    @property
    def loads(self) -> Optional[dict[str, memoryview]]:
        """What each move asks of its tool, None unless asked for: a dict of read-only views with one number a move.
        "volume" (float64): mm3 removed. The others float32: "rate" and "peak_rate" mm3/s at the feed, "depth" along the
        axis and "width" across the motion mm, "angle" degrees of the turn in material, "chip" mm (0: number of teeth,
        feed or speed not known), the greatest of the move; "climb" 1: climb milling, -1: conventional; "at" 0 .. 1
        along the move, where the angle is greatest."""

@final
class CheckFinding(
    structseq[Any],
    tuple[
        Severity, str, PartKind, int, int, int, int, float, tuple[float, float, float], tuple[float, float, float],
        float, str
    ],
):
    """Something that Stock.check() found."""

    __match_args__: Final = (
        "severity", "kind", "part", "operation", "move", "line", "tool", "t", "tip", "point", "depth", "text"
    )
    @property
    def severity(self) -> Severity: ...
    @property
    def kind(self) -> str: ...
    @property
    def part(self) -> PartKind: ...
    @property
    def operation(self) -> int: ...
    @property
    def move(self) -> int: ...
    @property
    def line(self) -> int: ...
    @property
    def tool(self) -> int: ...
    @property
    def t(self) -> float: ...
    @property
    def tip(self) -> tuple[float, float, float]: ...
    @property
    def point(self) -> tuple[float, float, float]: ...
    @property
    def depth(self) -> float: ...
    @property
    def text(self) -> str: ...

@final
class Cluster(
    structseq[Any],
    tuple[
        Literal["excess", "gouge", "not reached"], float, bool, tuple[float, float, float], float, float,
        tuple[tuple[float, float, float], tuple[float, float, float]], int, tuple[int, ...], float
    ],
):
    """Neighbouring places where the deviation is beyond tolerance."""

    __match_args__: Final = ("kind", "value", "at_least", "place", "area", "volume", "box", "triangle", "moves", "away")
    @property
    def kind(self) -> Literal["excess", "gouge", "not reached"]: ...
    @property
    def value(self) -> float: ...
    @property
    def at_least(self) -> bool: ...
    @property
    def place(self) -> tuple[float, float, float]: ...
    @property
    def area(self) -> float: ...
    @property
    def volume(self) -> float: ...
    @property
    def box(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]: ...
    @property
    def triangle(self) -> int: ...
    @property
    def moves(self) -> tuple[int, ...]: ...
    @property
    def away(self) -> float: ...

@final
class Deviation:
    """The deviation of a stock from its design, see measure_deviation(). Immutable, any thread."""

    def judge(
        self,
        *,
        excess: float = 0.05,
        gouge: float = 0.05,
        allowance: float = 0.0,
        region: Optional[Box] = None,
        ignore: Optional[_Buffer] = None,
        program: Optional[Program] = None,
        tools: Optional[dict[int, Cutter]] = None,
        progress: Progress = None,
    ) -> Deviation:
        """The same measurement judged by other options, see measure_deviation(), without measuring again: fast ->
        Deviation. Stock and design may be gone; `first` stays what it was."""
    def histogram(self, lo: float, hi: float, bins: int = 64) -> tuple[float, ...]:
        """mm2 of the surface in equal steps of the deviation from lo to hi; what is beyond counts in the outer ones."""
    @property
    def passed(self) -> bool:
        """Whether no cluster is a gouge, or an excess that a move reached."""
    @property
    def clusters(self) -> tuple[Cluster, ...]:
        """Tuple of Cluster: those that fail first, the largest volume first."""
    @property
    def comparison(self) -> Comparison:
        """Volumes of stock, design, excess and gouge: Comparison."""
    @property
    def points(self) -> memoryview:
        """Read-only (n, 3) float32 view: measured points of the surface, mm."""
    @property
    def values(self) -> memoryview:
        """Read-only float32 view: their deviations, mm, positive where material is left."""
    @property
    def kinds(self) -> memoryview:
        """Read-only uint8 view: 1 near an edge, 2 untouched, 4 not to be measured."""
    @property
    def percentiles(self) -> tuple[float, float, float, float, float, float, float]:
        """Deviations (mm) that 1, 5, 25, 50, 75, 95 and 99 % of the area lie below."""
    @property
    def area(self) -> float:
        """Measured surface, mm2."""
    @property
    def mean(self) -> float:
        """Mean deviation, mm."""
    @property
    def rms(self) -> float:
        """Root of the mean square, mm."""
    @property
    def least(self) -> float:
        """Least deviation, mm."""
    @property
    def most(self) -> float:
        """Greatest deviation, mm."""
    @property
    def excess_area(self) -> float:
        """Surface with too much left, mm2."""
    @property
    def gouge_area(self) -> float:
        """Surface cut too deep, mm2."""
    @property
    def not_reached_area(self) -> float:
        """Surface with too much left where no move went, mm2."""
    @property
    def error(self) -> float:
        """How far a value on a smooth face may be off, mm."""

def measure_deviation(
    stock: Stock,
    design: Solid,
    *,
    excess: float = 0.05,
    gouge: float = 0.05,
    allowance: float = 0.0,
    region: Optional[Box] = None,
    ignore: Optional[_Buffer] = None,
    first: Optional[Stock] = None,
    program: Optional[Program] = None,
    tools: Optional[dict[int, Cutter]] = None,
    progress: Progress = None,
) -> Deviation:
    """Hold a stock against a design Solid. Tolerances ``excess`` and ``gouge`` in mm; ``allowance`` is meant to be
    left; ``region`` is a box to stay in; ``ignore`` has one byte for each triangle of the design's mesh, not 0 where it
    is not to be measured; ``first`` is the Stock before the first cut, to tell where no move went; ``program`` and
    ``tools`` tell the moves behind each cluster. The stocks are unchanged."""

def compare_place(stock: Stock, design: Solid) -> tuple[str, float, float, str]:
    """What makes it doubtful that a design belongs to a stock -> (kind, value, factor, text): "" when all looks well,
    "unit" (value times as large, units that are factor apart), "empty", "beside", "out" (by value mm)."""

def compare_overlap(
    stock: Stock, solid: Solid, *, progress: Progress = None
) -> tuple[float, tuple[float, float, float]]:
    """How deep (mm, 0.0: not at all) a Solid, a fixture, reaches into a stock, and where. No more than six voxels are
    told; less than 0.35 of one, as beside edges, is none."""

def picture_colour(number: int) -> tuple[float, float, float]:
    """Linear RGB, 0 .. 1, of an operation (by its index) or a tool (by its number) in pictures that are coloured by
    them."""

def deviation_colours(values: _Table, rgba: _Buffer, tolerance: float) -> bytes:
    """Tint shaded pixels (RGBA bytes) by their deviations, an (n, 1) table of mm: green within the tolerance, by yellow
    to red where material is left, by cyan to blue where it is missing."""
