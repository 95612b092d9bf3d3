//! What a kind of artefact owes, and what it can rely on when its readings are made.

use super::checks::{check_rows, check_stated};
use super::dimension::Dimension;
use super::readings::Readings;
use super::stated::{Column, Frame, Rows, Size, Stated};
use crate::arm::{Arm, Unit};
use crate::error::{Error, Result};

/// A kind of artefact.
#[derive(Debug, Clone, Copy)]
pub struct Kind {
    /// Its name.
    pub name: &'static str,
    /// What must be stated, besides poses and probes.
    pub needs: &'static [Column],
    /// What may be stated besides.
    pub takes: &'static [Column],
    /// The dimensions that it has.
    pub dimensions: &'static [Asked],
    /// Makes its readings of what is stated, all of which has been checked but for what only the kind knows.
    pub(super) readings: fn(&Statement) -> Result<Box<dyn Readings>>,
}

/// A dimension of a kind.
#[derive(Debug, Clone, Copy)]
pub struct Asked {
    /// Its name.
    pub name: &'static str,
    /// What it is measured in.
    pub unit: Unit,
    /// Whether it must be stated.
    pub needed: bool,
    /// The least and the most that it can be.
    pub range: (f64, f64),
    /// The same in words.
    pub expected: &'static str,
}

impl Asked {
    /// A diameter or length, mm.
    pub(super) const fn length(name: &'static str, needed: bool) -> Asked {
        Asked { name, unit: Unit::Mm, needed, range: (1e-6, 1e7), expected: "a number from 1e-6 to 1e7" }
    }
}

/// All that is said of an artefact and its readings.
pub(super) struct Statement<'a> {
    /// its kind
    pub kind: &'a Kind,
    pub stated: &'a Stated<'a>,
    pub rows: &'a Rows<'a>,
    /// the arm that took the readings
    pub arm: &'a Arm,
}

impl<'a> Statement<'a> {
    /// Checks all that a kind need not know.
    pub fn checked(kind: &'a Kind, stated: &'a Stated, rows: &'a Rows, arm: &'a Arm) -> Result<Statement<'a>> {
        let statement = Statement { kind, stated, rows, arm };
        for column in Column::ALL {
            let given = column.is_given(stated, rows);
            if !given && kind.needs.contains(&column) {
                return Err(statement.missing(column.name()));
            }
            if given && !kind.needs.contains(&column) && !kind.takes.contains(&column) {
                return Err(statement.unused(column.name()));
            }
        }
        for asked in kind.dimensions.iter().filter(|asked| asked.needed) {
            if statement.size(asked.name).is_none() {
                return Err(statement.missing(&format!("the dimension {:?}", asked.name)));
            }
        }
        for (number, size) in stated.dimensions.iter().enumerate() {
            let asked = kind.dimensions.iter().find(|asked| asked.name == size.name);
            let Some(asked) = asked else {
                return Err(statement.unused(&format!("the dimension {:?}", size.name)));
            };
            if stated.dimensions[..number].iter().any(|other| other.name == size.name) {
                return Err(statement.contradiction(format!("the dimension {:?} is stated twice", size.name)));
            }
            statement.check_size(asked, size)?;
        }
        check_stated(stated, rows, arm)?;
        check_rows(rows, arm)?;
        Ok(statement)
    }

    fn check_size(&self, asked: &Asked, size: &Size) -> Result<()> {
        let (least, most) = asked.range;
        if !(least..=most).contains(&size.value) {
            return Err(Error::OutOfRange {
                what: format!("the {} of artefact {}, {},", size.name, self.stated.name, asked.unit.as_str()),
                value: size.value,
                expected: asked.expected,
            });
        }
        if !(size.u.is_finite() && size.u >= 0.0) {
            return Err(Error::OutOfRange {
                what: format!("the uncertainty of the {} of artefact {}", size.name, self.stated.name),
                value: size.u,
                expected: "a number not below zero",
            });
        }
        Ok(())
    }

    /// What is missing, in words.
    pub fn missing(&self, what: &str) -> Error {
        Error::Lacking { artefact: self.stated.name.into(), kind: self.kind.name, what: what.into() }
    }

    /// What has no meaning here, in words.
    pub fn unused(&self, what: &str) -> Error {
        Error::Unused { artefact: self.stated.name.into(), kind: self.kind.name, what: what.into() }
    }

    /// What cannot both be.
    pub fn contradiction(&self, why: String) -> Error {
        Error::Contradiction { artefact: self.stated.name.into(), why }
    }

    /// The rows of what stands in that frame: those of placements, or, in the arm's own, of none.
    pub fn rows_in(&self, frame: Frame) -> Result<Rows<'a>> {
        match frame {
            Frame::Free if self.rows.placement.is_none() => Err(self.missing(Column::Placement.name())),
            Frame::Free => Ok(*self.rows),
            // nothing is to be placed
            Frame::Arm => Ok(Rows { placement: None, ..*self.rows }),
        }
    }

    /// A dimension as it is stated.
    pub fn size(&self, name: &str) -> Option<&'a Size<'a>> {
        self.stated.dimensions.iter().find(|size| size.name == name)
    }

    /// A dimension as an unknown of the problem, if it is not known exactly.
    pub fn dimension(&self, name: &str) -> Option<Dimension> {
        let asked = self.kind.dimensions.iter().find(|asked| asked.name == name)?;
        let size = self.size(name).filter(|size| size.fitted || size.u > 0.0)?;
        Some(Dimension {
            name: format!("artefact.{}.{name}", self.stated.name),
            unit: asked.unit,
            value: size.value,
            u: size.u,
            fitted: size.fitted,
        })
    }
}
