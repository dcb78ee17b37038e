# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plays the job that is open: the clockwork of core.transport driven by a timer, its wishes handed to the engine, and
what the engine shows handed to the widgets."""

from ...core import transport as model
from .. import colours, settings
from ..qt import QtCore

# Milliseconds between two looks at the clock while playing.
TICK_MS = 30

# Seconds between two looks that count: when FreeCAD stood still for longer, playing goes on from there, without a jump.
STALL_SECONDS = 0.25


class Player:
    """transport: the core Transport of the job that is open, None for none. selected: the line whose faces stand out in
    the picture, None for none; the list marks it as well while the cutting stands where it stood at the selection."""

    def __init__(self, panel):
        self._panel = panel
        self.transport = self.selected = self._stood = None
        self._clock = QtCore.QElapsedTimer()
        self._timer = QtCore.QTimer(panel)
        self._timer.setInterval(TICK_MS)
        self._timer.timeout.connect(self._tick)

    def open(self, session, enabled):
        """Stand before the first move of a session. enabled: kinds of stops."""
        self.transport = model.Transport(session.clock, session.stops)
        self.transport.speed = settings.speed()
        self._panel.bar.set_speed(self.transport.speed)
        self.set_stops(enabled)

    def close_job(self):
        """Play nothing any more."""
        self._timer.stop()
        self.transport = self.selected = self._stood = None
        self._panel.bar.set_playing(False)

    def select(self, line):
        """Have the faces that a line cut stand out, None: none."""
        self._stood = None if self.transport is None else self.transport.wanted
        if line != self.selected:
            self.selected = line
            self._panel.wish()

    def _tick(self):
        elapsed = min(self._clock.restart() / 1000.0, STALL_SECONDS)
        if self.transport is None:
            self._timer.stop()
            return
        self._panel.opening.wish(self.transport.tick(elapsed))

    def toggle(self):
        """Play or pause."""
        if self.transport is None:
            return
        if self.transport.playing:
            self.pause()
        else:
            self.transport.play()
            self._panel.view.set_mark(None)
            self.select(None)
            self._clock.start()
            self._timer.start()
        self._panel.bar.set_playing(self.transport.playing)

    def pause(self):
        """Stand where the cutting is."""
        if self.transport is not None:
            self.transport.pause()
            self._panel.opening.wish(self.transport.wanted)
            self._timer.stop()
            self._panel.bar.set_playing(False)

    def seek(self, place, line=None, mark=None):
        """Stop, and go to a place. line: the one that is selected from now on, mark: the point that is marked, None:
        none."""
        if self.transport is None:
            return
        self.transport.seek(place)
        self.select(line)
        self._timer.stop()
        self._panel.bar.set_playing(False)
        self._panel.view.set_mark(mark)
        self._panel.opening.wish(self.transport.wanted)

    def step(self, name):
        """One of the steps of the transport's buttons."""
        if self.transport is None:
            return
        listing, at = self._panel.session.listing, self.transport.wanted
        self.seek({"operation-back": listing.previous_operation, "operation-forward": listing.next_operation,
                   "line-back": listing.previous_line, "line-forward": listing.next_line,
                   "move-back": lambda place: -(-place // 1) - 1, "move-forward": lambda place: place // 1 + 1}
                  [name](at))

    def set_speed(self, speed):
        """Times as fast as the machine, 0: as fast as possible."""
        settings.set_speed(speed)
        if self.transport is not None:
            self.transport.set_speed(speed)
        self._panel.bar.set_speed(speed)

    def set_stops(self, kinds):
        """Kinds of places to halt at."""
        if self.transport is not None:
            self.transport.enabled = set(kinds)

    def go_to_operation(self, index):
        """Where an operation begins."""
        if self.transport is not None:
            self.seek(self._panel.session.listing.operation_begin[index])

    def go_to_line(self, line):
        """Show what a line has cut: stand behind its last move, but keep it marked, not the next one; its faces stand
        out."""
        if self.transport is not None:
            self.seek(self._panel.session.listing.moves_of(line)[1], line)

    def show(self, frame):
        """A picture came: the cutting stands at its place."""
        panel, was_playing = self._panel, self.transport.playing
        self.transport.arrived(frame.place)
        panel.view.set_frame(frame)
        if was_playing and not self.transport.playing:
            self._timer.stop()
            panel.bar.set_playing(False)
        self._show_place()

    def _show_place(self):
        panel, place = self._panel, self.transport.at
        session = panel.session
        listing, last = session.listing, len(session.clock)
        move = min(int(place), max(last - 1, 0))
        line, operation, tool = listing.line_of(move), listing.operation_at(move), session.tool_at(place)
        if self.selected is not None and place == self._stood:
            line, operation = self.selected, listing.operation[self.selected]
            tool = session.tool_at(listing.moves_of(line)[0])
        panel.timeline.set_place(place)
        panel.bar.set_clock(self.transport.time, session.clock.seconds)
        panel.program.set_current(line)
        panel.operations.set_current(operation)
        name = session.data.tools.get(tool, ("",))[0]
        detail = ["T%d %s" % (tool, name)] if tool >= 0 else []
        if listing.number[line]:
            detail.append(listing.text(line))
        panel.view.caption = (listing.operations[operation].name, "   ".join(detail), colours.of_operation(operation))
        panel.view.update()
