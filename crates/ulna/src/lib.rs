//! The core of Ulna: from encoder readings of known artefacts to the geometry of an articulated measuring arm.
//!
//! Pure computation in mm and rad: no files, no printing, no Python.
//!
//! | room | what is in it | may use |
//! |---|---|---|
//! | [`arm`] | joints, probes, parameter names, units and order | |
//! | [`simd`] | columns and vectors of doubles, a sine and cosine | |
//! | [`kinematics`] | the map from encoder angles to the tip and its derivatives, plain and in batches | `arm`, `simd` |
//! | [`residuals`] | what is observed: one file for each kind of residual | `kinematics` |
//! | [`problem`], [`assembly`] | an arm and readings, and the free parameters as unknowns | `residuals`, `solver` |
//! | [`solver`] | least squares from streamed rows; knows no kinematics | `simd` |
//! | [`decomposition`], [`covariance`] | singular values and what follows from them; know no kinematics | `solver` |
//! | [`design`] | which measurements to take, chosen by exchange; knows no kinematics | `monitor` |
//! | [`identifiability`], [`causes`] | what is lost, in parameters and words | `decomposition` |
//! | [`pins`], [`families`] | directions no reading sees, kept at their start | `assembly`, `decomposition` |
//! | [`symmetry`] | twins: parameter sets that describe the same readings | `arm` |
//! | [`losses`], `robust` | how much outliers count; know no kinematics | |
//! | [`priors`] | what is known before | |
//! | [`solve`], `search`, `signs`, `settle` | the way to the minimum | `assembly`, `solver` |
//! | [`calibrate`] | the fit and all that is judged of it | everything above |
//! | [`monte_carlo`] | calibrations repeated on new noise | `calibrate` |
//! | [`propagate`], [`inverse`], [`numdiff`] | uncertainty of a point; postures for a point; a derivative checker | `kinematics` |
//!
//! ```
//! use ulna::arm::{Arm, Joint, JointModel, Probe};
//! use ulna::calibrate::{Options, fit};
//! use ulna::kinematics::tip_mm;
//! use ulna::monitor::Unwatched;
//! use ulna::kinematics::Angles;
//! use ulna::problem::Problem;
//! use ulna::residuals::TouchRows;
//! use ulna::residuals::points::{Features, Frame, Uncertainty};
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
//! let labels: Vec<String> = (1..=10).map(|k| format!("p{k}")).collect();
//! let features = Features {
//!     name: "grid", labels: &labels, coordinates_mm: &places, u: Uncertainty::None, fitted: false, frame: Frame::Arm,
//! };
//! let each: Vec<usize> = (0..10).collect();
//! let rows = TouchRows { poses: Angles::cold(&q_rad), probe: &[0; 10], feature: &each, placement: &[0; 10] };
//!
//! let mut problem = Problem::new(nominal, None)?;
//! problem.add_points(&features, rows)?;
//! let free: Vec<usize> = (0..problem.arm().parameter_count()).collect();
//! let fitted = fit(&mut problem, &free, &Options::default(), &Unwatched)?;
//! assert!((fitted.arm.joints()[0].a_mm - 200.0).abs() < 1e-6);
//! # Ok::<(), ulna::Error>(())
//! ```

pub mod arm;
pub mod assembly;
pub mod calibrate;
pub mod causes;
pub mod covariance;
pub mod decomposition;
pub mod design;
pub mod error;
pub mod families;
pub mod identifiability;
pub mod inverse;
pub mod kinematics;
pub mod losses;
pub mod monitor;
pub mod monte_carlo;
pub mod numdiff;
pub mod pins;
pub mod priors;
pub mod problem;
pub mod propagate;
pub mod residuals;
pub mod robust;
mod search;
mod seeds;

mod settle;
mod signs;
pub mod simd;
pub mod solve;
pub mod solver;
pub mod symmetry;

pub use error::{Error, Result};
