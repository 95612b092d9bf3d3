//! The free parameters of a problem as unknowns of a least-squares problem that the solver can read.

use crate::arm::Unit;
use crate::decomposition::Decomposition;
use crate::error::Result;
use crate::monitor::Monitor;
use crate::problem::Problem;
use crate::residuals::{Buffers, Model, Readings, Unknowns, Writer};
use crate::simd::{Columns, PAD};
use crate::solver::gram::{Gram, smallest_pivot};
use crate::solver::triangle::Triangle;
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

/// One more equation that keeps a direction at its start which the readings do not determine: the size of an arm
/// whose readings know no length, or a family of parameters that describes the same readings at the start. Nothing
/// opposes it, so it is met exactly, whatever the noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Pin {
    /// The direction over the unknowns, rad and mm.
    pub direction: Vec<f64>,
    /// Whether it is the growth of the whole arm.
    pub is_scale: bool,
    /// The equation's coefficients, in the unit of a weighted residual per unknown.
    coefficients: Vec<f64>,
    start: Vec<f64>,
}

impl Pin {
    /// The direction at other parameters: growth is along the lengths as they are there.
    pub fn direction_at(&self, problem: &Problem, free: &[usize], parameters: &[f64]) -> Vec<f64> {
        let growth = self.is_scale.then(|| scale_direction(problem, free, parameters)).flatten();
        growth.unwrap_or_else(|| self.direction.clone())
    }
}

/// A pivot of the unit-diagonal normal equations below this calls for a look at the singular values.
const SUSPICIOUS_PIVOT: f64 = 1e-10;

/// The directions that the readings do not determine at some parameters, to be pinned where the problem's own arm has
/// them; and the normal equations there.
///
/// # Errors
/// [`crate::Error::Interrupted`].
pub fn pins(problem: &Problem, free: &[usize], parameters: &[f64], monitor: &dyn Monitor) -> Result<(Vec<Pin>, Gram)> {
    let mut assembly = Assembly::new(problem, free, &[], monitor);
    let start: Vec<f64> = free.iter().map(|&j| assembly.parameters[j]).collect();
    let here: Vec<f64> = free.iter().map(|&j| parameters[j]).collect();
    let scale = scale_direction(problem, free, parameters).map(|direction| {
        let weights: f64 = problem.groups().iter().map(|g| g.weight_squared_sum()).sum();
        Pin {
            coefficients: direction.iter().map(|d| d * weights.sqrt()).collect(),
            direction,
            is_scale: true,
            start: start.clone(),
        }
    });
    let mut pins: Vec<Pin> = scale.into_iter().collect();
    let mut gram = Gram::new(free.len());
    assembly.rows(&here, true, &mut gram)?;
    if smallest_pivot(&gram, assembly.natural_scale()) > SUSPICIOUS_PIVOT {
        return Ok((pins, gram));
    }
    let mut triangle = Triangle::new(free.len());
    assembly.rows(&here, true, &mut triangle)?;
    let symmetries: Vec<&[f64]> = pins.iter().map(|p| p.direction.as_slice()).collect();
    let decomposition = Decomposition::new(&triangle, free.len(), assembly.natural_scale(), &symmetries);
    for vector in decomposition.null_vectors() {
        let mut pin = Pin {
            direction: vec![0.0; free.len()],
            is_scale: false,
            coefficients: vec![0.0; free.len()],
            start: start.clone(),
        };
        for ((&unknown, norm), v) in decomposition.kept.iter().zip(&decomposition.norms).zip(&vector) {
            pin.direction[unknown] = v / norm;
            pin.coefficients[unknown] = v * norm;
        }
        pins.push(pin);
    }
    Ok((pins, gram))
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
    /// [`Error::Interrupted`].
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

/// The direction in which all lengths grow, over the unknowns: where no reading knows a length and none is held.
fn scale_direction(problem: &Problem, free: &[usize], values: &[f64]) -> Option<Vec<f64>> {
    if !problem.scale_free() || problem.groups().is_empty() {
        return None;
    }
    let units = problem.arm().parameter_units();
    let used = problem.probes_used();
    let joints = problem.arm().joint_parameter_count();
    let matters = |j: usize| j < joints || used[(j - joints) / 3];
    // d_1 only lifts the base and so does not hold the size
    let holds = |j: &usize| units[*j] == Unit::Mm && matters(*j) && *j != 3 && values[*j] != 0.0 && !free.contains(j);
    if (0..values.len()).any(|j| holds(&j)) {
        return None;
    }
    let grows = |&j: &usize| if units[j] == Unit::Mm && matters(j) && j != 3 { values[j] } else { 0.0 };
    let lengths = nalgebra::DVector::from_iterator(free.len(), free.iter().map(grows));
    let norm = lengths.norm();
    (norm > 0.0).then(|| (lengths / norm).as_slice().to_vec())
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
            let moved = x.iter().zip(&pin.start).zip(&pin.coefficients);
            let residual: f64 = moved.map(|((x, start), c)| (x - start) * c).sum();
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
