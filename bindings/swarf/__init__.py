# SPDX-License-Identifier: LGPL-2.1-or-later
"""Milling simulation: what a program does to the stock, before the machine does it.

>>> import swarf
>>> stock = swarf.Stock.box((0, 0, -5), (40, 20, 0), voxel=0.1)
>>> program = swarf.Program(start=(5, 10, 5))
>>> program.add_operation("slot")
0
>>> program.set_section(tool=1)
>>> program.add_line((5, 10, -2), feed_mm_min=100)
>>> program.add_line((35, 10, -2), feed_mm_min=400)
>>> tools = {1: swarf.Cutter("flat:d=6,l=20")}
>>> surface = swarf.Surface(stock, program, tools)
>>> simulation = stock.simulate(program, tools)
>>> swarf.Mesh.from_stock(stock, 0.01, surface=surface).write("slot.stl")
"""
from ._native import (
    BusyError,
    Camera,
    Cancelled,
    Check,
    CheckFinding,
    Cluster,
    Comparison,
    Contour,
    Cutter,
    Deviation,
    Error,
    Finding,
    FormatError,
    GeometryError,
    Held,
    History,
    Lump,
    Mesh,
    Pick,
    Picture,
    Program,
    Scene,
    Shell,
    Simulation,
    Solid,
    Stock,
    Surface,
    compare_overlap,
    compare_place,
    compare_volume,
    deviation_colours,
    isa,
    measure_deviation,
    memory_peak,
    picture_colour,
    set_progress_interval,
    set_threads,
    threads,
    version,
)
from .gcode import read_gcode
from .job import Job
from .simulate import Result, simulate
from .verify import Verification, verify

__version__ = version()

__all__ = [
    "BusyError", "Camera", "Cancelled", "Check", "CheckFinding", "Cluster", "Comparison", "Contour", "Cutter",
    "Deviation", "Error", "Finding", "FormatError", "GeometryError", "Held", "History", "Job", "Lump", "Mesh", "Pick",
    "Picture", "Program", "Result", "Scene", "Shell", "Simulation", "Solid", "Stock", "Surface", "Verification",
    "compare_overlap", "compare_place", "compare_volume", "deviation_colours", "isa", "measure_deviation",
    "memory_peak", "picture_colour", "read_gcode", "set_progress_interval", "set_threads", "simulate", "threads",
    "verify", "version",
]
