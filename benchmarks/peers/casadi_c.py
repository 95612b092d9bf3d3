"""CasADi: the residual as an expression, its derivatives as generated C code, compiled; a C loop folds the rows."""

import ctypes
import tempfile
from pathlib import Path

import casadi
import numpy as np
from numpy.typing import NDArray

from benchmarks.lengths import F64, FREE, Lengths
from benchmarks.levenberg_marquardt import minimise
from benchmarks.peers import Contender
from benchmarks.peers.native import FLAGS, compile_to
from benchmarks.tasks import measure_functions

#: loops over rows around the generated functions, and folds each row into JᵀJ, Jᵀr and rᵀr
LOOP = """
void forward_rows(long rows, const double* x, const double* q, double* out) {
    double w[forward_SZ_W + 1]; casadi_int iw[forward_SZ_IW + 1];
    for (long i = 0; i < rows; ++i) {
        const double* arg[forward_SZ_ARG + 2] = {x, q + 7 * i};
        double* res[forward_SZ_RES + 1] = {out + 3 * i};
        forward(arg, res, iw, w, 0);
    }
}
void fold_rows(long rows, const double* x, const double* q, const double* p, const double* length, double* gram) {
    double w[row_SZ_W + 1]; casadi_int iw[row_SZ_IW + 1];
    double r[26];
    for (int k = 0; k < 26 * 26; ++k) gram[k] = 0.0;
    for (long i = 0; i < rows; ++i) {
        const double* arg[row_SZ_ARG + 4] = {x, q + 7 * i, p + 7 * i, length + i};
        double* res[row_SZ_RES + 2] = {r + 25, r};
        row(arg, res, iw, w, 0);
        for (int a = 0; a < 26; ++a)
            for (int b = 0; b < 26; ++b) gram[26 * a + b] += r[a] * r[b];
    }
}
"""


def _tip(x: casadi.SX, q: casadi.SX) -> casadi.SX:
    px, py, pz = x[24], x[25], x[26]
    cos, sin = casadi.cos(q[6]), casadi.sin(q[6])
    px, py = cos * px - sin * py, sin * px + cos * py
    for i in range(5, -1, -1):
        ca, sa = casadi.cos(x[4 * i + 1]), casadi.sin(x[4 * i + 1])
        px, py, pz = px + x[4 * i + 2], ca * py - sa * pz, sa * py + ca * pz + x[4 * i + 3]
        cos, sin = casadi.cos(q[i] - x[4 * i]), casadi.sin(q[i] - x[4 * i])
        px, py = cos * px - sin * py, sin * px + cos * py
    return casadi.vertcat(px, py, pz)


def _library(folder: Path) -> ctypes.CDLL:
    x, q, p, length = (casadi.SX.sym(name, size) for name, size in (("x", 27), ("q", 7), ("p", 7), ("length", 1)))
    residual = casadi.norm_2(_tip(x, q) - _tip(x, p)) - length
    gradient = casadi.densify(casadi.jacobian(residual, x)[:, FREE.tolist()])
    generator = casadi.CodeGenerator("generated.c", {"with_header": False, "with_mem": False})
    sizes = ""
    for function in (
        casadi.Function("forward", [x, q], [_tip(x, q)]),
        casadi.Function("row", [x, q, p, length], [residual, gradient], {"cse": True}),
    ):
        generator.add(function)
        for size in ("sz_arg", "sz_res", "sz_iw", "sz_w"):
            sizes += f"#define {function.name()}_{size.upper()} {getattr(function, size)()}\n"
    source = folder / "generated.c"
    source.write_text(generator.dump() + sizes + LOOP)
    compile_to(folder / "generated.so", source, ["-shared", "-fPIC", "-lm"], cxx=False)
    return ctypes.CDLL(str(folder / "generated.so"))


def _pointer(values: NDArray[np.float64]) -> ctypes.c_void_p:
    return ctypes.c_void_p(values.ctypes.data)


def contender() -> Contender:
    with tempfile.TemporaryDirectory() as folder:
        library = _library(Path(folder))

    def forward(x: F64, q_rad: F64) -> F64:
        out = np.empty((len(q_rad), 3))
        library.forward_rows(ctypes.c_long(len(q_rad)), _pointer(x), _pointer(q_rad), _pointer(out))
        return out

    def folded(x: F64, data: Lengths) -> tuple[F64, F64, float]:
        gram = np.empty((26, 26))
        library.fold_rows(
            ctypes.c_long(len(data.length_mm)),
            _pointer(x),
            _pointer(data.q_rad),
            _pointer(data.p_rad),
            _pointer(data.length_mm),
            _pointer(gram),
        )
        return gram[:25, :25], gram[:25, 25], float(gram[25, 25])

    def fit(start: F64, data: Lengths) -> F64:
        return minimise(lambda x: folded(x, data), start)

    return Contender(
        "CasADi, generated C",
        f"CasADi {casadi.__version__}",
        f"C code from CasADi compiled with {' '.join(FLAGS)}, one row a call, rows folded in C; "
        "the fit adds a lean Levenberg–Marquardt in NumPy",
        lambda quick: measure_functions(forward, folded, fit, quick),
    )
