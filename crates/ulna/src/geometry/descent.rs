//! Gauss-Newton for a handful of unknowns, each step shortened until it lowers the cost; Newton where that takes long, as it
//! does where residuals are large.

use nalgebra::{SMatrix, SVector};

/// Steps to the best figure; some five are enough but for points that hardly show it.
pub(super) const TO_THE_END: usize = 60;
/// Steps after which, at the latest, what is left to do is done with second derivatives.
const GAUSS_NEWTON_STEPS: usize = 5;
/// A step this small against the figure's size is none.
const STILL: f64 = 1e-14;
/// A step that promises to lower the cost by a smaller part than this is taken unasked: the costs to be compared are
/// rounded more than that.
const PROMISE: f64 = 1e-9;

/// Normal equations `JᵀJ s = -Jᵀr` of the residuals at a state, and their sum of squares.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sum<const N: usize> {
    normal: SMatrix<f64, N, N>,
    /// what second derivatives add, `Σ r ∂²r`
    curvature: SMatrix<f64, N, N>,
    right: SVector<f64, N>,
    pub cost: f64,
}

impl<const N: usize> Sum<N> {
    pub fn new() -> Sum<N> {
        Sum { normal: SMatrix::zeros(), curvature: SMatrix::zeros(), right: SVector::zeros(), cost: 0.0 }
    }

    /// Takes a weighed residual times its second derivatives.
    #[inline(always)]
    pub fn bend(&mut self, curvature: SMatrix<f64, N, N>) {
        self.curvature += curvature;
    }

    /// Takes a weighed residual and its derivatives.
    #[inline(always)]
    pub fn add(&mut self, derivatives: SVector<f64, N>, residual: f64) {
        self.normal += derivatives * derivatives.transpose();
        self.right -= derivatives * residual;
        self.cost += residual * residual;
    }
}

/// The state of least cost near a start, or what so many steps come to, and its cost. Unknowns are lengths, `size` is one
/// that they compare with; `sum` is told whether second derivatives are asked for.
pub(super) fn settled<S, const N: usize>(
    start: S,
    steps: usize,
    size: f64,
    sum: impl Fn(&S, bool) -> Sum<N>,
    moved: impl Fn(&S, &SVector<f64, N>) -> S,
) -> (S, f64)
where
    nalgebra::Const<N>: nalgebra::DimMin<nalgebra::Const<N>, Output = nalgebra::Const<N>>,
{
    let mut state = start;
    let mut here = sum(&state, false);
    let (mut last, mut newton) = (f64::INFINITY, false);
    for number in 0..steps {
        // what no point shows stays as it is
        let shown = 1e-12 * here.normal.trace().max(f64::MIN_POSITIVE);
        let normal = here.normal + SMatrix::from_diagonal_element(shown);
        let curved = newton.then(|| (normal + here.curvature).cholesky()).flatten();
        let Some(factor) = curved.or_else(|| normal.cholesky()) else { break };
        let mut step = factor.solve(&here.right);
        let promised = step.dot(&here.right) <= PROMISE * here.cost;
        // steps that do not get smaller any more are rounding
        if promised && step.norm() >= last {
            break;
        }
        last = if promised && newton { step.norm() } else { f64::INFINITY };
        newton |= promised || number + 1 >= GAUSS_NEWTON_STEPS;
        let mut better = None;
        for _ in 0..30 {
            let next = moved(&state, &step);
            let there = sum(&next, newton);
            if promised || there.cost <= here.cost {
                better = Some((next, there));
                break;
            }
            step *= 0.5;
        }
        let Some(better) = better else { break };
        (state, here) = better;
        if step.norm() <= STILL * size {
            break;
        }
    }
    (state, here.cost)
}
