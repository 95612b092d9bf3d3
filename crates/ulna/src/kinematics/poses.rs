//! Encoder angles of many poses, in columns.

use super::chain::Link;
use crate::simd::{Columns, Lanes};
use pulp::{Arch, Simd, WithSimd};
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Encoder angles of many poses, with their sines and cosines where they are kept.
#[derive(Debug, Clone)]
pub struct Poses {
    pub(crate) q_rad: Columns,
    /// sines in the first n columns, cosines in the next n
    pub(crate) sin_cos: Option<Columns>,
}

impl Poses {
    /// Poses from row-major angles, n a row, rad.
    pub fn from_rows(q_rad: &[f64], encoders: usize) -> Poses {
        Poses { q_rad: Columns::from_rows(q_rad, encoders), sin_cos: None }
    }

    /// The angles, one column an encoder.
    pub fn q_rad(&self) -> &Columns {
        &self.q_rad
    }

    /// One pose's angles.
    pub fn pose(&self, row: usize) -> Vec<f64> {
        (0..self.encoders()).map(|j| self.q_rad.column(j)[row]).collect()
    }

    /// Takes all sines and cosines once: a fit then never takes them again, since `turn = reading - theta0`.
    pub fn keep_sin_cos(&mut self) {
        let columns = self.encoders();
        let mut kept = Columns::zeros(2 * columns, self.q_rad.rows());
        let (sin, cos) = kept.data.split_at_mut(self.q_rad.data.len());
        Arch::new().dispatch(SinCosOp { q: &self.q_rad.data, sin, cos });
        self.sin_cos = Some(kept);
    }

    /// Sine and cosine of the turn of joint `i` for vector `k` of poses.
    #[inline(always)]
    pub(super) fn turn<S: Simd>(&self, simd: S, link: &Link, i: usize, k: usize) -> (Lanes<S>, Lanes<S>) {
        let c = |value: f64| Lanes::splat(simd, value);
        match &self.sin_cos {
            Some(kept) => {
                let sin_q = kept.load(simd, i, k) * c(link.sign);
                let cos_q = kept.load(simd, self.encoders() + i, k);
                let (sin0, cos0) = (c(link.sin_theta0), c(link.cos_theta0));
                (cos_q.neg_mul_add(sin0, sin_q * cos0), sin_q.mul_add(sin0, cos_q * cos0))
            }
            None => {
                let q = self.q_rad.load(simd, i, k);
                q.mul_add(c(link.sign), c(-link.theta0)).sin_cos()
            }
        }
    }

    /// Number of encoders.
    #[inline(always)]
    pub fn encoders(&self) -> usize {
        self.q_rad.data.len() / self.q_rad.stride.max(1)
    }

    /// Some rows of row-major angles, in the order of `rows`.
    pub(crate) fn gathered(q_rad: &[f64], encoders: usize, rows: &[usize]) -> Poses {
        let mut columns = Columns::zeros(encoders, rows.len());
        for j in 0..encoders {
            for (value, &row) in columns.column_mut(j).iter_mut().zip(rows) {
                *value = q_rad[row * encoders + j];
            }
        }
        Poses { q_rad: columns, sin_cos: None }
    }

    /// Some of these poses, in the order of `rows`.
    pub(crate) fn picked(&self, rows: &[usize]) -> Poses {
        Poses { q_rad: self.q_rad.picked(rows), sin_cos: None }
    }

    /// Adds normal noise to every angle, sigma per encoder (none where the slice ends).
    pub(crate) fn add_noise(&mut self, sigma_rad: &[f64], rng: &mut Xoshiro256PlusPlus) {
        let rows = self.q_rad.rows();
        for (j, sigma) in sigma_rad.iter().enumerate() {
            for value in &mut self.q_rad.column_mut(j)[..rows] {
                let normal: f64 = StandardNormal.sample(rng);
                *value += sigma * normal;
            }
        }
        if self.sin_cos.is_some() {
            self.keep_sin_cos();
        }
    }
}

struct SinCosOp<'a> {
    q: &'a [f64],
    sin: &'a mut [f64],
    cos: &'a mut [f64],
}

impl WithSimd for SinCosOp<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for k in 0..self.q.len() / S::F64_LANES {
            let (sin, cos) = Lanes::load(simd, self.q, k).sin_cos();
            sin.store(self.sin, k);
            cos.store(self.cos, k);
        }
    }
}
