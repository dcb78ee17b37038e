# SPDX-License-Identifier: LGPL-2.1-or-later
"""The dock in which a job is watched being cut: one widget per file, put together in dock.py."""
