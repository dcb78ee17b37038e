# SPDX-License-Identifier: LGPL-2.1-or-later
"""The add-on's own exception."""


class JobError(ValueError):
    """A job, tool or stock that cannot be simulated; the text says what, where and what would be right."""
