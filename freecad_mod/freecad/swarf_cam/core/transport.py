# SPDX-License-Identifier: LGPL-2.1-or-later
"""The player's clockwork: where the simulation should stand now. No threads, no timers: told how much time went by.

The place wanted runs with the machine's clock, times the speed, and never past the next stop; how far the cutting has
come is told by arrived(), and the clock waits for it, so that what is shown is never behind what the clock says by
more than a step.
"""

# Offered speeds: times as fast as the machine; AS_FAST_AS_POSSIBLE does not look at the clock.
AS_FAST_AS_POSSIBLE = 0.0
SPEEDS = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, AS_FAST_AS_POSSIBLE)

# Where playback can halt by itself.
STOP_OPERATION, STOP_TOOL_CHANGE, STOP_FINDING = "operation", "tool_change", "finding"

# How far the clock may run ahead of the cutting, seconds of the viewer's time.
LEAD_SECONDS = 0.2


class Transport:
    """Play, pause, seek. clock: core.clock.Clock. stops: kind -> sorted places where it may halt."""

    def __init__(self, clock, stops):
        self.clock = clock
        self.stops = stops
        self.enabled = set()
        self.speed = 50.0
        self.playing = False
        self.wanted = 0.0
        self.at = 0.0
        self._time = 0.0
        self._passed = 0.0  # since playing began
        self._waiting = False  # for a picture of where playing begins: those that come are of before

    @property
    def end(self):
        """The place behind the last move."""
        return float(len(self.clock))

    @property
    def time(self):
        """Seconds on the machine's clock at the place that is shown."""
        return self.clock.time_of(self.at)

    def play(self):
        """Go on, from the start when it stands at the end."""
        if self.wanted >= self.end:
            self.seek(0.0)
        self.playing = self.end > 0
        self._passed = self.wanted
        self._waiting = self.at != self.wanted

    def pause(self):
        """Stand where the cutting is."""
        if self.playing:
            self.seek(self._reached())

    def _reached(self):
        """How far playing has come."""
        return self.wanted if self._waiting else min(max(self.at, self._passed), self.wanted)

    def seek(self, place):
        """Stop, and go to a place."""
        self.playing = False
        self.wanted = min(max(float(place), 0.0), self.end)
        self._time = self.clock.time_of(self.wanted)

    def next_stop(self, place):
        """The first enabled stop behind a place, or the end."""
        after = [stop for kind in self.enabled for stop in self.stops.get(kind, ()) if stop > place]
        return min(after, default=self.end)

    def tick(self, seconds):
        """Let so much of the viewer's time go by; the place wanted now."""
        if not self.playing or self._waiting:
            return self.wanted
        stop = self.next_stop(self._passed)
        if self.speed == AS_FAST_AS_POSSIBLE:
            self.wanted = stop
        else:
            lead = self._time - self.clock.time_of(self.at)
            if lead <= LEAD_SECONDS * self.speed or self.at >= self.wanted:
                self._time += seconds * self.speed
            # behind what is wanted already: moves without time, such as tool changes, do not send it back
            self.wanted = min(max(self.clock.place_at(self._time), self.wanted), stop)
        return self.wanted

    def arrived(self, place):
        """The cutting stands at this place now; at a stop or the end playing is over."""
        self.at = place
        if not self.playing:
            return
        if self._waiting:
            self._waiting = place != self.wanted
        elif place < self.wanted:
            self._passed = max(self._passed, place)
        elif place == self.wanted and place > self._passed and self._halts(place):
            self.playing = False
            self._time = self.clock.time_of(place)

    def _halts(self, place):
        return place >= self.end or any(place in self.stops.get(kind, ()) for kind in self.enabled)

    def set_speed(self, speed):
        """Times as fast as the machine, or AS_FAST_AS_POSSIBLE."""
        self.speed = speed
        if self.playing:  # what was wanted at the old speed is not wanted any more
            self.wanted = self._reached()
            self._time = self.clock.time_of(self.wanted)

    def faster(self, steps):
        """The speed so many steps up or down the list from this one."""
        index = SPEEDS.index(self.speed) if self.speed in SPEEDS else 0
        return SPEEDS[min(max(index + steps, 0), len(SPEEDS) - 1)]
