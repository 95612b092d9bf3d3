//! What every kind of readings can do.

use super::dimension::{Dimension, Unknowns};
use super::model::At;
use super::noise::{Noise, Weighing, normal};
use super::residuals::{Unweighted, Whitened};
use super::writer::Writer;
use crate::arm::Seen;
use crate::error::Result;
use crate::kinematics::Sample;
use rand_xoshiro::Xoshiro256PlusPlus;
use std::fmt::Debug;

/// How readings are taken once more: exact where the arm and the artefact truly are, but for new noise.
#[derive(Debug, Clone, Copy)]
pub struct Again<'a> {
    /// The arm and the dimensions as they are.
    pub truth: At<'a>,
    /// The dimensions as they were calibrated anew.
    pub calibrated: &'a [f64],
    /// Of the seats and the encoders.
    pub noise: &'a Noise,
}

/// Readings of one artefact.
pub trait Readings: Debug + Send + Sync {
    /// Number of rows in the file.
    fn len(&self) -> usize;

    /// Whether there are none.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Scalar equations.
    fn equations(&self) -> usize;

    /// Unknowns of all placements.
    fn placement_unknowns(&self) -> usize;

    /// Places in which the artefact stands; rows of a file where it stands nowhere or its place is known.
    fn standings(&self) -> usize;

    /// Whether scaling the arm, and with it what [`Readings::growing`] says, scales every residual: no length is known.
    fn scale_free(&self) -> bool;

    /// Whether any of them tells where the tip is: orientations do not.
    fn tell_places(&self) -> bool {
        true
    }

    /// How fast each dimension grows with the arm where no length is known.
    fn growing(&self, at: At) -> Vec<f64> {
        vec![0.0; at.dimensions.len()]
    }

    /// Whether the mirror image of the arm explains them as well.
    fn mirror_free(&self) -> bool;

    /// Whether a tip that never moves explains them as well: nothing about them is a distance between places of the tip.
    fn still_free(&self) -> bool;

    /// For each probe, whether it took any of them.
    fn probes_used(&self, probes: usize) -> Vec<bool>;

    /// Dimensions that are not known exactly.
    fn dimensions(&self) -> &[Dimension];

    /// Bytes that keeping the sines and cosines would take.
    fn sin_cos_bytes(&self) -> usize;

    /// Keeps sines and cosines of all readings for the fits to come.
    fn keep_sin_cos(&mut self);

    /// Weighs every reading for the noise, at these parameters; without noise every reading weighs one.
    fn weigh(&mut self, at: At, noise: Option<&Noise>, how: Weighing);

    /// Weighs each reading, in the order they were given, by a further factor: what a loss makes of it. None: by one.
    fn discount(&mut self, factors: Option<&[f64]>);

    /// Whether some reading weighs its directions differently where encoders have noise.
    fn weighs_directions(&self) -> bool {
        self.equations() > self.len()
    }

    /// Sum of the squared weights of all readings, 1/mm².
    fn weight_squared_sum(&self) -> f64;

    /// Streams the equations.
    ///
    /// # Errors
    /// [`crate::Error::Interrupted`].
    fn stream(&self, at: At, unknowns: &Unknowns, jacobian: bool, out: &mut Writer) -> Result<()>;

    /// Residuals as a person reads them.
    fn unweighted(&self, at: At) -> Unweighted;

    /// Residuals as a loss judges them.
    fn whitened(&self, at: At) -> Whitened;

    /// Poses of the readings, at most about `most` of them.
    fn samples(&self, most: usize) -> Vec<Sample>;

    /// What they show of what the arm's effects depend on.
    fn seen(&self) -> Seen;

    /// The same readings, exact at these parameters, with new noise, and dimensions calibrated anew.
    fn redrawn(&self, truth: At, noise: &Noise, rng: &mut Xoshiro256PlusPlus) -> Box<dyn Readings> {
        let stated = self.dimensions().iter().zip(truth.dimensions);
        let calibrated: Vec<f64> = stated.map(|(dimension, value)| value + dimension.u * normal(rng)).collect();
        self.taken_anew(&Again { truth, calibrated: &calibrated, noise }, rng)
    }

    /// The same readings taken once more.
    fn taken_anew(&self, again: &Again, rng: &mut Xoshiro256PlusPlus) -> Box<dyn Readings>;

    /// About `most` of these readings, evenly chosen, for a quick look.
    fn thinned(&self, most: usize) -> Box<dyn Readings>;

    /// The same knowledge, or nearly, as lengths between pairs of touches, where it can be told so: nothing has to be placed
    /// then, and a search finds its way more often.
    fn as_lengths(&self) -> Option<Box<dyn Readings>> {
        None
    }

    /// A copy.
    fn boxed(&self) -> Box<dyn Readings>;
}
