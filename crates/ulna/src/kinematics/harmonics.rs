//! What eccentric encoders add to the turns, for vectors of poses.

use crate::arm::Harmonics;
use crate::simd::Lanes;
use pulp::Simd;

/// Amplitudes as the kernels use them.
#[derive(Debug, Clone)]
pub(super) struct Amplitudes {
    orders: Vec<u32>,
    /// of cosine and sine: for each joint, for each order
    pub(super) rad: Vec<[f64; 2]>,
}

impl Amplitudes {
    pub(super) fn new(harmonics: &Harmonics) -> Amplitudes {
        Amplitudes { orders: harmonics.orders.clone(), rad: harmonics.amplitudes_rad.clone() }
    }

    /// Columns of one joint.
    pub(super) fn of_joint(&self) -> usize {
        2 * self.orders.len()
    }

    /// Calls `each` with a joint's own number of each order and cos kq, sin kq, from cos q and sin q.
    #[inline(always)]
    pub(super) fn waves<S: Simd>(
        &self,
        sin_q: Lanes<S>,
        cos_q: Lanes<S>,
        mut each: impl FnMut(usize, Lanes<S>, Lanes<S>),
    ) {
        let (mut sin, mut cos, mut order) = (sin_q, cos_q, 1);
        for (number, &k) in self.orders.iter().enumerate() {
            while order < k {
                (sin, cos) = (sin.mul_add(cos_q, cos * sin_q), sin.neg_mul_add(sin_q, cos * cos_q));
                order += 1;
            }
            each(number, cos, sin);
        }
    }

    /// What is added to the encoder angle of joint `i`, rad.
    #[inline(always)]
    pub(super) fn added<S: Simd>(&self, simd: S, i: usize, sin_q: Lanes<S>, cos_q: Lanes<S>) -> Lanes<S> {
        let mut sum = Lanes::splat(simd, 0.0);
        let own = &self.rad[i * self.orders.len()..];
        self.waves(
            sin_q,
            cos_q,
            #[inline(always)]
            |number, cos, sin| {
                let [c, s] = own[number].map(|amplitude| Lanes::splat(simd, amplitude));
                sum = cos.mul_add(c, sin.mul_add(s, sum));
            },
        );
        sum
    }
}
