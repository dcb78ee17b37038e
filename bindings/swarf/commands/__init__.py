# SPDX-License-Identifier: LGPL-2.1-or-later
"""The subcommands of ``swarf``: each module of this package is one, by the module's name.

A module has ``add(subparsers)``, which adds its parser by ``subparsers.add_parser(NAME, ...)``, and ``run(arguments)``,
which does the work and returns the exit status (console.DONE, console.FINDINGS). What goes wrong is raised as
swarf.Error, OSError, ValueError or MemoryError; ``cli`` says it in one line.
"""
from __future__ import annotations

import importlib
import pkgutil
from types import ModuleType


def collect() -> dict[str, ModuleType]:
    """All subcommands by name, in the alphabet's order."""
    names = sorted(module.name for module in pkgutil.iter_modules(__path__))
    return {name: importlib.import_module(f"{__name__}.{name}") for name in names}
