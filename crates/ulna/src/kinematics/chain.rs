//! An arm's geometry, and what it does beyond it, as the kernels use them.

use super::carried::Carried;
use crate::arm::effects::{Base, BaseOffset, BaseTilt, Compliance, Expansion, FromStated};
use crate::arm::{Arm, Effects, JointModel};
use crate::simd::Lanes;
use pulp::Simd;

/// One joint's numbers as the kernels use them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Link {
    pub(crate) theta0: f64,
    pub(crate) sign: f64,
    pub(crate) cos_theta0: f64,
    pub(crate) sin_theta0: f64,
    pub(crate) cos_alpha: f64,
    pub(crate) sin_alpha: f64,
    pub(crate) a: f64,
    pub(crate) d: f64,
    /// cosine and sine of beta, for a Hayati joint
    pub(crate) beta: Option<(f64, f64)>,
    /// a last joint that only turns the tip
    pub(crate) bare: bool,
    /// it slides along its axis and does not turn
    pub(crate) slides: bool,
}

/// An arm's geometry with its sines and cosines taken, ready for the kernels.
///
/// Its derivatives come in columns: four for each joint with a link, x, y, z of the tip, one for each parameter of the
/// effects, and, behind all parameters, the turn of the last joint.
#[derive(Debug, Clone)]
pub struct Chain {
    pub(crate) links: Vec<Link>,
    pub(super) effects: Effects,
    pub(super) columns: EffectColumns,
    /// what the arm carries, if that bends it
    pub(super) carried: Option<Carried>,
    /// where its first axis stands, if not at z of the base frame
    pub(super) base: Option<Base>,
}

/// Where the derivatives of effects stand, counted from those of the first.
#[derive(Debug, Clone, Default)]
pub(super) struct EffectColumns {
    /// of each joint, those of effects that add to the angle of its encoder
    of_encoder: Vec<Vec<usize>>,
    /// all of them
    pub(super) on_encoders: usize,
    pub(super) expansion: usize,
    pub(super) compliance: usize,
    pub(super) base_tilt: usize,
    pub(super) base_offset: usize,
    count: usize,
}

impl EffectColumns {
    fn new(effects: &Effects, encoders: usize) -> EffectColumns {
        let (mut of_encoder, mut first) = (vec![vec![]; encoders], 0);
        for effect in effects.on_encoder() {
            for (joint, own) in of_encoder.iter_mut().enumerate() {
                own.extend(effect.of_joint(joint).map(|value| first + value));
            }
            first += effect.values().len();
        }
        EffectColumns {
            of_encoder,
            on_encoders: first,
            expansion: effects.start_of(Expansion::KIND),
            compliance: effects.start_of(Compliance::KIND),
            base_tilt: effects.start_of(BaseTilt::KIND),
            base_offset: effects.start_of(BaseOffset::KIND),
            count: effects.count(),
        }
    }

    /// Those of one joint's encoder.
    #[inline(always)]
    pub(super) fn of_encoder(&self, joint: usize) -> impl Iterator<Item = usize> {
        self.of_encoder[joint].iter().copied()
    }
}

impl Chain {
    /// The chain of an arm, its probes left out.
    pub fn new(arm: &Arm) -> Chain {
        let links = arm.joints().iter().enumerate().map(|(i, j)| Link {
            theta0: j.theta0_rad,
            sign: j.sign,
            cos_theta0: j.theta0_rad.cos(),
            sin_theta0: j.theta0_rad.sin(),
            cos_alpha: j.alpha_rad.cos(),
            sin_alpha: j.alpha_rad.sin(),
            a: j.a_mm,
            d: if j.model == JointModel::Dh { j.d_mm } else { 0.0 },
            beta: (j.model == JointModel::Hayati).then(|| (j.beta_rad.cos(), j.beta_rad.sin())),
            bare: false,
            slides: arm.slides(i),
        });
        let bare = Link {
            theta0: 0.0,
            sign: arm.signs().last().unwrap_or(1.0),
            cos_theta0: 1.0,
            sin_theta0: 0.0,
            cos_alpha: 1.0,
            sin_alpha: 0.0,
            a: 0.0,
            d: 0.0,
            beta: None,
            bare: true,
            slides: arm.slides(arm.encoders() - 1),
        };
        Chain {
            links: links.chain((!arm.has_full_last_link()).then_some(bare)).collect(),
            effects: arm.effects().clone(),
            columns: EffectColumns::new(arm.effects(), arm.encoders()),
            carried: arm.effects().compliance.as_ref().map(Carried::new),
            base: Base::of(arm.effects().base_tilt.as_ref(), arm.effects().base_offset.as_ref()),
        }
    }

    /// Takes other numbers for the joints, four a joint in the order of [`Arm::parameters`], and for the effects.
    pub fn set_parameters(&mut self, joints: &[f64], effects: &[f64]) {
        for (link, p) in self.links.iter_mut().zip(joints.chunks_exact(4)) {
            link.theta0 = p[0];
            (link.sin_theta0, link.cos_theta0) = p[0].sin_cos();
            (link.sin_alpha, link.cos_alpha) = p[1].sin_cos();
            link.a = p[2];
            match &mut link.beta {
                Some((cos_beta, sin_beta)) => (*sin_beta, *cos_beta) = p[3].sin_cos(),
                None => link.d = p[3],
            }
        }
        self.effects.set(effects);
        self.base = Base::of(self.effects.base_tilt.as_ref(), self.effects.base_offset.as_ref());
    }

    /// Number of encoders.
    pub fn encoders(&self) -> usize {
        self.links.len()
    }

    /// Number of parameters of the joints.
    pub fn joint_parameter_count(&self) -> usize {
        4 * (self.links.len() - usize::from(self.links.last().is_some_and(|link| link.bare)))
    }

    /// Number of derivatives that are of parameters: joints, tip and effects.
    pub fn parameter_columns(&self) -> usize {
        self.effect_column() + self.columns.count
    }

    /// The first of those of effects.
    #[inline(always)]
    pub(super) fn effect_column(&self) -> usize {
        self.joint_parameter_count() + 3
    }

    /// The column behind them: the derivative with respect to what the last joint does, its turn or its shift.
    pub fn turn_column(&self) -> usize {
        self.parameter_columns()
    }

    /// The column that says how the tip follows an encoder, but for the sign.
    pub(crate) fn encoder_column(&self, encoder: usize) -> usize {
        match 4 * encoder {
            first if first >= self.joint_parameter_count() => self.turn_column(),
            // what slides moves the tip as its d does
            first if self.links[encoder].slides => first + 3,
            first => first,
        }
    }

    /// How the tip follows every encoder, from how it follows every turn, in place: a number for each encoder as in its
    /// [column](Self::encoder_column), but for the sign.
    /// add: own + other · ratio.
    #[inline(always)]
    pub(crate) fn by_encoders<T: Copy>(&self, by_turn: &mut [T], add: impl Fn(T, T, f64) -> T) {
        let Some(coupling) = &self.effects.coupling else { return };
        // the derivative by theta0 of a joint with a link is minus that by its turn
        let sense = |i: usize| if self.links[i].bare { self.links[i].sign } else { -self.links[i].sign };
        let given: Vec<T> = by_turn.to_vec();
        for (joint, other, ratio) in coupling.pairs() {
            by_turn[other] = add(by_turn[other], given[joint], sense(joint) * sense(other) * ratio);
        }
    }

    /// The same for vectors of poses.
    #[inline(always)]
    pub(crate) fn by_encoders_in_lanes<S: Simd>(&self, simd: S, by_turn: &mut [Lanes<S>]) {
        self.by_encoders(
            by_turn,
            #[inline(always)]
            |own, of_other, ratio| of_other.mul_add(Lanes::splat(simd, ratio), own),
        );
    }

    /// Which encoder a column is that of, if it is one.
    #[inline(always)]
    pub(crate) fn encoder_of(&self, column: usize) -> Option<usize> {
        let joints = self.joint_parameter_count();
        match column {
            c if c < joints => (c == self.encoder_column(c / 4)).then_some(c / 4),
            c if c == self.turn_column() && joints < 4 * self.links.len() => Some(self.links.len() - 1),
            _ => None,
        }
    }

    /// Which parameter of an arm with so many probes a column is, if it is one: tips are those of `probe`.
    pub fn parameter_of(&self, column: usize, probe: usize, probes: usize) -> Option<usize> {
        let joints = self.joint_parameter_count();
        match column {
            c if c < joints => Some(c),
            c if c < joints + 3 => Some(c + 3 * probe),
            c if c < self.turn_column() => Some(c + 3 * (probes - 1)),
            _ => None,
        }
    }

    /// Whether there is anything but geometry.
    pub(super) fn has_effects(&self) -> bool {
        self.columns.count > 0
    }
}
