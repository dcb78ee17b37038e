# SPDX-License-Identifier: LGPL-2.1-or-later
"""One line of text that changes when anything that a simulation depends on does."""

import hashlib
import json

# Change it when the same inputs give another result: old results are then shown as out of date.
VERSION = 1


def signature(operations, tools, stock, design, voxel_mm):
    """Hash of the inputs, each any mixture of numbers, texts, lists and dicts; floats count with 9 digits, so that
    what the document rounds when it is saved stays the same."""
    def plain(value):
        if isinstance(value, float):
            return "%.9g" % (value + 0.0)
        if isinstance(value, dict):
            return {str(key): plain(item) for key, item in sorted(value.items())}
        if isinstance(value, (list, tuple)):
            return [plain(item) for item in value]
        return value

    text = json.dumps(plain([VERSION, operations, tools, stock, design, voxel_mm]), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()
