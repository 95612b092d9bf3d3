//! The forward map and its derivatives over many readings at once: columns of numbers, SIMD lanes, no allocation in the loop.
//!
//! A point is carried from the tip to the base (`forward`), remembering in each joint's frame what the derivatives
//! need. A direction is carried back from the base to the tip (`gradient`), giving the derivative of `direction · p`
//! with respect to every parameter on the way: about as much work as the map itself. Every residual is such a
//! direction or three, so the 3 × parameters Jacobian of a pose is never formed.

use super::lanes::{Lanes, PAD, padded};
use crate::arm::{Arm, JointModel};
use pulp::{Arch, Simd, WithSimd};
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Equally long columns of numbers, each padded with zeros to whole vectors.
#[derive(Debug, Clone, Default)]
pub struct Columns {
    data: Vec<f64>,
    stride: usize,
    rows: usize,
}

impl Columns {
    /// Columns of zeros.
    pub fn zeros(columns: usize, rows: usize) -> Columns {
        let stride = padded(rows);
        Columns {
            data: vec![0.0; columns * stride],
            stride,
            rows,
        }
    }

    /// Columns from row-major data of `columns` numbers a row.
    pub fn from_rows(row_major: &[f64], columns: usize) -> Columns {
        let mut result = Columns::zeros(columns, row_major.len() / columns);
        result.fill_from_rows(row_major, columns);
        result
    }

    fn fill_from_rows(&mut self, row_major: &[f64], columns: usize) {
        for (column, values) in self.data.chunks_exact_mut(self.stride.max(1)).take(columns).enumerate() {
            for (value, row) in values.iter_mut().zip(row_major.chunks_exact(columns)) {
                *value = row[column];
            }
        }
    }

    /// Number of rows, the padding left out.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// One column with its padding.
    #[inline(always)]
    pub fn column(&self, index: usize) -> &[f64] {
        &self.data[index * self.stride..][..self.stride]
    }

    /// One column with its padding, to write to.
    #[inline(always)]
    pub fn column_mut(&mut self, index: usize) -> &mut [f64] {
        &mut self.data[index * self.stride..][..self.stride]
    }
}

/// One joint's numbers as the kernels use them.
#[derive(Debug, Clone, Copy)]
struct Link {
    theta0: f64,
    sign: f64,
    cos_theta0: f64,
    sin_theta0: f64,
    cos_alpha: f64,
    sin_alpha: f64,
    a: f64,
    d: f64,
    /// cosine and sine of beta, for a Hayati joint
    beta: Option<(f64, f64)>,
}

/// An arm's geometry with its sines and cosines taken, ready for the kernels.
#[derive(Debug, Clone)]
pub struct Chain {
    links: Vec<Link>,
}

impl Chain {
    /// The chain of an arm, its probes left out.
    pub fn new(arm: &Arm) -> Chain {
        let links = arm.joints().iter().map(|j| Link {
            theta0: j.theta0_rad,
            sign: j.sign,
            cos_theta0: j.theta0_rad.cos(),
            sin_theta0: j.theta0_rad.sin(),
            cos_alpha: j.alpha_rad.cos(),
            sin_alpha: j.alpha_rad.sin(),
            a: j.a_mm,
            d: if j.model == JointModel::Dh { j.d_mm } else { 0.0 },
            beta: (j.model == JointModel::Hayati).then(|| (j.beta_rad.cos(), j.beta_rad.sin())),
        });
        let last = Link {
            theta0: 0.0,
            sign: arm.signs().last().unwrap_or(1.0),
            cos_theta0: 1.0,
            sin_theta0: 0.0,
            cos_alpha: 1.0,
            sin_alpha: 0.0,
            a: 0.0,
            d: 0.0,
            beta: None,
        };
        Chain {
            links: links.chain([last]).collect(),
        }
    }

    /// Takes other numbers for the joints, four a joint in the order of [`Arm::parameters`].
    pub fn set_joint_parameters(&mut self, parameters: &[f64]) {
        for (link, p) in self.links.iter_mut().zip(parameters.chunks_exact(4)) {
            link.theta0 = p[0];
            (link.sin_theta0, link.cos_theta0) = p[0].sin_cos();
            (link.sin_alpha, link.cos_alpha) = p[1].sin_cos();
            link.a = p[2];
            match &mut link.beta {
                Some((cos_beta, sin_beta)) => (*sin_beta, *cos_beta) = p[3].sin_cos(),
                None => link.d = p[3],
            }
        }
    }

    /// Number of encoders.
    pub fn encoders(&self) -> usize {
        self.links.len()
    }

    /// Number of parameters of the joints.
    pub fn joint_parameter_count(&self) -> usize {
        4 * (self.links.len() - 1)
    }

    /// Vectors of scratch that one pose of every lane needs.
    pub(crate) fn scratch_len(&self) -> usize {
        self.links.len() * SLOTS * PAD
    }
}

/// Encoder angles of many poses, with their sines and cosines where they are kept.
#[derive(Debug, Clone)]
pub struct Poses {
    q_rad: Columns,
    /// sines in the first n columns, cosines in the next n
    sin_cos: Option<Columns>,
}

impl Poses {
    /// Poses from row-major angles, n a row, rad.
    pub fn from_rows(q_rad: &[f64], encoders: usize) -> Poses {
        Poses {
            q_rad: Columns::from_rows(q_rad, encoders),
            sin_cos: None,
        }
    }

    /// The angles, one column an encoder.
    pub fn q_rad(&self) -> &Columns {
        &self.q_rad
    }

    /// One pose's angles.
    pub fn pose(&self, row: usize) -> Vec<f64> {
        (0..self.encoders())
            .map(|j| self.q_rad.column(j)[row])
            .collect()
    }

    /// Takes all sines and cosines once: a fit then never takes them again, since `turn = reading - theta0`.
    pub fn keep_sin_cos(&mut self) {
        let columns = self.encoders();
        let mut kept = Columns::zeros(2 * columns, self.q_rad.rows);
        let (sin, cos) = kept.data.split_at_mut(self.q_rad.data.len());
        Arch::new().dispatch(SinCosOp {
            q: &self.q_rad.data,
            sin,
            cos,
        });
        self.sin_cos = Some(kept);
    }

    /// Sine and cosine of the turn of joint `i` for vector `k` of poses.
    #[inline(always)]
    fn turn<S: Simd>(&self, simd: S, link: &Link, i: usize, k: usize) -> (Lanes<S>, Lanes<S>) {
        let c = |value: f64| Lanes::splat(simd, value);
        match &self.sin_cos {
            Some(kept) => {
                let sin_q = Lanes::load(simd, kept.column(i), k) * c(link.sign);
                let cos_q = Lanes::load(simd, kept.column(self.encoders() + i), k);
                let (sin0, cos0) = (c(link.sin_theta0), c(link.cos_theta0));
                (
                    cos_q.neg_mul_add(sin0, sin_q * cos0),
                    sin_q.mul_add(sin0, cos_q * cos0),
                )
            }
            None => {
                let q = Lanes::load(simd, self.q_rad.column(i), k);
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
        Poses {
            q_rad: columns,
            sin_cos: None,
        }
    }

    /// Some of these poses, in the order of `rows`.
    pub(crate) fn picked(&self, rows: &[usize]) -> Poses {
        let mut q_rad = Columns::zeros(self.encoders(), rows.len());
        for j in 0..self.encoders() {
            for (value, &row) in q_rad.column_mut(j).iter_mut().zip(rows) {
                *value = self.q_rad.column(j)[row];
            }
        }
        Poses { q_rad, sin_cos: None }
    }

    /// Adds normal noise to every angle, sigma per encoder (none where the slice ends).
    pub(crate) fn add_noise(&mut self, sigma_rad: &[f64], rng: &mut Xoshiro256PlusPlus) {
        let rows = self.q_rad.rows;
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

/// Vectors remembered for each joint: sin and cos of the turn, X, Y and z of the point, and x, z before beta.
const SLOTS: usize = 7;

/// Carries the tip of vector `k` of poses to the base; leaves in `scratch` what [`gradient`] needs.
#[inline(always)]
pub(crate) fn forward<S: Simd>(
    simd: S,
    chain: &Chain,
    poses: &Poses,
    k: usize,
    tip: [Lanes<S>; 3],
    scratch: &mut [f64],
) -> [Lanes<S>; 3] {
    let c = |value: f64| Lanes::splat(simd, value);
    let [mut x, mut y, mut z] = tip;
    for (i, link) in chain.links.iter().enumerate().rev() {
        let slot = i * SLOTS;
        if let Some((cos_beta, sin_beta)) = link.beta {
            let before = x;
            x = z.mul_add(c(sin_beta), before * c(cos_beta));
            z = before.neg_mul_add(c(sin_beta), z * c(cos_beta));
            x.store(scratch, slot + 5);
            z.store(scratch, slot + 6);
        }
        if i + 1 < chain.links.len() {
            let before = y;
            y = z.neg_mul_add(c(link.sin_alpha), before * c(link.cos_alpha));
            z = before.mul_add(c(link.sin_alpha), z * c(link.cos_alpha));
            z.store(scratch, slot + 4);
            x = x + c(link.a);
            z = z + c(link.d);
        }
        let (sin, cos) = poses.turn(simd, link, i, k);
        sin.store(scratch, slot);
        cos.store(scratch, slot + 1);
        x.store(scratch, slot + 2);
        y.store(scratch, slot + 3);
        let before = x;
        x = y.neg_mul_add(sin, before * cos);
        y = before.mul_add(sin, y * cos);
    }
    [x, y, z]
}

/// Carries a direction of the base frame to the tip after [`forward`] and emits, for each parameter of the joints
/// and then x, y, z of the tip, the derivative of `direction · p`; last, that with respect to the last joint's turn.
#[inline(always)]
pub(crate) fn gradient<S: Simd>(
    simd: S,
    chain: &Chain,
    scratch: &[f64],
    direction: [Lanes<S>; 3],
    mut emit: impl FnMut(usize, Lanes<S>),
) {
    let c = |value: f64| Lanes::splat(simd, value);
    let [mut gx, mut gy, mut gz] = direction;
    for (i, link) in chain.links.iter().enumerate() {
        let at = |slot: usize| Lanes::load(simd, scratch, i * SLOTS + slot);
        let (sin, cos, x, y) = (at(0), at(1), at(2), at(3));
        let before = gx;
        gx = gy.mul_add(sin, before * cos);
        gy = before.neg_mul_add(sin, gy * cos);
        // direction · (z × p) = x gy - y gx
        let minus_turn = y.mul_add(gx, -(x * gy));
        if i + 1 == chain.links.len() {
            emit(4 * i, gx);
            emit(4 * i + 1, gy);
            emit(4 * i + 2, gz);
            emit(4 * i + 3, -minus_turn);
            return;
        }
        emit(4 * i, minus_turn);
        let z = at(4);
        emit(4 * i + 1, gz.mul_add(y, -(gy * z)));
        emit(4 * i + 2, gx);
        if link.beta.is_none() {
            emit(4 * i + 3, gz);
        }
        let before = gy;
        gy = gz.mul_add(c(link.sin_alpha), before * c(link.cos_alpha));
        gz = before.neg_mul_add(c(link.sin_alpha), gz * c(link.cos_alpha));
        if let Some((cos_beta, sin_beta)) = link.beta {
            let (x, z) = (at(5), at(6));
            emit(4 * i + 3, gx.mul_add(z, -(gz * x)));
            let before = gx;
            gx = gz.neg_mul_add(c(sin_beta), before * c(cos_beta));
            gz = before.mul_add(c(sin_beta), gz * c(cos_beta));
        }
    }
}

/// Tip positions of all poses into `out` (three columns, mm, base frame); `tips` has the tip of each pose (three columns).
pub fn tips_mm(chain: &Chain, poses: &Poses, tips: &Columns, out: &mut Columns) {
    let mut scratch = vec![0.0; chain.scratch_len()];
    Arch::new().dispatch(TipsOp {
        chain,
        poses,
        tip: Tip::Each(tips),
        out,
        scratch: &mut scratch,
    });
}

/// Tip positions of all poses with one probe into `out` (three columns, mm, base frame).
pub fn tips_of_probe_mm(chain: &Chain, poses: &Poses, tip_mm: [f64; 3], out: &mut Columns) {
    let mut scratch = vec![0.0; chain.scratch_len()];
    Arch::new().dispatch(TipsOp {
        chain,
        poses,
        tip: Tip::Same(tip_mm),
        out,
        scratch: &mut scratch,
    });
}

/// Tip positions from row-major angles into row-major positions, one probe: the same, tile by tile in the cache.
pub fn tips_from_rows_mm(chain: &Chain, tip_mm: [f64; 3], q_rad: &[f64], out_mm: &mut [f64]) {
    const TILE: usize = 256;
    let n = chain.encoders();
    let mut poses = Poses {
        q_rad: Columns::zeros(n, TILE),
        sin_cos: None,
    };
    let mut tile = Columns::zeros(3, TILE);
    let mut scratch = vec![0.0; chain.scratch_len()];
    for (q, out) in q_rad.chunks(TILE * n).zip(out_mm.chunks_mut(TILE * 3)) {
        poses.q_rad.fill_from_rows(q, n);
        Arch::new().dispatch(TipsOp {
            chain,
            poses: &poses,
            tip: Tip::Same(tip_mm),
            out: &mut tile,
            scratch: &mut scratch,
        });
        let (x, y, z) = (tile.column(0), tile.column(1), tile.column(2));
        for (row, p) in out.chunks_exact_mut(3).enumerate() {
            p.copy_from_slice(&[x[row], y[row], z[row]]);
        }
    }
}

/// Calls `each(row, component, column, value)` with ∂p/∂(joint parameters, tip, turn of the last joint) of every pose of
/// row-major angles, mm/rad and mm/mm.
pub fn for_each_derivative(chain: &Chain, tip_mm: [f64; 3], q_rad: &[f64], mut each: impl FnMut(usize, usize, usize, f64)) {
    const TILE: usize = 64;
    let n = chain.encoders();
    let columns = chain.joint_parameter_count() + 4;
    let mut poses = Poses {
        q_rad: Columns::zeros(n, TILE),
        sin_cos: None,
    };
    let mut tile = Columns::zeros(3 * columns, TILE);
    let mut scratch = vec![0.0; chain.scratch_len()];
    for (t, q) in q_rad.chunks(TILE * n).enumerate() {
        poses.q_rad.fill_from_rows(q, n);
        Arch::new().dispatch(DerivativesOp {
            chain,
            poses: &poses,
            tip_mm,
            tile: &mut tile,
            scratch: &mut scratch,
        });
        for component in 0..3 {
            for column in 0..columns {
                let values = &tile.column(component * columns + column)[..q.len() / n];
                for (row, &value) in values.iter().enumerate() {
                    each(t * TILE + row, component, column, value);
                }
            }
        }
    }
}

struct DerivativesOp<'a> {
    chain: &'a Chain,
    poses: &'a Poses,
    tip_mm: [f64; 3],
    tile: &'a mut Columns,
    scratch: &'a mut [f64],
}

impl WithSimd for DerivativesOp<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let columns = self.chain.joint_parameter_count() + 4;
        let tip = self.tip_mm.map(|t| Lanes::splat(simd, t));
        for k in 0..self.poses.q_rad.stride / S::F64_LANES {
            forward(simd, self.chain, self.poses, k, tip, self.scratch);
            for component in 0..3 {
                let axis = |j: usize| Lanes::splat(simd, if j == component { 1.0 } else { 0.0 });
                gradient(simd, self.chain, self.scratch, [axis(0), axis(1), axis(2)], |column, value| {
                    value.store(self.tile.column_mut(component * columns + column), k);
                });
            }
        }
    }
}

#[derive(Clone, Copy)]
enum Tip<'a> {
    Same([f64; 3]),
    Each(&'a Columns),
}

struct TipsOp<'a> {
    chain: &'a Chain,
    poses: &'a Poses,
    tip: Tip<'a>,
    out: &'a mut Columns,
    scratch: &'a mut [f64],
}

impl WithSimd for TipsOp<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for k in 0..self.poses.q_rad.stride / S::F64_LANES {
            let tip = match self.tip {
                Tip::Same(tip) => tip.map(|t| Lanes::splat(simd, t)),
                Tip::Each(tips) => [0, 1, 2].map(|j| Lanes::load(simd, tips.column(j), k)),
            };
            let p = forward(simd, self.chain, self.poses, k, tip, self.scratch);
            for (j, value) in p.into_iter().enumerate() {
                value.store(self.out.column_mut(j), k);
            }
        }
    }
}

/// Which instruction set the kernels run on: `avx512`, `avx2`, `neon` or `scalar`.
pub fn simd_level() -> &'static str {
    struct Level;
    impl WithSimd for Level {
        type Output = &'static str;
        fn with_simd<S: Simd>(self, _: S) -> &'static str {
            match S::F64_LANES {
                8 => "avx512",
                4 => "avx2",
                2 => "neon",
                _ => "scalar",
            }
        }
    }
    Arch::new().dispatch(Level)
}
