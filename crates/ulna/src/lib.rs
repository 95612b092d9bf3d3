//! The core of Ulna: from encoder readings of known artefacts to the geometry of an articulated measuring arm.
//!
//! Pure computation in mm and rad: no files, no printing, no Python.
//!
//! | room | what is in it | may use |
//! |---|---|---|
//! | [`simd`] | columns and vectors of doubles, a sine and cosine | |
//! | [`arm`] | joints, probes, effects, parameter names, units and order | |
//! | [`solver`] | least squares from streamed rows, singular values, losses; knows no kinematics | `simd` |
//! | [`geometry`] | least-squares spheres, planes and cylinders of points; knows no arm | |
//! | [`design`] | which measurements to take, chosen by exchange; knows no kinematics | |
//! | [`kinematics`] | from encoder angles to the tip, its derivatives, and back; plain and in batches | `arm`, `simd` |
//! | [`artefacts`] | what is observed: readings of artefacts as residuals | `kinematics`, `geometry`, `solver` |
//! | [`problem`] | an arm and readings, what is known before, the free parameters as unknowns | `artefacts` |
//! | [`identify`] | what readings cannot determine, in parameters and words | `problem` |
//! | [`fit`] | the way to the minimum, and all that is judged of it | `identify` |
//!
//! Every room may use the rooms above it in this table, and [`error`] and [`monitor`]; none uses one below.
//!
//! ```
//! use ulna::arm::{Arm, Joint, JointModel, Probe};
//! use ulna::artefacts::{Frame, Rows, Stated};
//! use ulna::fit::calibrate::{Options, fit};
//! use ulna::kinematics::{Angles, tip_mm};
//! use ulna::monitor::Unwatched;
//! use ulna::problem::Problem;
//!
//! // two joints and a probe, with a link length that is not quite known
//! let joint = |a_mm, alpha_rad| Joint {
//!     theta0_rad: 0.1, alpha_rad, a_mm, d_mm: 20.0, beta_rad: 0.0, sign: 1.0, model: JointModel::Dh,
//! };
//! let probe = Probe { name: "ball".into(), tip_mm: [15.0, 0.0, 100.0] };
//! let truth = Arm::new(vec![joint(200.0, 1.5), joint(150.0, -0.7)], 1.0, vec![probe.clone()])?;
//! let nominal = Arm::new(vec![joint(203.0, 1.5), joint(150.0, -0.7)], 1.0, vec![probe])?;
//!
//! // places in the arm's own frame, touched once each
//! let q_rad: Vec<f64> = (0..30).map(|i| (f64::from(i) * 0.7).sin() * 2.0).collect();
//! let places: Vec<[f64; 3]> = q_rad.chunks(3).map(|q| tip_mm(&truth, 0, q).into()).collect();
//! let each: Vec<usize> = (0..10).collect();
//! let grid = Stated { name: "grid", features_mm: Some(&places), frame: Some(Frame::Arm), ..Stated::default() };
//! let rows = Rows { poses: Angles::cold(&q_rad), probe: &[0; 10], feature: Some(&each), ..Rows::default() };
//!
//! let mut problem = Problem::new(nominal, None)?;
//! problem.add("points", &grid, &rows)?;
//! let free: Vec<usize> = (0..problem.arm().parameter_count()).collect();
//! let fitted = fit(&mut problem, &free, &Options::default(), &Unwatched)?;
//! assert!((fitted.arm.joints()[0].a_mm - 200.0).abs() < 1e-6);
//! # Ok::<(), ulna::Error>(())
//! ```

pub mod arm;
pub mod artefacts;
pub mod design;
pub mod error;
pub mod fit;
pub mod geometry;
pub mod identify;
pub mod kinematics;
pub mod monitor;
pub mod problem;
pub mod simd;
pub mod solver;

mod seeds;

pub use error::{Error, Result};
