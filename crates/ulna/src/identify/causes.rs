//! Why a direction is lost, found by looking at what it does to the tip.

use crate::arm::{Arm, JointModel, Lost, Seen, Unit};
use crate::kinematics::{Sample, jacobian, tip_mm};
use crate::problem::Problem;
use nalgebra::{DMatrix, DVector, Vector3};

/// Kinds of causes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cause {
    /// It only moves the base frame.
    BaseFrame,
    /// It only scales the arm.
    Scale,
    /// The tip lies on the last axis.
    ProbeOnAxis,
    /// No reading was taken with the probe.
    ProbeUnused,
    /// A joint was never moved.
    JointStill,
    /// Two successive axes are parallel.
    ParallelAxes,
    /// The last link and the tip say the same thing twice.
    RedundantLink,
    /// Of an axis along which a joint slides only the direction matters.
    SlidingAxis,
    /// An effect had no chance to show: one of its own words.
    OfEffect(&'static str),
    /// It moves the tip, but not in what was read.
    Coverage,
}

impl Cause {
    /// The word for it in files.
    pub fn as_str(self) -> &'static str {
        match self {
            Cause::BaseFrame => "base-frame",
            Cause::Scale => "scale",
            Cause::ProbeOnAxis => "probe-on-axis",
            Cause::ProbeUnused => "probe-unused",
            Cause::JointStill => "joint-still",
            Cause::ParallelAxes => "parallel-axes",
            Cause::RedundantLink => "redundant-link",
            Cause::SlidingAxis => "sliding-axis",
            Cause::OfEffect(cause) => cause,
            Cause::Coverage => "coverage",
        }
    }
}

/// A cause with its explanation and remedy.
#[derive(Debug, Clone, PartialEq)]
pub struct Because {
    /// Which kind.
    pub cause: Cause,
    /// In words.
    pub because: String,
    /// What would help.
    pub remedy: String,
}

impl Because {
    /// Whether nothing but the frame of the coordinates depends on it: no length, no shape.
    pub fn is_frame(&self) -> bool {
        self.cause == Cause::BaseFrame
    }
}

/// Where a direction is looked at.
pub(crate) struct Scene<'a> {
    pub arm: &'a Arm,
    /// indices of the free parameters; those behind the arm's are dimensions of artefacts
    pub free: &'a [usize],
    /// poses of some of the readings
    poses: &'a [Sample],
    probes_used: Vec<bool>,
    /// of what effects depend on
    seen: Seen,
    /// how far a unit of each parameter moves a tip at the most, mm
    natural_scale: Vec<f64>,
    /// parameters that only move the base frame
    base: Vec<usize>,
    /// whether any reading tells where the tip is
    tells_places: bool,
}

impl<'a> Scene<'a> {
    pub fn new(problem: &Problem, arm: &'a Arm, free: &'a [usize], poses: &'a [Sample]) -> Scene<'a> {
        let (probes_used, seen) = (problem.probes_used(), problem.seen());
        let (natural_scale, base) = (problem.natural_scale(), problem.base_parameters());
        let tells_places = problem.tells_places();
        Scene { arm, free, poses, probes_used, seen, natural_scale, base, tells_places }
    }

    /// Whether every tip that was read with lies on the last axis.
    fn read_on_axis(&self, arm: &Arm) -> bool {
        (0..arm.probes().len()).all(|p| !self.probes_used[p] || on_last_axis(arm, p))
    }

    /// Whether a parameter is one of the last joint's effects.
    fn of_last_encoder(&self, j: usize) -> bool {
        j >= self.arm.geometry_count() && self.arm.joint_of(j) == Some(self.arm.encoders() - 1)
    }
}

/// A joint that turned less than this has not been moved, rad.
const STILL_RAD: f64 = 1e-6;
/// Axes closer to parallel than this are parallel, rad.
const PARALLEL_RAD: f64 = 1e-6;
/// A tip closer to the last axis than this part of its length is on it.
const ON_AXIS: f64 = 1e-6;
/// A motion this much smaller than it could be is rounding.
const VANISHED: f64 = 1e-10;
/// A motion explained but for this part of its size is explained.
const EXPLAINED: f64 = 1e-7;

/// Names the cause of a lost direction, looking at what it does to the tip of `arm`.
pub(crate) fn explain(direction: &[f64], arm: &Arm, scene: &Scene) -> Because {
    let takes_part: Vec<usize> =
        scene.free.iter().zip(direction).filter(|(_, d)| **d != 0.0).map(|(&j, _)| j).collect();
    let (joints, geometry) = (scene.arm.joint_parameter_count(), scene.arm.geometry_count());
    let unused = |&j: &usize| (joints..geometry).contains(&j) && !scene.probes_used[(j - joints) / 3];
    if takes_part.iter().all(unused) {
        let probe = &scene.arm.probes()[(takes_part.first().copied().unwrap_or(joints) - joints) / 3].name;
        return Because {
            cause: Cause::ProbeUnused,
            because: format!("no reading was taken with probe {probe}"),
            remedy: format!(
                "take readings with probe {probe} (32 poses in one seat are enough once the arm is known), or hold probe.{probe}.*"
            ),
        };
    }
    // a base that grows with the temperature moves by next to nothing more in the warm than in the cold
    if takes_part.iter().all(|j| scene.base.contains(j)) {
        return base_frame();
    }
    let units = arm.parameter_units();
    if !scene.tells_places && takes_part.iter().all(|&j| units.get(j) == Some(&Unit::Mm)) {
        return no_places();
    }
    if let Some(because) = of_effects(&takes_part, scene) {
        return because;
    }
    let motion = Motion::new(direction, arm, scene);
    if let Some(because) = moves_nothing(&motion, &takes_part, arm, scene) {
        return because;
    }
    if motion.explained_by(false) {
        return base_frame();
    }
    if motion.explained_by(true) {
        return scale();
    }
    if let Some(joint) = still_joint(&takes_part, scene) {
        return Because {
            cause: Cause::JointStill,
            because: format!("joint {} was never moved in these readings", joint + 1),
            remedy: format!(
                "take readings with joint {} turned over its whole travel, or hold these parameters",
                joint + 1
            ),
        };
    }
    Because {
        cause: Cause::Coverage,
        because: "it moves the tip, but not in anything that was read: the poses are too few or too much alike".into(),
        remedy:
            "take readings at other places and directions, every joint turned over its travel; or hold these parameters"
                .into(),
    }
}

/// What is said of parameters beyond the geometry that had no chance to show.
fn of_effects(takes_part: &[usize], scene: &Scene) -> Option<Because> {
    let last = scene.arm.encoders() - 1;
    let mut first = scene.arm.geometry_count();
    scene.arm.effects().all().find_map(|effect| {
        let own = first..first + effect.values().len();
        first = own.end;
        let mine = takes_part.iter().filter(|j| own.contains(j));
        let joints: Vec<usize> = mine.filter_map(|&j| scene.arm.joint_of(j)).collect();
        if joints.is_empty() {
            return None;
        }
        let unseen = effect.unseen(&Lost {
            alone: takes_part.len() == 1,
            hidden: scene.read_on_axis(scene.arm).then_some(last),
            joints: &joints,
            seen: &scene.seen,
        })?;
        Some(Because { cause: Cause::OfEffect(unseen.cause), because: unseen.because, remedy: unseen.remedy })
    })
}

/// What is said of a motion of the base.
pub(crate) fn base_frame() -> Because {
    Because {
        cause: Cause::BaseFrame,
        because: "it only moves the base frame: the readings see the arm from nowhere but itself".into(),
        remedy: "none is needed, no length depends on it; coordinates of features in the base frame (frame = \"arm\") \
                 would fix it"
            .into(),
    }
}

/// What is said where the size of the arm is lost.
pub(crate) fn scale() -> Because {
    Because {
        cause: Cause::Scale,
        because: "it only scales the arm: no length is known in these readings".into(),
        remedy: "add readings of a bar of known length, or hold one known length of the arm".into(),
    }
}

/// What is said of lengths where only orientations were read.
fn no_places() -> Because {
    Because {
        cause: Cause::Scale,
        because: "only orientations were read: they tell no length of the arm".into(),
        remedy: "add readings of places: points of the same tracker, a bar, a seat; or hold the lengths".into(),
    }
}

fn moves_nothing(motion: &Motion, takes_part: &[usize], arm: &Arm, scene: &Scene) -> Option<Because> {
    if motion.size > EXPLAINED * motion.effort && motion.size > VANISHED * motion.most {
        return None;
    }
    let (joints, geometry) = (scene.arm.joint_parameter_count(), scene.arm.geometry_count());
    let last_link = joints - 4;
    let of_last = |j: &usize| (last_link..geometry).contains(j);
    if arm.has_full_last_link() && takes_part.iter().all(of_last) {
        let n = arm.encoders();
        return Some(Because {
            cause: Cause::RedundantLink,
            because: format!(
                "the link of joint {n} and the tip are one rigid body: both say where the tip is, twice over"
            ),
            remedy: format!(
                "none is needed, no point depends on it; without full_last_link the tip says it all, or hold joint.{n}.*"
            ),
        });
    }
    let seen_by_turning = |j: &usize| of_last(j) || scene.of_last_encoder(*j);
    if takes_part.iter().any(seen_by_turning) && scene.read_on_axis(arm) {
        return Some(Because {
            cause: Cause::ProbeOnAxis,
            because: "the tip lies on the last axis: turning the last joint moves nothing, so the direction of that axis cannot be seen".into(),
            remedy: "measure with a probe at least 10 mm off the last axis, or with a second straight probe of another length".into(),
        });
    }
    if let Some(because) = sliding_axis(takes_part, arm) {
        return Some(because);
    }
    for (i, joint) in arm.joints().iter().enumerate() {
        let parallel = joint.model == JointModel::Dh && joint.alpha_rad.sin().abs() < PARALLEL_RAD;
        if parallel && takes_part.contains(&(4 * i + 3)) {
            return Some(Because {
                cause: Cause::ParallelAxes,
                because: format!(
                    "the axes of joints {} and {} are parallel: an offset along one is an offset along the other",
                    i + 1,
                    i + 2
                ),
                remedy: format!("write joint {} with model = \"hayati\" (beta instead of d)", i + 1),
            });
        }
    }
    still_joint(takes_part, scene).map(|joint| Because {
        cause: Cause::JointStill,
        because: format!("joint {} was never moved in these readings", joint + 1),
        remedy: format!(
            "take readings with joint {} turned over its whole travel, or hold these parameters",
            joint + 1
        ),
    })
}

/// What is said where parameters around a joint that slides move nothing together.
fn sliding_axis(takes_part: &[usize], arm: &Arm) -> Option<Because> {
    let (last, geometry) = (arm.encoders() - 1, arm.geometry_count());
    let around = |i: usize| {
        // joints that slide one after the other, and the links at both ends of them
        let slides = |&k: &usize| arm.slides(k);
        let from = (0..i).rev().take_while(slides).last().unwrap_or(i).saturating_sub(1);
        let to = (i..=last).take_while(slides).last().unwrap_or(i) + 1;
        takes_part.iter().all(|&j| match arm.joint_of(j) {
            Some(joint) => j < geometry && (from..=to).contains(&joint),
            // the tip stands for the last joint's link
            None => j < geometry && last <= to,
        })
    };
    let i = (0..=last).find(|&i| arm.slides(i) && around(i))?;
    let name = i + 1;
    Some(Because {
        cause: Cause::SlidingAxis,
        because: format!(
            "joint {name} slides: of such an axis only the direction matters, and where it lies is said by the links beside it \
             as well"
        ),
        remedy: "none is needed, no point depends on it; or hold one of these parameters".into(),
    })
}

/// Whether a probe's tip does not move when the last joint turns.
fn on_last_axis(arm: &Arm, probe: usize) -> bool {
    if arm.slides(arm.encoders() - 1) {
        return false;
    }
    let tip = Vector3::from(arm.probes()[probe].tip_mm);
    let q_rad: Vec<f64> = vec![0.0; arm.encoders()];
    let frames = crate::kinematics::frames(arm, &q_rad);
    let from_axis = frames[arm.encoders() - 1].inverse() * (frames[arm.encoders()] * nalgebra::Point3::from(tip));
    from_axis.coords.xy().norm() <= ON_AXIS * from_axis.coords.norm().max(1.0)
}

/// A joint next to one of these parameters that stands still in all readings.
fn still_joint(takes_part: &[usize], scene: &Scene) -> Option<usize> {
    let joints = scene.arm.joint_parameter_count();
    let range = |i: usize| {
        let angles = scene.poses.iter().map(|pose| pose.q_rad[i]);
        let (low, high) = angles.fold((f64::MAX, f64::MIN), |(low, high), q| (low.min(q), high.max(q)));
        high - low
    };
    (0..scene.arm.encoders()).find(|&i| {
        let concerns = |&j: &usize| match scene.arm.joint_of(j) {
            Some(joint) if j < joints => joint == i || joint + 1 == i,
            Some(joint) => joint == i,
            None => j < scene.arm.geometry_count() && i + 1 == scene.arm.encoders(),
        };
        takes_part.iter().any(concerns) && range(i) < STILL_RAD
    })
}

/// How the tip moves along a direction, over the poses that were read.
struct Motion {
    tips: Vec<Vector3<f64>>,
    moves: Vec<Vector3<f64>>,
    /// root mean square of the moves
    size: f64,
    /// the same of the parts that cancel
    effort: f64,
    /// and of parts as large as they can be
    most: f64,
}

impl Motion {
    fn new(direction: &[f64], arm: &Arm, scene: &Scene) -> Motion {
        let (mut tips, mut moves, mut effort) = (Vec::new(), Vec::new(), 0.0);
        for sample in scene.poses {
            let jacobian = jacobian(arm, sample.probe, sample.pose());
            let mut moved = Vector3::zeros();
            for (&j, &weight) in scene.free.iter().zip(direction).filter(|(j, _)| **j < arm.parameter_count()) {
                let part: Vector3<f64> = jacobian.column(j) * weight;
                moved += part;
                effort += part.norm_squared();
            }
            moves.push(moved);
            tips.push(tip_mm(arm, sample.probe, sample.pose()).coords);
        }
        let count = moves.len().max(1) as f64;
        let most = scene.free.iter().zip(direction).map(|(&j, weight)| (weight * scene.natural_scale[j]).powi(2));
        Motion {
            most: most.sum::<f64>().sqrt(),
            size: (moves.iter().map(Vector3::norm_squared).sum::<f64>() / count).sqrt(),
            effort: (effort / count).sqrt(),
            tips,
            moves,
        }
    }

    /// Whether a rigid motion, or one with growth, explains all moves.
    fn explained_by(&self, growth: bool) -> bool {
        let columns = if growth { 7 } else { 6 };
        let rows = 3 * self.tips.len();
        if rows <= columns {
            return false;
        }
        let reach = self.tips.iter().map(Vector3::norm).fold(f64::MIN_POSITIVE, f64::max);
        let mut a = DMatrix::zeros(rows, columns);
        let mut b = DVector::zeros(rows);
        for (i, (tip, moved)) in self.tips.iter().zip(&self.moves).enumerate() {
            for k in 0..3 {
                let axis = Vector3::ith(k, 1.0);
                a.fixed_view_mut::<3, 1>(3 * i, k).copy_from(&axis);
                a.fixed_view_mut::<3, 1>(3 * i, 3 + k).copy_from(&(axis.cross(tip) / reach));
            }
            if growth {
                a.fixed_view_mut::<3, 1>(3 * i, 6).copy_from(&(tip / reach));
            }
            b.fixed_rows_mut::<3>(3 * i).copy_from(moved);
        }
        let svd = a.clone().svd(true, true);
        let Ok(solution) = svd.solve(&b, 1e-12) else {
            return false;
        };
        (a * solution - &b).norm() <= EXPLAINED * b.norm()
    }
}
