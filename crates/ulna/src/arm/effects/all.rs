//! All causes of an arm together.

use super::compliance::Compliance;
use super::effect::Effect;
use super::expansion::Expansion;
use super::harmonics::Harmonics;
use crate::error::{Error, Result};

/// What an arm does beyond its geometry.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Effects {
    /// Eccentric encoders.
    pub harmonics: Option<Harmonics>,
    /// Links that grow with temperature.
    pub expansion: Option<Expansion>,
    /// Joints that bend under gravity.
    pub compliance: Option<Compliance>,
}

impl Effects {
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.all().next().is_none()
    }

    /// Those that there are, in the order of their parameters.
    pub fn all(&self) -> impl Iterator<Item = &dyn Effect> {
        let each = [
            self.harmonics.as_ref().map(|e| e as &dyn Effect),
            self.expansion.as_ref().map(|e| e as &dyn Effect),
            self.compliance.as_ref().map(|e| e as &dyn Effect),
        ];
        each.into_iter().flatten()
    }

    /// Number of parameters.
    pub fn count(&self) -> usize {
        self.all().map(|effect| effect.values().len()).sum()
    }

    /// Takes other values for all parameters.
    pub fn set(&mut self, mut values: &[f64]) {
        let each = [
            self.harmonics.as_mut().map(|e| e as &mut dyn Effect),
            self.expansion.as_mut().map(|e| e as &mut dyn Effect),
            self.compliance.as_mut().map(|e| e as &mut dyn Effect),
        ];
        for effect in each.into_iter().flatten() {
            let (own, rest) = values.split_at(effect.values().len());
            effect.set(own);
            values = rest;
        }
    }

    pub(in crate::arm) fn check(&self, joints: usize) -> Result<()> {
        for effect in self.all() {
            if effect.joints() != joints {
                return Err(Error::Shape {
                    what: format!("the joints of {}", effect.names().first().map_or("", |name| name)),
                    got: effect.joints(),
                    expected: joints,
                });
            }
        }
        self.compliance.as_ref().map_or(Ok(()), Compliance::check)
    }
}
