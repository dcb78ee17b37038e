# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids with faces as they were cut: what is left of a stock bounded by planes, cylinders, cones, spheres and tori.

The way of the data: what shape made each triangle of a mesh (``regions``, by ``shapes``), where regions meet
(``chains``), faces narrower than the voxels and what else the mesh bridged (``strips``, ``opening``, asking the surface
by ``probe``), edges and corners solved on the shapes (``brep``, into ``topology``), whether that is right (``truth``,
``volume``), the file (``step``). ``export`` is what others use: files of such solids, and of facets where there are
none.
"""
from .export import SUFFIXES, Cut, Written, as_cut, facets, write, write_cut, write_facets

__all__ = ["SUFFIXES", "Cut", "Written", "as_cut", "facets", "write", "write_cut", "write_facets"]
