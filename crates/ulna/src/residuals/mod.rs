//! What is observed: readings of features of placed artefacts, one file for each kind of residual.
//!
//! A [`Readings`] streams its equations for given parameters. Placements are unknown and of no interest: each is put
//! where it fits best at these parameters, and its derivatives are eliminated before the rows reach the solver
//! (variable projection, Golub and Pereyra 1973, with Kaufman's Jacobian 1975).

pub mod length;
pub mod points;
mod rows;
pub mod surface;
mod tile;
mod touches;

use crate::arm::{Arm, Seen};
use crate::error::{Error, Result};
use crate::kinematics::batch::scratch_len;
use crate::kinematics::{Chain, Sample};
use crate::monitor::Monitor;
use crate::simd::Columns;
use crate::solver::{BLOCK_ROWS, RowBlock, RowSink};
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::fmt::Debug;
pub use touches::TouchRows;

/// Standard deviations of what is random in a reading.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Noise {
    /// Of each encoder, rad; empty for none.
    pub encoder_rad: Vec<f64>,
    /// Of a touch, per coordinate, mm.
    pub seat_mm: f64,
}

/// How a reading's directions are weighed against each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weighing {
    /// All alike: at parameters that are far off, the directions of the encoders' noise are not known yet.
    Even,
    /// By the noise in each.
    Full,
}

/// The numbers of an arm as the residuals use them.
#[derive(Debug, Clone)]
pub struct Model {
    /// The joints, and what the arm does beyond its geometry.
    pub chain: Chain,
    /// The tip of each probe, mm.
    pub tips_mm: Vec<[f64; 3]>,
}

impl Model {
    /// From an arm.
    pub fn new(arm: &Arm) -> Model {
        Model { chain: Chain::new(arm), tips_mm: arm.probes().iter().map(|p| p.tip_mm).collect() }
    }

    /// Takes other parameters, in the arm's order.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        let (joints, rest) = parameters.split_at(self.chain.joint_parameter_count());
        let (tips, effects) = rest.split_at(3 * self.tips_mm.len());
        self.chain.set_parameters(joints, effects);
        for (tip, p) in self.tips_mm.iter_mut().zip(tips.chunks_exact(3)) {
            tip.copy_from_slice(p);
        }
    }
}

/// Where readings are looked at: an arm's numbers, and those of the artefact's dimensions.
#[derive(Debug, Clone, Copy)]
pub struct At<'a> {
    /// The arm.
    pub model: &'a Model,
    /// The dimensions of the group's artefact, in the order of [`Readings::dimensions`], mm.
    pub dimensions_mm: &'a [f64],
}

/// A dimension of an artefact that is not known exactly: common to all its readings.
#[derive(Debug, Clone, PartialEq)]
pub struct Dimension {
    /// What it is, as a parameter's name: `artefact.ball.diameter`.
    pub name: String,
    /// Its calibrated value, mm.
    pub value_mm: f64,
    /// The standard uncertainty of that, mm; 0 of a fitted dimension of which nothing is known.
    pub u_mm: f64,
    /// Whether it is an unknown of the fit (with its calibration as prior, where u is not 0), or stays at its value, and
    /// what is not known of it goes into the covariance.
    pub fitted: bool,
}

/// Which unknown each parameter and dimension is, if any.
#[derive(Debug, Clone, Default)]
pub struct Unknowns {
    /// For each parameter of the arm.
    pub parameters: Vec<Option<usize>>,
    /// For the dimensions of the readings at hand.
    pub dimensions: Vec<Option<usize>>,
}

/// Residuals of a group of readings in the order they were given.
#[derive(Debug, Clone, PartialEq)]
pub struct Unweighted {
    /// Numbers of one reading: 3 for a point, 1 for a length or a surface.
    pub components: usize,
    /// Row-major, mm: tip minus the feature's place, distance minus length, or distance from the surface.
    pub residuals_mm: Vec<f64>,
    /// Root of the weight of each reading, 1/mm: equal in effect where it differs by direction.
    pub weights: Vec<f64>,
}

/// How far each reading is off, in units of its stated noise (mm where none is stated), a loss's weights left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Whitened {
    /// Norm of each reading's whitened residual, in the order they were given.
    pub norms: Vec<f64>,
    /// How many degrees of freedom it has: its equations less what its placement takes of them.
    pub freedoms: Vec<f64>,
}

/// A placement that takes more than this part of its readings' equations tells no reading from another.
const FOLLOWS: f64 = 0.5;

/// Where a placement follows its few readings so closely that it could make any of them look wrong, all are judged as one:
/// they share what is left of them. (A bar touched once at each end is one length, and neither end is worse.)
fn shared(norms: &mut [f64], freedoms: &mut [f64], components: usize) {
    let count = norms.len() as f64;
    let left = freedoms.iter().sum::<f64>() / count;
    if left < FOLLOWS * components as f64 {
        let norm = (norms.iter().map(|norm| norm * norm).sum::<f64>() / count).sqrt();
        norms.fill(norm);
        freedoms.fill(left);
    }
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

    /// Whether scaling the arm, and with it what [`Readings::growing`] says, scales every residual: no length is known.
    fn scale_free(&self) -> bool;

    /// How fast each dimension grows with the arm where no length is known, mm.
    fn growing(&self, at: At) -> Vec<f64> {
        vec![0.0; at.dimensions_mm.len()]
    }

    /// Whether the mirror image of the arm explains them as well.
    fn mirror_free(&self) -> bool;

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

    /// Sum of the squared weights of all readings, 1/mm².
    fn weight_squared_sum(&self) -> f64;

    /// Streams the equations.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
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
    fn redrawn(&self, truth: At, noise: &Noise, rng: &mut Xoshiro256PlusPlus) -> Box<dyn Readings>;

    /// About `most` of these readings, evenly chosen, for a quick look.
    fn thinned(&self, most: usize) -> Box<dyn Readings>;

    /// The same knowledge, or nearly, as lengths between pairs of touches, where it can be told so: nothing has to be placed
    /// then, and a search finds its way more often.
    fn as_lengths(&self) -> Option<Box<dyn Readings>> {
        None
    }

    /// The same knowledge told by lengths alone, where that is all there is: of an artefact of two features, touched once
    /// each wherever it stands, five of six coordinates say where that is. Same dimensions; weights are to be found anew.
    fn lengths_alone(&self) -> Option<Box<dyn Readings>> {
        None
    }

    /// A copy.
    fn boxed(&self) -> Box<dyn Readings>;
}

/// Collects equations into blocks and hands full ones to a sink.
pub struct Writer<'a> {
    /// The block being filled.
    pub block: RowBlock,
    /// Scratch of the kernels.
    pub scratch: [Vec<f64>; 2],
    sink: &'a mut dyn RowSink,
    monitor: &'a dyn Monitor,
    rows_since_asked: usize,
}

/// Buffers that outlive a [`Writer`].
#[derive(Debug, Default)]
pub struct Buffers {
    columns: Columns,
    targets: Vec<(usize, usize)>,
    scratch: [Vec<f64>; 2],
    capacity: usize,
}

impl<'a> Writer<'a> {
    /// A writer of rows with at most `columns` columns, on borrowed buffers.
    pub fn new(
        buffers: &mut Buffers,
        columns: usize,
        model: &Model,
        sink: &'a mut dyn RowSink,
        monitor: &'a dyn Monitor,
    ) -> Writer<'a> {
        if buffers.capacity < columns {
            buffers.columns = Columns::zeros(columns, BLOCK_ROWS);
            buffers.capacity = columns;
        }
        let need = scratch_len(&model.chain);
        for scratch in &mut buffers.scratch {
            scratch.resize(need, 0.0);
        }
        Writer {
            block: RowBlock {
                columns: std::mem::take(&mut buffers.columns),
                rows: 0,
                targets: std::mem::take(&mut buffers.targets),
                residual: 0,
            },
            scratch: std::mem::take(&mut buffers.scratch),
            sink,
            monitor,
            rows_since_asked: 0,
        }
    }

    /// Gives the buffers back.
    pub fn finish(mut self, buffers: &mut Buffers) -> Result<()> {
        let result = self.flush();
        buffers.columns = self.block.columns;
        buffers.targets = self.block.targets;
        buffers.scratch = self.scratch;
        result
    }

    /// Starts rows of another layout.
    pub fn layout(&mut self, residual: usize, targets: impl Iterator<Item = (usize, usize)>) -> Result<()> {
        self.flush()?;
        self.block.residual = residual;
        self.block.targets.clear();
        self.block.targets.extend(targets);
        Ok(())
    }

    /// Hands the block to the sink.
    pub fn flush(&mut self) -> Result<()> {
        if self.block.rows > 0 {
            self.sink.fold(&mut self.block);
            self.rows_since_asked += self.block.rows;
            self.block.rows = 0;
            if self.rows_since_asked >= ROWS_BETWEEN_QUESTIONS {
                self.rows_since_asked = 0;
                if !self.monitor.keep_going() {
                    return Err(Error::Interrupted);
                }
            }
        }
        Ok(())
    }

    /// Makes room for `rows` more in the block.
    pub fn reserve(&mut self, rows: usize) -> Result<()> {
        if self.block.rows + rows > BLOCK_ROWS {
            self.flush()?;
        }
        Ok(())
    }
}

/// A millisecond of work or less.
const ROWS_BETWEEN_QUESTIONS: usize = 1 << 15;

/// A standard normal number.
pub(crate) fn normal(rng: &mut Xoshiro256PlusPlus) -> f64 {
    StandardNormal.sample(rng)
}
