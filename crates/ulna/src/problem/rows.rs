//! What readings tell of the free parameters, equation by equation, placements eliminated.

use super::assembly::Assembly;
use super::groups::Problem;
use crate::artefacts::{Readings, Weighing};
use crate::error::{Error, Result};
use crate::monitor::Monitor;
use crate::solver::{RowBlock, RowSink};

/// Rows of the whitened Jacobian of which a placement explains nothing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct WhitenedRows {
    /// Row-major over the free parameters, standing by standing.
    pub rows: Vec<f64>,
    /// The residual of each.
    pub residuals: Vec<f64>,
    /// Which standing each row is of: counted as they first come in each group of readings, group after group; of readings
    /// that stand nowhere, or whose place is known, each is one.
    pub standing: Vec<u32>,
}

/// The rows at the problem's own arm, weighed for the stated noise. A standing leaves as many as its equations are more
/// than its unknowns; which they are of all that span the same is arbitrary. Priors are left out.
///
/// # Errors
/// No readings, or interrupted.
pub fn whitened_rows(problem: &mut Problem, free: &[usize], monitor: &dyn Monitor) -> Result<WhitenedRows> {
    if problem.readings() == 0 {
        return Err(Error::NoReadings);
    }
    let parameters = problem.parameters();
    problem.weigh(&parameters, Weighing::Full);
    rows_at(problem, free, &parameters, monitor)
}

/// The same at other parameters, weighed as the readings are.
///
/// # Errors
/// Interrupted.
pub fn rows_at(problem: &Problem, free: &[usize], parameters: &[f64], monitor: &dyn Monitor) -> Result<WhitenedRows> {
    let x: Vec<f64> = free.iter().map(|&j| parameters[j]).collect();
    let mut sink = Kept { unknowns: free.len(), kept: WhitenedRows::default() };
    Assembly::new(problem, free, &[], monitor).rows_of_standings(&x, &mut sink)?;
    Ok(sink.kept.sorted(free.len()))
}

/// The same with the considered dimensions as further unknowns behind the free ones: so many are told.
///
/// # Errors
/// Interrupted.
pub fn considered_rows_at(
    problem: &Problem,
    free: &[usize],
    parameters: &[f64],
    monitor: &dyn Monitor,
) -> Result<(WhitenedRows, usize)> {
    let x: Vec<f64> = free.iter().map(|&j| parameters[j]).collect();
    let mut assembly = Assembly::new(problem, free, &[], monitor);
    let considered = assembly.considered();
    let mut sink = Kept { unknowns: free.len() + considered, kept: WhitenedRows::default() };
    assembly.considered_rows_of_standings(&x, &mut sink)?;
    Ok((sink.kept.sorted(free.len() + considered), considered))
}

/// The same of other readings of the artefact of a group, weighed as the problem's are at these parameters; none where they
/// have other dimensions than the group's: a feature that is touched once has an error of its own instead of one.
///
/// # Errors
/// No such group, or interrupted.
pub fn rows_beside(
    problem: &Problem,
    (free, parameters): (&[usize], &[f64]),
    group: usize,
    readings: &dyn Readings,
    monitor: &dyn Monitor,
) -> Result<Option<WhitenedRows>> {
    let count = problem.groups().len();
    let Some(like) = problem.groups().get(group) else {
        return Err(Error::NoSuch { what: "group", index: group as i64, count });
    };
    if !readings.dimensions().iter().map(|d| &d.name).eq(like.dimensions().iter().map(|d| &d.name)) {
        return Ok(None);
    }
    let mut readings = readings.boxed();
    problem.weigh_beside(parameters, group, readings.as_mut());
    let x: Vec<f64> = free.iter().map(|&j| parameters[j]).collect();
    let mut assembly = Assembly::new(problem, free, &[], monitor);
    let unknowns = free.len() + assembly.considered();
    let mut sink = Kept { unknowns, kept: WhitenedRows::default() };
    assembly.rows_beside(&x, group, readings.as_ref(), &mut sink)?;
    Ok(Some(sink.kept.sorted(unknowns)))
}

impl WhitenedRows {
    /// The rows and residuals of each standing in turn, for so many unknowns: which one, and rows with their residual.
    pub fn by_standing(&self, unknowns: usize) -> Vec<(u32, Vec<Vec<f64>>)> {
        let mut found: Vec<(u32, Vec<Vec<f64>>)> = Vec::new();
        for (k, row) in self.rows.chunks_exact(unknowns).enumerate() {
            let whole = [row, &self.residuals[k..=k]].concat();
            match found.last_mut() {
                Some((standing, rows)) if *standing == self.standing[k] => rows.push(whole),
                _ => found.push((self.standing[k], vec![whole])),
            }
        }
        found
    }

    /// Standing by standing: rows of several probes or ways of telling come one after the other.
    fn sorted(self, unknowns: usize) -> WhitenedRows {
        if self.standing.is_sorted() {
            return self;
        }
        let mut order: Vec<usize> = (0..self.standing.len()).collect();
        order.sort_by_key(|&row| self.standing[row]);
        WhitenedRows {
            rows: order.iter().flat_map(|&row| &self.rows[row * unknowns..(row + 1) * unknowns]).copied().collect(),
            residuals: order.iter().map(|&row| self.residuals[row]).collect(),
            standing: order.iter().map(|&row| self.standing[row]).collect(),
        }
    }
}

/// Keeps rows as they come.
struct Kept {
    unknowns: usize,
    kept: WhitenedRows,
}

impl RowSink for Kept {
    fn fold(&mut self, block: &mut RowBlock) {
        let telling = |row: &usize| block.standing[*row] != RowBlock::NONE;
        let rows: Vec<usize> = (0..block.rows).filter(telling).collect();
        let first = self.kept.rows.len();
        self.kept.rows.resize(first + rows.len() * self.unknowns, 0.0);
        for &(column, unknown) in &block.targets {
            let values = block.columns.column(column);
            let own = self.kept.rows[first..].iter_mut().skip(unknown).step_by(self.unknowns);
            own.zip(&rows).for_each(|(own, &row)| *own = values[row]);
        }
        let residuals = block.columns.column(block.residual);
        self.kept.residuals.extend(rows.iter().map(|&row| residuals[row]));
        self.kept.standing.extend(rows.iter().map(|&row| block.standing[row]));
    }
}
