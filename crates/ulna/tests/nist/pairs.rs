//! Least-squares figures against NIST's reference pairs.
//!
//! `data/nist_*.txt` are 30 pairs each of points and least-squares fits, those that NIST gives away for self-checking of
//! the Algorithm Testing System (ASME B89.4.10), a work of the US government: one line of a name, the number of points and
//! the reference fit, then the points. A sphere's fit is centre and diameter; a plane's a point and the normal; a
//! cylinder's a point of the axis, its direction and the diameter; a cone's a point of the axis, its direction towards
//! growing radius, the distance from that point to the surface and the whole angle at the apex in degrees.

use crate::cones::{Cone, cone};
use crate::tabulate;
use nalgebra::Vector3;
use ulna::geometry::plane::Plane;
use ulna::geometry::{Contact, line, point};

/// Name, points and reference fit of every pair.
fn pairs(text: &str) -> Vec<(String, Vec<Vector3<f64>>, Vec<f64>)> {
    let mut lines = text.lines();
    let mut pairs = Vec::new();
    while let Some(head) = lines.next() {
        let mut words = head.split_whitespace();
        let name = words.next().unwrap().to_string();
        let count: usize = words.next().unwrap().parse().unwrap();
        let fit = words.map(|word| word.parse().unwrap()).collect();
        let point = |line: &str| {
            let xyz: Vec<f64> = line.split_whitespace().map(|word| word.parse().unwrap()).collect();
            Vector3::from_column_slice(&xyz)
        };
        pairs.push((name, lines.by_ref().take(count).map(point).collect(), fit));
    }
    assert_eq!(pairs.len(), 30);
    pairs
}

fn contacts(points: &[Vector3<f64>]) -> Vec<Contact> {
    points.iter().map(|&p_mm| Contact { p_mm, apart_mm: 0.0, weight: 1.0 }).collect()
}

/// How far a fit is off its reference: its place and its size in mm, its directions and angles in rad.
#[derive(Debug, Clone, Copy, Default)]
struct Off {
    place_mm: f64,
    size_mm: f64,
    turn_rad: f64,
}

impl Off {
    fn or(self, other: Off) -> Off {
        Off {
            place_mm: self.place_mm.max(other.place_mm),
            size_mm: self.size_mm.max(other.size_mm),
            turn_rad: self.turn_rad.max(other.turn_rad),
        }
    }

    fn within(&self, mm: f64, rad: f64) -> bool {
        self.place_mm < mm && self.size_mm < mm && self.turn_rad < rad
    }
}

/// Points and the reference fit.
type Fitted = fn(&[Vector3<f64>], &[f64]) -> Off;

fn sphere(points: &[Vector3<f64>], fit: &[f64]) -> Off {
    let found = point::sphere(&contacts(points)).unwrap();
    let place_mm = (found.at_mm - Vector3::from_column_slice(&fit[..3])).norm();
    Off { place_mm, size_mm: (2.0 * found.radius_mm - fit[3]).abs(), turn_rad: 0.0 }
}

fn plane(points: &[Vector3<f64>], fit: &[f64]) -> Off {
    let found = Plane::at_known_distances(&contacts(points));
    let (on, normal) = (Vector3::from_column_slice(&fit[..3]), Vector3::from_column_slice(&fit[3..6]));
    let place_mm = (found.normal.dot(&(on - found.middle_mm)) - found.offset_mm).abs();
    Off { place_mm, size_mm: 0.0, turn_rad: found.normal.cross(&normal).norm() }
}

/// How far a point is from an axis.
fn beside(p_mm: Vector3<f64>, on_mm: Vector3<f64>, along: Vector3<f64>) -> f64 {
    let arm = p_mm - on_mm;
    (arm - along * along.dot(&arm)).norm()
}

fn cylinder(points: &[Vector3<f64>], fit: &[f64]) -> Off {
    let found = line::cylinder(&contacts(points)).unwrap();
    let (on, along) = (Vector3::from_column_slice(&fit[..3]), Vector3::from_column_slice(&fit[3..6]));
    Off {
        place_mm: beside(on, found.foot_mm, found.direction),
        size_mm: (2.0 * found.radius_mm - fit[6]).abs(),
        turn_rad: found.direction.cross(&along).norm(),
    }
}

/// Coordinates are up to a metre: reference values agree with ours in all the digits that doubles have of them.
const OF_REFERENCE_MM: f64 = 1e-12;
const OF_REFERENCE_RAD: f64 = 1e-12;
/// Of a cone's axis some sets of points say little, so that rounding of a sum of squares moves it more.
const OF_CONE_MM: f64 = 1e-7;
const OF_CONE_RAD: f64 = 1e-9;

fn as_row(figure: &str, by: &str, count: usize, off: Off) -> String {
    let shown = |value: f64| if value == 0.0 { "–".to_string() } else { format!("{value:.0e}") };
    let Off { place_mm, size_mm, turn_rad } = off;
    format!("| {figure} | {by} | {count} | {} | {} | {} |", shown(place_mm), shown(size_mm), shown(turn_rad))
}

#[test]
fn figures_are_those_of_nist() {
    let figures: [(&str, &str, Fitted); 3] = [
        ("spheres", include_str!("../data/nist_sphere.txt"), sphere),
        ("planes", include_str!("../data/nist_plane.txt"), plane),
        ("cylinders", include_str!("../data/nist_cylinder.txt"), cylinder),
    ];
    let mut rows = vec![];
    for (figure, text, fitted) in figures {
        let mut worst = Off::default();
        for (name, points, fit) in pairs(text) {
            let off = fitted(&points, &fit);
            assert!(off.within(OF_REFERENCE_MM, OF_REFERENCE_RAD), "{name}: {off:?}");
            worst = worst.or(off);
        }
        rows.push(as_row(figure, "the core's fit", 30, worst));
    }
    let (count, worst) = cones();
    rows.push(as_row("cones", "the core's solver", count, worst));
    let head = "| figure | fitted by | pairs | place / mm | size / mm | direction, angle / rad |\n|---|---|---:|---:|---:|---:|";
    tabulate("nist-figures.md", head, &rows);
}

/// How many cones could be compared, and the worst.
fn cones() -> (usize, Off) {
    let (mut compared, mut worst) = (0, Off::default());
    for (name, points, fit) in pairs(include_str!("../data/nist_cone.txt")) {
        let reference = Cone {
            on_mm: Vector3::from_column_slice(&fit[..3]),
            along: Vector3::from_column_slice(&fit[3..6]),
            to_surface_mm: fit[6],
            half_angle_rad: fit[7].to_radians() / 2.0,
        };
        let found = cone(&points);
        let (least, of_reference) = (found.cost(&points), reference.cost(&points));
        let rounding = points.len() as f64 * (1e-12_f64).powi(2);
        assert!(least <= of_reference * (1.0 + 1e-9) + rounding, "{name}: {least:e}, reference {of_reference:e}");
        if points.len() == 6 {
            continue; // as many points as unknowns: several cones go through them
        }
        let there =
            found.to_surface_mm + (reference.on_mm - found.on_mm).dot(&found.along) * found.half_angle_rad.sin();
        let off = Off {
            place_mm: beside(reference.on_mm, found.on_mm, found.along),
            size_mm: (there - reference.to_surface_mm).abs(),
            turn_rad: (found.along - reference.along)
                .norm()
                .max(2.0 * (found.half_angle_rad - reference.half_angle_rad).abs()),
        };
        assert!(off.within(OF_CONE_MM, OF_CONE_RAD), "{name}: {off:?}");
        compared += 1;
        worst = worst.or(off);
    }
    (compared, worst)
}
