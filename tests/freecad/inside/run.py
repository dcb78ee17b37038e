# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs the tests of this folder inside FreeCAD:  freecadcmd run.py -M freecad_mod -P build/python
$SWARF_TESTS chooses: names of modules, classes or tests (default: all). Exit status 0 when all passed."""

import os
import sys
import traceback
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
SUPPORT = os.path.join(os.path.dirname(os.path.dirname(HERE)), "support")


def main():
    """0 or 1."""
    sys.path[:0] = [HERE, SUPPORT]
    import telling

    telling.nothing_by_time()
    loader = unittest.defaultTestLoader
    chosen = os.environ.get("SWARF_TESTS")
    suite = loader.loadTestsFromNames(chosen.split()) if chosen else loader.discover(HERE)
    result = unittest.TextTestRunner(stream=sys.stdout, verbosity=2).run(suite)
    for test, reason in result.skipped:
        print("SKIPPED", test, reason)
    return 0 if result.wasSuccessful() and result.testsRun else 1


if __name__ in ("run", "__main__"):
    status = 1
    try:
        status = main()
    except BaseException:  # left to freecadcmd, it would run the file a second time, and exit with 0
        traceback.print_exc()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)
