# SPDX-License-Identifier: LGPL-2.1-or-later
"""The dock: puts the widgets together, and turns what they tell into wishes to the engine.

Everything here runs in the GUI's thread and returns at once. Reading the job from its document is done here too, as
only this thread may; all else is the engine's.
"""

import time

import FreeCAD
import FreeCADGui as Gui

from ... import native, session as sessions
from ...app import job as jobs
from ...app import simulation
from ...core import transport as model
from ...core.engine import Engine
from ...core.errors import JobError
from .. import colours, settings
from ..qt import QtCore, QtWidgets
from .accuracy import Accuracy
from .banner import Banner
from .bridge import Bridge
from .checking import Checking
from .files import Files
from .findings import FindingList
from .inspector import Inspector
from .operations import OperationList
from .picking import Picking
from .program_list import ProgramList
from .sectionrow import SectionRow
from .timeline import Timeline
from .toolrow import ToolRow
from .transport import TransportBar
from .view import PictureView
from .watch import JobWatch

translate = FreeCAD.Qt.translate

# Milliseconds between two looks at the clock while playing.
TICK_MS = 30

# Seconds that quitting waits for the engine to break off what it does.
QUIT_SECONDS = 10.0

# Pixels for the picture and the lists at first.
SIZES = (900, 150)

# From this width on the lists lie beside the picture, below it else; wide enough that no tab is hidden.
WIDE, WIDE_LISTS = 1000, 460


class LivePanel(QtWidgets.QDockWidget):
    """Watch one job at a time; see module."""

    def __init__(self, parent):
        super().__init__(translate("Swarf", "Milling, live"), parent)
        self.setObjectName("SwarfLive")
        self._swarf = native.load()
        self.session = None
        self._engine = self._watch = None
        self._old_engines = []
        self._tag = 0
        self._opened_at = 0.0
        self._resume = self._line = None
        self.transport = None
        self.files, self.picking = Files(self), Picking(self)
        self._build()
        self.checking = Checking(self)
        self._connect()
        self._clock = QtCore.QElapsedTimer()
        self._timer = QtCore.QTimer(self)
        self._timer.setInterval(TICK_MS)
        self._timer.timeout.connect(self._tick)
        QtWidgets.QApplication.instance().aboutToQuit.connect(self.shut_down)
        self._show_state()

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
        self.inspector, self.findings, self.accuracy = Inspector(), FindingList(), Accuracy()
        for widget, text in ((self.operations, translate("Swarf", "Operations")),
                             (self.program, translate("Swarf", "Program")),
                             (self.inspector, translate("Swarf", "Point")),
                             (self.findings, translate("Swarf", "Findings")),
                             (self.accuracy, translate("Swarf", "Accuracy"))):
            self.tabs.addTab(widget, text)
        self.splitter.addWidget(self.tabs)
        self.splitter.setStretchFactor(0, 1)
        self.splitter.setStretchFactor(1, 0)
        self.splitter.setSizes(SIZES)
        self.splitter.setCollapsible(0, False)
        column.addWidget(self.splitter, 1)
        self.setWidget(body)

    def _connect(self):
        presses = {"fit": self.view.fit, "isometric": lambda: self.view.look("isometric"), "reload": self.reload,
                   "keep": self.files.keep_result, "copy": self.files.copy_picture,
                   "save-picture": self.files.ask_picture, "save-animation": self.files.ask_animation}
        self.tools.pressed.connect(lambda name: presses[name]())
        switches = {"perspective": self._set_perspective, "cutter": self._set_cutter, "path": self._set_path,
                    "section": self._set_section}
        self.tools.switched.connect(lambda name, on: switches[name](on))
        self.tools.coloured.connect(self._wish)
        self.tools.toleranced.connect(self._wish)
        self.tools.toleranced.connect(self.checking.start_soon)
        self.section.changed.connect(self._wish)
        self.view.camera_changed.connect(self._wish)
        self.view.clicked.connect(self.picking.pick)
        self.timeline.sought.connect(self.seek)
        self.bar.play_pressed.connect(self.toggle)
        self.bar.stepped.connect(self.step)
        self.bar.speed_chosen.connect(self.set_speed)
        self.bar.stops_chosen.connect(self._set_stops)
        self.operations.chosen.connect(self._go_to_operation)
        self.operations.shown.connect(self._show_path_of)
        self.program.chosen.connect(self._go_to_line)
        self.accuracy.chosen.connect(lambda voxel: self.reload(voxel))

    # For the parts of the panel

    @property
    def job(self):
        """The job that is watched, None once it is gone."""
        return self._watch.job if self._watch is not None else None

    def call(self, function, on_result):
        """Do function(session, progress) in the engine's thread; on_result(result, error) follows in this one."""
        self._engine.call(function, self._bridge.answer_to(on_result))

    def cancel_call(self):
        """Break off what call() does."""
        if self._engine is not None:
            self._engine.cancel()

    def is_cancelled(self, error):
        """Whether an error is that the user broke it off."""
        return isinstance(error, self._swarf.Cancelled)

    # Opening and closing

    def watch(self, job, voxel_mm=None):
        """Read a job and show it; voxel_mm None: from the preferences."""
        self.close_job()
        self._watch = JobWatch(job, self)
        self._watch.changed.connect(self._job_changed)
        self._watch.deleted.connect(lambda: self._job_gone(translate(
            "Swarf", "The job was deleted. What you see is how it was; it can still be played.")))
        self._watch.closed.connect(self._document_closed)
        try:
            box = simulation.job_box(job)
            if voxel_mm is None:
                voxel_mm = self._default_voxel(box)
            self.accuracy.open(box, voxel_mm)
            data = jobs.read_job(job)
        except JobError as error:
            self.fail(error)
            self._show_state()
            return
        self._tag += 1
        tag = self._tag
        bridge = Bridge(self)
        self._engine = Engine(lambda progress: sessions.Session(data, voxel_mm, progress), bridge.listener,
                              self._swarf.Cancelled)
        queued = QtCore.Qt.QueuedConnection
        engine = self._engine
        bridge.opened.connect(lambda session: self._opened(session) if tag == self._tag else None, queued)
        bridge.progressed.connect(lambda done: self._progress(done) if tag == self._tag else None, queued)
        bridge.failed.connect(lambda error: self._failed(error) if tag == self._tag else None, queued)
        bridge.frame_came.connect(lambda: self._show_frame(bridge) if tag == self._tag else None, queued)
        bridge.finished.connect(lambda: self._ended(engine), queued)
        self._bridge = bridge
        self._opened_at = time.monotonic()
        self.banner.work(translate("Swarf", "Cutting '{0}' once ...").format(job.Label), self._cancel_opening)
        self._engine.start()
        self._show_state()

    @staticmethod
    def _default_voxel(box):
        edge = max(b - a for a, b in zip(*box)) / settings.resolution()
        return float("%.1e" % edge) if edge > 0 else 0.1

    def reload(self, voxel_mm=None):
        """Read the job again, with another voxel size or the same, and go back to where it stood."""
        job = self.job
        if job is None:
            self.fail(JobError(translate("Swarf", "The job is gone: select another one and start again.")))
            return
        place = self.transport.wanted if self.transport is not None else None
        keep = self.session.voxel_mm if self.session is not None else self.accuracy.voxel.value()
        self.watch(job, voxel_mm or keep)
        self._resume = place

    def _cancel_opening(self):
        self._engine.cancel()
        self.banner.text.setText(translate("Swarf", "Cancelling ..."))

    def _ended(self, engine):
        if engine in self._old_engines:
            self._old_engines.remove(engine)
        if engine is self._engine and self.session is None:
            self._engine = None
            self._show_state()

    def close_job(self):
        """Watch no job: the engine ends by itself, as soon as what it does lets it."""
        self._tag += 1
        self._timer.stop()
        if self._watch is not None:
            self._watch.stop()
            self._watch.deleteLater()
        if self._engine is not None:
            self._engine.stop()
            self._old_engines.append(self._engine)
        self._engine = self.session = self._watch = None
        self.transport = self._resume = self._line = None
        self.view.close_job()
        self.view.mark, self.view.caption = None, ("", "", None)
        self.timeline.open(None)
        self.operations.open(None, ())
        self.program.open(None)
        self.picking.close_job()
        self.checking.close_job()
        self.bar.set_playing(False)
        self.banner.done()
        self._show_state()

    def closeEvent(self, event):
        """Closing the panel ends the work."""
        self.close_job()
        self.files.keeper.cancel()
        super().closeEvent(event)

    def shut_down(self):
        """FreeCAD quits: no thread may be left that would call into what is gone."""
        self.close_job()
        self.files.keeper.cancel()
        for engine in list(self._old_engines):
            engine.join(QUIT_SECONDS)
        self.files.keeper.join(QUIT_SECONDS)
        self.checking.join(QUIT_SECONDS)

    # What the engine tells

    def _progress(self, fraction):
        if self.session is None and self.banner.working:
            self.banner.progress(fraction)

    def _opened(self, session):
        self.session = session
        self.banner.done()
        self.transport = model.Transport(session.clock, session.stops)
        self.transport.speed = settings.speed()
        self.bar.set_speed(self.transport.speed)
        self._set_stops(self.bar.chosen_stops())
        self.timeline.open(session)
        self.operations.open(session, [self._path_is_shown(index) for index in range(len(session.data.operations))])
        self.program.open(session.listing)
        self.checking.open(session)
        self.accuracy.measured(session, time.monotonic() - self._opened_at)
        self.tools.open(session.job.design is not None)
        self.section.open(session.box)
        self.view.open(session.box)
        place, self._resume = self._resume, None
        if place is not None:
            self.seek(min(place, self.transport.end))
        elif settings.flag("AutoPlay"):
            self.toggle()
        errors = [text for _, severity, text in session.overview.findings if severity == "error"]
        if errors:
            self.banner.say("error", errors[0])
        self._show_state()
        self._wish()

    def _failed(self, error):
        if self.is_cancelled(error):
            self.banner.say("note", translate("Swarf", "Cancelled."), translate("Swarf", "Again"), self.reload)
            return
        if self.transport is not None:
            self.transport.pause()
            self._show_state()
        self.fail(error)

    def fail(self, error):
        """Say it in the banner, where the user looks, and in the report view, where it stays."""
        text = str(error) or type(error).__name__
        if isinstance(error, MemoryError):
            text = translate("Swarf", "Not enough memory: {0} Choose larger voxels on the page Accuracy.").format(
                text.rstrip(".") + ".")
            self.tabs.setCurrentWidget(self.accuracy)
        retry = self.job is not None
        self.banner.say("error", text, translate("Swarf", "Read the job again"), self.reload if retry else None)
        FreeCAD.Console.PrintError("Swarf: %s\n" % text)

    def _show_frame(self, bridge):
        frame = bridge.take_frame()
        if frame is None or self.transport is None:
            return
        was_playing = self.transport.playing
        self.transport.arrived(frame.place)
        self.view.set_frame(frame)
        if was_playing and not self.transport.playing:
            self._timer.stop()
            self.bar.set_playing(False)
        self._show_place()

    def _show_place(self):
        session, place = self.session, self.transport.at
        listing, last = session.listing, len(session.clock)
        move = min(int(place), max(last - 1, 0))
        line, operation = listing.line_of(move), listing.operation_at(move)
        if self._line is not None and place == listing.moves_of(self._line)[1]:
            line, operation = self._line, listing.operation[self._line]
        self.timeline.set_place(place)
        self.bar.set_clock(self.transport.time, session.clock.seconds)
        self.program.set_current(line)
        self.operations.set_current(operation)
        tool = session.tool_at(place)
        name = session.data.tools.get(tool, ("",))[0]
        detail = ["T%d %s" % (tool, name)] if tool >= 0 else []
        if listing.number[line]:
            detail.append(listing.text(line))
        self.view.caption = (listing.operations[operation].name, "   ".join(detail), colours.of_operation(operation))
        self.view.update()

    # What the user wants

    def _look(self):
        bottom, top = colours.background(self.palette())
        return (("background", bottom), ("background_top", top), ("occlusion", settings.flag("Occlusion")),
                ("shadow", settings.flag("Shadow")), ("edges", True),
                ("colouring", "material" if self.tools.tolerance_mm else self.tools.colouring), ("colour", colours.MATERIAL), ("sections", self.section.planes()))

    def current_view(self, size=None):
        """session.View of what is shown, or of another size (width, height) of the picture."""
        width, height = size or self.view.pixels()
        return sessions.View(self.view.camera.copy(), width, height, self._look(), settings.flag("ShowCutter"),
                             settings.flag("ShowPath"), self.tools.tolerance_mm)

    def _wish(self):
        self.view.set_legend(self.tools.tolerance_mm)
        if self._engine is not None and self.session is not None and self.view.camera is not None:
            self._engine.wish(self.transport.wanted, self.current_view())

    def _tick(self):
        elapsed = self._clock.restart() / 1000.0
        if self.transport is None or self._engine is None:
            self._timer.stop()
            return
        self._engine.wish(self.transport.tick(elapsed))

    def toggle(self):
        """Play or pause."""
        if self.transport is None:
            return
        if self.transport.playing:
            self.transport.pause()
            self._engine.wish(self.transport.wanted)
            self._timer.stop()
        else:
            self.transport.play()
            self._clock.start()
            self._timer.start()
        self.bar.set_playing(self.transport.playing)

    def seek(self, place, line=None):
        """Stop, and go to a place. line: stays the marked one if the place is behind its last move."""
        if self.transport is None:
            return
        if line is not None:
            self._line = line
        if self._line is not None and place != self.session.listing.moves_of(self._line)[1]:
            self._line = None
        self.transport.seek(place)
        self._timer.stop()
        self.bar.set_playing(False)
        self._engine.wish(self.transport.wanted)

    def step(self, name):
        """One of the steps of the transport's buttons."""
        if self.transport is None:
            return
        listing, at = self.session.listing, self.transport.wanted
        self.seek({"operation-back": listing.previous_operation, "operation-forward": listing.next_operation,
                   "line-back": listing.previous_line, "line-forward": listing.next_line,
                   "move-back": lambda place: -(-place // 1) - 1, "move-forward": lambda place: place // 1 + 1}
                  [name](at))

    def set_speed(self, speed):
        """Times as fast as the machine, 0: as fast as possible."""
        settings.set_speed(speed)
        if self.transport is not None:
            self.transport.set_speed(speed)
        self.bar.set_speed(speed)

    def _set_stops(self, kinds):
        if self.transport is not None:
            self.transport.enabled = set(kinds)

    def _go_to_operation(self, index):
        if self.session is not None:
            self.seek(self.session.listing.operation_begin[index])

    def _go_to_line(self, line):
        """Show what a line has cut: stand behind its last move, but keep it marked, not the next one."""
        if self.session is not None:
            self.seek(self.session.listing.moves_of(line)[1], line)

    def _set_perspective(self, on):
        settings.set_flag("Perspective", on)
        self.view.set_perspective(on)

    def _set_cutter(self, on):
        settings.set_flag("ShowCutter", on)
        self._wish()

    def _set_section(self, on):
        self.section.setVisible(on)
        self._wish()

    def _set_path(self, on):
        settings.set_flag("ShowPath", on)
        self._wish()

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

    # The document

    def _job_changed(self, differs):
        if self.session is None:
            return
        if differs:
            self.banner.say("warning", translate("Swarf", "The job was changed. What you see is how it was."),
                            translate("Swarf", "Read the job again"), self.reload)
        elif not self.banner.working:
            self.banner.done()

    def _job_gone(self, text):
        self.files.keeper.cancel()
        if self.session is None:
            self.close_job()
            text = translate("Swarf", "The job was deleted while it was being read.")
        self.banner.say("warning", text)
        self._show_state()

    def _document_closed(self):
        self.files.keeper.cancel()
        self.close_job()
        self.banner.say("note", translate("Swarf", "The document was closed."))

    def _show_state(self):
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
        if self.transport is None:
            super().keyPressEvent(event)
        elif key == qt.Key_Space:
            self.toggle()
        elif key in (qt.Key_Left, qt.Key_Right):
            self.step(unit + ("-back" if key == qt.Key_Left else "-forward"))
        elif key in (qt.Key_Home, qt.Key_End):
            self.seek(0.0 if key == qt.Key_Home else self.transport.end)
        elif key in (qt.Key_Up, qt.Key_Down):
            self.set_speed(self.transport.faster(1 if key == qt.Key_Up else -1))
        elif key == qt.Key_P:
            self.tools.actions_by_name["perspective"].toggle()
        else:
            super().keyPressEvent(event)

    def resizeEvent(self, event):
        """Lists beside the picture when there is room."""
        super().resizeEvent(event)
        wanted = QtCore.Qt.Horizontal if self.width() >= WIDE else QtCore.Qt.Vertical
        if self.splitter.orientation() != wanted:
            self.splitter.setOrientation(wanted)
            self.splitter.setSizes(SIZES if wanted == QtCore.Qt.Vertical else (self.width() - WIDE_LISTS, WIDE_LISTS))

    def changeEvent(self, event):
        """The theme may have changed."""
        super().changeEvent(event)
        if event.type() in (QtCore.QEvent.PaletteChange, QtCore.QEvent.StyleChange) and hasattr(self, "tools"):
            self._wish()


_panel = None


def show(job):
    """The panel, made when there is none, watching a job."""
    global _panel
    main = Gui.getMainWindow()
    if _panel is None:
        _panel = LivePanel(main)
        main.addDockWidget(QtCore.Qt.RightDockWidgetArea, _panel)
        _panel.resize(640, 720)
        main.resizeDocks([_panel], [640], QtCore.Qt.Horizontal)
    _panel.show()
    _panel.raise_()
    _panel.watch(job)
    _panel.view.setFocus()
    return _panel
