# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves in the 3D views of a document, in front of all else, that are no part of it: what would come of a panel."""

import FreeCADGui as Gui
from pivy import coin

COLOUR = (0.85, 0.1, 0.1)
WIDTH = 3.0


class Curves:
    """Closed curves that are shown until remove()."""

    def __init__(self, document):
        self._document = document.Name
        self._root = coin.SoAnnotation()
        self._root.ref()
        self._root.setName("SwarfCurves")
        light = coin.SoLightModel()
        light.model = coin.SoLightModel.BASE_COLOR
        colour = coin.SoBaseColor()
        colour.rgb = COLOUR
        style = coin.SoDrawStyle()
        style.lineWidth = WIDTH
        pick = coin.SoPickStyle()  # clicks go to the part
        pick.style = coin.SoPickStyle.UNPICKABLE
        self._places, self._lines = coin.SoCoordinate3(), coin.SoLineSet()
        for node in (light, colour, style, pick, self._places, self._lines):
            self._root.addChild(node)
        for graph in self._graphs():
            graph.addChild(self._root)

    def _graphs(self):
        """Scene graphs of the views that are there now."""
        try:
            views = Gui.getDocument(self._document).mdiViewsOfType("Gui::View3DInventor")
        except (NameError, RuntimeError, AttributeError):  # the document has been closed
            return []
        return [view.getSceneGraph() for view in views]

    @property
    def count(self):
        """How many are shown."""
        return self._lines.numVertices.getNum() if self._root is not None else 0

    def show(self, curves):
        """Others instead, each of points (x, y, z)."""
        closed = [[*curve, curve[0]] for curve in curves if curve]
        for field, values in ((self._places.point, [place for curve in closed for place in curve]),
                              (self._lines.numVertices, [len(curve) for curve in closed])):
            field.setNum(len(values))
            if values:
                field.setValues(0, len(values), values)

    def remove(self, *_):
        """Out of the views."""
        if self._root is None:
            return
        for graph in self._graphs():
            if graph.findChild(self._root) >= 0:
                graph.removeChild(self._root)
        self._root.unref()
        self._root = None
