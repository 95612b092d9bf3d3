//! The forward map and its derivatives, twice: here as the formula reads, in [`batch`] over many readings at once.
//!
//! ```text
//! turn_i = sign_i q_i - theta0_i
//! p_base = T_1 T_2 … T_{n-1} Rz(sign_n q_n) tip
//! T_i    = Rz(turn_i) Tz(d_i) Tx(a_i) Rx(alpha_i)        Denavit-Hartenberg
//! T_i    = Rz(turn_i) Tx(a_i) Rx(alpha_i) Ry(beta_i)     Hayati
//! ```

pub mod batch;
mod chain;
mod poses;

use crate::arm::{Arm, Joint, JointModel};
pub use chain::Chain;
use nalgebra::{Isometry3, Matrix3xX, Point3, Translation3, UnitQuaternion, Vector3};
pub use poses::Poses;

/// `T_i`: from the frame after joint i to the frame before it, at encoder angle `q_rad`.
fn step(joint: &Joint, q_rad: f64) -> Isometry3<f64> {
    let turn = joint.sign * q_rad - joint.theta0_rad;
    let rz = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn);
    let rx = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), joint.alpha_rad);
    match joint.model {
        JointModel::Dh => rz * Translation3::new(joint.a_mm, 0.0, joint.d_mm) * rx,
        JointModel::Hayati => {
            let ry = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), joint.beta_rad);
            rz * Translation3::new(joint.a_mm, 0.0, 0.0) * (rx * ry)
        }
    }
}

/// Frames `t_base_joint` of every joint before its turn, the probe's frame last: n + 1 frames.
pub fn frames(arm: &Arm, q_rad: &[f64]) -> Vec<Isometry3<f64>> {
    let mut t_base = Isometry3::identity();
    let mut all = vec![t_base];
    for (joint, &q) in arm.joints().iter().zip(q_rad) {
        t_base *= step(joint, q);
        all.push(t_base);
    }
    let n = arm.encoders();
    let last_sign = arm.signs().last().unwrap_or(1.0);
    let roll = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), last_sign * q_rad[n - 1]);
    all.push(t_base * roll);
    all
}

/// Tip position in the base frame, mm, of one pose of n encoder angles.
pub fn tip_mm(arm: &Arm, probe: usize, q_rad: &[f64]) -> Point3<f64> {
    let frames = frames(arm, q_rad);
    frames[arm.encoders()] * Point3::from(arm.probes()[probe].tip_mm)
}

/// ∂p/∂parameter of one pose, 3 × parameters: mm/rad and mm/mm, all columns by cross products (MODEL section 2).
pub fn jacobian(arm: &Arm, probe: usize, q_rad: &[f64]) -> Matrix3xX<f64> {
    let frames = frames(arm, q_rad);
    let p_tip = frames[arm.encoders()] * Point3::from(arm.probes()[probe].tip_mm);
    let mut jacobian = Matrix3xX::zeros(arm.parameter_count());
    for (i, joint) in arm.joints().iter().enumerate() {
        let (before, after) = (&frames[i], &frames[i + 1]);
        let z_joint = before * Vector3::z();
        let turn = joint.sign * q_rad[i] - joint.theta0_rad;
        let x_link = before * Vector3::new(turn.cos(), turn.sin(), 0.0);
        let from_axis = p_tip.coords - before.translation.vector;
        let from_end = p_tip.coords - after.translation.vector;
        let mut set = |k: usize, v: Vector3<f64>| jacobian.set_column(4 * i + k, &v);
        set(0, -z_joint.cross(&from_axis));
        set(1, x_link.cross(&from_end));
        set(2, x_link);
        set(
            3,
            match joint.model {
                JointModel::Dh => z_joint,
                JointModel::Hayati => (after * Vector3::y()).cross(&from_end),
            },
        );
    }
    let r_base_tip = frames[arm.encoders()].rotation.to_rotation_matrix();
    for k in 0..3 {
        jacobian.set_column(arm.tip_offset(probe) + k, &r_base_tip.matrix().column(k));
    }
    jacobian
}

/// ∂p/∂q of one pose, 3 × n, mm/rad.
pub fn encoder_jacobian(arm: &Arm, probe: usize, q_rad: &[f64]) -> Matrix3xX<f64> {
    let frames = frames(arm, q_rad);
    let p_tip = frames[arm.encoders()] * Point3::from(arm.probes()[probe].tip_mm);
    let columns = arm.signs().enumerate().map(|(i, sign)| {
        let z_joint = frames[i] * Vector3::z();
        sign * z_joint.cross(&(p_tip.coords - frames[i].translation.vector))
    });
    Matrix3xX::from_columns(&columns.collect::<Vec<_>>())
}
