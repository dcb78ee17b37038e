# SPDX-License-Identifier: LGPL-2.1-or-later
"""Work in steps: a generator that yields between them and returns what came out, so that others can live meanwhile."""

import time


def run(steps):
    """What the steps come to, taken one after the other."""
    while True:
        try:
            next(steps)
        except StopIteration as end:
            return end.value


def run_for(steps, seconds):
    """Take steps for about so long -> (whether they are through, what they came to)."""
    end = time.monotonic() + seconds
    while True:
        try:
            next(steps)
        except StopIteration as done:
            return True, done.value
        if time.monotonic() >= end:
            return False, None
