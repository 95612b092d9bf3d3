//! What is known while readings still come: rows are added and taken away, nothing is started over.
//!
//! Readings are looked at from one arm, where it was last fitted. Each standing of an artefact is a leaf of a
//! [`TriangleTree`]: its rows, its placement eliminated. A touch more, or one withdrawn, changes one leaf and the triangles
//! above it, so what is known follows in the time of a few small triangles, and is what a fit judges of all readings at once
//! at that arm. Where the arm has moved by more than its uncertainty one fits anew, from there.

use crate::artefacts::{Readings, Weighing};
use crate::error::Result;
use crate::fit::judged::decompose;
use crate::fit::solve::{ASSUMED_SCATTER_MM, prepare};
use crate::identify::families::pins;
use crate::identify::identifiability::Known;
use crate::monitor::Monitor;
use crate::problem::assembly::Assembly;
use crate::problem::pins::{Kind, Pin};
use crate::problem::{Problem, considered_rows_at, rows_beside};
use crate::solver::covariance::covariance;
use crate::solver::decomposition::Decomposition;
use crate::solver::tree::TriangleTree;
use crate::solver::triangle::Triangle;
use crate::solver::{BLOCK_ROWS, LeastSquares, RowBlock, RowSink};

/// What is known so far, from rows that come and go.
#[derive(Debug, Clone)]
pub struct Running {
    problem: Problem,
    free: Vec<usize>,
    parameters: Vec<f64>,
    pins: Vec<Pin>,
    natural_scale: Vec<f64>,
    considered_u: Vec<f64>,
    /// of a whitened residual
    sigma: f64,
    /// what is known beforehand
    before: Triangle,
    tree: TriangleTree,
}

/// What the readings so far determine.
#[derive(Debug, Clone, PartialEq)]
pub struct SoFar {
    /// How many independent combinations of the free parameters are determined.
    pub determined: usize,
    /// For each free parameter, whether it takes part in a direction that is not.
    pub lost: Vec<bool>,
    /// Over the free parameters, row-major: from the readings alone, along what they determine.
    pub covariance: Vec<f64>,
    /// Where the free parameters would go in one step.
    pub step: Vec<f64>,
}

/// What is known so far together with what is known of an arm from its drawing: every direction has an end.
#[derive(Debug, Clone, PartialEq)]
pub struct WithDrawing {
    /// Over the free parameters, row-major.
    pub covariance: Vec<f64>,
    /// R of the whitened rows, upper and row-major over the free parameters: what [`crate::design::gains`] asks for. What is
    /// not known of the artefacts is left out: no touch of the arm's can mend it.
    pub triangle: Vec<f64>,
}

impl Running {
    /// Of a problem's readings, looked at from some of its parameters; `sigma` of a whitened residual, as a fit has shown it,
    /// and none before there was a fit. Leaf k is the standing numbered k, as [`crate::problem::WhitenedRows`] counts them.
    ///
    /// # Errors
    /// Interrupted.
    pub fn new(
        problem: &Problem,
        free: &[usize],
        parameters: &[f64],
        sigma: Option<f64>,
        monitor: &dyn Monitor,
    ) -> Result<Running> {
        let mut problem = problem.clone();
        let unit = problem.unit();
        prepare(&mut problem);
        if sigma.is_some() {
            problem.set_unit(unit);
        }
        problem.weigh(parameters, Weighing::Full);
        let (mut pins, _) = pins(&problem, free, parameters, monitor)?;
        // what the first touches cannot tell apart later ones can: only what no touch ever tells stays out
        pins.retain(|pin| pin.kind != Kind::Family);
        let x: Vec<f64> = free.iter().map(|&j| parameters[j]).collect();
        let (rows, considered) = considered_rows_at(&problem, free, parameters, monitor)?;
        let unknowns = free.len() + considered;
        let (natural_scale, before) = {
            let assembly = Assembly::new(&problem, free, &[], monitor);
            let mut before = Triangle::new(unknowns);
            assembly.prior_rows(&x, &mut before);
            (assembly.natural_scale().to_vec(), before)
        };
        let mut tree = TriangleTree::new(unknowns);
        for (standing, rows) in rows.by_standing(unknowns) {
            tree.put(standing as usize, Some(&triangle_of(&rows, unknowns)));
        }
        let assumed = if problem.noise().is_some() { 1.0 } else { ASSUMED_SCATTER_MM };
        Ok(Running {
            considered_u: problem.considered_u(free),
            problem,
            free: free.to_vec(),
            parameters: parameters.to_vec(),
            pins,
            natural_scale,
            sigma: sigma.unwrap_or(assumed),
            before,
            tree,
        })
    }

    /// The free parameters.
    pub fn free(&self) -> &[usize] {
        &self.free
    }

    /// Leaves that there are: standings, with those that were emptied.
    pub fn leaves(&self) -> usize {
        self.tree.leaves()
    }

    /// Puts readings of a group's artefact, all in one standing, into a leaf, in place of those that it held. Returns whether
    /// it did: readings with other dimensions than the group's can only be looked at with all the others.
    ///
    /// # Errors
    /// No such group, or interrupted.
    pub fn put(&mut self, leaf: usize, group: usize, readings: &dyn Readings, monitor: &dyn Monitor) -> Result<bool> {
        let unknowns = self.free.len() + self.considered_u.len();
        let there = (self.free.as_slice(), self.parameters.as_slice());
        let Some(found) = rows_beside(&self.problem, there, group, readings, monitor)? else { return Ok(false) };
        let rows: Vec<Vec<f64>> = found.by_standing(unknowns).into_iter().flat_map(|(_, rows)| rows).collect();
        self.tree.put(leaf, Some(&triangle_of(&rows, unknowns)));
        Ok(true)
    }

    /// Takes away what a leaf holds.
    pub fn empty(&mut self, leaf: usize) {
        self.tree.put(leaf, None);
    }

    /// What the readings so far determine.
    pub fn so_far(&mut self) -> SoFar {
        let triangle = self.whole();
        let (decomposition, _) =
            decompose(&self.problem, &self.free, &self.pins, &self.parameters, &triangle, &self.natural_scale);
        let step = decomposition.pseudo_solve(&triangle, triangle.unknowns());
        SoFar {
            determined: decomposition.rank,
            lost: decomposition.lost(),
            covariance: covariance(&decomposition, &triangle, self.sigma * self.sigma, &self.considered_u),
            step: step.into_iter().map(|value| -value).collect(),
        }
    }

    /// The same with what a drawing says of every parameter without a prior; without what one leaf holds, where that is
    /// asked: what the readings in one place would tell with one more of them is asked of all the others.
    pub fn with_drawing(&mut self, known: Known, without: Option<usize>) -> WithDrawing {
        let mut triangle = match without {
            None => self.tree.root(),
            Some(leaf) => self.tree.root_without(leaf),
        };
        triangle.fold_triangle(&self.before);
        let count = self.free.len();
        let of_drawing = self.problem.known(known.length_mm, known.angle_rad);
        let unknowns = triangle.unknowns();
        let rows: Vec<Vec<f64>> = (0..count)
            .map(|k| {
                let mut row = vec![0.0; unknowns + 1];
                row[k] = self.sigma / of_drawing[self.free[k]];
                row
            })
            .collect();
        fold_rows(&mut triangle, &rows);
        let decomposition = Decomposition::new(&triangle, count, &self.natural_scale, &[]);
        let leading = triangle.leading(count);
        // a row's sign is nobody's business, a whitened row's size is
        WithDrawing {
            covariance: covariance(&decomposition, &triangle, self.sigma * self.sigma, &self.considered_u),
            triangle: (0..count * count).map(|k| leading[(k / count, k % count)]).collect(),
        }
    }

    /// The triangle of readings and of what is known beforehand.
    fn whole(&mut self) -> Triangle {
        let mut triangle = self.tree.root();
        triangle.fold_triangle(&self.before);
        triangle
    }
}

fn triangle_of(rows: &[Vec<f64>], unknowns: usize) -> Triangle {
    let mut triangle = Triangle::new(unknowns);
    fold_rows(&mut triangle, rows);
    triangle
}

fn fold_rows(triangle: &mut Triangle, rows: &[Vec<f64>]) {
    let unknowns = triangle.unknowns();
    for some in rows.chunks(BLOCK_ROWS) {
        triangle.fold(&mut RowBlock::of_rows(some, unknowns));
    }
}
