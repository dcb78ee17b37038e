# SPDX-License-Identifier: LGPL-2.1-or-later
"""Holders of tool controllers, kept in the document as properties that the add-on adds to them."""

import FreeCAD

from ..core.errors import JobError

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

# Saved names: never change them.
HOLDER, STICKOUT, GROUP = "SwarfHolder", "SwarfStickout", "Swarf"


def holder_of(controller):
    """(name, stickout in mm, None where it is not set) of a tool controller's holder; None: it has none."""
    name = str(getattr(controller, HOLDER, "") or "").strip()
    if not name:
        return None
    stickout = getattr(controller, STICKOUT, 0.0)
    stickout = float(getattr(stickout, "Value", stickout))
    return name, stickout if stickout > 0 else None


def assign(controller, name, stickout):
    """Put a tool controller's tool into a holder, "" into none; in the transaction of the caller, so that it can be
    undone. stickout: mm from the tool's tip to the holder. JobError for a holder without stickout."""
    name = name.strip()
    if name and not stickout > 0:
        raise JobError("the holder '%s' of '%s' needs its stickout, the distance from the tool's tip to the holder"
                       % (name, controller.Label))
    for kind, key, text in (
            ("App::PropertyString", HOLDER, QT_TRANSLATE_NOOP("App::Property", "What holds the tool, e.g. SK40-ER32")),
            ("App::PropertyLength", STICKOUT,
             QT_TRANSLATE_NOOP("App::Property", "From the tool's tip to the holder's lower face"))):
        if key not in controller.PropertiesList:
            controller.addProperty(kind, key, GROUP, text)
    setattr(controller, HOLDER, name)
    setattr(controller, STICKOUT, stickout if name else 0.0)
