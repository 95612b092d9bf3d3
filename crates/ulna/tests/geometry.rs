//! Least-squares figures against the figure that the points were made from; `nist` has them against reference fits.

use nalgebra::Vector3;
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use ulna::geometry::{Contact, line, point};

mod common;
use common::rng;

fn normal(rng: &mut Xoshiro256PlusPlus) -> f64 {
    StandardNormal.sample(rng)
}

fn direction(rng: &mut Xoshiro256PlusPlus) -> Vector3<f64> {
    Vector3::from_fn(|_, _| normal(rng)).normalize()
}

/// A cylinder, and touches of a part of it: how far round, how long, how many, how noisy, all as it comes.
fn touched(rng: &mut Xoshiro256PlusPlus, fewest: usize) -> (line::Axis, Vec<Contact>) {
    let along = direction(rng);
    let first = along.cross(&direction(rng)).normalize();
    let axis = line::Axis {
        foot_mm: Vector3::from_fn(|_, _| rng.random_range(-800.0..800.0)),
        direction: along,
        across: [first, along.cross(&first)],
        radius_mm: 0.0,
    };
    let radius = 10.0_f64.powf(rng.random_range(0.7..2.0));
    let (arc, length) = (rng.random_range(1.5..6.3), radius * 10.0_f64.powf(rng.random_range(-0.2..1.2)));
    let noise = radius * 10.0_f64.powf(rng.random_range(-4.0..-2.0));
    let ball = rng.random_range(1.0..4.0) * if rng.random::<bool>() { 1.0 } else { -0.5 };
    let touch = |rng: &mut Xoshiro256PlusPlus| {
        let (turn, height) = (rng.random_range(0.0..arc), rng.random_range(0.0..length));
        let (sin, cos) = f64::sin_cos(turn);
        let apart_mm = radius + ball;
        let out = axis.across[0] * cos + axis.across[1] * sin;
        let p_mm = axis.foot_mm + along * height + out * (apart_mm + noise * normal(rng));
        Contact { p_mm, apart_mm, weight: rng.random_range(50.0..150.0) }
    };
    let count = rng.random_range(fewest..40);
    let contacts = (0..count).map(|_| touch(rng)).collect();
    (axis, contacts)
}

fn cost(contacts: &[Contact], residual: impl Fn(&Contact) -> f64) -> f64 {
    contacts.iter().map(|contact| (contact.weight * residual(contact)).powi(2)).sum()
}

#[test]
fn no_line_is_better_than_the_one_found() {
    let mut rng = rng(5);
    for number in 0..3000 {
        let (truth, contacts) = touched(&mut rng, 9);
        let found = line::at_known_distances(&contacts);
        let (best, own) = (cost(&contacts, |c| found.residual(c).0), cost(&contacts, |c| truth.residual(c).0));
        assert!(best <= own * (1.0 + 1e-9), "{number}: {} touches, {best:e} against {own:e}", contacts.len());
    }
}

#[test]
fn no_cylinder_is_better_than_the_one_found() {
    let mut rng = rng(6);
    for number in 0..3000 {
        let (truth, contacts) = touched(&mut rng, 10);
        let found = line::cylinder(&contacts).unwrap();
        let (best, own) = (cost(&contacts, |c| found.residual(c).0), cost(&contacts, |c| truth.residual(c).0));
        assert!(best <= own * (1.0 + 1e-9), "{number}: {} touches, {best:e} against {own:e}", contacts.len());
    }
}

/// A point, and tips at measured distances from it: all around or nearly in a plane, near or far.
fn ranged(rng: &mut Xoshiro256PlusPlus) -> (Vector3<f64>, Vec<Contact>) {
    let foot = Vector3::from_fn(|_, _| rng.random_range(-1500.0..1500.0));
    let (turn, size) = (nalgebra::Rotation3::new(direction(rng) * 2.0), rng.random_range(100.0..800.0));
    let flat = 10.0_f64.powf(rng.random_range(-1.5..0.0));
    let noise = 10.0_f64.powf(rng.random_range(-2.0..1.0)).min(0.02 * flat * size);
    let tip = |rng: &mut Xoshiro256PlusPlus| {
        let at =
            Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0) * size).component_mul(&Vector3::new(1.0, 1.0, flat));
        let p_mm = turn * at;
        Contact { p_mm, apart_mm: (p_mm - foot).norm() + noise * normal(rng), weight: rng.random_range(50.0..150.0) }
    };
    let count = rng.random_range(6..40);
    let contacts = (0..count).map(|_| tip(rng)).collect();
    (foot, contacts)
}

#[test]
fn no_point_is_better_than_the_one_found() {
    let mut rng = rng(8);
    for number in 0..5000 {
        let (foot, contacts) = ranged(&mut rng);
        let (found, truth) = (point::at_known_distances(&contacts), point::Centre { at_mm: foot, radius_mm: 0.0 });
        let (best, own) = (cost(&contacts, |c| found.residual(c).0), cost(&contacts, |c| truth.residual(c).0));
        assert!(best <= own * (1.0 + 1e-9), "{number}: {} tips, {best:e} against {own:e}", contacts.len());
    }
}

#[test]
fn a_line_has_no_slope_where_it_is_found() {
    let mut rng = rng(7);
    for _ in 0..300 {
        let (_, contacts) = touched(&mut rng, 9);
        let found = line::at_known_distances(&contacts);
        let mut slopes = [[0.0, 0.0]; 4];
        for contact in &contacts {
            let (residual, normal, along) = found.residual(contact);
            for (slope, own) in slopes.iter_mut().zip(found.derivatives(&normal, along)) {
                let (own, residual) = (contact.weight * own, contact.weight * residual);
                *slope = [slope[0] + own * residual, slope[1] + (own * residual).abs()];
            }
        }
        assert!(slopes.iter().all(|[sum, size]| sum.abs() < 1e-8 * size), "{slopes:?}");
    }
}
