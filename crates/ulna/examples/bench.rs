//! Timing.
use std::time::Instant;
use ulna::{arm::*, kinematics::batch::*};
fn main() {
    let h = std::f64::consts::FRAC_PI_2;
    let joint = |p: [f64; 4]| Joint { theta0_rad: p[0], alpha_rad: p[1], a_mm: p[2], d_mm: p[3], beta_rad: 0.0, sign: 1.0, model: JointModel::Dh };
    let dh = [[0.0, -h, 40.0, 250.0],[2.2689, h, -40.0, 0.0],[0.0, -h, 30.0, 450.0],[2.2689, h, -30.0, 0.0],[0.0, -h, 30.0, 450.0],[2.2689, h, -30.0, 0.0]];
    let arm = Arm::new(dh.map(joint).to_vec(), 1.0, vec![Probe { name: "bent".into(), tip_mm: [10.0, 0.0, 200.0] }]).unwrap();
    let chain = Chain::new(&arm);
    let n = 1_000_000;
    let q: Vec<f64> = (0..7 * n).map(|i| ((i as f64 * 0.618).fract() - 0.5) * 6.0).collect();
    let mut poses = Poses::from_rows(&q, 7);
    let mut out = Columns::zeros(3, n);
    println!("{}", simd_level());
    for _ in 0..5 {
        let t = Instant::now();
        tips_of_probe_mm(&chain, &poses, [10.0, 0.0, 200.0], &mut out);
        println!("forward {:.1} M/s", n as f64 / t.elapsed().as_secs_f64() / 1e6);
    }
    let mut rows = vec![0.0; 3 * n];
    for _ in 0..3 {
        let t = Instant::now();
        tips_from_rows_mm(&chain, [10.0, 0.0, 200.0], &q, &mut rows);
        println!("rows {:.1} M/s", n as f64 / t.elapsed().as_secs_f64() / 1e6);
    }
    poses.keep_sin_cos();
    for _ in 0..3 {
        let t = Instant::now();
        tips_of_probe_mm(&chain, &poses, [10.0, 0.0, 200.0], &mut out);
        println!("kept {:.1} M/s", n as f64 / t.elapsed().as_secs_f64() / 1e6);
    }
    let mut worst = 0.0f64;
    for i in (0..n).step_by(1000) {
        let p = ulna::kinematics::tip_mm(&arm, 0, &q[7*i..7*i+7]);
        worst = worst.max((p.x - out.column(0)[i]).abs()).max((p.z-rows[3*i+2]).abs());
    }
    println!("worst {worst:e}");
}
