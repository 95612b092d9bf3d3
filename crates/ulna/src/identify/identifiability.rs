//! What the readings determine, what they do not, and why.

use crate::arm::{Arm, Unit};
use crate::identify::causes::{Because, Scene, base_frame, explain, scale};
use crate::problem::pins::{Kind, Pin, Symmetry};
use crate::solver::decomposition::Decomposition;

/// A direction that no reading sees.
#[derive(Debug, Clone, PartialEq)]
pub struct LostDirection {
    /// Parameters that move together (rad, mm) without any residual changing; the leading one has weight 1.
    pub combination: Vec<(String, f64)>,
    /// Why, and what would help.
    pub because: Because,
}

/// A direction that the readings determine worse than a drawing would.
#[derive(Debug, Clone, PartialEq)]
pub struct WeakDirection {
    /// Parameters that move together (rad, mm); the leading one has weight 1.
    pub combination: Vec<(String, f64)>,
    /// Standard uncertainty of the leading parameter along this direction.
    pub u: f64,
    /// Its unit.
    pub unit: Unit,
    /// In words.
    pub because: String,
    /// What would help.
    pub remedy: String,
}

/// How well an arm is known before it is calibrated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Known {
    /// Standard uncertainty of a length, mm.
    pub length_mm: f64,
    /// Standard uncertainty of an angle, rad.
    pub angle_rad: f64,
}

impl Default for Known {
    /// A drawing: 1 mm, 0.01 rad.
    fn default() -> Self {
        Known { length_mm: 1.0, angle_rad: 0.01 }
    }
}

/// What readings can and cannot determine.
#[derive(Debug, Clone, PartialEq)]
pub struct Identifiability {
    /// The free parameters.
    pub names: Vec<String>,
    /// How many independent combinations of them are determined.
    pub determined: usize,
    /// Of the Jacobian with unit columns, descending, zero for columns that vanished: one for each free parameter.
    pub singular_values: Vec<f64>,
    /// Smallest kept singular value over the largest.
    pub condition: f64,
    /// What is lost.
    pub lost: Vec<LostDirection>,
    /// What is determined worse than it was known before.
    pub weak: Vec<WeakDirection>,
    /// The lost directions as vectors over the free parameters.
    pub lost_directions: Vec<Vec<f64>>,
    /// For each free parameter, whether it is left open: it takes part in a lost direction, and by more than is nothing
    /// beside its uncertainty.
    pub in_lost: Vec<bool>,
    /// Free parameters of which the readings say next to nothing: what is known of them is their prior.
    pub from_prior: Vec<String>,
}

/// An uncertainty that is no less than this part of the prior's is the prior's.
const NO_NEWS: f64 = 0.95;

/// What the analysis needs to know of the problem.
pub(crate) struct Question<'a> {
    pub scene: Scene<'a>,
    /// of all parameters
    pub names: &'a [String],
    pub units: &'a [Unit],
    /// of each free parameter: value and standard uncertainty before
    pub priors: &'a [Option<(f64, f64)>],
    /// the arm at the start, where the pinned families were found
    pub start: &'a Arm,
    pub pins: &'a [Pin],
    /// the same directions at the arm in question
    pub symmetries: &'a [Symmetry],
    /// of each parameter: standard uncertainty before any reading, where it has no prior
    pub known: &'a [f64],
    /// standard deviation of a whitened residual
    pub sigma: f64,
}

/// Weights smaller than this part of the largest, in units of effect on the readings, are rounding.
const NEGLIGIBLE_WEIGHT: f64 = 1e-6;

pub(crate) fn analyse(decomposition: &Decomposition, question: &Question) -> Identifiability {
    let count = question.scene.free.len();
    let names: Vec<String> = question.scene.free.iter().map(|&j| question.names[j].clone()).collect();
    let (directions, origins): (Vec<_>, Vec<_>) = lost_directions(decomposition, question, count).into_iter().unzip();
    let one = |(direction, origin): (&Vec<f64>, &Origin)| LostDirection {
        combination: combination(direction, &names),
        because: match origin {
            Origin::Scale => scale(),
            Origin::Lift => base_frame(),
            Origin::Start(there) => explain(there, question.start, &question.scene),
            Origin::Here => explain(direction, question.scene.arm, &question.scene),
        },
    };
    let lost: Vec<LostDirection> = directions.iter().zip(&origins).map(one).collect();
    let mut singular_values = decomposition.singular_values.clone();
    singular_values.resize(count, 0.0);
    let kept = &decomposition.singular_values[..decomposition.rank];
    Identifiability {
        determined: decomposition.rank,
        condition: match (kept.first(), kept.last()) {
            (Some(largest), Some(smallest)) => smallest / largest,
            _ => 0.0,
        },
        from_prior: from_prior(decomposition, question, &names),
        in_lost: left_open(&directions, decomposition, question),
        weak: weak(decomposition, question, &names),
        lost_directions: directions,
        singular_values,
        lost,
        names,
    }
}

/// Parameters whose uncertainty the readings did not lower.
fn from_prior(decomposition: &Decomposition, question: &Question, names: &[String]) -> Vec<String> {
    if question.priors.iter().all(Option::is_none) {
        return vec![];
    }
    let covariance = decomposition.covariance();
    let count = names.len();
    let no_news = |&k: &usize| {
        let after = question.sigma * covariance[k * count + k].sqrt();
        question.priors[k].is_some_and(|(_, u)| after >= NO_NEWS * u)
    };
    (0..count).filter(no_news).map(|k| names[k].clone()).collect()
}

/// A step that is less than this part of what is known of a parameter is nothing.
const NOTHING: f64 = 0.1;

/// Whether a lost direction leaves each free parameter open.
///
/// A direction can be lost but for its noise: a tip a hair off the last axis shifts everything a hair along with that
/// axis. So the direction moves as far as an arm is known beforehand, and who is moved by less than a tenth of that, and
/// of its own uncertainty, is known all the same.
fn left_open(directions: &[Vec<f64>], decomposition: &Decomposition, question: &Question) -> Vec<bool> {
    let count = question.scene.free.len();
    let known = |j: usize| match question.priors[j] {
        Some((_, u)) => u,
        None => question.known[question.scene.free[j]],
    };
    let covariance = if directions.is_empty() { vec![] } else { decomposition.covariance() };
    let mut open = vec![false; count];
    for direction in directions {
        let taking_part: Vec<usize> = (0..count).filter(|&j| direction[j] != 0.0).collect();
        let most = taking_part.iter().map(|&j| known(j) / direction[j].abs()).fold(f64::INFINITY, f64::min);
        for j in taking_part {
            let step = most * direction[j].abs();
            let u = question.sigma * covariance[j * count + j].sqrt();
            open[j] |= step > NOTHING * known(j) || step > NOTHING * u || u.is_nan();
        }
    }
    open
}

fn combination(direction: &[f64], names: &[String]) -> Vec<(String, f64)> {
    let parts = names.iter().zip(direction).filter(|(_, w)| **w != 0.0);
    parts.map(|(name, &weight)| (name.clone(), weight)).collect()
}

/// Where a lost direction was found.
#[derive(Debug, Clone, PartialEq)]
enum Origin {
    /// known beforehand: no reading knows a length
    Scale,
    /// known beforehand: nothing fixes the base along its first axis
    Lift,
    /// at the start, where it was this direction, and pinned there
    Start(Vec<f64>),
    /// at the arm in question
    Here,
}

/// A sparse basis of what is lost, physical units over all unknowns: vanished columns one by one, growth, and the rest
/// reduced to as few parameters as possible.
fn lost_directions(decomposition: &Decomposition, question: &Question, count: usize) -> Vec<(Vec<f64>, Origin)> {
    let (kept, norms) = (&decomposition.kept, &decomposition.norms);
    let mut lost = Vec::new();
    for j in (0..count).filter(|j| !kept.contains(j)) {
        let mut direction = vec![0.0; count];
        direction[j] = 1.0;
        lost.push((direction, Origin::Here));
    }
    let scaled =
        |direction: &Vec<f64>| kept.iter().zip(norms).map(|(&j, norm)| direction[j] * norm).collect::<Vec<f64>>();
    let here = |kind: Kind| question.symmetries.iter().filter(move |s| s.0 == kind).map(|s| scaled(&s.1));
    // leading parameter 1, nothing that is rounding
    let sparse = |v: Vec<f64>| {
        let mut direction = vec![0.0; count];
        let leading = (0..v.len()).max_by(|&a, &b| rank(&v, a).total_cmp(&rank(&v, b))).unwrap_or(0);
        let unit = v[leading] / norms[leading];
        for a in (0..v.len()).filter(|&a| v[a].abs() > NEGLIGIBLE_WEIGHT * v[leading].abs()) {
            direction[kept[a]] = v[a] / norms[a] / unit;
        }
        direction
    };
    lost.extend(here(Kind::Growth).map(|v| (sparse(v), Origin::Scale)));
    lost.extend(here(Kind::Lift).map(|v| (sparse(v), Origin::Lift)));
    let mut families: Vec<Vec<f64>> = here(Kind::Family).collect();
    let there = question.pins.iter().filter(|p| p.kind == Kind::Family);
    let mut there: Vec<Vec<f64>> = there.map(|p| scaled(&p.direction)).collect();
    let mut null = decomposition.null_vectors();
    for vectors in [&mut families, &mut there, &mut null] {
        reduce(vectors);
    }
    let families = families.into_iter().zip(there);
    lost.extend(families.map(|(v, start)| (sparse(v), Origin::Start(sparse(start)))));
    lost.extend(null.into_iter().map(|v| (sparse(v), Origin::Here)));
    lost
}

/// By how much a column takes part. Of equals the later one leads, whatever rounding says: where half a backlash is a zero
/// offset, the backlash is what is lost.
fn rank(row: &[f64], column: usize) -> f64 {
    row[column].abs() * (1.0 + 1e-9 * column as f64)
}

/// Gauss-Jordan with complete pivoting on the rows: each keeps one pivot that no other has.
fn reduce(rows: &mut [Vec<f64>]) {
    let columns = rows.first().map_or(0, Vec::len);
    let mut used = vec![false; columns];
    for k in 0..rows.len() {
        let candidates = (k..rows.len()).flat_map(|r| (0..columns).map(move |c| (r, c)));
        let free = candidates.filter(|&(_, c)| !used[c]);
        let Some((row, pivot)) = free.max_by(|&(r, c), &(s, d)| rank(&rows[r], c).total_cmp(&rank(&rows[s], d))) else {
            return;
        };
        used[pivot] = true;
        rows.swap(k, row);
        let value = rows[k][pivot];
        rows[k].iter_mut().for_each(|v| *v /= value);
        let pivot_row = rows[k].clone();
        for other in (0..rows.len()).filter(|&r| r != k) {
            let factor = rows[other][pivot];
            rows[other].iter_mut().zip(&pivot_row).for_each(|(v, p)| *v -= factor * p);
        }
    }
}

/// An uncertainty in words.
fn two_digits(u: f64) -> String {
    if (0.01..1e4).contains(&u) { format!("{u:.2}") } else { format!("{u:.1e}") }
}

/// Singular directions along which a parameter's uncertainty exceeds what was known of it before.
fn weak(decomposition: &Decomposition, question: &Question, names: &[String]) -> Vec<WeakDirection> {
    let units = question.units;
    // what has a prior is never known worse than that
    let known = |j: usize| match question.priors[j] {
        Some(_) => f64::INFINITY,
        None => question.known[question.scene.free[j]],
    };
    let mut result = Vec::new();
    for i in (0..decomposition.rank).rev() {
        let u = decomposition.u_along(i, question.sigma);
        let times_known: Vec<f64> = u.iter().enumerate().map(|(j, u)| u.abs() / known(j)).collect();
        let leading = (0..u.len()).max_by(|&a, &b| times_known[a].total_cmp(&times_known[b])).unwrap_or(0);
        if u.is_empty() || times_known[leading] <= 1.0 {
            continue;
        }
        let share = |&j: &usize| times_known[j] > 0.05 * times_known[leading];
        let unit = units[question.scene.free[leading]];
        let known = known(leading);
        result.push(WeakDirection {
            combination: (0..u.len()).filter(share).map(|j| (names[j].clone(), u[j] / u[leading])).collect(),
            u: u[leading].abs(),
            unit,
            because: format!(
                "the readings determine {} only to {} {}, worse than the {known} {} it is taken to be known to before",
                names[leading],
                two_digits(u[leading].abs()),
                unit.as_str(),
                unit.as_str(),
            ),
            remedy: "hold these parameters at their nominal values, or take readings that differ more in the joints they \
                     belong to (a straight probe: one at least 10 mm off the last axis, or a second one of another length)"
                .into(),
        });
    }
    result
}
