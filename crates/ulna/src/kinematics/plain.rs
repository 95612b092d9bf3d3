//! The forward map and its derivatives as the formula reads, one pose at a time: what the kernels must equal.

use super::pose::Pose;
use crate::arm::effects::{Base, BaseOffset, BaseTilt, Body, Compliance, Expansion, FromStated};
use crate::arm::{Arm, Joint, JointModel};
use nalgebra::{Isometry3, Matrix3xX, Point3, Translation3, UnitQuaternion, Vector3};

/// `T_i`: from the frame after joint i to the frame before it, at a turn or a shift along its axis, its link stretched.
fn step(joint: &Joint, (turn_rad, shift_mm): (f64, f64), stretch: f64) -> Isometry3<f64> {
    let rz = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn_rad);
    let rx = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), joint.alpha_rad);
    let a_mm = stretch * joint.a_mm;
    match joint.model {
        JointModel::Dh => rz * Translation3::new(a_mm, 0.0, stretch * (joint.d_mm + shift_mm)) * rx,
        JointModel::Hayati => {
            let ry = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), joint.beta_rad);
            rz * Translation3::new(a_mm, 0.0, 0.0) * (rx * ry)
        }
    }
}

/// Frames `t_base_joint` of every joint before its turn and the probe's frame last, n + 1 frames, for given turns, the
/// first at `t_base`.
/// shifts_mm: of joints that slide, how far; 0 of others.
fn chained(
    arm: &Arm,
    mut t_base: Isometry3<f64>,
    turns_rad: &[f64],
    shifts_mm: &[f64],
    stretches: &[f64],
) -> Vec<Isometry3<f64>> {
    let mut all = vec![t_base];
    let last = turns_rad.len() - 1;
    for (i, joint) in arm.joints().iter().enumerate() {
        t_base *= step(joint, (turns_rad[i], shifts_mm[i]), stretches[i]);
        all.push(t_base);
    }
    if !arm.has_full_last_link() {
        let roll = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turns_rad[last]);
        all.push(t_base * Translation3::new(0.0, 0.0, stretches[last] * shifts_mm[last]) * roll);
    }
    all
}

/// An arm at a pose: everything that the map and its derivatives are made of.
struct Posed<'a> {
    arm: &'a Arm,
    pose: Pose<'a>,
    /// of each joint, rad
    turns_rad: Vec<f64>,
    /// of each joint that slides, mm
    shifts_mm: Vec<f64>,
    /// of each link, and of the tip with the last joint
    stretches: Vec<f64>,
    frames: Vec<Isometry3<f64>>,
    p_tip: Vector3<f64>,
    tip_mm: Vector3<f64>,
    weight: Option<Weight<'a>>,
}

impl<'a> Posed<'a> {
    fn new(arm: &'a Arm, probe: usize, pose: Pose<'a>) -> Posed<'a> {
        let n = arm.encoders();
        let effects = arm.effects();
        let stretches: Vec<f64> = match &effects.expansion {
            Some(e) => e.per_kelvin.iter().enumerate().map(|(i, epsilon)| 1.0 + epsilon * pose.warmth_k(i)).collect(),
            None => vec![1.0; n],
        };
        let theta0 = |i: usize| arm.joints().get(i).map_or(0.0, |joint| joint.theta0_rad);
        let signs: Vec<f64> = arm.signs().collect();
        let read = |i: usize| signs[i] * pose.q_rad[i];
        let shifts_mm: Vec<f64> = (0..n).map(|i| if arm.slides(i) { read(i) } else { 0.0 }).collect();
        let rigid: Vec<f64> = (0..n).map(|i| if arm.slides(i) { -theta0(i) } else { read(i) - theta0(i) }).collect();
        let weight = effects.compliance.as_ref().map(|_| Weight::new(arm, pose, &rigid, &shifts_mm));
        let turn = |i: usize| {
            if arm.slides(i) {
                return rigid[i];
            }
            let added = signs[i] * effects.added_rad(i, pose.encoder(i));
            let given = weight.as_ref().map_or(0.0, |w| w.rad_per_nm(i) * w.moment_nm(i));
            rigid[i] + added + given
        };
        let turns_rad: Vec<f64> = (0..n).map(turn).collect();
        let base = Base::of(effects.base_tilt.as_ref(), effects.base_offset.as_ref());
        let t_base = base.map_or_else(Isometry3::identity, |base| base.pose());
        let frames = chained(arm, t_base, &turns_rad, &shifts_mm, &stretches);
        let tip_mm = Vector3::from(arm.probes()[probe].tip_mm) * stretches[n - 1];
        let p_tip = (frames[n] * Point3::from(tip_mm)).coords;
        Posed { arm, pose, turns_rad, shifts_mm, stretches, frames, p_tip, tip_mm, weight }
    }

    fn axis(&self, i: usize) -> Vector3<f64> {
        self.frames[i] * Vector3::z()
    }

    /// ∂p/∂turn_i, mm/rad.
    fn by_turn(&self, i: usize) -> Vector3<f64> {
        self.axis(i).cross(&(self.p_tip - self.frames[i].translation.vector))
    }

    /// How the tip follows the moments where a parameter changes them by `moments_nm`.
    fn by_moments(&self, moments_nm: impl Fn(&Weight, usize) -> f64) -> Vector3<f64> {
        let Some(weight) = &self.weight else { return Vector3::zeros() };
        let given = |i: usize| self.by_turn(i) * (weight.rad_per_nm(i) * moments_nm(weight, i));
        (0..self.arm.encoders()).filter(|&i| !self.arm.slides(i)).map(given).sum()
    }
}

/// Frames `t_base_joint` of every joint before its turn, the probe's frame last: n + 1 frames.
pub fn frames<'a>(arm: &Arm, pose: impl Into<Pose<'a>>) -> Vec<Isometry3<f64>> {
    Posed::new(arm, 0, pose.into()).frames
}

/// Tip position in the base frame, mm, of one pose of n encoder angles.
pub fn tip_mm<'a>(arm: &Arm, probe: usize, pose: impl Into<Pose<'a>>) -> Point3<f64> {
    Posed::new(arm, probe, pose.into()).p_tip.into()
}

/// ∂p/∂parameter of one pose, 3 × parameters: mm for each of [`Arm::parameter_units`], all columns by cross products
/// (MODEL section 2).
pub fn jacobian<'a>(arm: &Arm, probe: usize, pose: impl Into<Pose<'a>>) -> Matrix3xX<f64> {
    let posed = Posed::new(arm, probe, pose.into());
    let mut jacobian = Matrix3xX::zeros(arm.parameter_count());
    for (i, joint) in arm.joints().iter().enumerate() {
        let (before, after) = (&posed.frames[i], &posed.frames[i + 1]);
        let z_joint = posed.axis(i);
        let turn = posed.turns_rad[i];
        let x_link = before * Vector3::new(turn.cos(), turn.sin(), 0.0);
        let from_end = posed.p_tip - after.translation.vector;
        let mut set = |k: usize, rigid: Vector3<f64>| {
            jacobian.set_column(4 * i + k, &(rigid + posed.by_moments(|weight, j| weight.derivative_nm(j, i, k))));
        };
        set(0, -posed.by_turn(i));
        set(1, x_link.cross(&from_end));
        set(2, x_link * posed.stretches[i]);
        set(
            3,
            match joint.model {
                JointModel::Dh => z_joint * posed.stretches[i],
                JointModel::Hayati => (after * Vector3::y()).cross(&from_end),
            },
        );
    }
    let n = arm.encoders();
    let r_base_tip = posed.frames[n].rotation.to_rotation_matrix();
    for k in 0..3 {
        jacobian.set_column(arm.tip_offset(probe) + k, &(r_base_tip.matrix().column(k) * posed.stretches[n - 1]));
    }
    let effects = arm.effects();
    let mut at = arm.geometry_count();
    for effect in effects.on_encoder() {
        for (i, sign) in arm.signs().enumerate() {
            for shape in effect.shapes(i, posed.pose.encoder(i)) {
                // what slides has no encoder that turns
                let shape = if arm.slides(i) { 0.0 } else { shape };
                jacobian.set_column(at, &(posed.by_turn(i) * sign * shape));
                at += 1;
            }
        }
    }
    let first = arm.geometry_count() + effects.start_of(Expansion::KIND);
    for i in 0..effects.expansion.as_ref().map_or(0, |e| e.per_kelvin.len()) {
        let link = arm.joints().get(i).map_or(Vector3::zeros(), |joint| {
            let turn = posed.turns_rad[i];
            posed.frames[i] * Vector3::new(joint.a_mm * turn.cos(), joint.a_mm * turn.sin(), joint.d_mm)
        });
        let slid = posed.axis(i) * posed.shifts_mm[i];
        let tip = if i + 1 == n { posed.frames[n] * posed.tip_mm / posed.stretches[i] } else { Vector3::zeros() };
        jacobian.set_column(first + i, &((link + slid + tip) * posed.pose.warmth_k(i)));
    }
    let first = arm.geometry_count() + effects.start_of(Compliance::KIND);
    if let Some(weight) = &posed.weight {
        for i in (0..n).filter(|&i| !arm.slides(i)) {
            jacobian.set_column(first + i, &(posed.by_turn(i) * weight.moment_nm(i)));
        }
    }
    if let Some(tilt) = &effects.base_tilt {
        let first = arm.geometry_count() + effects.start_of(BaseTilt::KIND);
        let from_base = posed.p_tip - posed.frames[0].translation.vector;
        for (k, axis) in tilt.axes().iter().enumerate() {
            jacobian.set_column(first + k, &axis.cross(&from_base));
        }
    }
    if effects.base_offset.is_some() {
        let first = arm.geometry_count() + effects.start_of(BaseOffset::KIND);
        (0..2).for_each(|k| jacobian.set_column(first + k, &Vector3::ith(k, 1.0)));
    }
    jacobian
}

/// ∂p/∂q of one pose, 3 × n, mm/rad; of a joint that slides mm/mm.
pub fn encoder_jacobian<'a>(arm: &Arm, probe: usize, pose: impl Into<Pose<'a>>) -> Matrix3xX<f64> {
    let posed = Posed::new(arm, probe, pose.into());
    // a moment follows the turn that the encoder says, without what is added to it
    let given = |i: usize| posed.by_moments(|weight, j| -weight.derivative_nm(j, i, 0));
    let signs: Vec<f64> = arm.signs().collect();
    let slid = |i: usize| posed.by_moments(|weight, j| weight.derivative_nm(j, i, 3));
    let columns = signs.iter().enumerate().map(|(i, &sign)| {
        if arm.slides(i) {
            return sign * (posed.axis(i) * posed.stretches[i] + slid(i));
        }
        let slope = arm.effects().slope(i, posed.pose.encoder(i));
        sign * (posed.by_turn(i) * (1.0 + slope) + given(i))
    });
    let mut jacobian = Matrix3xX::from_columns(&columns.collect::<Vec<_>>());
    for (joint, other, ratio) in arm.effects().coupling.iter().flat_map(|coupling| coupling.pairs()) {
        let with = jacobian.column(other) + posed.by_turn(joint) * (signs[joint] * ratio);
        jacobian.set_column(other, &with);
    }
    jacobian
}

/// What the arm carries, at turns that its weight has not changed yet.
struct Weight<'a> {
    arm: &'a Arm,
    frames: Vec<Isometry3<f64>>,
    turns_rad: Vec<f64>,
    /// of all that moves with each joint: mass times centre, base frame, kg mm, and mass, kg
    outboard: Vec<(Vector3<f64>, f64)>,
    pull: Vector3<f64>,
    rad_per_nm: &'a [f64],
}

impl<'a> Weight<'a> {
    fn new(arm: &'a Arm, pose: Pose, turns_rad: &[f64], shifts_mm: &[f64]) -> Weight<'a> {
        let n = arm.encoders();
        // gravity is told in the frame of the first axis
        let frames = chained(arm, Isometry3::identity(), turns_rad, shifts_mm, &vec![1.0; n]);
        let mut weight = Weight {
            arm,
            turns_rad: turns_rad.to_vec(),
            outboard: vec![(Vector3::zeros(), 0.0); n],
            pull: Vector3::zeros(),
            rad_per_nm: &[],
            frames,
        };
        if let Some(compliance) = &arm.effects().compliance {
            weight.pull = compliance.pull().into();
            weight.rad_per_nm = &compliance.rad_per_nm;
            let hung = |i: usize, body: &Body| {
                let centre = weight.frames[i + 1] * Point3::from(body.centre_mm);
                (centre.coords * body.mass_kg, body.mass_kg)
            };
            // what is carried hangs on the last joint, as the probe does
            let mut sum = hung(n - 1, &pose.payload());
            for (i, body) in compliance.bodies.iter().enumerate().rev() {
                let (moment, mass) = hung(i, body);
                sum = (sum.0 + moment, sum.1 + mass);
                weight.outboard[i] = sum;
            }
        }
        weight
    }

    fn rad_per_nm(&self, i: usize) -> f64 {
        self.rad_per_nm[i]
    }

    /// Of all that moves with joint `i`, seen from a point: mass times lever, kg mm.
    fn lever(&self, i: usize, from: &Vector3<f64>) -> Vector3<f64> {
        let (sum, mass) = self.outboard[i];
        sum - from * mass
    }

    fn axis(&self, i: usize) -> Vector3<f64> {
        self.frames[i] * Vector3::z()
    }

    /// Moment of gravity about axis `i`: `pull · z_i × Σ m (c - o_i)`.
    fn moment_nm(&self, i: usize) -> f64 {
        self.pull.dot(&self.axis(i).cross(&self.lever(i, &self.frames[i].translation.vector)))
    }

    /// Derivative of the moment about axis `i` with respect to parameter `k` of joint `j`.
    fn derivative_nm(&self, i: usize, j: usize, k: usize) -> f64 {
        let joint = &self.arm.joints()[j.min(self.arm.joints().len() - 1)];
        let (before, after) = (&self.frames[j], &self.frames[j + 1]);
        let z_joint = self.axis(j);
        let turn = self.turns_rad[j];
        let x_link = before * Vector3::new(turn.cos(), turn.sin(), 0.0);
        // a parameter turns all that is outboard of it about an axis through a point, or shifts it
        let (turning, shift, through) = match (k, joint.model) {
            // of a bare last joint too, which has no model
            (3, _) if self.arm.slides(j) => (Vector3::zeros(), z_joint, after.translation.vector),
            (0, _) => (-z_joint, Vector3::zeros(), before.translation.vector),
            (1, _) => (x_link, Vector3::zeros(), after.translation.vector),
            (2, _) => (Vector3::zeros(), x_link, after.translation.vector),
            (_, JointModel::Dh) => (Vector3::zeros(), z_joint, after.translation.vector),
            (_, JointModel::Hayati) => (after * Vector3::y(), Vector3::zeros(), after.translation.vector),
        };
        let axis = self.axis(i);
        if i > j {
            // axis i moves together with all that hangs on it
            let lever = self.lever(i, &self.frames[i].translation.vector);
            return self.pull.dot(&turning.cross(&axis.cross(&lever)));
        }
        let (_, mass) = self.outboard[j];
        let moved = turning.cross(&self.lever(j, &through)) + shift * mass;
        self.pull.dot(&axis.cross(&moved))
    }
}
