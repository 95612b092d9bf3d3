//! The free parameters of a problem as unknowns of a least-squares problem that the solver can read.

use super::groups::Problem;
use super::pins::Pin;
use super::priors::Prior;
use crate::artefacts::{At, Buffers, Model, Readings, Unknowns, Writer};
use crate::error::Result;
use crate::monitor::Monitor;
use crate::solver::{BLOCK_ROWS, LeastSquares, RowBlock, RowSink};

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
    priors: Vec<Prior>,
    natural_scale: Vec<f64>,
    negligible_cost: f64,
    pins: Vec<Pin>,
    buffers: Buffers,
}

/// What is told of each equation beside its residual.
#[derive(Clone, Copy)]
struct Wanted {
    jacobian: bool,
    /// derivatives of the considered dimensions too
    considered: bool,
    /// which standing it is of
    standings: bool,
}

impl<'a> Assembly<'a> {
    /// With the free parameters given by index. The readings must have been weighed.
    pub fn new(problem: &'a Problem, free: &[usize], pins: &[Pin], monitor: &'a dyn Monitor) -> Assembly<'a> {
        let natural = problem.natural_scale();
        let mut of_parameter = vec![None; problem.parameter_count()];
        for (unknown, &parameter) in free.iter().enumerate() {
            of_parameter[parameter] = Some(unknown);
        }
        let priors = problem.priors();
        let priors = priors.into_iter().filter(|prior| of_parameter[prior.parameter].is_some()).collect();
        let mut of_readings = of_parameter.clone();
        // turning or lifting the base changes no distance: with residuals left these columns would not vanish by themselves
        for parameter in problem.base_parameters() {
            of_readings[parameter] = None;
        }
        let (of_arm, _) = of_readings.split_at(problem.arm().parameter_count());
        let mut considered = 0;
        let mut unknown = |slot: &Option<usize>| {
            let fitted = slot.and_then(|parameter| of_parameter[parameter]);
            considered += usize::from(fitted.is_none());
            Some(fitted.unwrap_or(free.len() + considered.saturating_sub(1)))
        };
        let mut group_unknowns = |slots: &Vec<Option<usize>>| Unknowns {
            parameters: of_arm.to_vec(),
            dimensions: slots.iter().map(&mut unknown).collect(),
        };
        let unknowns = problem.slots().iter().map(&mut group_unknowns).collect();
        let weight_squared: f64 = problem.groups().iter().map(|g| g.weight_squared_sum()).sum();
        let rounding = 32.0 * f64::EPSILON * problem.reach_mm();
        Assembly {
            problem,
            monitor,
            natural_scale: free.iter().map(|&j| natural[j]).collect(),
            pins: pins.to_vec(),
            free: free.to_vec(),
            model: Model::new(problem.arm()),
            parameters: problem.parameters(),
            unknowns,
            considered,
            priors,
            negligible_cost: weight_squared * rounding * rounding,
            buffers: Buffers::default(),
        }
    }

    /// The equations of readings and priors at `x`, the considered dimensions as further unknowns behind the free ones.
    ///
    /// # Errors
    /// [`crate::Error::Interrupted`].
    pub fn considered_rows(&mut self, x: &[f64], sink: &mut dyn RowSink) -> Result<()> {
        self.stream(x, Wanted { jacobian: true, considered: true, standings: false }, sink)?;
        self.stream_priors(x, true, x.len() + self.considered, sink);
        Ok(())
    }

    /// The equations of readings at `x`, each with the standing that it is of: see [`Writer::ask_standings`].
    ///
    /// # Errors
    /// [`crate::Error::Interrupted`].
    pub fn rows_of_standings(&mut self, x: &[f64], sink: &mut dyn RowSink) -> Result<()> {
        self.stream(x, Wanted { jacobian: true, considered: false, standings: true }, sink)
    }

    /// The same, with the considered dimensions as further unknowns.
    ///
    /// # Errors
    /// [`crate::Error::Interrupted`].
    pub fn considered_rows_of_standings(&mut self, x: &[f64], sink: &mut dyn RowSink) -> Result<()> {
        self.stream(x, Wanted { jacobian: true, considered: true, standings: true }, sink)
    }

    /// The equations of other readings of the artefact of a group, which are in no group, weighed already; the considered
    /// dimensions as further unknowns.
    ///
    /// # Errors
    /// [`crate::Error::Interrupted`].
    pub fn rows_beside(
        &mut self,
        x: &[f64],
        group: usize,
        readings: &dyn Readings,
        sink: &mut dyn RowSink,
    ) -> Result<()> {
        self.place(x);
        let own = self.problem.dimensions_at(&self.parameters).swap_remove(group);
        let columns = self.problem.arm().parameter_count() + own.len() + 1 + 6;
        let mut out = Writer::new(&mut self.buffers, columns, &self.model, sink, self.monitor);
        out.ask_standings();
        let at = At { model: &self.model, dimensions: &own };
        let streamed = readings.stream(at, &self.unknowns[group], true, &mut out);
        let finished = out.finish(&mut self.buffers);
        streamed.and(finished)
    }

    /// The equations of what is known beforehand, for a sink of the free unknowns and the considered ones.
    pub fn prior_rows(&self, x: &[f64], sink: &mut dyn RowSink) {
        self.stream_priors(x, true, x.len() + self.considered, sink);
    }

    /// Number of considered dimensions: known with an uncertainty, and not fitted.
    pub fn considered(&self) -> usize {
        self.considered
    }

    fn place(&mut self, x: &[f64]) {
        for (&j, &value) in self.free.iter().zip(x) {
            self.parameters[j] = value;
        }
        self.model.set_parameters(&self.parameters[..self.problem.arm().parameter_count()]);
    }

    fn stream(&mut self, x: &[f64], wanted: Wanted, sink: &mut dyn RowSink) -> Result<()> {
        self.place(x);
        let dimensions = self.problem.dimensions_at(&self.parameters);
        // parameters of the arm, dimensions of a group, residual, standing
        let most_dimensions = dimensions.iter().map(Vec::len).max().unwrap_or(0);
        let columns = self.problem.arm().parameter_count() + most_dimensions + 1 + 6;
        let mut out = Writer::new(&mut self.buffers, columns, &self.model, sink, self.monitor);
        if wanted.standings {
            out.ask_standings();
        }
        let (mut streamed, mut first) = (Ok(()), 0);
        for ((group, unknowns), own) in self.problem.groups().iter().zip(&mut self.unknowns).zip(&dimensions) {
            let at = At { model: &self.model, dimensions: own };
            // without the considered ones, whose numbers are behind the unknowns
            let kept = (!wanted.considered).then(|| unknowns.dimensions.clone());
            if !wanted.considered {
                let fitted = |unknown: &mut Option<usize>| *unknown = unknown.filter(|&u| u < self.free.len());
                unknowns.dimensions.iter_mut().for_each(fitted);
            }
            out.count_from(first);
            first += group.standings();
            streamed = group.stream(at, unknowns, wanted.jacobian, &mut out);
            if let Some(kept) = kept {
                unknowns.dimensions = kept;
            }
            if streamed.is_err() {
                break;
            }
        }
        let finished = out.finish(&mut self.buffers);
        streamed.and(finished)
    }

    /// `unit (x - value) / u` of each prior, for a sink of so many unknowns.
    fn stream_priors(&self, x: &[f64], jacobian: bool, unknowns: usize, sink: &mut dyn RowSink) {
        for priors in self.priors.chunks(BLOCK_ROWS) {
            let row = |prior: &Prior| {
                let (mut row, weight) = (vec![0.0; unknowns + 1], self.problem.unit() / prior.u);
                if let Some(unknown) = self.free.iter().position(|&j| j == prior.parameter) {
                    row[unknown] = weight;
                    row[unknowns] = weight * (x[unknown] - prior.value);
                }
                row
            };
            let mut block = RowBlock::of_rows(&priors.iter().map(row).collect::<Vec<_>>(), unknowns);
            if !jacobian {
                block.targets.clear();
            }
            sink.fold(&mut block);
        }
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
        self.stream(x, Wanted { jacobian, considered: false, standings: false }, sink)?;
        self.stream_priors(x, jacobian, x.len(), sink);
        for pin in &self.pins {
            let row = pin.coefficients.iter().copied().chain([pin.residual(x)]).collect();
            let mut block = RowBlock::of_rows(&[row], x.len());
            if !jacobian {
                block.targets.clear();
            }
            sink.fold(&mut block);
        }
        Ok(())
    }
}
