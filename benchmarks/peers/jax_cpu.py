"""JAX on the CPU in double precision: the chain as a scan over joints, reverse-mode derivatives, compiled by XLA.

A plain loop over joints is several times slower here: XLA fuses it whole and computes inner joints again and again.
"""

import os

# One thread for every contender; XLA reads this once, when JAX is first imported.
os.environ.setdefault("XLA_FLAGS", "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1")

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from benchmarks.lengths import F64, FREE, Lengths
from benchmarks.levenberg_marquardt import minimise
from benchmarks.peers import Contender
from benchmarks.tasks import measure_functions

jax.config.update("jax_enable_x64", True)
#: rows folded at a time: keeps the Jacobian of a chunk in cache
CHUNK = 2048


def _chain(links: Any, cos: Any, sin: Any) -> Any:
    """cos α, sin α, a, d (each (6,) or (6, N)) and a tip, (7, N) cosines and sines of the turns → (3, N) tips."""
    ca, sa, a, d, tip = links

    def joint(p: Any, link: Any) -> tuple[Any, None]:
        ca, sa, a, d, c, s = link
        px, py, pz = p[0] + a, ca * p[1] - sa * p[2], sa * p[1] + ca * p[2] + d
        return jnp.stack([c * px - s * py, s * px + c * py, pz]), None

    c, s = cos[6], sin[6]
    turned = jnp.stack([c * tip[0] - s * tip[1], s * tip[0] + c * tip[1], jnp.broadcast_to(tip[2], c.shape)])
    return jax.lax.scan(joint, turned, (ca, sa, a, d, cos[:6], sin[:6]), reverse=True)[0]


def _turns(x: Any, q: Any) -> tuple[Any, Any]:
    turn = q - jnp.concatenate([x[0:24:4], jnp.zeros(1)])[:, None]
    return jnp.cos(turn), jnp.sin(turn)


def _tips(x: Any, q: Any) -> Any:
    """(27,) parameters, (N, 7) rad → (N, 3) tips, mm."""
    alpha = x[1:24:4]
    return _chain((jnp.cos(alpha), jnp.sin(alpha), x[2:24:4], x[3:24:4], x[24:]), *_turns(x, q.T)).T


def _residual_jacobian(x: Any, q: Any, p: Any, length: Any) -> tuple[Any, Any]:
    """(7, N) poses and (N,) lengths → (N,) residuals and (25, N) derivatives.

    Each row has its own copy of the links, so one backward pass gives the derivatives of all rows.
    """
    rows = length.shape[0]
    cos, sin = _turns(x, jnp.concatenate([q, p], axis=1))
    ca, sa = jnp.cos(x[1:24:4]), jnp.sin(x[1:24:4])
    copies = tuple(jnp.broadcast_to(v[:, None], (len(v), 2 * rows)) for v in (ca, sa, x[2:24:4], x[3:24:4], x[24:]))

    def distance(links: Any, cos: Any, sin: Any) -> Any:
        tip = _chain(links, cos, sin)
        difference = tip[:, :rows] - tip[:, rows:]
        return jnp.sqrt(jnp.sum(difference * difference, axis=0))

    found, backward = jax.vjp(distance, copies, cos, sin)
    (of_ca, of_sa, of_a, of_d, of_tip), of_cos, of_sin = backward(jnp.ones(rows))
    of_theta0 = (of_cos * sin - of_sin * cos)[:6]
    of_alpha = ca[:, None] * of_sa - sa[:, None] * of_ca
    of_links = jnp.stack([of_theta0, of_alpha, of_a, of_d], axis=1).reshape(24, 2 * rows)
    jacobian = jnp.concatenate([of_links, of_tip])
    return found - length, (jacobian[:, :rows] + jacobian[:, rows:])[FREE]


def _fold(x: Any, q: Any, p: Any, length: Any, weight: Any) -> Any:
    """JᵀJ, Jᵀr, rᵀr of (chunks, …, rows); weight is zero for rows that only fill the last chunk."""

    def one(sums: Any, chunk: Any) -> tuple[Any, None]:
        *readings, weight = chunk
        residual, jacobian = _residual_jacobian(x, *readings)
        residual, jacobian = residual * weight, jacobian * weight
        gram, gradient, cost = sums
        return (gram + jacobian @ jacobian.T, gradient + jacobian @ residual, cost + residual @ residual), None

    zero = (jnp.zeros((25, 25)), jnp.zeros(25), jnp.zeros(()))
    return jax.lax.scan(one, zero, (q, p, length, weight))[0]


def _chunks(data: Lengths) -> tuple[Any, ...]:
    """The readings in full chunks, components before rows, and the weights of the rows."""
    rows = len(data.length_mm)
    size = min(CHUNK, rows)

    def shaped(values: F64, fill: float) -> Any:
        widths = [(0, -rows % size)] + [(0, 0)] * (values.ndim - 1)
        filled = np.pad(values, widths, constant_values=fill).reshape(-1, size, *values.shape[1:])
        return jnp.asarray(np.moveaxis(filled, -1, 1) if filled.ndim == 3 else filled)

    # filling rows need two different poses: the derivative of a distance of zero is not a number
    weight = shaped(np.ones(rows), 0.0)
    return shaped(data.q_rad, 0.5), shaped(data.p_rad, 1.0), shaped(data.length_mm, 1.0), weight


def contender() -> Contender:
    compiled_tips = jax.jit(_tips)
    compiled_fold = jax.jit(_fold)
    kept: list[tuple[Lengths, tuple[Any, ...]]] = []

    def forward(x: F64, q_rad: F64) -> F64:
        return np.asarray(compiled_tips(x, q_rad))

    def folded(x: F64, chunks: tuple[Any, ...]) -> tuple[F64, F64, float]:
        gram, gradient, cost = compiled_fold(x, *chunks)
        return np.asarray(gram), np.asarray(gradient), float(cost)

    def residual_jacobian(x: F64, data: Lengths) -> object:
        if not kept or kept[0][0] is not data:
            kept[:] = [(data, _chunks(data))]
        return folded(x, kept[0][1])

    def fit(start: F64, data: Lengths) -> F64:
        chunks = _chunks(data)
        return minimise(lambda x: folded(x, chunks), start)

    return Contender(
        "JAX",
        f"JAX {jax.__version__}",
        f"jit, double precision, one thread, reverse mode over chunks of {CHUNK} rows folded in XLA, compile time "
        "left out; the fit adds a lean Levenberg–Marquardt in NumPy",
        lambda quick: measure_functions(forward, residual_jacobian, fit, quick),
    )
