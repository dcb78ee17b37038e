# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the user chose, in FreeCAD's parameters, and what FreeCAD's own 3D view is set to."""

import FreeCAD

GROUP = "User parameter:BaseApp/Preferences/Mod/Swarf"
VIEW = "User parameter:BaseApp/Preferences/View"

# Voxels along the longest edge of the stock at first: shows a part at once on any machine.
RESOLUTION = 400
SPEED = 50.0

# Deviation from the design that is well, mm.
TOLERANCE_MM, TOLERANCE_MIN_MM, TOLERANCE_MAX_MM = 0.05, 0.001, 10.0

# How near holders may come to the stock before it is a warning, mm.
CLEARANCE_MAX_MM = 100.0

# What is meant to be left on the model, mm.
ALLOWANCE_MAX_MM = 100.0

BOOLEANS = {"AutoPlay": True, "AutoCheck": True, "StopAtError": False, "ShowCutter": True, "ShowPath": False,
            "ShowOrigin": False, "Perspective": False, "Occlusion": True, "Shadow": False}


def _group():
    return FreeCAD.ParamGet(GROUP)


def flag(name):
    """One of BOOLEANS."""
    return _group().GetBool(name, BOOLEANS[name])


def set_flag(name, value):
    """Keep one of BOOLEANS."""
    _group().SetBool(name, bool(value))


def resolution():
    """Voxels along the longest edge of a stock."""
    return max(_group().GetInt("Resolution", RESOLUTION), 10)


def set_resolution(value):
    """Keep it."""
    _group().SetInt("Resolution", int(value))


def speed():
    """Times as fast as the machine; 0 as fast as possible."""
    return _group().GetFloat("Speed", SPEED)


def set_speed(value):
    """Keep it."""
    _group().SetFloat("Speed", value)


def tolerance():
    """Deviation from the design that is well, mm."""
    value = _group().GetFloat("Tolerance", TOLERANCE_MM)
    return value if value > 0 else TOLERANCE_MM


def set_tolerance(value):
    """Keep it."""
    _group().SetFloat("Tolerance", value)


def allowance():
    """What is meant to be left on the model, mm."""
    return min(max(_group().GetFloat("Allowance", 0.0), 0.0), ALLOWANCE_MAX_MM)


def set_allowance(value):
    """Keep it."""
    _group().SetFloat("Allowance", value)


def clearance():
    """How near holders may come to the stock before it is a warning, mm."""
    return min(max(_group().GetFloat("Clearance", 0.0), 0.0), CLEARANCE_MAX_MM)


def set_clearance(value):
    """Keep it."""
    _group().SetFloat("Clearance", value)


def navigation():
    """(style, turntable, invert zoom, zoom at cursor) of FreeCAD's 3D view."""
    view = FreeCAD.ParamGet(VIEW)
    return (view.GetString("NavigationStyle", "Gui::CADNavigationStyle"), view.GetInt("OrbitStyle", 1) == 0,
            view.GetBool("InvertZoom", True), view.GetBool("ZoomAtCursor", True))
