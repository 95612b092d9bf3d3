//! All effects: one row each.

use super::backlash::Backlash;
use super::base::{BaseOffset, BaseTilt};
use super::compliance::Compliance;
use super::coupling::Coupling;
use super::effect::{Effect, FromStated};
use super::expansion::Expansion;
use super::harmonics::Harmonics;
use super::on_encoder::{Encoder, EncoderLanes, OnEncoder};
use super::stated::Stated;
use crate::error::{Error, Result};
use crate::simd::Lanes;
use pulp::Simd;

/// Writes [`Effects`] and all that goes through every one of them.
macro_rules! registry {
    (
        on_encoder { $($(#[$encoder_doc:meta])* $encoder:ident: $Encoder:ty,)* }
        elsewhere { $($(#[$other_doc:meta])* $other:ident: $Other:ty,)* }
    ) => {
        /// What an arm does beyond its geometry. The order of the fields is that of the parameters.
        #[derive(Debug, Clone, PartialEq, Default)]
        pub struct Effects {
            $($(#[$encoder_doc])* pub $encoder: Option<$Encoder>,)*
            $($(#[$other_doc])* pub $other: Option<$Other>,)*
        }

        impl Effects {
            /// The words by which studies ask for effects.
            pub const KINDS: &'static [&'static str] = &[$(<$Encoder>::KIND,)* $(<$Other>::KIND,)*];

            /// Those that there are, in the order of their parameters.
            pub fn all(&self) -> impl Iterator<Item = &dyn Effect> {
                let each = [
                    $(self.$encoder.as_ref().map(|effect| effect as &dyn Effect),)*
                    $(self.$other.as_ref().map(|effect| effect as &dyn Effect),)*
                ];
                each.into_iter().flatten()
            }

            fn all_mut(&mut self) -> impl Iterator<Item = &mut dyn Effect> {
                let each = [
                    $(self.$encoder.as_mut().map(|effect| effect as &mut dyn Effect),)*
                    $(self.$other.as_mut().map(|effect| effect as &mut dyn Effect),)*
                ];
                each.into_iter().flatten()
            }

            /// Those that add to the angles of the encoders: their parameters come first.
            pub(crate) fn on_encoder(&self) -> impl Iterator<Item = &dyn OnEncoder> {
                let each = [$(self.$encoder.as_ref().map(|effect| effect as &dyn OnEncoder),)*];
                each.into_iter().flatten()
            }

            /// Calls `each` with every parameter that adds to the angle of a joint's encoder: its number among those of
            /// the effects, its value, and its shape for a vector of poses.
            #[inline(always)]
            pub(crate) fn shapes_in_lanes<S: Simd>(
                &self,
                simd: S,
                joint: usize,
                at: &impl EncoderLanes<S>,
                mut each: impl FnMut(usize, f64, Lanes<S>),
            ) {
                let mut first = 0;
                $(if let Some(effect) = &self.$encoder {
                    let (values, own) = (effect.values(), effect.of_joint(joint).start);
                    effect.shapes_in_lanes(
                        simd,
                        joint,
                        at,
                        #[inline(always)]
                        |number, shape| each(first + own + number, values[own + number], shape),
                    );
                    first += values.len();
                })*
                let _ = first;
            }

            /// Takes what is stated of one effect.
            fn take(&mut self, given: &mut Stated, joints: usize) -> Result<()> {
                match given.kind() {
                    $(<$Encoder>::KIND => self.$encoder = Some(<$Encoder>::from_stated(given, joints)?),)*
                    $(<$Other>::KIND => self.$other = Some(<$Other>::from_stated(given, joints)?),)*
                    other => return Err(Error::NoSuchEffect { given: other.into(), known: Effects::KINDS }),
                }
                Ok(())
            }
        }
    };
}

registry! {
    on_encoder {
        /// Eccentric encoders.
        harmonics: Harmonics,
        /// Play between joints and their encoders.
        backlash: Backlash,
        /// Joints that turn with other joints' encoders.
        coupling: Coupling,
    }
    elsewhere {
        /// Links that grow with temperature.
        expansion: Expansion,
        /// Joints that bend under gravity.
        compliance: Compliance,
        /// The first axis leans in the stated frame.
        base_tilt: BaseTilt,
        /// And stands beside its origin.
        base_offset: BaseOffset,
    }
}

impl Effects {
    /// From numbers by their names, of an arm with so many joints.
    ///
    /// # Errors
    /// An effect that does not exist or is stated twice, an array that is missing, unknown or of another shape, a number
    /// out of its range.
    pub fn from_stated(given: impl IntoIterator<Item = Stated>, joints: usize) -> Result<Effects> {
        let mut effects = Effects::default();
        for mut stated in given {
            if effects.all().any(|effect| effect.kind() == stated.kind()) {
                return Err(Error::Twice { what: format!("effect {:?}", stated.kind()) });
            }
            effects.take(&mut stated, joints)?;
            stated.finish()?;
        }
        Ok(effects)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.all().next().is_none()
    }

    /// Number of parameters.
    pub fn count(&self) -> usize {
        self.all().map(|effect| effect.values().len()).sum()
    }

    /// Where among the parameters of all effects those of a kind begin; their end where there are none.
    pub(crate) fn start_of(&self, kind: &str) -> usize {
        self.all().take_while(|effect| effect.kind() != kind).map(|effect| effect.values().len()).sum()
    }

    /// Takes other values for all parameters.
    pub fn set(&mut self, mut values: &[f64]) {
        for effect in self.all_mut() {
            let (own, rest) = values.split_at(effect.values().len());
            effect.values_mut().copy_from_slice(own);
            values = rest;
        }
    }

    /// What is added to a joint's encoder angle, rad.
    pub(crate) fn added_rad(&self, joint: usize, at: Encoder) -> f64 {
        self.sum(joint, |effect| effect.shapes(joint, at))
    }

    /// Derivative of [`Self::added_rad`] with respect to the encoder angle.
    pub(crate) fn slope(&self, joint: usize, at: Encoder) -> f64 {
        self.sum(joint, |effect| effect.slopes(joint, at))
    }

    fn sum(&self, joint: usize, of: impl Fn(&dyn OnEncoder) -> Vec<f64>) -> f64 {
        let one = |effect: &dyn OnEncoder| -> f64 {
            let own = of(effect);
            effect.values()[effect.of_joint(joint)].iter().zip(&own).map(|(value, shape)| value * shape).sum()
        };
        self.on_encoder().map(one).sum()
    }

    pub(in crate::arm) fn check(&self, joints: usize) -> Result<()> {
        for effect in self.all() {
            effect.check()?;
            let parameters: usize = (0..effect.joints()).map(|joint| effect.suffixes(joint).len()).sum();
            if effect.joints() != joints || effect.values().len() != parameters {
                return Err(Error::Shape {
                    what: format!("the joints of effect {:?}", effect.kind()),
                    got: effect.joints(),
                    expected: joints,
                });
            }
        }
        Ok(())
    }
}
