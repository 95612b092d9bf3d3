//! Timings of the core, one thread unless said otherwise, printed as JSON for `make bench`.
//!
//! The arm is the assumed truth of Cheng 2011, Table 2 (bent probe, r = 10 mm); angles are uniform in ±3 rad; fits start
//! from Table 3. Each figure is the best of several runs: the machine is shared, and what is slower is somebody else.

mod shared;

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use shared::{Dropped, TABLE_2, arm, best};
use std::f64::consts::PI;
use std::hint::black_box;
use std::time::Instant;
use ulna::arm::Unit;
use ulna::artefacts::{Noise, Rows, Stated, Weighing};
use ulna::fit::calibrate::{Options, Start, fit, solve};
use ulna::fit::monte_carlo::{Repeat, recalibrate};
use ulna::kinematics::{Angles, Chain, Poses, batch};
use ulna::monitor::Unwatched;
use ulna::problem::Problem;
use ulna::problem::assembly::Assembly;
use ulna::simd::{Columns, simd_level};
use ulna::solver::LeastSquares;

/// Where the fits start: its Table 3.
const TABLE_3: [[f64; 4]; 6] = [
    [0.1, -1.57, 35.0, 260.0],
    [2.2, 1.57, -35.0, 0.0],
    [0.1, -1.57, 35.0, 400.0],
    [2.2, 1.57, -35.0, 0.0],
    [0.1, -1.57, 35.0, 400.0],
    [2.2, 1.57, -35.0, 0.0],
];

fn angles(rng: &mut Xoshiro256PlusPlus, count: usize) -> Vec<f64> {
    (0..count).map(|_| rng.random_range(-3.0..3.0)).collect()
}

/// Lengths that are exact for the truth.
fn problem(rng: &mut Xoshiro256PlusPlus, count: usize, noise: Option<Noise>) -> Problem {
    let (truth, start) = (arm(TABLE_2, [10.0, 0.0, 200.0]), arm(TABLE_3, [5.0, 0.1, 180.0]));
    let (q, p) = (angles(rng, 7 * count), angles(rng, 7 * count));
    let tips = |angles: &[f64]| {
        let mut out = vec![0.0; 3 * count];
        batch::tips_from_rows_mm(&Chain::new(&truth), [10.0, 0.0, 200.0], Angles::cold(angles), &mut out);
        out
    };
    let (from, to) = (tips(&q), tips(&p));
    let distance = |k: usize| (0..3).map(|j| (from[3 * k + j] - to[3 * k + j]).powi(2)).sum::<f64>().sqrt();
    let length_mm: Vec<f64> = (0..count).map(distance).collect();
    let mut problem = Problem::new(start, noise).expect("a valid problem");
    let rows = Rows {
        poses: Angles::cold(&q),
        probe: &vec![0; count],
        second: Some(Angles::cold(&p)),
        measured_mm: Some(&length_mm),
        ..Rows::default()
    };
    problem.add("length", &Stated { name: "bar", ..Stated::default() }, &rows).expect("valid rows");
    problem
}

/// Searches with zero offsets wrong by up to π and lengths by up to 100 mm on 101 exact lengths: how many end at the
/// truth (residuals below 1e-8 mm), and the seconds of the slowest, judgement included.
fn searches(rng: &mut Xoshiro256PlusPlus, count: usize) -> (usize, f64) {
    let free: Vec<usize> = (0..27).collect();
    let options = Options { start: Start::Search, ..Options::default() };
    let mut readings = problem(rng, 101, None);
    let truth = arm(TABLE_2, [10.0, 0.0, 200.0]);
    let (mut found, mut slowest) = (0, 0.0_f64);
    for _ in 0..count {
        let mut start = truth.parameters();
        for (j, unit) in truth.parameter_units().into_iter().enumerate() {
            match unit {
                Unit::Mm => start[j] += rng.random_range(-100.0..100.0),
                Unit::Rad if j % 4 == 0 => start[j] += rng.random_range(-PI..PI),
                _ => {}
            }
        }
        readings.set_arm(truth.with_parameters(&start).expect("a valid arm"));
        let begin = Instant::now();
        let fitted = fit(&mut readings, &free, &options, &Unwatched).expect("a fit");
        slowest = slowest.max(begin.elapsed().as_secs_f64());
        found += usize::from(fitted.rms_mm < 1e-8);
    }
    (found, slowest)
}

/// A line of what the system says of this process's memory, MB; 0 where it does not say.
fn memory_mb(line: &str) -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let found = status.lines().find(|l| l.starts_with(line));
    found.and_then(|l| l.split_whitespace().nth(1)).and_then(|kb| kb.parse::<f64>().ok()).unwrap_or(0.0) / 1024.0
}

fn main() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(2011);
    let free: Vec<usize> = (0..27).collect();
    let mut figures: Vec<(String, f64)> = Vec::new();

    // fits first, the largest of them before anything else has taken memory
    let mut fits = Vec::new();
    for (count, runs) in [(1_000_000, 3), (10_000, 20), (101, 2000)] {
        let mut problem = problem(&mut rng, count, None);
        // forget the peak that making the readings left, so that the fit's own shows
        let _ = std::fs::write("/proc/self/clear_refs", "5");
        let before_mb = memory_mb("VmRSS");
        let solved = best(runs, || {
            black_box(solve(&mut problem, &free, &Options::default(), &Unwatched).expect("a fit"));
        });
        if count == 1_000_000 {
            figures.push(("fit_1000000_memory_beyond_data_mb".into(), memory_mb("VmHWM") - before_mb));
        }
        let judged = best(runs.min(50), || {
            black_box(fit(&mut problem, &free, &Options::default(), &Unwatched).expect("a fit"));
        });
        fits.push((count, solved * 1e3, judged * 1e3));
    }

    let truth = arm(TABLE_2, [10.0, 0.0, 200.0]);
    let million = angles(&mut rng, 7_000_000);
    let poses = Poses::from_rows(&million, 7);
    let mut out = Columns::zeros(3, 1_000_000);
    let chain = Chain::new(&truth);
    let forward = best(7, || batch::tips_of_probe_mm(&chain, &poses, [10.0, 0.0, 200.0], &mut out));
    figures.push(("forward_poses_per_s".into(), 1e6 / forward));

    let mut lengths = problem(&mut rng, 10_000, None);
    let x = lengths.arm().parameters();
    lengths.weigh(&x, Weighing::Full);
    let mut assembly = Assembly::new(&lengths, &free, &[], &Unwatched);
    let rows = best(200, || assembly.rows(&x, true, &mut Dropped).expect("rows"));
    figures.push(("residual_jacobian_poses_per_s".into(), 2e4 / rows));

    let noise = Noise { encoder_rad: vec![5e-6; 7], seat_mm: 0.008 };
    let noisy = problem(&mut rng, 101, Some(noise));
    let mut repeats = Vec::new();
    for threads in [1, 2] {
        let repeat = Repeat { truth: &truth, first: 0, runs: 1000, seed: 1, threads, uncertainties: false };
        let seconds = best(7, || {
            black_box(recalibrate(&noisy, &free, &repeat, &Unwatched).expect("fits"));
        });
        repeats.push((threads, seconds));
    }

    let (found, slowest) = searches(&mut rng, 200);
    figures.push(("search_found_of_200".into(), found as f64));
    figures.push(("search_slowest_s".into(), slowest));

    let list = |items: Vec<String>| items.join(", ");
    let solve_ms = list(fits.iter().map(|(n, ms, _)| format!("\"{n}\": {ms:.5}")).collect());
    let fit_ms = list(fits.iter().map(|(n, _, ms)| format!("\"{n}\": {ms:.5}")).collect());
    let repeat_s = list(repeats.iter().map(|(t, s)| format!("\"{t}\": {s:.5}")).collect());
    let plain = list(figures.iter().map(|(name, value)| format!("\"{name}\": {value:.3}")).collect());
    println!(
        "{{\"simd\": \"{}\", {plain}, \"fit_ms\": {{{solve_ms}}}, \"fit_and_judge_ms\": {{{fit_ms}}}, \
         \"recalibrate_1000_s\": {{{repeat_s}}}}}",
        simd_level()
    );
}
