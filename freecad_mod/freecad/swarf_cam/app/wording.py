# SPDX-License-Identifier: LGPL-2.1-or-later
"""What swarf says of findings, in the user's language: swarf.wording has the sentences, the add-on their
translations. Documents keep them in English, whoever simulated."""

import FreeCAD

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

# Where freecad_mod/translate puts the sentences of swarf.wording.
CONTEXT = "SwarfFinding"

SEVERITIES = {"error": QT_TRANSLATE_NOOP("Swarf", "error"), "warning": QT_TRANSLATE_NOOP("Swarf", "warning"),
              "note": QT_TRANSLATE_NOOP("Swarf", "note")}


def say(text, point="."):
    """A text in the user's language, where it is a swarf.wording.Said; else as it is. point: that of decimals. Units
    are written as everywhere in the add-on; names of the user's in the values stay as they are."""
    translated = getattr(text, "translated", None)
    return text if translated is None else translated(_form, point)


def _form(form):
    return translate(CONTEXT, form).replace("mm2", "mm²").replace("mm3", "mm³")


def line(severity, operation, number, text, job=None):
    """A finding in a line of English: severity of swarf, names of operation and job or None, number of the command."""
    of = "" if job is None else "job '%s', " % job
    return "%s: %soperation '%s', command %s: %s" % (severity, of, operation or "-", number, text)
