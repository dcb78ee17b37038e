# SPDX-License-Identifier: LGPL-2.1-or-later
"""Is the program right? A job is played once more with all checks, and what is left held against its design. Imports
no FreeCAD; any thread: it works on a stock of its own, so that the one that is watched can be played meanwhile."""

from . import native

# Where each stage begins and how much of the whole it is, about.
STAGES = {"design": (0.0, 0.05), "stock": (0.05, 0.15), "cut": (0.2, 0.55), "compare": (0.75, 0.25)}


def run(job, voxel_mm, tolerance_mm, progress):
    """List of swarf Verdicts on a swarf.Job; without a design, or with one that encloses nothing, of the checks alone.

    progress as in native.simulate(). MemoryError, swarf.Error.
    """
    swarf = native.load()
    from swarf.simulate import make_stock  # of the package, once it is known to be there
    from swarf.verify import Verdict, findings_of, verify

    def report(stage, fraction):
        begin, share = STAGES[stage]
        return progress(begin + share * fraction)

    doubts = []
    if job.design is not None:
        try:
            return verify(job, tolerance=tolerance_mm, voxel=voxel_mm, loads=False, progress=report).findings
        except swarf.GeometryError as error:
            doubts.append(Verdict("warning", str(error), "design"))
    stock = make_stock(job.stock, voxel=voxel_mm, progress=lambda done: report("stock", done))
    checked = stock.check(job.program, job.tools, teeth=job.teeth, progress=lambda done: report("cut", done))
    return doubts + findings_of(job, checked, voxel_mm)
