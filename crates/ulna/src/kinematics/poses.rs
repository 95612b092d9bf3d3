//! Encoder angles of many poses, in columns, and how warm the arm was.

use super::chain::Link;
use super::pose::{Pose, Sample};
use crate::simd::{Columns, Lanes};
use pulp::{Arch, Simd, WithSimd};
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

/// What a file says of many poses.
#[derive(Debug, Clone, Copy, Default)]
pub struct Angles<'a> {
    /// Row-major encoder angles, rad.
    pub q_rad: &'a [f64],
    /// Temperature above 20 °C, K: one a row, or row-major one for each joint; empty where it was 20 °C.
    pub warmth_k: &'a [f64],
}

impl<'a> Angles<'a> {
    /// Of 20 °C.
    pub fn cold(q_rad: &'a [f64]) -> Angles<'a> {
        Angles { q_rad, warmth_k: &[] }
    }

    /// In parts of at most `rows` poses.
    pub fn chunks(self, rows: usize, encoders: usize) -> impl Iterator<Item = Angles<'a>> {
        let all = self.q_rad.len() / encoders;
        let width = self.warmth_k.len().checked_div(all).unwrap_or(0);
        (0..all).step_by(rows.max(1)).map(move |start| {
            let end = all.min(start + rows);
            Angles {
                q_rad: &self.q_rad[start * encoders..end * encoders],
                warmth_k: &self.warmth_k[start * width..end * width],
            }
        })
    }

    /// One pose.
    pub fn pose(self, row: usize, encoders: usize) -> Pose<'a> {
        let width = self.warmth_k.len() * encoders / self.q_rad.len().max(1);
        Pose {
            q_rad: &self.q_rad[row * encoders..(row + 1) * encoders],
            warmth_k: &self.warmth_k[row * width..(row + 1) * width],
        }
    }
}

/// Encoder angles of many poses, with their sines and cosines where they are kept.
#[derive(Debug, Clone)]
pub struct Poses {
    pub(crate) q_rad: Columns,
    /// temperature above 20 °C: one column, or one for each joint; none for 20 °C
    warmth_k: Option<Columns>,
    /// sines in the first n columns, cosines in the next n
    pub(crate) sin_cos: Option<Columns>,
}

impl Poses {
    /// Poses from row-major angles, n a row, rad.
    pub fn from_rows(q_rad: &[f64], encoders: usize) -> Poses {
        Poses { q_rad: Columns::from_rows(q_rad, encoders), warmth_k: None, sin_cos: None }
    }

    /// Poses from row-major angles and warmth.
    pub fn new(angles: Angles, encoders: usize) -> Poses {
        let rows = angles.q_rad.len() / encoders;
        Poses { warmth_k: warmth(angles.warmth_k, rows, None), ..Poses::from_rows(angles.q_rad, encoders) }
    }

    /// Room for `rows` poses, to be filled again and again.
    pub(crate) fn room(encoders: usize, rows: usize) -> Poses {
        Poses { q_rad: Columns::zeros(encoders, rows), warmth_k: None, sin_cos: None }
    }

    /// Takes other poses, no more than there is room for; without sines and cosines.
    pub(crate) fn fill(&mut self, angles: Angles) {
        let (encoders, rows) = (self.encoders(), self.q_rad.rows());
        self.q_rad.fill_from_rows(angles.q_rad, encoders);
        self.warmth_k = warmth(angles.warmth_k, angles.q_rad.len() / encoders, Some(rows));
    }

    /// The angles, one column an encoder.
    pub fn q_rad(&self) -> &Columns {
        &self.q_rad
    }

    /// One pose, taken with a probe.
    pub fn sample(&self, row: usize, probe: usize) -> Sample {
        let of = |columns: &Columns| (0..columns.width()).map(|j| columns.column(j)[row]).collect();
        Sample { probe, q_rad: of(&self.q_rad), warmth_k: self.warmth_k.as_ref().map_or_else(Vec::new, of) }
    }

    /// Whether the temperature is known and not the same in all poses.
    pub fn warmth_range_k(&self) -> Option<(f64, f64)> {
        let warmth = self.warmth_k.as_ref()?;
        let all = (0..warmth.width()).flat_map(|j| &warmth.column(j)[..warmth.rows()]);
        Some(all.fold((f64::MAX, f64::MIN), |(low, high), &t| (low.min(t), high.max(t))))
    }

    /// Temperature above 20 °C of the link of joint `i`, for vector `k` of poses.
    #[inline(always)]
    pub(in crate::kinematics) fn warmth<S: Simd>(&self, simd: S, i: usize, k: usize) -> Lanes<S> {
        match &self.warmth_k {
            None => Lanes::splat(simd, 0.0),
            Some(warmth) => warmth.load(simd, if warmth.width() == 1 { 0 } else { i }, k),
        }
    }

    /// Sine and cosine of the encoder angle of joint `i` for vector `k` of poses.
    #[inline(always)]
    pub(in crate::kinematics) fn sin_cos_q<S: Simd>(&self, simd: S, i: usize, k: usize) -> (Lanes<S>, Lanes<S>) {
        match &self.sin_cos {
            Some(kept) => (kept.load(simd, i, k), kept.load(simd, self.encoders() + i, k)),
            None => self.q_rad.load(simd, i, k).sin_cos(),
        }
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
    pub(in crate::kinematics) fn turn<S: Simd>(
        &self,
        simd: S,
        link: &Link,
        i: usize,
        k: usize,
    ) -> (Lanes<S>, Lanes<S>) {
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
        self.q_rad.width()
    }

    /// Some rows of what a file says, in the order of `rows`.
    pub(crate) fn gathered(angles: Angles, encoders: usize, rows: &[usize]) -> Poses {
        let of_file = angles.q_rad.len() / encoders;
        let gather = |row_major: &[f64], width: usize| {
            let mut columns = Columns::zeros(width, rows.len());
            for j in 0..width {
                for (value, &row) in columns.column_mut(j).iter_mut().zip(rows) {
                    *value = row_major[row * width + j];
                }
            }
            columns
        };
        let warmth_k = (!angles.warmth_k.is_empty()).then(|| gather(angles.warmth_k, angles.warmth_k.len() / of_file));
        Poses { q_rad: gather(angles.q_rad, encoders), warmth_k, sin_cos: None }
    }

    /// Some of these poses, in the order of `rows`.
    pub(crate) fn picked(&self, rows: &[usize]) -> Poses {
        let warmth_k = self.warmth_k.as_ref().map(|warmth| warmth.picked(rows));
        Poses { q_rad: self.q_rad.picked(rows), warmth_k, sin_cos: None }
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

/// Warmth of `rows` poses in columns, with room for more where asked.
fn warmth(warmth_k: &[f64], rows: usize, room: Option<usize>) -> Option<Columns> {
    let width = warmth_k.len().checked_div(rows)?;
    if width == 0 {
        return None;
    }
    let mut columns = Columns::zeros(width, room.unwrap_or(rows));
    columns.fill_from_rows(warmth_k, width);
    Some(columns)
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
