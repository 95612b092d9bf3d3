"""Work that is cut into pieces and done here or elsewhere, with the same answer.

`pieces`: what a piece of work and who does it must be, and this process as one who does; `on_dask`: the workers of a
Dask cluster; `ledger`: finished pieces are kept, so that interrupted work goes on where it stopped; `recalibrations`:
the work that is cut most, calibrations repeated on new noise.
"""
