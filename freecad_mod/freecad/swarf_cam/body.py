# SPDX-License-Identifier: LGPL-2.1-or-later
"""The mesh of what is left of a stock in swarf's hands: cut by planes, taken apart, measured. Imports no FreeCAD,
touches no document: runs in any thread."""

import os
import tempfile

from . import native
from .core import measures
from .core.errors import JobError


# Of a file that cannot be handed over, and why.
NO_PLACE = "the stock needs room in the folder of temporary files: %s"


class Body:
    """A closed mesh, handed over as a .ply file by write(its path) at once: numbers in Python would take ten times as
    long. It is read when it is needed first. JobError where there is no place for the file."""

    def __init__(self, write):
        self._count = 0
        self._mesh = None
        try:
            self._folder = tempfile.TemporaryDirectory(prefix="swarf-")
            write(self._file("body.ply"))
        except OSError as error:  # FreeCAD's own has a dictionary for a text
            raise JobError(NO_PLACE % (error.strerror or "it cannot be written to")) from error

    def _file(self, name):
        return os.path.join(self._folder.name, name)

    @property
    def mesh(self):
        """swarf.Mesh. JobError."""
        if self._mesh is None:
            try:
                self._mesh = native.load().Mesh.read(self._file("body.ply"))
            except (OSError, native.load().Error) as error:  # who wrote it does not tell that it was cut off
                raise JobError(NO_PLACE % "it may be full") from error
        return self._mesh

    def section(self, point, normal):
        """Closed polylines along which a plane cuts it, of points (x, y, z)."""
        return self.mesh.section(tuple(point), tuple(normal))

    def split(self, point, normal, each=False, progress=None, most=None):
        """Files of its parts on both sides of a plane, each closed: first what lies against the normal; or of each
        piece of them, `most` of them at most. They live as long as the body. JobError where the plane misses it or
        there are more, swarf.Error where it is open, swarf.Cancelled."""
        native.check(progress, 0)
        sides = self.mesh.split(tuple(point), tuple(normal))
        native.check(progress, 0.1)
        if not all(side.triangle_count for side in sides):
            raise JobError("the plane does not cut what is left of the stock")
        found = self._pieces(sides, native.share(progress, 0.1, 0.5), most) if each else sides
        files = []
        for number, part in enumerate(found):
            native.check(progress, 0.5 + 0.5 * number / len(found))
            self._count += 1
            files.append(self._file("part-%d.ply" % self._count))
            part.write(files[-1])
        return files

    @staticmethod
    def _pieces(sides, progress, most):
        """Meshes of the pieces of some, counted before they are made."""
        count = 2 * len(sides)
        groups = [native.pieces_of(side, native.share(progress, number / count, (number + 1) / count))
                  for number, side in enumerate(sides)]
        found = sum(map(len, groups))
        if most is not None and found > most:
            raise JobError("these are %d pieces, of which at most %d become objects: split by the plane alone, or "
                           "export the stock and split its file by 'swarf mesh --split'" % (found, most))
        return [piece for number, (side, group) in enumerate(zip(sides, groups), len(sides))
                for piece in side.split_shells(
                    group, progress=native.share(progress, number / count, (number + 1) / count))]

    def measures(self, progress=None):
        """core.measures.Table of the whole and its shells. swarf.Cancelled."""
        whole, shells = self.mesh.measure(), self.mesh.shells()
        return measures.table(whole, shells, native.thinnest(self.mesh, progress))
