# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs in freecadcmd for the command line: document, or a CAD file -> exchange folder. Arguments come in the
environment, because FreeCAD refuses options that it does not know."""

import os
import sys
import traceback

import FreeCAD

from ..core import exchange
from ..core.errors import JobError
from . import job as jobs
from . import setups, shapes

INPUT, JOB, FOLDER = "SWARF_EXPORT_INPUT", "SWARF_EXPORT_JOB", "SWARF_EXPORT_FOLDER"

# mm; set: a design is wanted, not a job
DEFLECTION = "SWARF_EXPORT_DEFLECTION"


def main():
    """Write the folder and end the process, whatever happens: freecadcmd would run on, or start over."""
    folder = os.environ[FOLDER]
    status = 1
    try:
        if os.environ.get(DEFLECTION):
            exchange.write_design(folder, shapes.read_design(os.environ[INPUT], float(os.environ[DEFLECTION])))
        else:
            document = FreeCAD.openDocument(os.environ[INPUT])
            exchange.write(folder, setups.read_job(jobs.pick_job(document, os.environ.get(JOB) or None)))
        status = 0
    except JobError as error:
        exchange.write_error(folder, str(error))
    except BaseException as error:  # nothing may reach freecadcmd; the other side shows the text
        traceback.print_exc()
        exchange.write_error(folder, "%s: %s" % (type(error).__name__, error))
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)
