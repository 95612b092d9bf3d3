//! Encoder angles of many poses, in columns, and what was true at them.

use super::chain::Link;
use super::conditions::{Conditions, Held, PAYLOAD};
use super::pose::{Pose, Sample};
use crate::arm::effects::{EncoderLanes, Seen};
use crate::simd::{Columns, Lanes};
use pulp::{Arch, Simd, WithSimd};
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

/// What a file says of many poses. Of an encoder whose joint slides the "angles" are mm.
#[derive(Debug, Clone, Copy, Default)]
pub struct Angles<'a> {
    /// Row-major encoder angles, rad.
    pub q_rad: &'a [f64],
    /// What was true there.
    pub conditions: Conditions<'a>,
}

impl<'a> Angles<'a> {
    /// Of 20 °C, approached from nobody knows where.
    pub fn cold(q_rad: &'a [f64]) -> Angles<'a> {
        Angles { q_rad, conditions: Conditions::default() }
    }

    /// In parts of at most `rows` poses.
    pub fn chunks(self, rows: usize, encoders: usize) -> impl Iterator<Item = Angles<'a>> {
        let all = self.q_rad.len() / encoders;
        (0..all).step_by(rows.max(1)).map(move |start| {
            let end = all.min(start + rows);
            let q_rad = &self.q_rad[start * encoders..end * encoders];
            Angles { q_rad, conditions: self.conditions.part(start..end, all) }
        })
    }

    /// One pose.
    pub fn pose(self, row: usize, encoders: usize) -> Pose<'a> {
        let q_rad = &self.q_rad[row * encoders..(row + 1) * encoders];
        let conditions = self.conditions.part(row..row + 1, self.q_rad.len() / encoders);
        Pose { q_rad, conditions }
    }
}

/// Encoder angles of many poses, with their sines and cosines where they are kept.
#[derive(Debug, Clone)]
pub struct Poses {
    pub(crate) q_rad: Columns,
    conditions: Held,
    /// sines in the first n columns, cosines in the next n
    pub(crate) sin_cos: Option<Columns>,
}

impl Poses {
    /// Poses from row-major angles, n a row, rad.
    pub fn from_rows(q_rad: &[f64], encoders: usize) -> Poses {
        Poses::new(Angles::cold(q_rad), encoders)
    }

    /// Poses from row-major angles and what was true there.
    pub fn new(angles: Angles, encoders: usize) -> Poses {
        let rows = angles.q_rad.len() / encoders;
        let conditions = Held::new(angles.conditions, rows, None);
        Poses { q_rad: Columns::from_rows(angles.q_rad, encoders), conditions, sin_cos: None }
    }

    /// Room for `rows` poses, to be filled again and again.
    pub(crate) fn room(encoders: usize, rows: usize) -> Poses {
        Poses { q_rad: Columns::zeros(encoders, rows), conditions: Held::default(), sin_cos: None }
    }

    /// Takes other poses, no more than there is room for; without sines and cosines.
    pub(crate) fn fill(&mut self, angles: Angles) {
        let (encoders, rows) = (self.encoders(), self.q_rad.rows());
        self.q_rad.fill_from_rows(angles.q_rad, encoders);
        self.conditions = Held::new(angles.conditions, angles.q_rad.len() / encoders, Some(rows));
    }

    /// The angles, one column an encoder.
    pub fn q_rad(&self) -> &Columns {
        &self.q_rad
    }

    /// One pose, taken with a probe.
    pub fn sample(&self, row: usize, probe: usize) -> Sample {
        let q_rad = (0..self.encoders()).map(|j| self.q_rad.column(j)[row]).collect();
        let [warmth_k, approach, payload] = self.conditions.row(row);
        Sample { probe, q_rad, warmth_k, approach, payload }
    }

    /// What they show of what effects depend on.
    pub fn seen(&self) -> Seen {
        self.conditions.seen()
    }

    /// Temperature above 20 °C of the link of joint `i`, for vector `k` of poses.
    #[inline(always)]
    pub(in crate::kinematics) fn warmth<S: Simd>(&self, simd: S, i: usize, k: usize) -> Lanes<S> {
        self.conditions.warmth(simd, i, k)
    }

    /// What vector `k` of poses carried beside the arm's own masses, if any of all poses carried any.
    #[inline(always)]
    pub(in crate::kinematics) fn payload<S: Simd>(&self, simd: S, k: usize) -> Option<[Lanes<S>; PAYLOAD]> {
        self.conditions.payload(simd, k)
    }

    /// Sine and cosine of the encoder angle of joint `i` for vector `k` of poses.
    #[inline(always)]
    fn sin_cos_q<S: Simd>(&self, simd: S, i: usize, k: usize) -> (Lanes<S>, Lanes<S>) {
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
        if link.slides {
            return (c(-link.sin_theta0), c(link.cos_theta0));
        }
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

    /// Offset along the axis of joint `i` for vector `k` of poses: `d`, and what slides, mm.
    #[inline(always)]
    pub(in crate::kinematics) fn along<S: Simd>(&self, simd: S, link: &Link, i: usize, k: usize) -> Lanes<S> {
        let d = Lanes::splat(simd, link.d);
        match link.slides {
            false => d,
            true => self.q_rad.load(simd, i, k).mul_add(Lanes::splat(simd, link.sign), d),
        }
    }

    /// Number of encoders.
    #[inline(always)]
    pub fn encoders(&self) -> usize {
        self.q_rad.width()
    }

    /// Some rows of what a file says, in the order of `rows`.
    pub(crate) fn gathered(angles: Angles, encoders: usize, rows: &[usize]) -> Poses {
        let conditions = Held::gathered(angles.conditions, angles.q_rad.len() / encoders, rows);
        Poses { q_rad: Columns::gathered(angles.q_rad, encoders, rows), conditions, sin_cos: None }
    }

    /// Some of these poses, in the order of `rows`.
    pub(crate) fn picked(&self, rows: &[usize]) -> Poses {
        Poses { q_rad: self.q_rad.picked(rows), conditions: self.conditions.picked(rows), sin_cos: None }
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

/// What the encoder of one joint said, for one vector of poses.
pub(in crate::kinematics) struct EncoderOf<'a, S: Simd> {
    pub simd: S,
    pub poses: &'a Poses,
    pub joint: usize,
    /// which vector of poses
    pub k: usize,
}

impl<S: Simd> EncoderLanes<S> for EncoderOf<'_, S> {
    #[inline(always)]
    fn sin_cos(&self) -> (Lanes<S>, Lanes<S>) {
        self.poses.sin_cos_q(self.simd, self.joint, self.k)
    }

    #[inline(always)]
    fn approach(&self) -> Lanes<S> {
        self.poses.conditions.approach(self.simd, self.joint, self.k)
    }

    #[inline(always)]
    fn angle(&self, joint: usize) -> Lanes<S> {
        self.poses.q_rad.load(self.simd, joint, self.k)
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
