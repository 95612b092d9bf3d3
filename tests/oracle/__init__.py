"""An independent implementation of the measurement model in plain NumPy and SciPy: what the tests hold the core to.

It shares no code with the program: 4×4 matrices as the formulas are written, derivatives by complex steps, placements
as explicit unknowns in a dense Jacobian, ranks from a plain singular value decomposition. Slow and readable on purpose.
Only `core.py` knows the program: it hands the same arm and readings to it.
"""
