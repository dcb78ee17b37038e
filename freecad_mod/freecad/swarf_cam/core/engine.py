# SPDX-License-Identifier: LGPL-2.1-or-later
"""The thread that cuts and draws, so that nobody else waits: told what is wanted, it does the most urgent bit, tells
what came out, and looks again at what is wanted.

The GUI writes the newest wish (place in the program, view) and forgets older ones; what is asked by call() is done in
turn. While anything moves pictures are drawn within a budget of time; at rest they are refined step by step, and a new
wish breaks that off. Listeners are called in this thread.
"""

import collections
import threading
import time

# Milliseconds for a picture while things move: with as much for cutting about twelve pictures a second in the worst
# case, and thirty when only the view turns.
BUDGET_MS = 35.0

# Seconds of cutting between two pictures while the stock is played.
SLICE_SECONDS = 0.04

# Seconds without a new wish after which the picture is refined: shorter would refine between two mouse moves.
REST_SECONDS = 0.12

# Rays along the edge of a pixel in the pictures at rest, one after the other: exact at once, then smooth.
RAYS_AT_REST = (1, 3)


class Call:
    """Something to be done once by the engine's thread; see Engine.call()."""

    def __init__(self, function, on_result):
        self.function, self.on_result = function, on_result
        self.cancelled = False

    def cancel(self):
        """Break it off, or do not begin it. Any thread."""
        self.cancelled = True


class Engine:
    """open_session(progress) -> the session that cuts and draws; listener has opened(session), frame(frame),
    progress(fraction), failed(error) and finished(), which comes last.

    A session has at, the place it stands at, step(place, seconds, progress) -> at, and draw(view, place, budget_ms,
    progress, rays) -> frame, budget_ms None for all the time it takes. Both raise cancelled_type when a progress
    answered true. What is called may leave it anywhere: it goes on from there to the place that is wished.
    """

    def __init__(self, open_session, listener, cancelled_type):
        self._open, self._listener, self._cancelled_type = open_session, listener, cancelled_type
        self._changed = threading.Condition()
        self._calls = collections.deque()
        self._place, self._view = 0.0, None
        self._revision = 0  # of place and view together
        self._stopping = self._cancelling = False
        self._thread = threading.Thread(target=self._run, name="Swarf engine", daemon=True)

    def start(self):
        """Begin; returns at once."""
        self._thread.start()

    def wish(self, place=None, view=None):
        """Where to stand and what to show from now on."""
        with self._changed:
            if (place is None or place == self._place) and (view is None or view == self._view):
                return
            self._place = self._place if place is None else place
            self._view = self._view if view is None else view
            self._revision += 1
            self._changed.notify()

    def call(self, function, on_result):
        """Do function(session, progress) in turn; on_result(result, error) is called in the engine's thread -> Call."""
        made = Call(function, on_result)
        with self._changed:
            self._calls.append(made)
            self._changed.notify()
        return made

    def cancel(self):
        """Break off opening."""
        self._cancelling = True

    def stop(self):
        """End the thread soon; its work is broken off. Any thread."""
        with self._changed:
            self._stopping = True
            self._changed.notify()

    def join(self, seconds):
        """Wait for the end; whether it came."""
        self._thread.join(seconds)
        return not self._thread.is_alive()

    def _run(self):
        try:
            session = self._open(self._opening)
            self._listener.opened(session)
            self._work(session)
        except self._cancelled_type as error:
            if not self._stopping:
                self._listener.failed(error)
        except BaseException as error:  # it would be lost with the thread
            self._listener.failed(error)
        finally:
            session = None
            self._listener.finished()

    def _opening(self, fraction):
        self._listener.progress(fraction)
        return self._stopping or self._cancelling

    def _work(self, session):
        drawn, rest, failed = -1, len(RAYS_AT_REST), -1  # rest: how many of the pictures at rest are drawn
        at = 0.0
        while True:
            with self._changed:
                while not (self._stopping or self._calls or self._revision != drawn or rest < len(RAYS_AT_REST)):
                    self._changed.wait()
                if self._stopping:
                    return
                call = self._calls.popleft() if self._calls else None
                revision, place, view = self._revision, self._place, self._view
            if call:
                self._do(session, call)
                if session.at != at:
                    at, drawn = session.at, -1
                continue
            if revision == drawn and rest == 0 and self._wait_for_rest(revision):
                continue
            try:
                if revision != drawn or at != place:
                    at = session.step(place, SLICE_SECONDS, self._break_off)
                    if view is not None:
                        self._listener.frame(session.draw(view, at, BUDGET_MS, self._break_off, 1))
                    drawn = revision if at == place else -1
                    rest = len(RAYS_AT_REST) if view is None else 0
                else:
                    self._listener.frame(
                        session.draw(view, place, None, lambda _: self._is_old(revision), RAYS_AT_REST[rest]))
                    rest += 1
            except self._cancelled_type:
                continue
            except Exception as error:  # one failure per wish: the next wish may do better
                if failed != revision:
                    self._listener.failed(error)
                failed = drawn = revision
                rest = len(RAYS_AT_REST)

    def _break_off(self, _):
        return self._stopping

    def _is_old(self, revision):
        return self._stopping or self._revision != revision or bool(self._calls)

    def _wait_for_rest(self, revision):
        """Whether something newer came while waiting."""
        end = time.monotonic() + REST_SECONDS
        with self._changed:
            while not self._is_old(revision):
                left = end - time.monotonic()
                if left <= 0:
                    return False
                self._changed.wait(left)
        return True

    def _do(self, session, call):
        try:
            if call.cancelled:
                raise self._cancelled_type
            result = call.function(session, lambda _: self._stopping or call.cancelled)
        except Exception as error:
            call.on_result(None, error)
        else:
            call.on_result(result, None)
