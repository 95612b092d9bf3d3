//! The 27 nonlinear problems of NIST's Statistical Reference Datasets, from both starts.
//!
//! `data/strd` holds them as NIST distributes them, a work of the US government; `Roszman1.dat` has the certified b1 of the
//! certificate again, 2.0196866396E-01, where the copy at hand had one that its own residual sum contradicts.

use crate::dual::Dual;
use crate::equations::Equations;
use crate::problems::{MODELS, problem};
use crate::tabulate;
use ulna::solver::lm::Options;

/// A calibration stops after 200 steps; some of these starts are farther away.
const MOST_STEPS: usize = 1000;

/// Starts, from 1, from which the solver does not come down, and says that what it has is no minimum.
const FALLS_SHORT: [(&str, usize); 2] = [
    // its way leads along a valley in which b1 falls by decades: the steps run out, and the report says so
    ("MGH10", 1),
    // the first step is to b2 = 115, where exp(-b2 x) is 0: b2 moves no residual any more, and is not determined
    ("BoxBOD", 1),
];

/// A sum of squares that is larger than the best by this part is not the least.
const LEAST: f64 = 1e-9;
/// Of its standard deviation, what a parameter is off where the next step would gain a part in 10¹² of the sum of squares.
const OFF: f64 = 1e-4;
/// Relative, what eleven certified digits leave open.
const PRINTED: f64 = 1e-10;

/// Digits in which two numbers agree: the log relative error, no more than the eleven that NIST certifies.
fn digits(found: f64, certified: f64) -> f64 {
    let off = ((found - certified) / certified).abs();
    if off.is_finite() { -off.clamp(1e-11, 1.0).log10() } else { 0.0 }
}

fn fewest(found: &[f64], certified: &[f64]) -> f64 {
    found.iter().zip(certified).map(|(f, c)| digits(*f, *c)).fold(11.0, f64::min)
}

#[test]
fn minima_are_those_of_nist() {
    let mut rows = vec![];
    for (name, model) in MODELS {
        let problem = problem(name);
        let (n, count) = (problem.parameters.len(), problem.y.len());
        let rounding = f64::EPSILON * problem.y.iter().fold(0.0, |most: f64, y| most.max(y.abs()));
        let mut row = format!("| {name} | {n} |");
        for (number, start) in (1..).zip(&problem.starts) {
            let residual = |b: &[Dual], row: usize| model(b, &problem.x[row]) - problem.y[row];
            let mut equations = Equations::new(n, count, rounding, residual);
            let mut x = start.clone();
            let report = equations.minimize(&mut x, &Options { max_iterations: MOST_STEPS, ..Options::default() });
            let (cost, deviations) = (equations.cost(&x), equations.deviations(&x));
            if FALLS_SHORT.contains(&(name, number)) {
                assert!(cost > problem.cost * 2.0, "{name} from {number} comes down: it falls short no more");
                let told = !report.termination.converged() || deviations.is_none();
                assert!(told, "{name} from {number}: nothing says that this is no minimum");
                row += " – | – | – | – |";
                continue;
            }
            let deviations = deviations.unwrap_or_else(|| panic!("{name} from {number}: not all is determined"));
            assert!(report.termination.converged(), "{name} from {number}: {}", report.termination.as_str());
            let met = rounding * (count as f64).sqrt();
            let most = (problem.cost * (1.0 + LEAST)).sqrt() + 2.0 * met;
            assert!(cost.sqrt() <= most, "{name} from {number}: {cost:e}, best {:e}", problem.cost);
            for (j, certified) in problem.parameters.iter().enumerate() {
                let allowed = OFF * problem.deviations[j] + PRINTED * certified.abs();
                let off = (x[j] - certified).abs();
                assert!(off <= allowed, "{name} from {number}: b{} is off by {off:e}, allowed {allowed:e}", j + 1);
            }
            let of_deviations = fewest(&deviations, &problem.deviations);
            // Lanczos1: the residuals are of the size of rounding in y, and so are their sum and what comes from it
            let rounded = 2.0 * met / problem.cost.sqrt();
            assert!(of_deviations >= 4.0 || 10.0_f64.powf(-of_deviations) <= rounded, "{name} from {number}");
            let figures = [fewest(&x, &problem.parameters), of_deviations, digits(cost, problem.cost)];
            row += &format!(" {} |", report.evaluations);
            figures.iter().for_each(|figure| row += &format!(" {figure:.1} |"));
        }
        rows.push(row);
    }
    let head = "| problem | n | passes | b | u | S | passes | b | u | S |\n\
                |---|---:|---:|---:|---:|---:|---:|---:|---:|---:|";
    tabulate("nist-nonlinear.md", head, &rows);
}
