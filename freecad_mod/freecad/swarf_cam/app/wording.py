# SPDX-License-Identifier: LGPL-2.1-or-later
"""What swarf says of findings, in the user's language: swarf.wording has the sentences, the add-on their
translations."""

import FreeCAD

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

# Where freecad_mod/translate puts the sentences of swarf.wording.
CONTEXT = "SwarfFinding"

SEVERITIES = {"error": QT_TRANSLATE_NOOP("Swarf", "error"), "warning": QT_TRANSLATE_NOOP("Swarf", "warning"),
              "note": QT_TRANSLATE_NOOP("Swarf", "note")}


def say(text, point="."):
    """A text in the user's language, where it is a swarf.wording.Said; else as it is. point: that of decimals."""
    translated = getattr(text, "translated", None)
    return text if translated is None else translated(lambda form: translate(CONTEXT, form), point)


def line(severity, operation, number, text, job=None):
    """A finding in a line: severity of swarf, names of operation and job or None, number of the command."""
    values = {"severity": translate("Swarf", SEVERITIES[severity]), "operation": operation or "-", "number": number,
              "text": say(text), "job": job}
    if job is None:
        return translate("Swarf", "{severity}: operation '{operation}', command {number}: {text}").format(**values)
    return translate("Swarf", "{severity}: job '{job}', operation '{operation}', command {number}: {text}").format(**values)
