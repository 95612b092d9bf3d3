"""Least-squares shapes through measured points: one file each. Many sets of points at once; lengths mm."""

from ulna.geometry.plane import Planes, planes
from ulna.geometry.sphere import Spheres, spheres

__all__ = ["Planes", "Spheres", "planes", "spheres"]
