//! The free parameters of a problem as unknowns of a least-squares problem that the solver can read.

use crate::arm::Unit;
use crate::error::Result;
use crate::monitor::Monitor;
use crate::pins::Pin;
use crate::problem::Problem;
use crate::residuals::{Buffers, Model, Readings, Unknowns, Writer};
use crate::simd::{Columns, PAD};
use crate::solver::{LeastSquares, RowBlock, RowSink};

/// The free parameters of a problem as unknowns of a least-squares problem.
pub struct Assembly<'a> {
    problem: &'a Problem,
    monitor: &'a dyn Monitor,
    /// indices of the free parameters
    free: Vec<usize>,
    parameters: Vec<f64>,
    model: Model,
    unknowns: Vec<Unknowns>,
    considered: usize,
    natural_scale: Vec<f64>,
    negligible_cost: f64,
    pins: Vec<Pin>,
    buffers: Buffers,
}

impl<'a> Assembly<'a> {
    /// With the free parameters given by index. The readings must have been weighed.
    pub fn new(problem: &'a Problem, free: &[usize], pins: &[Pin], monitor: &'a dyn Monitor) -> Assembly<'a> {
        let units = problem.arm().parameter_units();
        let reach = problem.reach_mm();
        let mut of_parameter = vec![None; problem.arm().parameter_count()];
        for (unknown, &parameter) in free.iter().enumerate() {
            of_parameter[parameter] = Some(unknown);
        }
        // turning or lifting the base changes no distance: with residuals left these columns would not vanish by themselves
        for parameter in problem.base_parameters() {
            of_parameter[parameter] = None;
        }
        let mut considered = 0;
        let mut group_unknowns = |group: &dyn Readings| {
            let first = free.len() + considered;
            considered += group.considered().len();
            Unknowns {
                parameters: of_parameter.clone(),
                considered: (first..free.len() + considered).map(Some).collect(),
            }
        };
        let unknowns = problem.groups().iter().map(|g| group_unknowns(g.as_ref())).collect();
        let weight_squared: f64 = problem.groups().iter().map(|g| g.weight_squared_sum()).sum();
        let rounding = 32.0 * f64::EPSILON * reach;
        let start = problem.arm().parameters();
        Assembly {
            problem,
            monitor,
            natural_scale: free.iter().map(|&j| if units[j] == Unit::Rad { reach } else { 1.0 }).collect(),
            pins: pins.to_vec(),
            free: free.to_vec(),
            model: Model::new(problem.arm()),
            parameters: start,
            unknowns,
            considered,
            negligible_cost: weight_squared * rounding * rounding,
            buffers: Buffers::default(),
        }
    }

    /// The readings' own equations at `x`, the considered dimensions as further unknowns behind the free ones.
    ///
    /// # Errors
    /// [`crate::Error::Interrupted`].
    pub fn considered_rows(&mut self, x: &[f64], sink: &mut dyn RowSink) -> Result<()> {
        self.stream(x, true, true, sink)
    }

    /// Number of considered dimensions.
    pub fn considered(&self) -> usize {
        self.considered
    }

    fn stream(&mut self, x: &[f64], jacobian: bool, considered: bool, sink: &mut dyn RowSink) -> Result<()> {
        for (&j, &value) in self.free.iter().zip(x) {
            self.parameters[j] = value;
        }
        self.model.set_parameters(&self.parameters);
        // joints and tips, considered dimensions, residual, placement
        let columns = self.parameters.len() + self.considered + 1 + 6;
        let mut out = Writer::new(&mut self.buffers, columns, &self.model, sink, self.monitor);
        let mut streamed = Ok(());
        for (group, unknowns) in self.problem.groups().iter().zip(&mut self.unknowns) {
            let kept = (!considered).then(|| std::mem::take(&mut unknowns.considered));
            unknowns.considered.resize(group.considered().len(), None);
            streamed = group.stream(&self.model, unknowns, jacobian, &mut out);
            if let Some(kept) = kept {
                unknowns.considered = kept;
            }
            if streamed.is_err() {
                break;
            }
        }
        let finished = out.finish(&mut self.buffers);
        streamed.and(finished)
    }
}

impl LeastSquares for Assembly<'_> {
    fn unknowns(&self) -> usize {
        self.free.len()
    }

    fn natural_scale(&self) -> &[f64] {
        &self.natural_scale
    }

    fn negligible_cost(&self) -> f64 {
        self.negligible_cost
    }

    fn rows(&mut self, x: &[f64], jacobian: bool, sink: &mut dyn RowSink) -> Result<()> {
        self.stream(x, jacobian, false, sink)?;
        for pin in &self.pins {
            let residual = pin.residual(x);
            let mut block = single_row(pin.coefficients.iter().chain([&residual]), x.len() + 1);
            if !jacobian {
                block.targets.clear();
            }
            sink.fold(&mut block);
        }
        Ok(())
    }
}

/// A block of one equation, its last column the residual.
fn single_row<'a>(values: impl Iterator<Item = &'a f64>, columns: usize) -> RowBlock {
    let mut block = RowBlock {
        columns: Columns::zeros(columns, 1),
        rows: PAD,
        targets: (0..columns - 1).map(|c| (c, c)).collect(),
        residual: columns - 1,
    };
    for (column, &value) in values.enumerate() {
        block.columns.column_mut(column)[0] = value;
    }
    block
}
