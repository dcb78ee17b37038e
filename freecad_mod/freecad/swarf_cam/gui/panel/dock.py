# SPDX-License-Identifier: LGPL-2.1-or-later
"""The dock: makes the widgets and the parts that use them, and connects what one tells to what another does. Everything
here runs in the GUI's thread and returns at once.
"""

import math

import FreeCAD
import FreeCADGui as Gui

from ... import native, session as sessions
from .. import colours, numbers, settings
from ..qt import QtCore, QtWidgets
from .accuracy import Accuracy
from .banner import Banner
from .checking import Checking
from .deviation import DeviationPage
from .files import Files
from .findings import FindingList
from .inspector import Inspector
from .opening import Opening
from .operations import OperationList
from .picking import Picking
from .playing import Player
from .program_list import ProgramList
from .sectionrow import SectionRow
from .settingup import SettingUp
from .setup import SetupPage
from .timeline import Timeline
from .toolrow import ToolRow
from .transport import TransportBar
from .view import PictureView

translate = FreeCAD.Qt.translate

# Seconds that quitting waits for threads to break off what they do.
QUIT_SECONDS = 10.0

# Pixels for the picture and the lists at first.
SIZES = (900, 150)

# Width and height of the dock at first, pixels.
DOCK_SIZE = (640, 720)

# Length of the origin's axes, as a part of the stock's diagonal.
AXES_SHARE = 0.2

# Least width of a page of the lists, pixels.
PAGE_WIDTH = 400

# The lists lie beside the picture where it still has this width, else below it; pixels, as the lists' least width.
WIDE_PICTURE, WIDE_LISTS = 480, 460


class LivePanel(QtWidgets.QDockWidget):
    """Watch one job at a time; see module. opening, player, checking, picking, setting_up, files: its parts; the
    other names are widgets."""

    def __init__(self, parent):
        super().__init__(translate("Swarf", "Milling, live"), parent)
        self.setObjectName("SwarfLive")
        self._swarf = native.load()
        self.cancelled_type = self._swarf.Cancelled
        self._build()
        self.files, self.picking = Files(self), Picking(self)
        self.opening, self.player, self.checking = Opening(self), Player(self), Checking(self)
        self.setting_up = SettingUp(self)
        self._connect()
        QtWidgets.QApplication.instance().aboutToQuit.connect(self.shut_down)
        self.show_state()

    # Widgets

    def _build(self):
        body = QtWidgets.QWidget()
        column = QtWidgets.QVBoxLayout(body)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        self.tools = ToolRow(sessions.known_keywords(), hasattr(self._swarf.Scene, "set_surface"))
        column.addWidget(self.tools)
        self.section = SectionRow()
        self.section.hide()
        column.addWidget(self.section)
        self.splitter = QtWidgets.QSplitter(QtCore.Qt.Vertical)
        stage = QtWidgets.QWidget()
        stage_column = QtWidgets.QVBoxLayout(stage)
        stage_column.setContentsMargins(0, 0, 0, 0)
        stage_column.setSpacing(0)
        self.view = PictureView(self._swarf)
        self.banner = Banner(self.view)
        stage_column.addWidget(self.view, 1)
        self.timeline = Timeline()
        stage_column.addWidget(self.timeline)
        self.bar = TransportBar()
        stage_column.addWidget(self.bar)
        self.splitter.addWidget(stage)
        self.tabs = QtWidgets.QTabWidget()
        self.tabs.setObjectName("SwarfTabs")
        self.tabs.setDocumentMode(True)
        self.operations, self.program = OperationList(), ProgramList()
        self.inspector, self.findings = Inspector(), FindingList()
        self.deviation, self.accuracy = DeviationPage(self._swarf), Accuracy()
        self.setup = SetupPage(native.holder_names())
        for widget, text in ((self.operations, translate("Swarf", "Operations")),
                             (self.program, translate("Swarf", "Program")),
                             (self.inspector, translate("Swarf", "Point")),
                             (self.findings, translate("Swarf", "Findings")),
                             (self.deviation, translate("Swarf", "Deviation")),
                             (self.setup, translate("Swarf", "Set-up")),
                             (self.accuracy, translate("Swarf", "Accuracy"))):
            widget.setMinimumWidth(PAGE_WIDTH)  # else the widest one would hold the dock
            self.tabs.addTab(widget, text)
        self.splitter.addWidget(self.tabs)
        self.splitter.setStretchFactor(0, 1)
        self.splitter.setStretchFactor(1, 0)
        self.splitter.setSizes(SIZES)
        self.splitter.setCollapsible(0, False)
        self.topLevelChanged.connect(self._float)
        column.addWidget(self.splitter, 1)
        self.setWidget(body)

    def _connect(self):
        player = self.player
        presses = {"fit": self.view.fit, "isometric": lambda: self.view.look("isometric"),
                   "reload": self.opening.reload, "keep": self.files.keep_result, "copy": self.files.copy_picture,
                   "save-picture": self.files.ask_picture, "save-animation": self.files.ask_animation}
        self.tools.pressed.connect(lambda name: presses[name]())
        self.tools.switched.connect(self._switch)
        self.tools.coloured.connect(self.wish)
        self.tools.toleranced.connect(self.wish)
        self.tools.toleranced.connect(self.checking.judge_soon)
        self.deviation.allowed.connect(self.wish)
        self.deviation.allowed.connect(self.checking.judge_soon)
        self.setup.cleared.connect(self.checking.check_soon)
        self.section.changed.connect(self.wish)
        self.view.camera_changed.connect(self.wish)
        self.view.clicked.connect(self.picking.pick)
        self.timeline.sought.connect(player.seek)
        self.bar.play_pressed.connect(player.toggle)
        self.bar.stepped.connect(player.step)
        self.bar.speed_chosen.connect(player.set_speed)
        self.bar.stops_chosen.connect(player.set_stops)
        self.operations.chosen.connect(player.go_to_operation)
        self.operations.chosen.connect(self.picking.select_operation)
        self.operations.shown.connect(self._show_path_of)
        self.program.chosen.connect(player.go_to_line)
        self.program.chosen.connect(self.picking.select_line)
        self.accuracy.chosen.connect(lambda voxel: self.opening.reload(voxel))

    # For the parts of the panel

    @property
    def job(self):
        """The job that is watched, None once it is gone."""
        return self.opening.job

    @property
    def session(self):
        """The session that is open, None for none."""
        return self.opening.session

    @property
    def transport(self):
        """The core Transport of the job that is open, None for none."""
        return self.player.transport

    def is_cancelled(self, error):
        """Whether an error is that the user broke it off."""
        return isinstance(error, self.cancelled_type)

    def fail(self, error):
        """Say it in the banner, where the user looks, and in the report view, where it stays: once, however many
        pictures in a row fail in the same way."""
        text = str(error) or type(error).__name__
        if isinstance(error, MemoryError):
            text = translate("Swarf", "Not enough memory: {0} Choose larger voxels on the page Accuracy.").format(
                text.rstrip(".") + ".")
        if self.banner.isVisible() and self.banner.text.text() == text:
            return
        if isinstance(error, MemoryError):
            self.tabs.setCurrentWidget(self.accuracy)
        retry = self.job is not None
        self.banner.say("error", text, translate("Swarf", "Read the job again"), self.opening.reload if retry else None)
        FreeCAD.Console.PrintError("Swarf: %s\n" % text)

    def fail_or_cancel(self, error):
        """Say what ended the work on the job, and stand still."""
        if self.is_cancelled(error):
            self.banner.say("note", translate("Swarf", "Cancelled."), translate("Swarf", "Again"), self.opening.reload)
        else:
            self.player.pause()
            self.fail(error)
        self.show_state()

    def watch(self, job, voxel_mm=None):
        """Read a job and show it; voxel_mm None: from the preferences."""
        self.opening.watch(job, voxel_mm)

    def open_session(self, session, place, seconds):
        """A session was opened in so many seconds; place: where to stand, None: as the settings say."""
        self.banner.done()
        self.player.open(session, self.bar.chosen_stops())
        self.timeline.open(session)
        self.operations.open(session, [self._path_is_shown(index) for index in range(len(session.data.operations))])
        self.program.open(session.listing)
        self.setting_up.show()
        self.accuracy.measured(session, seconds)
        self.tools.open(session.job.design is not None)
        self.deviation.show_allowance()
        self.deviation.allowance.setEnabled(session.job.design is not None)
        self.section.open(session.box)
        self.view.open(session.box)
        self.checking.open(session)
        if place is not None:
            self.player.seek(min(place, self.transport.end))
        elif settings.flag("AutoPlay"):
            self.player.toggle()
        errors = [text for _, severity, text in session.overview.findings if severity == "error"]
        if errors:
            self.banner.say("error", numbers.in_words(errors[0]))
        self.show_state()
        self.wish()

    def close_job(self, for_another=False):
        """Watch no job; for_another: one is watched at once, whose set-up is shown then over what is shown now."""
        self.opening.close_job()
        self.player.close_job()
        self.view.close_job()
        self.timeline.open(None)
        self.operations.open(None, ())
        self.program.open(None)
        if not for_another:
            self.setting_up.show()
        self.picking.close_job()
        self.checking.close_job()
        self.banner.done()
        self.show_state()

    def show_frame(self, frame):
        """A picture came."""
        self.player.show(frame)
        self.checking.picture_came(frame)

    def closeEvent(self, event):
        """Closing the panel ends the work."""
        self.close_job()
        self.files.keeper.cancel()
        super().closeEvent(event)

    def shut_down(self):
        """FreeCAD quits: no thread may be left that would call into what is gone."""
        self.close_job()
        self.files.keeper.cancel()
        self.opening.join(QUIT_SECONDS)
        self.files.keeper.join(QUIT_SECONDS)
        self.checking.join(QUIT_SECONDS)

    # What is shown

    def _look(self):
        bottom, top = colours.background(self.palette())
        box = self.session.box if settings.flag("ShowOrigin") else None
        return (("outline", box), ("axes", AXES_SHARE * math.dist(*box) if box else 0.0),
                ("background", bottom), ("background_top", top), ("occlusion", settings.flag("Occlusion")),
                ("shadow", settings.flag("Shadow")), ("edges", True),
                ("colouring", "material" if self.tools.tolerance_mm else self.tools.colouring),
                ("colour", colours.MATERIAL), ("sections", self.section.planes()), ("selected", self._selected()))

    def _selected(self):
        """(first, end) of the moves whose faces stand out, None for none; deviations have colours of their own."""
        if self.player.selected is None or self.tools.tolerance_mm:
            return None
        return self.session.listing.moves_of(self.player.selected)

    def current_view(self, size=None):
        """session.View of what is shown, or of another size (width, height) of the picture."""
        width, height = size or self.view.pixels()
        return sessions.View(self.view.camera.copy(), width, height, self._look(), settings.flag("ShowCutter"),
                             settings.flag("ShowPath"), self.tools.tolerance_mm, self.deviation.allowance.value(),
                             self.tools.shown)

    def wish(self):
        """Have the picture drawn as it is to be shown now."""
        self.view.set_legend(self.tools.tolerance_mm, self.deviation.allowance.value())
        if self.session is not None and self.view.camera is not None:
            self.opening.wish(self.transport.wanted, self.current_view())

    def _switch(self, name, on):
        if name == "section":
            self.section.setVisible(on)
        else:
            settings.set_flag({"perspective": "Perspective", "cutter": "ShowCutter", "path": "ShowPath"}[name], on)
        if name == "perspective":
            self.view.set_perspective(on)
        else:
            self.wish()

    def document_object(self, name):
        """The object of this name beside the job, None when it or the job is gone."""
        return self.job.Document.getObject(name) if self.job is not None and name else None

    def _path_is_shown(self, index):
        obj = self.document_object(self.session.listing.operations[index].source)
        view = getattr(obj, "ViewObject", None)
        return bool(view is not None and view.Visibility)

    def _show_path_of(self, index, shown):
        obj = self.document_object(self.session.listing.operations[index].source)
        if obj is not None and getattr(obj, "ViewObject", None) is not None:
            obj.ViewObject.Visibility = shown

    def show_state(self):
        """What can be done now."""
        ready = self.session is not None
        alive = self.job is not None
        for widget in (self.bar, self.timeline):
            widget.setEnabled(ready)
        self.tools.show_state(ready, alive)
        self.accuracy.apply.setEnabled(alive)
        if self.transport is not None:
            self.bar.set_playing(self.transport.playing)

    # Qt's events

    def keyPressEvent(self, event):
        """Keys that the focused widget left: space plays, arrows step, up and down change the speed."""
        qt, key, keys = QtCore.Qt, event.key(), event.modifiers()
        unit = "operation" if keys & qt.ControlModifier else "move" if keys & qt.AltModifier else "line"
        player = self.player
        if self.transport is None:
            super().keyPressEvent(event)
        elif key == qt.Key_Space:
            player.toggle()
        elif key in (qt.Key_Left, qt.Key_Right):
            player.step(unit + ("-back" if key == qt.Key_Left else "-forward"))
        elif key in (qt.Key_Home, qt.Key_End):
            player.seek(0.0 if key == qt.Key_Home else self.transport.end)
        elif key in (qt.Key_Up, qt.Key_Down):
            player.set_speed(self.transport.faster(1 if key == qt.Key_Up else -1))
        elif key == qt.Key_P:
            self.tools.actions_by_name["perspective"].toggle()
        else:
            super().keyPressEvent(event)

    def resizeEvent(self, event):
        """Lists beside the picture when there is room."""
        super().resizeEvent(event)
        lists = max(WIDE_LISTS, self.tabs.tabBar().sizeHint().width() + 8)  # no tab is hidden
        wanted = QtCore.Qt.Horizontal if self.width() >= lists + WIDE_PICTURE else QtCore.Qt.Vertical
        if self.splitter.orientation() != wanted:
            self.splitter.setOrientation(wanted)
            self.splitter.setSizes(SIZES if wanted == QtCore.Qt.Vertical else (self.width() - lists, lists))

    def _float(self, floats):
        """Docked again it is as wide as at first: it may have been far wider than what it is docked to can spare."""
        if not floats:
            QtCore.QTimer.singleShot(0, self.take_width)

    def take_width(self):
        """As wide as at first, and as the tabs of this language want it."""
        width = max(DOCK_SIZE[0], self.tabs.tabBar().sizeHint().width() + 16)
        self.parentWidget().resizeDocks([self], [width], QtCore.Qt.Horizontal)

    def changeEvent(self, event):
        """The theme may have changed."""
        super().changeEvent(event)
        if event.type() in (QtCore.QEvent.PaletteChange, QtCore.QEvent.StyleChange) and hasattr(self, "tools"):
            self.wish()


_panel = None


def show(job):
    """The panel, made when there is none, watching a job."""
    global _panel
    main = Gui.getMainWindow()
    if _panel is None:
        _panel = LivePanel(main)
        main.addDockWidget(QtCore.Qt.RightDockWidgetArea, _panel)
        _panel.resize(*DOCK_SIZE)
        _panel.take_width()
    _panel.show()
    _panel.raise_()
    _panel.watch(job)
    _panel.view.setFocus()
    return _panel
