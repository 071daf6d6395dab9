//! From the closed form's branches to the solutions of a pose.

use std::f64::consts::{PI, TAU};

use crate::arm::{branches, BESIDE, DOF, FREE_DEFAULTS, FREE_JOINTS, LOWER, MAX_SOLUTIONS, ORIENTATION, READ, REVOLUTE, UPPER, WHOLE_POSE};
use crate::arm::{COINCIDENT, CONTINUUM_BELOW, LIMIT_TOLERANCE, POSE_TOLERANCE, SINGULAR_BELOW, TRIES, TRY_STEP};
use crate::chain::product;
use crate::newton::{loses_rank, polish};
use crate::{Joints, Options, Pose, Row, Solutions, Status};

/// All joint values that bring TIP_LINK to the pose in BASE_LINK.
pub fn solve(pose: &Pose, options: &Options) -> Solutions {
    if !is_pose(pose) {
        return Solutions { status: Status::Invalid, rows: Vec::new() };
    }
    let seed = options.seed.filter(|q| q.iter().all(|x| x.is_finite()));
    let (rows, real) = fitting(pose, seed, &held(options, seed));
    let status = match (rows.is_empty(), real) {
        (false, _) => Status::Ok,
        (true, true) => Status::Limits,
        (true, false) => Status::Unreachable,
    };
    Solutions { status, rows }
}

/// The options with the seed's values for held joints that are left at their defaults.
fn held(options: &Options, seed: Option<Joints>) -> Options {
    let mut out = *options;
    if let Some(q) = seed {
        for (i, &j) in FREE_JOINTS.iter().enumerate() {
            if out.free[i] == FREE_DEFAULTS[i] {
                out.free[i] = q[j];
            }
        }
    }
    out
}

/// Solutions on the right turns, and whether there were any before limits. Where the pose leaves a joint
/// free and the seed's value of it leads nowhere, others are tried.
fn fitting(pose: &Pose, seed: Option<Joints>, options: &Options) -> (Vec<Row>, bool) {
    let mut real = false;
    for turn in 0..TRIES {
        let mut start = seed.unwrap_or([0.0; DOF]);
        for j in 0..DOF {
            start[j] += if REVOLUTE[j] { turn as f64 * TRY_STEP } else { 0.0 };
        }
        for (i, &j) in FREE_JOINTS.iter().enumerate() {
            start[j] = options.free[i];
        }
        let (found, hit) = find_rows(pose, &start, options);
        real |= !found.is_empty();
        let place = |row: Row| place_row(row.q, seed, options.limits).map(|q| Row { q, ..row });
        let mut rows: Vec<Row> = found.into_iter().filter_map(place).collect();
        if rows.is_empty() && seed.is_some() && polish(&mut start, pose) {
            rows.extend(place(Row { q: start, singular: loses_rank(&start, CONTINUUM_BELOW) }));
        }
        if !rows.is_empty() || !hit {
            if let Some(seed) = seed {
                rows.sort_by(|a, b| distance(&a.q, &seed).total_cmp(&distance(&b.q, &seed)));
            }
            return (rows, real);
        }
    }
    (Vec::new(), real)
}

/// The distinct solutions, polished where the closed form lost digits, and whether a joint was left free.
fn find_rows(pose: &Pose, start: &Joints, options: &Options) -> (Vec<Row>, bool) {
    let mut candidates = Vec::new();
    let hit = branches(pose, start, &options.free, &mut candidates);
    for motion in &BESIDE {
        branches(&product(pose, motion), start, &options.free, &mut candidates);
    }
    let mut rows: Vec<Row> = Vec::new();
    let mut add = |q: Joints, singular: bool| {
        if rows.len() < MAX_SOLUTIONS && !rows.iter().any(|row| same(&row.q, &q)) {
            rows.push(Row { q, singular });
        }
    };
    let mut q = *start;
    if hit && polish(&mut q, pose) {
        add(q, loses_rank(&q, CONTINUUM_BELOW));
    }
    for row in candidates.iter().filter(|row| row.rough) {
        let mut q = row.q;
        if polish(&mut q, pose) {
            add(q, loses_rank(&q, if row.singular { CONTINUUM_BELOW } else { SINGULAR_BELOW }));
        }
    }
    for row in candidates.iter().filter(|row| !row.rough) {
        add(row.q, row.singular);
    }
    (rows, hit)
}

/// Whether two rows are the same, whole turns aside.
fn same(a: &Joints, b: &Joints) -> bool {
    (0..DOF).all(|j| {
        let gap = (a[j] - b[j]).abs();
        gap <= COINCIDENT || (REVOLUTE[j] && (gap - TAU * (gap / TAU).round()).abs() <= COINCIDENT)
    })
}

fn distance(a: &Joints, b: &Joints) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum()
}

/// The row on the whole turns that the seed or the limits ask for; None outside the limits.
fn place_row(mut q: Joints, seed: Option<Joints>, limits: bool) -> Option<Joints> {
    for j in 0..DOF {
        let (low, high) = (LOWER[j] - LIMIT_TOLERANCE, UPPER[j] + LIMIT_TOLERANCE);
        if REVOLUTE[j] && !FREE_JOINTS.contains(&j) {
            q[j] -= TAU * ((q[j] - PI) / TAU).ceil();
            if let Some(seed) = seed {
                q[j] += TAU * ((seed[j] - q[j]) / TAU).round();
            }
            if limits && q[j] < low {
                q[j] += TAU * ((low - q[j]) / TAU).ceil();
            }
            if limits && q[j] > high {
                q[j] -= TAU * ((q[j] - high) / TAU).ceil();
            }
        }
        if limits && !(low <= q[j] && q[j] <= high) {
            return None;
        }
    }
    Some(q)
}

/// Whether what the task reads of the pose is that of a rigid transform.
fn is_pose(t: &Pose) -> bool {
    let near = |x: f64, y: f64| (x - y).abs() < POSE_TOLERANCE;
    let product = |a: usize, b: usize| (0..3).map(|k| t[a][k] * t[b][k]).sum::<f64>();
    let column = |c: usize| (0..3).map(|r| t[r][c] * t[r][c]).sum::<f64>();
    if READ.iter().any(|&(r, c, _)| !t[r][c].is_finite()) || (WHOLE_POSE && t[3] != [0.0, 0.0, 0.0, 1.0]) {
        return false;
    }
    match ORIENTATION {
        "rotation" => {
            let third = |i: usize, j: usize| t[0][i] * t[1][j] - t[0][j] * t[1][i];
            near(product(0, 0), 1.0)
                && near(product(1, 1), 1.0)
                && near(product(0, 1), 0.0)
                && near(third(1, 2), t[2][0])
                && near(third(2, 0), t[2][1])
                && near(third(0, 1), t[2][2])
        }
        "direction" => near(column(2), 1.0),
        "yaw" => {
            let square = t[0][0] * t[0][0] + t[1][0] * t[1][0];
            square > 0.0 && square < 1.0 + POSE_TOLERANCE
        }
        _ => true,
    }
}
