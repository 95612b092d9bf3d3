//! What is observed: readings of features of placed artefacts, one file for each kind of residual.
//!
//! A [`Readings`] streams its equations for given parameters. Placements are unknown and of no interest: each is put
//! where it fits best at these parameters, and its derivatives are eliminated before the rows reach the solver
//! (variable projection, Golub and Pereyra 1973, with Kaufman's Jacobian 1975).

pub mod length;
pub mod points;

use crate::arm::Arm;
use crate::error::{Error, Result};
use crate::kinematics::Chain;
use crate::kinematics::batch::scratch_len;
use crate::monitor::Monitor;
use crate::simd::Columns;
use crate::solver::{BLOCK_ROWS, RowBlock, RowSink};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::fmt::Debug;

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
    /// The joints.
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
        let (joints, tips) = parameters.split_at(self.chain.joint_parameter_count());
        self.chain.set_joint_parameters(joints);
        for (tip, p) in self.tips_mm.iter_mut().zip(tips.chunks_exact(3)) {
            tip.copy_from_slice(p);
        }
    }
}

/// A dimension of an artefact that is known with an uncertainty: common to all its readings.
#[derive(Debug, Clone, PartialEq)]
pub struct Considered {
    /// What it is, for reports.
    pub name: String,
    /// Its standard uncertainty, mm.
    pub u_mm: f64,
}

/// Which unknown each parameter and considered dimension is, if any.
#[derive(Debug, Clone, Default)]
pub struct Unknowns {
    /// For each parameter of the arm.
    pub parameters: Vec<Option<usize>>,
    /// For the considered dimensions of the readings at hand.
    pub considered: Vec<Option<usize>>,
}

/// Residuals of a group of readings in the order they were given.
#[derive(Debug, Clone, PartialEq)]
pub struct Unweighted {
    /// Numbers of one reading: 3 for a point, 1 for a length.
    pub components: usize,
    /// Row-major, mm: tip minus the feature's place, or distance minus length.
    pub residuals_mm: Vec<f64>,
    /// Root of the weight of each reading, 1/mm: equal in effect where it differs by direction.
    pub weights: Vec<f64>,
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

    /// Whether scaling the arm scales every residual: no length is known anywhere in them.
    fn scale_free(&self) -> bool;

    /// Whether the mirror image of the arm explains them as well.
    fn mirror_free(&self) -> bool;

    /// For each probe, whether it took any of them.
    fn probes_used(&self, probes: usize) -> Vec<bool>;

    /// Dimensions known with an uncertainty.
    fn considered(&self) -> &[Considered];

    /// Bytes that keeping the sines and cosines would take.
    fn sin_cos_bytes(&self) -> usize;

    /// Keeps sines and cosines of all readings for the fits to come.
    fn keep_sin_cos(&mut self);

    /// Weighs every reading for the noise, at these parameters; without noise every reading weighs one.
    fn weigh(&mut self, model: &Model, noise: Option<&Noise>, how: Weighing);

    /// Sum of the squared weights of all readings, 1/mm².
    fn weight_squared_sum(&self) -> f64;

    /// Streams the equations.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    fn stream(&self, model: &Model, unknowns: &Unknowns, jacobian: bool, out: &mut Writer) -> Result<()>;

    /// Residuals as a person reads them.
    fn unweighted(&self, model: &Model) -> Unweighted;

    /// Encoder angles of the readings, one row-major pose after the other, at most about `most` of them.
    fn sample_poses(&self, most: usize) -> Vec<(usize, Vec<f64>)>;

    /// The same readings, exact for this model, with new noise.
    fn redrawn(&self, truth: &Model, noise: &Noise, rng: &mut Xoshiro256PlusPlus) -> Box<dyn Readings>;

    /// About `most` of these readings, evenly chosen, for a quick look.
    fn thinned(&self, most: usize) -> Box<dyn Readings>;

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
