# SPDX-License-Identifier: LGPL-2.1-or-later
"""Findings that are accepted, kept in the job as a list of texts, one JSON object each: see swarf.accept."""

import json

import FreeCAD

from ..core.errors import JobError

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

# Saved name: never change it.
ACCEPTED, GROUP = "SwarfAccepted", "Swarf"


def accepted_of(job):
    """The entries of a job. JobError names one that cannot be read."""
    entries = []
    for number, text in enumerate(getattr(job, ACCEPTED, None) or [], 1):
        try:
            entries.append(json.loads(text))
        except ValueError as error:
            raise JobError("the job '%s', acceptance %d: %s" % (job.Label, number, error)) from error
    return entries


def keep(job, entries):
    """Keep these entries, and no others; in the transaction of the caller, so that it can be undone."""
    for entry in entries:
        if not str(entry.get("reason", "")).strip():
            raise JobError("an accepted finding needs a reason")
    if ACCEPTED not in job.PropertiesList:
        job.addProperty("App::PropertyStringList", ACCEPTED, GROUP,
                        QT_TRANSLATE_NOOP("App::Property", "Findings that are accepted, with their reasons"))
    setattr(job, ACCEPTED, [json.dumps(entry, sort_keys=True) for entry in entries])


def accept(job, entry):
    """Keep one more."""
    keep(job, accepted_of(job) + [entry])
