# SPDX-License-Identifier: LGPL-2.1-or-later
"""Text files that are whole or not there, JSON files that are read, suffixes, whose errors are whose."""
from __future__ import annotations

import contextlib
import json
import os
import tempfile
from typing import Any, Iterator, Optional

from ._native import GeometryError


def read_json(path: str) -> Any:
    """What a JSON file holds. OSError has the file, ValueError begins with it."""
    try:
        with open(path, "rb") as stream:
            text = stream.read()
    except OSError as error:
        error.filename = path  # reading tells none, only opening does
        raise
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:  # JSONDecodeError, what is no UTF-8, what is nested too deep
        raise ValueError(f"{path}: is no JSON: {error}") from None


@contextlib.contextmanager
def naming(path: str) -> Iterator[None]:
    """A GeometryError in here begins with the file, or what else it is, whose shape is to blame."""
    try:
        yield
    except GeometryError as error:
        raise GeometryError(f"{path}: {error}") from None


def check_suffix(path: Optional[str], what: str, suffix: str) -> None:
    """ValueError unless a path (None: not given) ends in ``suffix``; ``what`` is e.g. "picture"."""
    if path is not None and os.path.splitext(os.fsdecode(path))[1].lower() != suffix:
        raise ValueError(f"{os.fsdecode(path)}: unknown suffix; a {what} is {suffix}")


def is_number(value: Any) -> bool:
    """Whether a value of a JSON file is a number, neither NaN nor more than lengths and speeds can be."""
    return type(value) in (int, float) and abs(value) < 1e15


def write_text(text: str, path: str) -> None:
    """Write a text, beside the target and renamed, so that a failure loses nothing. OSError."""
    try:
        _write(text, path)
    except OSError as error:
        raise OSError(f"{path}: cannot write: {error.strerror or error}") from None


def _write(text: str, path: str) -> None:
    place = os.path.realpath(path)  # renaming over a link would replace the link
    handle, temporary = tempfile.mkstemp(dir=os.path.dirname(place), prefix=".swarf-")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as stream:
            stream.write(text)
        umask = os.umask(0)  # mkstemp makes private files; a report is an ordinary one
        os.umask(umask)
        os.chmod(temporary, 0o666 & ~umask)
        os.replace(temporary, place)
    except BaseException:
        os.unlink(temporary)
        raise
