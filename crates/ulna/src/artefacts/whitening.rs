//! Weights of touches: the inverse root of each reading's covariance.

use super::noise::Weighing;
use super::tile::Directions;
use crate::simd::{Columns, Lanes};
use nalgebra::Matrix3;
use pulp::Simd;

/// `W` with `WᵀW = Σ⁻¹`, lower triangular.
#[derive(Debug, Clone)]
pub(in crate::artefacts) enum Whitening {
    /// The same in all directions, for all readings.
    Same(f64),
    /// The same in all directions, for each reading: one column.
    Round(Columns),
    /// Row by row of the triangle: six columns.
    Each(Columns),
}

impl Whitening {
    /// Of `count` readings, told apart by direction or not.
    pub fn weighed(self, how: Weighing, count: usize) -> Whitening {
        match how {
            Weighing::Full => self,
            Weighing::Even => self.even(count),
        }
    }

    /// Root of the weight of one reading, equal in effect where it differs by direction.
    pub fn weight(&self, row: usize) -> f64 {
        (self.at(row).norm_squared() / 3.0).sqrt()
    }

    /// One weight for all: that of the mean variance of `count` readings.
    fn even(self, count: usize) -> Whitening {
        let variance = |row: usize| self.weight(row).powi(-2);
        let mean = (0..count).map(variance).sum::<f64>() / count.max(1) as f64;
        Whitening::Same(mean.sqrt().recip())
    }

    /// With each reading's weight multiplied by a factor.
    pub fn times(&self, factors: &[f64]) -> Whitening {
        let scaled = |of: &Columns| {
            let mut scaled = of.clone();
            for k in 0..of.width() {
                scaled.column_mut(k).iter_mut().zip(factors).for_each(|(w, factor)| *w *= factor);
            }
            scaled
        };
        match self {
            Whitening::Same(w) => {
                let each: Vec<f64> = factors.iter().map(|factor| factor * w).collect();
                Whitening::Round(Columns::from_rows(&each, 1))
            }
            Whitening::Round(w) => Whitening::Round(scaled(w)),
            Whitening::Each(w) => Whitening::Each(scaled(w)),
        }
    }

    /// `W` of one reading.
    pub fn at(&self, row: usize) -> Matrix3<f64> {
        match self {
            Whitening::Same(w) => Matrix3::from_diagonal_element(*w),
            Whitening::Round(w) => Matrix3::from_diagonal_element(w.column(0)[row]),
            Whitening::Each(w) => {
                let at = |k: usize| w.column(k)[row];
                Matrix3::new(at(0), 0.0, 0.0, at(1), at(2), 0.0, at(3), at(4), at(5))
            }
        }
    }

    /// Whether each reading weighs alike in all directions.
    pub fn is_isotropic(&self) -> bool {
        !matches!(self, Whitening::Each(_))
    }

    /// Those of some readings.
    pub fn picked(&self, rows: &[usize]) -> Whitening {
        match self {
            Whitening::Same(w) => Whitening::Same(*w),
            Whitening::Round(w) => Whitening::Round(w.picked(rows)),
            Whitening::Each(w) => Whitening::Each(w.picked(rows)),
        }
    }
}

/// Row `component` of `W`: the direction whose residual it weighs.
impl Directions for Whitening {
    const COUNT: usize = 3;

    #[inline(always)]
    fn direction<S: Simd>(&self, simd: S, _: usize, component: usize, k: usize) -> [Lanes<S>; 3] {
        let mut direction = [Lanes::splat(simd, 0.0); 3];
        match self {
            Whitening::Same(w) => direction[component] = Lanes::splat(simd, *w),
            Whitening::Round(w) => direction[component] = w.load(simd, 0, k),
            Whitening::Each(w) => {
                let row = component * (component + 1) / 2;
                for (j, value) in direction.iter_mut().enumerate().take(component + 1) {
                    *value = w.load(simd, row + j, k);
                }
            }
        }
        direction
    }
}
