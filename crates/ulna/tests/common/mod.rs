//! Arms and readings that the tests share.
#![allow(dead_code, reason = "each test file uses its own part")]

pub mod cases;

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use ulna::arm::{
    Arm, Backlash, BaseOffset, BaseTilt, Body, Compliance, Coupling, Effects, Expansion, Harmonics, Joint, JointModel,
    Probe,
};
use ulna::artefacts::Noise;
use ulna::kinematics::{Angles, Conditions, tip_mm};

pub fn rng(seed: u64) -> Xoshiro256PlusPlus {
    Xoshiro256PlusPlus::seed_from_u64(seed)
}

pub fn angles(rng: &mut Xoshiro256PlusPlus, count: usize) -> Vec<f64> {
    (0..count).map(|_| rng.random_range(-3.0..3.0)).collect()
}

/// An arm of `n` encoders with all kinds of joints, signs and two probes.
pub fn any_arm(rng: &mut Xoshiro256PlusPlus, n: usize) -> Arm {
    let joints = (0..n - 1).map(|i| any_joint(rng, i)).collect();
    let probes = any_probes(rng);
    Arm::new(joints, if n.is_multiple_of(2) { 1.0 } else { -1.0 }, probes).unwrap()
}

/// The same with a link after the last joint too.
pub fn any_full_arm(rng: &mut Xoshiro256PlusPlus, n: usize) -> Arm {
    let joints = (0..n).map(|i| any_joint(rng, i)).collect();
    let probes = any_probes(rng);
    Arm::with_full_last_link(joints, probes).unwrap()
}

/// The same arm with some of its joints sliding, those of Hayati turning as before; none of them coupled.
pub fn sliding(arm: &Arm, rng: &mut Xoshiro256PlusPlus) -> Arm {
    let hayati = |i: usize| arm.joints().get(i).is_some_and(|joint| joint.model == JointModel::Hayati);
    let each = (0..arm.encoders()).map(|i| (!hayati(i) && rng.random()).then_some(300.0));
    let slides: Vec<Option<f64>> = each.collect();
    let effects = Effects { coupling: None, ..arm.effects().clone() };
    arm.with_effects(effects).unwrap().with_slides(&slides).unwrap()
}

/// The assumed truth of Cheng 2011, Table 2, with these probes.
pub fn cheng_2011(probes: &[(&str, [f64; 3])]) -> Arm {
    let rows = [
        [0.0, -1.57, 40.0, 255.0],
        [2.1, 1.57, -40.0, 0.0],
        [0.2, -1.57, 30.0, 410.0],
        [2.0, 1.57, -30.0, 0.0],
        [0.1, -1.57, 30.0, 400.0],
        [2.3, 1.57, -30.0, 0.0],
    ];
    let probes = probes.iter().map(|&(name, tip_mm)| Probe { name: name.into(), tip_mm }).collect();
    Arm::new(rows.map(Joint::dh).to_vec(), 1.0, probes).unwrap()
}

/// What some arms do beyond their geometry, larger than any arm would.
pub fn any_effects(rng: &mut Xoshiro256PlusPlus, n: usize) -> Effects {
    let mut small = |size: f64| rng.random_range(-size..size);
    let mut harmonics = Harmonics::zero(&[1, 2, 5], n);
    harmonics.amplitudes_rad.iter_mut().flatten().for_each(|amplitude| *amplitude = small(0.02));
    let body = |small: &mut dyn FnMut(f64) -> f64| Body {
        mass_kg: 3.0 + small(2.0),
        centre_mm: [small(100.0), small(100.0), small(100.0)],
    };
    Effects {
        harmonics: Some(harmonics),
        backlash: Some(Backlash { rad: (0..n).map(|_| small(0.05)).collect() }),
        coupling: Some(any_coupling(n, &mut small)),
        expansion: Some(Expansion { per_kelvin: (0..n).map(|_| small(1e-3)).collect() }),
        compliance: Some(Compliance {
            rad_per_nm: (0..n).map(|_| small(5e-3)).collect(),
            bodies: (0..n).map(|_| body(&mut small)).collect(),
            gravity: [small(1.0), small(1.0), -1.5],
            payload_kg: 8.0,
        }),
        base_tilt: Some(BaseTilt { rad: [small(1.0), small(1.0)], joints: n }),
        base_offset: Some(BaseOffset { mm: [small(50.0), small(50.0)], joints: n }),
    }
}

/// Every third joint turns with its neighbour, and the last with the two before it.
fn any_coupling(n: usize, small: &mut impl FnMut(f64) -> f64) -> Coupling {
    let others: Vec<Vec<usize>> = (0..n)
        .map(|joint| match joint {
            _ if joint + 1 == n => (joint.saturating_sub(2)..joint).collect(),
            _ if joint % 3 == 2 => vec![joint - 1],
            _ => vec![],
        })
        .collect();
    let count = others.iter().map(Vec::len).sum();
    Coupling { others, ratios: (0..count).map(|_| small(1.0)).collect() }
}

/// Temperatures above 20 °C, one for each joint of each pose.
pub fn warmth(rng: &mut Xoshiro256PlusPlus, count: usize) -> Vec<f64> {
    (0..count).map(|_| rng.random_range(-8.0..15.0)).collect()
}

/// From which side each joint of each pose was approached: any, unknown ones too.
pub fn approach(rng: &mut Xoshiro256PlusPlus, count: usize) -> Vec<f64> {
    (0..count).map(|_| f64::from(rng.random_range(-1..=1))).collect()
}

/// What each pose carried: mass, kg, and its centre, mm; some of them nothing.
pub fn payload(rng: &mut Xoshiro256PlusPlus, poses: usize) -> Vec<f64> {
    let mut one = || -> [f64; 4] {
        let mass_kg = [0.0, rng.random_range(0.0..8.0)][rng.random_range(0..2)];
        [mass_kg, rng.random_range(-90.0..90.0), rng.random_range(-90.0..90.0), rng.random_range(-90.0..90.0)]
    };
    (0..poses).flat_map(|_| one()).collect()
}

/// What was true at poses: of `joints` numbers each, warmth one or one for each joint.
pub struct Told {
    pub warmth_k: Vec<f64>,
    pub approach: Vec<f64>,
    pub payload: Vec<f64>,
}

impl Told {
    pub fn any(rng: &mut Xoshiro256PlusPlus, poses: usize, warmths: usize, approaches: usize) -> Told {
        let (warmth_k, approach) = (warmth(rng, poses * warmths), approach(rng, poses * approaches));
        Told { warmth_k, approach, payload: payload(rng, poses) }
    }

    pub fn at<'a>(&'a self, q_rad: &'a [f64]) -> Angles<'a> {
        let conditions = Conditions { warmth_k: &self.warmth_k, approach: &self.approach, payload: &self.payload };
        Angles { q_rad, conditions }
    }
}

fn any_joint(rng: &mut Xoshiro256PlusPlus, i: usize) -> Joint {
    let hayati = i % 3 == 1;
    Joint {
        theta0_rad: rng.random_range(-3.0..3.0),
        alpha_rad: rng.random_range(-2.0..2.0),
        a_mm: rng.random_range(-300.0..300.0),
        d_mm: if hayati { 0.0 } else { rng.random_range(-300.0..300.0) },
        beta_rad: if hayati { rng.random_range(-0.5..0.5) } else { 0.0 },
        sign: if rng.random::<bool>() { 1.0 } else { -1.0 },
        model: if hayati { JointModel::Hayati } else { JointModel::Dh },
    }
}

fn any_probes(rng: &mut Xoshiro256PlusPlus) -> Vec<Probe> {
    let mut tip = || [rng.random_range(-50.0..50.0), rng.random_range(-50.0..50.0), rng.random_range(100.0..250.0)];
    ["straight", "bent"].map(|name| Probe { name: name.into(), tip_mm: tip() }).to_vec()
}

pub fn noises(encoders: usize) -> [(&'static str, Option<Noise>); 3] {
    let seat_only = Noise { encoder_rad: vec![], seat_mm: 0.02 };
    let both = Noise { encoder_rad: vec![2e-5; encoders], seat_mm: 0.01 };
    [("no noise stated", None), ("seat noise", Some(seat_only)), ("encoder and seat noise", Some(both))]
}

/// Tips by the plain map, mm.
pub fn plain(arm: &Arm, probe: usize, q_rad: &[f64]) -> Vec<[f64; 3]> {
    q_rad.chunks_exact(arm.encoders()).map(|q| tip_mm(arm, probe, q).into()).collect()
}
