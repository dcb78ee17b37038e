# SPDX-License-Identifier: LGPL-2.1-or-later
"""Text files that are whole or not there."""
from __future__ import annotations

import os
import tempfile


def write_text(text: str, path: str) -> None:
    """Write a text, beside the target and renamed, so that a failure loses nothing. OSError."""
    try:
        _write(text, path)
    except OSError as error:
        raise OSError(f"{path}: cannot write: {error.strerror or error}") from None


def _write(text: str, path: str) -> None:
    folder = os.path.dirname(os.path.abspath(path))
    handle, temporary = tempfile.mkstemp(dir=folder, prefix=".swarf-")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as stream:
            stream.write(text)
        umask = os.umask(0)  # mkstemp makes private files; a report is an ordinary one
        os.umask(umask)
        os.chmod(temporary, 0o666 & ~umask)
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise
