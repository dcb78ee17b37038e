# SPDX-License-Identifier: LGPL-2.1-or-later
"""When native work tells its progress. By time, as for users, what is told depends on the machine, which tests may not:
they have nothing told by time, and where they look at what is told each piece of the work."""
import contextlib

import swarf

# Longer than any test.
NEVER_MS = 3600000


def nothing_by_time():
    """From now on in this process."""
    swarf.set_progress_interval(NEVER_MS)


@contextlib.contextmanager
def every_piece():
    """By one thread: of several, others than the calling one, which tells, may do all that is left."""
    swarf.set_progress_interval(0)
    swarf.set_threads(1)
    try:
        yield
    finally:
        swarf.set_threads(0)
        nothing_by_time()
