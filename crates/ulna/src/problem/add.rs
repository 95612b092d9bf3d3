//! Readings on their way into a problem: what cannot be used is refused, with its name and value.

use super::groups::{MOST_MM, Problem};
use crate::artefacts::Dimension;
use crate::artefacts::length::{LengthRows, Lengths};
use crate::artefacts::points::{Features, Points, Uncertainty};
use crate::artefacts::surface::{Plane, Side, Sphere, Surface};
use crate::artefacts::{Readings, TouchRows};
use crate::error::{Error, Result};
use crate::kinematics::Angles;

/// A ball or a hollow, as a study states it.
#[derive(Debug, Clone, Copy)]
pub struct BallArtefact<'a> {
    /// The artefact's name.
    pub name: &'a str,
    /// Diameter, mm.
    pub diameter_mm: f64,
    /// Standard uncertainty of the diameter, mm.
    pub u_mm: f64,
    /// Whether the diameter is an unknown of the fit; within its uncertainty, where that is not 0.
    pub fitted: bool,
    /// Which side is touched.
    pub side: Side,
    /// Diameter of each probe's ball, mm.
    pub balls_mm: &'a [f64],
}

impl Problem {
    /// Adds rows of two poses and a length; returns the group's number. `fitted`: the length may move within `u_mm`.
    ///
    /// # Errors
    /// Shapes that do not agree, an unknown probe, a value that is not finite or not positive.
    pub fn add_lengths(&mut self, name: &str, rows: LengthRows, u_mm: f64, fitted: bool) -> Result<usize> {
        let count = rows.length_mm.len();
        self.check_angles("first poses", rows.from, count)?;
        self.check_angles("second poses", rows.to, count)?;
        self.check_probes(rows.probe, count)?;
        for &value in rows.length_mm {
            check_size(&format!("a length of artefact {name}"), value)?;
        }
        check_uncertainty(name, u_mm)?;
        let group = Lengths::new(name, self.arm().encoders(), rows, u_mm, fitted);
        Ok(self.push(Box::new(group)))
    }

    /// Adds readings of an artefact's features; returns the group's number.
    ///
    /// # Errors
    /// Shapes that do not agree, an unknown probe or feature, a value that is not finite.
    pub fn add_points(&mut self, features: &Features, rows: TouchRows) -> Result<usize> {
        self.check_touches(rows)?;
        let known = features.coordinates_mm.len();
        if let Some(&index) = rows.feature.iter().find(|&&index| index >= known) {
            return Err(Error::NoSuch { what: "feature", index: index as i64, count: known });
        }
        for &value in features.coordinates_mm.iter().flatten() {
            if value.is_nan() || value.abs() > MOST_MM {
                return Err(Error::OutOfRange {
                    what: format!("a coordinate of artefact {}, mm,", features.name),
                    value,
                    expected: "a number from -1e7 to 1e7",
                });
            }
        }
        if features.labels.len() != known {
            return Err(Error::Shape {
                what: "the features' names".into(),
                got: features.labels.len(),
                expected: known,
            });
        }
        match features.u {
            Uncertainty::None => {}
            Uncertainty::Length(u_mm) => check_uncertainty(features.name, u_mm)?,
            Uncertainty::Each(each) => {
                if each.len() != known {
                    return Err(Error::Shape {
                        what: "the features' uncertainties".into(),
                        got: each.len(),
                        expected: known,
                    });
                }
                each.iter().try_for_each(|&u_mm| check_uncertainty(features.name, u_mm))?;
            }
        }
        let group = Points::new(features, self.arm().encoders(), rows);
        if group.dimensions().len() > MOST_DIMENSIONS {
            return Err(Error::TooManyDimensions {
                artefact: features.name.into(),
                dimensions: group.dimensions().len(),
                most: MOST_DIMENSIONS,
            });
        }
        Ok(self.push(Box::new(group)))
    }

    /// Adds touches of a ball's surface; returns the group's number. The rows' features are not looked at.
    ///
    /// # Errors
    /// Shapes that do not agree, an unknown probe, a value that is not finite or not positive.
    pub fn add_sphere(&mut self, ball: &BallArtefact, rows: TouchRows) -> Result<usize> {
        self.check_touches(rows)?;
        self.check_balls(ball.balls_mm, rows.probe)?;
        check_size(&format!("the diameter of artefact {}", ball.name), ball.diameter_mm)?;
        check_uncertainty(ball.name, ball.u_mm)?;
        let dimension = Dimension {
            name: format!("artefact.{}.diameter", ball.name),
            value_mm: ball.diameter_mm,
            u_mm: ball.u_mm,
            fitted: ball.fitted,
        };
        let unknown = ball.fitted || ball.u_mm > 0.0;
        let dimensions = if unknown { vec![dimension] } else { vec![] };
        let shape = Sphere { diameter_mm: ball.diameter_mm, side: ball.side };
        let group = Surface::new(shape, dimensions, ball.balls_mm, self.arm().encoders(), rows);
        Ok(self.push(Box::new(group)))
    }

    /// Adds touches of a flat; returns the group's number. The rows' features are not looked at.
    ///
    /// # Errors
    /// Shapes that do not agree, an unknown probe, a value that is not finite.
    pub fn add_plane(&mut self, balls_mm: &[f64], rows: TouchRows) -> Result<usize> {
        self.check_touches(rows)?;
        self.check_balls(balls_mm, rows.probe)?;
        let group = Surface::new(Plane, vec![], balls_mm, self.arm().encoders(), rows);
        Ok(self.push(Box::new(group)))
    }

    fn check_touches(&self, rows: TouchRows) -> Result<()> {
        let count = rows.feature.len();
        self.check_angles("poses", rows.poses, count)?;
        self.check_probes(rows.probe, count)?;
        if rows.placement.len() != count {
            return Err(Error::Shape {
                what: "the placement labels".into(),
                got: rows.placement.len(),
                expected: count,
            });
        }
        Ok(())
    }

    fn check_angles(&self, what: &str, angles: Angles, rows: usize) -> Result<()> {
        let encoders = self.arm().encoders();
        if angles.q_rad.len() != rows * encoders {
            return Err(Error::Shape {
                what: format!("the {what}"),
                got: angles.q_rad.len(),
                expected: rows * encoders,
            });
        }
        if let Some(&value) = angles.q_rad.iter().find(|v| !v.is_finite()) {
            return Err(Error::NotFinite { what: format!("an angle of the {what}"), value });
        }
        angles.conditions.check(what, rows, encoders)
    }

    fn check_probes(&self, probe: &[usize], rows: usize) -> Result<()> {
        if probe.len() != rows {
            return Err(Error::Shape { what: "the probe indices".into(), got: probe.len(), expected: rows });
        }
        let count = self.arm().probes().len();
        match probe.iter().find(|&&p| p >= count) {
            Some(&p) => Err(Error::NoSuch { what: "probe", index: p as i64, count }),
            None => Ok(()),
        }
    }

    /// Balls of probes that took no reading do not matter.
    fn check_balls(&self, balls_mm: &[f64], used: &[usize]) -> Result<()> {
        let expected = self.arm().probes().len();
        if balls_mm.len() != expected {
            return Err(Error::Shape {
                what: "the diameters of the probes' balls".into(),
                got: balls_mm.len(),
                expected,
            });
        }
        for &probe in used {
            let value = balls_mm[probe];
            if !(0.0..=MOST_MM).contains(&value) {
                let name = &self.arm().probes()[probe].name;
                return Err(Error::OutOfRange {
                    what: format!("the diameter of the ball of probe {name}, mm,"),
                    value,
                    expected: "a number from 0 to 1e7",
                });
            }
        }
        Ok(())
    }
}

/// Dimensions of one artefact that are carried through a fit as columns of their own.
const MOST_DIMENSIONS: usize = 1500;

fn check_size(what: &str, value: f64) -> Result<()> {
    if (1e-6..=MOST_MM).contains(&value) {
        return Ok(());
    }
    Err(Error::OutOfRange { what: format!("{what}, mm,"), value, expected: "a number from 1e-6 to 1e7" })
}

fn check_uncertainty(name: &str, u_mm: f64) -> Result<()> {
    if u_mm.is_finite() && u_mm >= 0.0 {
        return Ok(());
    }
    Err(Error::OutOfRange {
        what: format!("the uncertainty of artefact {name}"),
        value: u_mm,
        expected: "a number not below zero",
    })
}
