"""Least-squares fits and the smallest enclosing sphere of points, for many sets of points at once. Lengths mm."""
