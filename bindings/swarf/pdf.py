# SPDX-License-Identifier: LGPL-2.1-or-later
"""HTML reports on paper: as PDF, by whatever converter is installed."""
from __future__ import annotations

import os
import pathlib
import shutil
import subprocess
import tempfile
from typing import Callable

#: Seconds a converter may take.
PATIENCE_S = 120


def _browser(program: str, source: str, target: str) -> list[str]:
    words = [program, "--headless", "--disable-gpu", "--no-pdf-header-footer", f"--print-to-pdf={target}",
             pathlib.Path(source).as_uri()]
    # browsers refuse to run as root with their sandbox; what they show here is our own
    return words if os.name == "nt" or os.geteuid() else [*words[:1], "--no-sandbox", *words[1:]]


def _plain(program: str, source: str, target: str) -> list[str]:
    return [program, source, target]


#: Programs that turn HTML into PDF, those that lay it out best first.
CONVERTERS: dict[str, Callable[[str, str, str], list[str]]] = {
    "chromium": _browser, "chromium-browser": _browser, "google-chrome": _browser, "weasyprint": _plain,
    "wkhtmltopdf": _plain,
}


def find() -> str:
    """The converter that is installed. ValueError, with what can be, when none is."""
    for name in CONVERTERS:
        if shutil.which(name):
            return name
    raise ValueError(f"no converter from HTML to PDF is installed; one of {', '.join(CONVERTERS)} is needed, or write "
                     ".html and print it from a browser")


def write(text: str, path: str) -> None:
    """Write an HTML text as PDF. ValueError without a converter, OSError where it fails; then the file stays as it
    was."""
    name = find()
    with tempfile.TemporaryDirectory(prefix="swarf-") as folder:
        source, target = os.path.join(folder, "report.html"), os.path.join(folder, "report.pdf")
        pathlib.Path(source).write_text(text, encoding="utf-8")
        try:
            done = subprocess.run(CONVERTERS[name](shutil.which(name) or name, source, target), capture_output=True,
                                  text=True, timeout=PATIENCE_S, check=False)
        except subprocess.TimeoutExpired:
            raise OSError(f"{path}: {name} did not finish within {PATIENCE_S} s") from None
        if done.returncode or not os.path.exists(target):
            said = (done.stderr.strip().splitlines() or ["nothing"])[-1]
            raise OSError(f"{path}: {name} failed with status {done.returncode}, saying {said}")
        shutil.copyfile(target, path)
