//! try
use std::time::Instant;
use ulna::{arm::*, calibrate::*, monitor::Unwatched, problem::Problem, residuals::length::LengthRows, residuals::Noise, kinematics};
fn arm(dh: [[f64; 4]; 6], tip: [f64; 3]) -> Arm {
    let joint = |p: [f64; 4]| Joint { theta0_rad: p[0], alpha_rad: p[1], a_mm: p[2], d_mm: p[3], beta_rad: 0.0, sign: 1.0, model: JointModel::Dh };
    Arm::new(dh.map(joint).to_vec(), 1.0, vec![Probe { name: "bent".into(), tip_mm: tip }]).unwrap()
}
fn main() {
    let h = std::f64::consts::FRAC_PI_2;
    let t2 = [[0.0, -h, 40.0, 250.0],[2.2689, h, -40.0, 0.0],[0.0, -h, 30.0, 450.0],[2.2689, h, -30.0, 0.0],[0.0, -h, 30.0, 450.0],[2.2689, h, -30.0, 0.0]];
    let t3 = [[0.1,-1.57,35.,260.],[2.2,1.57,-35.,0.],[0.1,-1.57,35.,400.],[2.2,1.57,-35.,0.],[0.1,-1.57,35.,400.],[2.2,1.57,-35.,0.]];
    let mut s = 12345u64;
    let mut rnd = move || { s = s.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407); (s >> 11) as f64 / (1u64 << 53) as f64 };
    for r in [10.0, 0.0, 1.0, 0.1] {
        let truth = arm(t2, [r, 0.0, 200.0]);
        let start = arm(t3, [if r == 0.0 {0.0} else {r * 0.5}, if r == 0.0 {0.0} else {0.1}, 180.0]);
        for n in [101usize, 10_000, 1_000_000] {
            if n > 101 && r != 10.0 { continue; }
            let q: Vec<f64> = (0..7 * n).map(|_| (rnd() - 0.5) * 6.0).collect();
            let p: Vec<f64> = (0..7 * n).map(|_| (rnd() - 0.5) * 6.0).collect();
            let len: Vec<f64> = (0..n).map(|i| (kinematics::tip_mm(&truth, 0, &q[7*i..7*i+7]) - kinematics::tip_mm(&truth, 0, &p[7*i..7*i+7])).norm()).collect();
            let probe = vec![0usize; n];
            let mut problem = Problem::new(start.clone(), None).unwrap();
            problem.add_lengths("bar", LengthRows { q_rad: &q, p_rad: &p, probe: &probe, length_mm: &len }, 0.0).unwrap();
            let free: Vec<usize> = (0..27).collect();
            for _ in 0..if n > 100_000 {2} else {5} {
                let t = Instant::now();
                let s = solve(&mut problem, &free, &Options::default(), &Unwatched).unwrap();
                println!("r {r} n {n}: {:?} {:.1} us {:?}", s.report, t.elapsed().as_secs_f64() * 1e6, s.searched_starts);
            }
            let t = Instant::now();
            let f = fit(&mut problem, &free, &Options::default(), &Unwatched).unwrap();
            println!("fit {:.1} us rank {} cond {:.2e} {:?}", t.elapsed().as_secs_f64() * 1e6, f.identifiability.determined, f.identifiability.condition, f.folded);
            let tv = truth.parameters();
            let mut w = (0.0f64, 0.0f64);
            for (j, (a, b)) in f.solution.parameters.iter().zip(&tv).enumerate() {
                if f.identifiability.in_lost[j] { continue; }
                let e = (a - b).abs();
                if truth.parameter_units()[j] == Unit::Rad { w.0 = w.0.max(e) } else { w.1 = w.1.max(e) }
            }
            println!("worst rad {:.1e} mm {:.1e}", w.0, w.1);
            for l in &f.identifiability.lost { println!("  {:?} {:?}", l.because.cause, l.combination); }
            if n == 101 {
                let mut prob = Problem::new(start.clone(), Some(Noise { encoder_rad: vec![5e-6; 7], seat_mm: 0.008 })).unwrap();
                prob.add_lengths("bar", LengthRows { q_rad: &q, p_rad: &p, probe: &probe, length_mm: &len }, 0.0).unwrap();
                for threads in [1, 2] { for unc in [false, true] {
                    let t = Instant::now();
                    let runs = ulna::monte_carlo::recalibrate(&prob, &free, &ulna::monte_carlo::Repeat { truth: &truth, runs: 1000, seed: 1, threads, uncertainties: unc }, &Unwatched).unwrap();
                    println!("MC {threads} {unc} {:.1} ms conv {}", t.elapsed().as_secs_f64() * 1e3, runs.iter().filter(|r| r.converged).count());
                    if unc { let cov: Vec<String> = (0..27).map(|j| format!("{:.3}", runs.iter().filter(|r| (r.parameters[j] - tv[j]).abs() < 1.96 * r.u[j]).count() as f64 / 1000.0)).collect(); println!("{cov:?}"); }
                }}
            }
        }
    }
}
