//! The exchange itself.

use super::blocks::{Candidates, inverse, updated};
use super::criterion::{Criterion, gain};
use crate::error::{Error, Result};
use crate::monitor::{Monitor, Stage};
use rand::seq::index::sample;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use rayon::prelude::*;

/// What is asked.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    /// What there is to choose from.
    pub candidates: Candidates<'a>,
    /// Information that is there already, row-major over the unknowns: readings taken, priors. All zero: none.
    pub fixed: &'a [f64],
    /// What is made small.
    pub criterion: &'a Criterion,
    /// How many to choose.
    pub count: usize,
    /// Of the random set that the exchange begins with.
    pub seed: u64,
}

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub struct Chosen {
    /// Numbers of the candidates chosen, ascending.
    pub chosen: Vec<usize>,
    /// The criterion's value: of the start, then after every round.
    pub history: Vec<f64>,
    /// How many times one gave way to another.
    pub exchanges: usize,
}

/// Random sets to try until one determines everything.
const STARTS: usize = 200;
/// Rounds after which it is enough: a handful does.
const ROUNDS: usize = 40;
/// Of each chosen one, so many candidates are in the shortlist.
const SHORTLIST_EACH: usize = 20;
const SHORTLIST_LEAST: usize = 500;
/// Where the ranking is no more than a slope, so many of the best are tried in earnest.
const TRIED: usize = 12;
/// An exchange must take this part off the criterion.
const WORTH: f64 = 1e-9;

/// Chooses by exchange: see [`crate::design`]. No candidate is chosen twice.
///
/// # Errors
/// Shapes that do not agree, numbers that are not finite; fewer candidates than are to be chosen; too few rows to determine
/// every unknown; interrupted.
pub fn choose(task: &Task, monitor: &dyn Monitor) -> Result<Chosen> {
    let n = task.candidates.unknowns;
    check(task)?;
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(task.seed);
    let count = task.candidates.count();
    let start = match task.criterion {
        // a largest of many has no slope to follow from far off: the mean or the volume leads near it
        Criterion::Worst(_) => begun(task, &Criterion::Volume, monitor)?,
        Criterion::Widest(f) => begun(task, &Criterion::Mean(f.clone()), monitor)?,
        _ => (0..STARTS).find_map(|_| {
            let set = sample(&mut rng, count, task.count).into_vec();
            Some((inverse(&information(task, &set), n)?, set))
        }),
    };
    let Some((mut c, mut set)) = start else {
        return Err(Error::OutOfRange {
            what: "the number to choose".into(),
            value: task.count as f64,
            expected: "enough to determine every unknown (choose more, or hold parameters)",
        });
    };
    let mut history = vec![task.criterion.value(&c, n)];
    let mut exchanges = 0;
    for round in 0..ROUNDS {
        let mut taken = vec![false; count];
        set.iter().for_each(|&j| taken[j] = true);
        let shortlist = shortlist(task, &c, &taken);
        if !monitor.progress(Stage::Plan, round, ROUNDS) {
            return Err(Error::Interrupted);
        }
        let before = exchanges;
        // which one goes first must not depend on how candidates are numbered
        for i in (1..set.len()).rev() {
            set.swap(i, rng.random_range(0..=i));
        }
        for place in 0..set.len() {
            if !monitor.keep_going() {
                return Err(Error::Interrupted);
            }
            let Some(without) = updated(&c, task.candidates.block(set[place]), n, -1.0) else { continue };
            if let Some((better, next)) = best_instead(task, &without, set[place], &shortlist, &taken) {
                taken[set[place]] = false;
                taken[better] = true;
                (set[place], c) = (better, next);
                exchanges += 1;
            }
        }
        // updates lose a digit now and then
        c = inverse(&information(task, &set), n).unwrap_or(c);
        history.push(task.criterion.value(&c, n));
        if exchanges == before {
            break;
        }
    }
    set.sort_unstable();
    Ok(Chosen { chosen: set, history, exchanges })
}

/// What another criterion chooses, and its inverse.
fn begun(task: &Task, criterion: &Criterion, monitor: &dyn Monitor) -> Result<Option<(Vec<f64>, Vec<usize>)>> {
    let set = choose(&Task { criterion, ..*task }, monitor)?.chosen;
    Ok(inverse(&information(task, &set), task.candidates.unknowns).map(|c| (c, set)))
}

fn check(task: &Task) -> Result<()> {
    let (n, count) = (task.candidates.unknowns, task.candidates.count());
    let size = task.candidates.each * n;
    if size == 0 || task.candidates.rows.len() != count * size {
        let got = task.candidates.rows.len();
        return Err(Error::Shape { what: "the candidates' rows".into(), got, expected: count * size });
    }
    if task.fixed.len() != n * n {
        return Err(Error::Shape { what: "the information at hand".into(), got: task.fixed.len(), expected: n * n });
    }
    if let Criterion::Mean(f) | Criterion::Worst(f) | Criterion::Widest(f) = task.criterion
        && (f.is_empty() || !f.len().is_multiple_of(n))
    {
        return Err(Error::Shape { what: "the criterion's rows".into(), got: f.len(), expected: n });
    }
    if let Some(&value) = task.candidates.rows.iter().chain(task.fixed).find(|value| !value.is_finite()) {
        return Err(Error::NotFinite { what: "a number of the candidates".into(), value });
    }
    if task.count == 0 || task.count > count {
        return Err(Error::OutOfRange {
            what: "the number to choose".into(),
            value: task.count as f64,
            expected: "1 or more, and no more than there are candidates,",
        });
    }
    Ok(())
}

/// `M` of a set, with what is there already.
fn information(task: &Task, set: &[usize]) -> Vec<f64> {
    let n = task.candidates.unknowns;
    let mut m = task.fixed.to_vec();
    for row in set.iter().flat_map(|&j| task.candidates.block(j).chunks_exact(n)) {
        for (&factor, target) in row.iter().zip(m.chunks_exact_mut(n)) {
            target.iter_mut().zip(row).for_each(|(t, r)| *t += factor * r);
        }
    }
    m
}

/// The candidates that would add most to the set as it is.
fn shortlist(task: &Task, c: &[f64], taken: &[bool]) -> Vec<usize> {
    let n = task.candidates.unknowns;
    let weight = task.criterion.weight(c, n);
    let score = |j: usize| gain(c, weight.as_deref(), task.candidates.block(j), n);
    let free: Vec<usize> = (0..taken.len()).filter(|&j| !taken[j]).collect();
    let mut ranked: Vec<(f64, usize)> = free.into_par_iter().map(|j| (score(j), j)).collect();
    let most = (SHORTLIST_EACH * task.count).max(SHORTLIST_LEAST).min(ranked.len());
    if most < ranked.len() {
        ranked.select_nth_unstable_by(most, |a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        ranked.truncate(most);
    }
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    ranked.into_iter().map(|(_, j)| j).collect()
}

/// The best of the shortlist in the place of `gone`, and the inverse with it; none where `gone` is as good.
fn best_instead(
    task: &Task,
    without: &[f64],
    gone: usize,
    shortlist: &[usize],
    taken: &[bool],
) -> Option<(usize, Vec<f64>)> {
    let n = task.candidates.unknowns;
    let weight = task.criterion.weight(without, n);
    let score = |&j: &usize| (gain(without, weight.as_deref(), task.candidates.block(j), n), j);
    let open = |j: &&usize| !taken[**j];
    let better = |a: &(f64, usize), b: &(f64, usize)| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1));
    let (own, _) = score(&gone);
    let with = |j: usize| updated(without, task.candidates.block(j), n, 1.0);
    if task.criterion.exact() {
        let best = shortlist.par_iter().filter(open).map(score).min_by(better)?;
        return if best.0 > own + WORTH * own.abs() { Some((best.1, with(best.1)?)) } else { None };
    }
    let mut ranked: Vec<(f64, usize)> = shortlist.par_iter().filter(open).map(score).collect();
    ranked.sort_by(better);
    let value_with = |j: usize| with(j).map(|c| (task.criterion.value(&c, n), j, c));
    let (own, _, _) = value_with(gone)?;
    let tried = ranked.into_iter().take(TRIED).filter_map(|(_, j)| value_with(j));
    let best = tried.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))?;
    (best.0 < own - WORTH * own.abs()).then_some((best.1, best.2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::monitor::Unwatched;

    fn asked<'a>(rows: &'a [f64], each: usize, n: usize, fixed: &'a [f64], criterion: &'a Criterion) -> Task<'a> {
        Task { candidates: Candidates { rows, each, unknowns: n }, fixed, criterion, count: 4, seed: 1 }
    }

    fn powers(x: &[f64], degree: i32) -> Vec<f64> {
        x.iter().flat_map(|x| (0..=degree).map(move |p| x.powi(p))).collect()
    }

    fn identity(n: usize) -> Vec<f64> {
        (0..n * n).map(|k| f64::from(u8::from(k % (n + 1) == 0))).collect()
    }

    /// Points on [-1, 1], each five times over.
    fn grid() -> Vec<f64> {
        (0..=40).flat_map(|k| [f64::from(k) / 20.0 - 1.0; 5]).collect()
    }

    #[test]
    fn a_line_is_best_read_at_its_ends_and_a_parabola_in_the_middle_too() {
        let x = grid();
        let line = choose(&asked(&powers(&x, 1), 1, 2, &[0.0; 4], &Criterion::Volume), &Unwatched).unwrap();
        let mut at: Vec<f64> = line.chosen.iter().map(|&j| x[j]).collect();
        assert_eq!(at, [-1.0, -1.0, 1.0, 1.0]);
        let rows = powers(&x, 2);
        let task = Task { count: 6, ..asked(&rows, 1, 3, &[0.0; 9], &Criterion::Volume) };
        at = choose(&task, &Unwatched).unwrap().chosen.iter().map(|&j| x[j]).collect();
        assert_eq!(at, [-1.0, -1.0, 0.0, 0.0, 1.0, 1.0]);
        // at ends and middle alone: the equivalence theorem (Kiefer and Wolfowitz 1960): the worst variance of a prediction is p/N there
        let worst = Criterion::Worst(rows.clone());
        let found = choose(&Task { criterion: &worst, ..task }, &Unwatched).unwrap();
        assert!((found.history.last().unwrap() - 0.5).abs() < 1e-9, "{:?}", found.history);
    }

    #[test]
    fn what_was_taken_already_is_completed() {
        let x = grid();
        // four readings at the left end: all that is left to take belongs to the right
        let fixed = [4.0, -4.0, -4.0, 4.0];
        let found = choose(&asked(&powers(&x, 1), 1, 2, &fixed, &Criterion::Volume), &Unwatched).unwrap();
        assert!(found.chosen.iter().all(|&j| x[j] == 1.0), "{found:?}");
    }

    #[test]
    fn no_pair_of_exchanges_beats_what_brute_force_finds_by_much_for_any_criterion() {
        let n = 3;
        for each in [1, 2] {
            let number = |k: usize| ((k as f64 + 0.5) * 2.399).sin() + 0.4 * ((k * k) as f64 * 0.71).cos();
            let rows: Vec<f64> = (0..11 * each * n).map(number).collect();
            let tests: Vec<f64> = (0..8 * n).map(|k| number(7 * k + 3)).collect();
            let criteria = [
                Criterion::Volume,
                Criterion::Mean(tests.clone()),
                Criterion::Worst(tests),
                Criterion::Widest(identity(n)),
            ];
            for criterion in &criteria {
                let task = asked(&rows, each, n, &[0.0; 9], criterion);
                let value = |set: &[usize]| {
                    inverse(&information(&task, set), n).map_or(f64::INFINITY, |c| criterion.value(&c, n))
                };
                let mut least = f64::INFINITY;
                for bits in 0u32..1 << 11 {
                    if bits.count_ones() == 4 {
                        let set: Vec<usize> = (0..11).filter(|j| bits >> j & 1 == 1).collect();
                        least = least.min(value(&set));
                    }
                }
                let tries = (0..5).map(|seed| choose(&Task { seed, ..task }, &Unwatched).unwrap());
                let best = tries.map(|found| {
                    assert!((value(&found.chosen) - found.history.last().unwrap()).abs() < 1e-9);
                    assert!(found.history.windows(2).all(|pair| pair[1] <= pair[0] + 1e-9));
                    *found.history.last().unwrap()
                });
                let best = best.fold(f64::INFINITY, f64::min);
                assert!(best >= least - 1e-9 && best <= least + 0.02 * least.abs(), "{criterion:?}: {best} {least}");
            }
        }
    }

    #[test]
    fn what_cannot_be_asked_is_refused() {
        let rows = powers(&grid(), 2);
        let task = asked(&rows, 1, 3, &[0.0; 9], &Criterion::Volume);
        assert!(choose(&Task { count: 2, ..task }, &Unwatched).is_err());
        assert!(choose(&Task { count: 0, ..task }, &Unwatched).is_err());
        assert!(choose(&Task { count: 1000, ..task }, &Unwatched).is_err());
        assert!(choose(&Task { fixed: &[0.0; 4], ..task }, &Unwatched).is_err());
        let wrong = [f64::NAN; 30];
        assert!(choose(&asked(&wrong, 1, 3, &[0.0; 9], &Criterion::Volume), &Unwatched).is_err());
    }
}
