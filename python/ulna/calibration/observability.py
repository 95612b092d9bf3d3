"""How well a set of readings sees the parameters: indices of the literature."""

from __future__ import annotations

import numpy as np

from ulna.ground.arrays import F64


def indices(values: F64, rows: int) -> dict[str, float]:
    """O1 to O5, after Sun and Hollerbach (ICRA 2008), of a Jacobian with so many rows.

    With σ₁ ≥ … ≥ σ_L its singular values over the L determined directions, values (L,), and R rows:
    O1 = (σ₁ … σ_L)^(1/L) / √R (Borm and Menq), O2 = σ_L / σ₁ (Driels and Pathre), O3 = σ_L (Nahvi et al.),
    O4 = σ_L² / σ₁ (Nahvi and Hollerbach), O5 = 1 / Σ 1/σ_i (Sun and Hollerbach). All are the better the larger.
    """
    first, last = float(values[0]), float(values[-1])
    return {
        "O1": float(np.exp(np.log(values).mean()) / np.sqrt(rows)),
        "O2": last / first,
        "O3": last,
        "O4": last**2 / first,
        "O5": float(1.0 / (1.0 / values).sum()),
    }
