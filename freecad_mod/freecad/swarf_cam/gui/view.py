# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a simulation looks in the tree and in the 3D view."""

import os

from .. import ICONS

STOCK_COLOUR = (0.62, 0.70, 0.76)

# Degrees: triangles that meet at less are shaded as one curved face. What the mesher takes for an edge, native/mesh.
SMOOTH_DEG = 25


def show_colours(vobj):
    """Colour the triangles by the object's FaceColours where the user has not switched that off. FreeCAD takes them at
    the moment it is switched on, and those of another mesh would stay where they do not fit."""
    if getattr(vobj, "Coloring", False):
        vobj.Coloring = False
        vobj.Coloring = True


class SimulationView:
    """View provider: FreeCAD's mesh view, with an icon that shows whether the results are up to date."""

    def __init__(self, vobj):
        vobj.Proxy = self
        vobj.ShapeColor = STOCK_COLOUR
        vobj.DisplayMode = "Shaded"
        vobj.CreaseAngle = SMOOTH_DEG
        if hasattr(vobj, "Coloring"):  # from here on the user's
            vobj.Coloring = True

    def attach(self, vobj):
        """Called when the view is made and when a document is opened."""
        self.Object = vobj.Object

    def getIcon(self):
        """Path of the icon."""
        obj = getattr(self, "Object", None)
        up_to_date = getattr(obj, "UpToDate", False)
        return os.path.join(ICONS, "swarf.svg" if up_to_date else "swarf-outdated.svg")

    def updateData(self, obj, name):
        """The tree asks for the icon again only when told, and FreeCAD colours a mesh only when told."""
        if name == "UpToDate":
            obj.ViewObject.signalChangeIcon()
        elif name in ("Mesh", "FaceColours"):
            show_colours(obj.ViewObject)

    def doubleClicked(self, vobj):
        """Open the panel on this simulation."""
        from .task import show_panel

        show_panel(vobj.Object.Job, vobj.Object)
        return True

    def dumps(self):
        """Nothing is saved."""
        return None

    def loads(self, state):
        """Nothing is saved."""
        return None

    # FreeCAD before 1.0 calls them so
    __getstate__ = dumps
    __setstate__ = loads
