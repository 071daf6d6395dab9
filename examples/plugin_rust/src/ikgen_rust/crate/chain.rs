//! Forward kinematics and Jacobian of the file's own chain.

use crate::arm::{DOF, FRAMES, MOTIONS};
use crate::{Joints, Pose};

pub(crate) fn product(a: &Pose, b: &Pose) -> Pose {
    let mut out = [[0.0; 4]; 4];
    for i in 0..4 {
        for j in 0..4 {
            out[i][j] = (0..4).map(|k| a[i][k] * b[k][j]).sum();
        }
    }
    out
}

fn motion(revolute: bool, v: f64) -> Pose {
    let (s, c, d) = if revolute { (v.sin(), v.cos(), 0.0) } else { (0.0, 1.0, v) };
    [[c, -s, 0.0, 0.0], [s, c, 0.0, 0.0], [0.0, 0.0, 1.0, d], [0.0, 0.0, 0.0, 1.0]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Pose of TIP_LINK in BASE_LINK.
pub fn forward(q: &Joints) -> Pose {
    chain(q).0
}

/// Geometric Jacobian of the tip in BASE_LINK: linear rows (m/s), then angular (rad/s).
pub fn jacobian(q: &Joints) -> [[f64; DOF]; 6] {
    chain(q).1
}

/// Tip pose and Jacobian.
pub(crate) fn chain(q: &Joints) -> (Pose, [[f64; DOF]; 6]) {
    let mut pose = FRAMES[0];
    let mut lines = Vec::with_capacity(MOTIONS.len());
    for (i, &(joint, revolute, scale, offset)) in MOTIONS.iter().enumerate() {
        let axis = [0, 1, 2].map(|r| scale * pose[r][2]);
        let origin = [0, 1, 2].map(|r| pose[r][3]);
        lines.push((joint, revolute, axis, origin));
        pose = product(&product(&pose, &motion(revolute, scale * q[joint] + offset)), &FRAMES[i + 1]);
    }
    let mut slope = [[0.0; DOF]; 6];
    for (joint, revolute, axis, origin) in lines {
        let arm = [0, 1, 2].map(|r| pose[r][3] - origin[r]);
        let linear = if revolute { cross(axis, arm) } else { axis };
        for r in 0..3 {
            slope[r][joint] += linear[r];
            slope[3 + r][joint] += if revolute { axis[r] } else { 0.0 };
        }
    }
    (pose, slope)
}
