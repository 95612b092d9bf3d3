//! What the timing programs share: the arm of Cheng 2011, and how to time.

use std::hint::black_box;
use std::time::Instant;
use ulna::arm::{Arm, Joint, Probe};
use ulna::solver::{RowBlock, RowSink};

const H: f64 = std::f64::consts::FRAC_PI_2;
/// The assumed truth of its Table 2: theta0, alpha, a, d.
pub const TABLE_2: [[f64; 4]; 6] = [
    [0.0, -H, 40.0, 250.0],
    [2.2689, H, -40.0, 0.0],
    [0.0, -H, 30.0, 450.0],
    [2.2689, H, -30.0, 0.0],
    [0.0, -H, 30.0, 450.0],
    [2.2689, H, -30.0, 0.0],
];
/// An arm with one bent probe.
pub fn arm(dh: [[f64; 4]; 6], tip_mm: [f64; 3]) -> Arm {
    let probe = Probe { name: "bent".into(), tip_mm };
    Arm::new(dh.map(Joint::dh).to_vec(), 1.0, vec![probe]).expect("a valid arm")
}

/// Seconds of the best of `runs`.
pub fn best(runs: usize, mut work: impl FnMut()) -> f64 {
    let once = |work: &mut dyn FnMut()| {
        let begin = Instant::now();
        work();
        begin.elapsed().as_secs_f64()
    };
    (0..runs).map(|_| once(&mut work)).fold(f64::MAX, f64::min)
}

/// Takes rows and does nothing with them.
pub struct Dropped;

impl RowSink for Dropped {
    fn fold(&mut self, block: &mut RowBlock) {
        black_box(block.rows);
    }
}
