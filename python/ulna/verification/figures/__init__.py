"""What the tests of an arm report, computed from touches alone: one file a standard.

Points are those of the probe ball's centre, mm, in any frame; every function works on one test or on many: leading axes
of the points are those of the values. None of the standards' own text could be read: each figure carries its formula,
and is evaluated "in the manner of" the standard that it names.
"""
