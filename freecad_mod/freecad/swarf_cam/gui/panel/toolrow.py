# SPDX-License-Identifier: LGPL-2.1-or-later
"""The row of tools over the picture: views, what is shown, colours, files."""

import FreeCAD

from .. import icons, settings
from ..qt import QAction, QtCore, QtWidgets

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

# Scene.render's names and what they are called here.
COLOURINGS = (("material", QT_TRANSLATE_NOOP("Swarf", "Material")),
              ("operation", QT_TRANSLATE_NOOP("Swarf", "By operation")),
              ("tool", QT_TRANSLATE_NOOP("Swarf", "By tool")),
              ("age", QT_TRANSLATE_NOOP("Swarf", "By age")), ("feed", QT_TRANSLATE_NOOP("Swarf", "By feed")),
              ("deviation", QT_TRANSLATE_NOOP("Swarf", "Deviation")))
DEVIATION = "deviation"

# session.View's names of what is shown.
SHOWN = (("stock", QT_TRANSLATE_NOOP("Swarf", "Stock")), ("design", QT_TRANSLATE_NOOP("Swarf", "Model")),
         ("both", QT_TRANSLATE_NOOP("Swarf", "Both")))

# Name of icon and tool, what it says, and the keyword that Scene.render must know.
VIEWS = (("fit", QT_TRANSLATE_NOOP("Swarf", "Show the whole stock (F)"), None),
         ("isometric", QT_TRANSLATE_NOOP("Swarf", "Look from the corner (0); 1 to 6: the sides"), None),
         ("perspective", QT_TRANSLATE_NOOP("Swarf", "Perspective (P)"), None),
         ("cutter", QT_TRANSLATE_NOOP("Swarf", "Show the cutter"), "cutter"),
         ("path", QT_TRANSLATE_NOOP("Swarf", "Show the tool's path"), "path"),
         ("section", QT_TRANSLATE_NOOP("Swarf", "Cut the stock open"), "sections"))
RESULTS = (("reload", QT_TRANSLATE_NOOP("Swarf", "Read the job again"), None),
           ("keep", QT_TRANSLATE_NOOP("Swarf", "Put the result into the document"), None))

# Those that stay down, and the setting that keeps them; None: up at first.
SWITCHES = {"perspective": "Perspective", "cutter": "ShowCutter", "path": "ShowPath", "section": None}
FILES = (("copy", QT_TRANSLATE_NOOP("Swarf", "Copy the picture")),
         ("save-picture", QT_TRANSLATE_NOOP("Swarf", "Save the picture ...")),
         ("save-animation", QT_TRANSLATE_NOOP("Swarf", "Save an animation ...")))

# What can be done while a job is there, even when it is not open.
WITHOUT_SESSION = ("reload",)
ON_THE_JOB = ("reload", "keep")


class ToolRow(QtWidgets.QToolBar):
    """Tells the name of what was pressed, and of what was switched on or off; coloured when another colouring was
    chosen, toleranced another tolerance, which is kept in the settings. keywords: those of Scene.render; by_move:
    whether a scene knows which move made what."""

    pressed = QtCore.Signal(str)
    switched = QtCore.Signal(str, bool)
    coloured = QtCore.Signal()
    toleranced = QtCore.Signal()

    def __init__(self, keywords, by_move, parent=None):
        super().__init__(parent)
        self.setIconSize(QtCore.QSize(18, 18))
        self.actions_by_name = {}
        for tool in VIEWS:
            self._add(*tool, keywords)
        self._colouring = QtWidgets.QComboBox()
        self._colouring.setObjectName("SwarfColouring")
        self._colouring.setToolTip(translate("Swarf", "What the colours of the stock show"))
        for name, text in COLOURINGS:
            self._colouring.addItem(translate("Swarf", text), name)
        self._colouring.currentIndexChanged.connect(self._set_colouring)
        if by_move:
            self.addWidget(self._colouring)
        self.compared = QtWidgets.QComboBox()
        self.compared.setObjectName("SwarfCompared")
        self.compared.setToolTip(
            translate("Swarf", "Show the stock, the model that it should become, or one over the other"))
        for name, text in SHOWN:
            self.compared.addItem(translate("Swarf", text), name)
        self.compared.currentIndexChanged.connect(lambda *_: self.coloured.emit())
        self._compared_shown = self.addWidget(self.compared)
        self.tolerance = QtWidgets.QDoubleSpinBox()
        self.tolerance.setObjectName("SwarfTolerance")
        self.tolerance.setToolTip(translate("Swarf", "Deviation from the model that is well"))
        self.tolerance.setDecimals(3)
        self.tolerance.setRange(settings.TOLERANCE_MIN_MM, settings.TOLERANCE_MAX_MM)
        self.tolerance.setSingleStep(0.01)
        self.tolerance.setPrefix("± ")
        self.tolerance.setSuffix(" mm")
        self.tolerance.setKeyboardTracking(False)
        self.tolerance.setValue(settings.tolerance())
        self.tolerance.valueChanged.connect(self._set_tolerance)
        self._tolerance_shown = self.addWidget(self.tolerance)
        self._tolerance_shown.setVisible(False)
        spring = QtWidgets.QWidget()
        spring.setSizePolicy(QtWidgets.QSizePolicy.Expanding, QtWidgets.QSizePolicy.Preferred)
        self.addWidget(spring)
        for tool in RESULTS:
            self._add(*tool, keywords)
        self._add_files()
        self.take_theme()

    def _add(self, name, text, needs, keywords):
        action = QAction(translate("Swarf", text), self)
        action.setObjectName("Swarf-" + name)
        if name in SWITCHES:
            action.setCheckable(True)
            action.setChecked(SWITCHES[name] is not None and settings.flag(SWITCHES[name]))
            action.toggled.connect(lambda on: self.switched.emit(name, on))
        else:
            action.triggered.connect(lambda *_: self.pressed.emit(name))
        if needs is None or needs in keywords:
            self.addAction(action)
        self.actions_by_name[name] = action

    def _add_files(self):
        button = QAction(translate("Swarf", "Picture or animation"), self)
        button.setObjectName("Swarf-picture")
        menu = QtWidgets.QMenu(self)
        for name, text in FILES:
            action = QAction(translate("Swarf", text), menu)
            action.triggered.connect(lambda *_, name=name: self.pressed.emit(name))
            menu.addAction(action)
        button.setMenu(menu)
        self.addAction(button)
        self.widgetForAction(button).setPopupMode(QtWidgets.QToolButton.InstantPopup)
        self.actions_by_name["picture"] = button

    @property
    def colouring(self):
        """Scene.render's name of the colouring that is chosen."""
        return self._colouring.currentData()

    @property
    def tolerance_mm(self):
        """Tolerance of the colouring by deviation, 0.0 while there is another one."""
        return settings.tolerance() if self.colouring == DEVIATION else 0.0

    @property
    def shown(self):
        """session.View's name of what of stock and model is shown."""
        return self.compared.currentData()

    def open(self, has_design):
        """A job: without a design there is no deviation to show."""
        self._compared_shown.setVisible(has_design)
        if not has_design:
            self.compared.setCurrentIndex(0)
        index = self._colouring.findData(DEVIATION)
        self._colouring.model().item(index).setEnabled(has_design)
        if not has_design and self._colouring.currentIndex() == index:
            self._colouring.setCurrentIndex(0)

    def _set_colouring(self, *_):
        self._tolerance_shown.setVisible(self.colouring == DEVIATION)
        self.coloured.emit()

    def _set_tolerance(self, value):
        settings.set_tolerance(value)
        self.toleranced.emit()

    def set_colouring(self, name):
        """Choose a colouring."""
        self._colouring.setCurrentIndex(self._colouring.findData(name))

    def show_state(self, ready, alive):
        """ready: a job is open. alive: it is still in its document."""
        for name, action in self.actions_by_name.items():
            action.setEnabled((alive or name not in ON_THE_JOB) and (ready or name in WITHOUT_SESSION))

    def take_theme(self):
        """Icons in the theme's colours."""
        for name, action in self.actions_by_name.items():
            action.setIcon(icons.icon(name, self.palette()))

    def changeEvent(self, event):
        """The theme may have changed."""
        super().changeEvent(event)
        if event.type() in (QtCore.QEvent.PaletteChange, QtCore.QEvent.StyleChange) and \
                hasattr(self, "actions_by_name"):
            self.take_theme()
