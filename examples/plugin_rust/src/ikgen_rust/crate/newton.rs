//! Newton steps on the file's own chain, and whether a configuration is singular.

use crate::arm::{ARRIVED, CONVERGED, DAMPING, DOF, FREE_JOINTS, LARGEST_STEP, LEAST_DAMPING, PATIENCE, PROGRESS, READ, REFINEMENT};
use crate::chain::chain;
use crate::{Joints, Pose};

/// Per entry that the task reads: its error, and the derivative of the entry by each joint.
type Offset = [(f64, Joints); READ.len()];

fn offset_from(q: &Joints, target: &Pose) -> Offset {
    let (pose, slope) = chain(q);
    let mut out = [(0.0, [0.0; DOF]); READ.len()];
    for (&(r, c, weight), (error, row)) in READ.iter().zip(out.iter_mut()) {
        *error = weight * (target[r][c] - pose[r][c]);
        let (u, v) = ((r + 1) % 3, (r + 2) % 3);
        for j in (0..DOF).filter(|j| !FREE_JOINTS.contains(j)) {
            let turning = slope[3 + u][j] * pose[v][c] - slope[3 + v][j] * pose[u][c];
            row[j] = weight * if c == 3 { slope[r][j] } else { turning };
        }
    }
    out
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// x = A^-1 x by Cholesky's factor, which takes A's place.
fn solve_symmetric(a: &mut [Joints; DOF], x: &mut Joints) {
    for i in 0..DOF {
        for j in 0..=i {
            let sum = a[i][j] - dot(&a[i][..j], &a[j][..j]);
            a[i][j] = if i == j { sum.max(1e-300).sqrt() } else { sum / a[j][j] };
        }
        x[i] = (x[i] - dot(&a[i][..i], &x[..i])) / a[i][i];
    }
    for i in (0..DOF).rev() {
        let above: f64 = (i + 1..DOF).map(|k| a[k][i] * x[k]).sum();
        x[i] = (x[i] - above) / a[i][i];
    }
}

/// Damped least squares: at a fold of the solution set the steps halve the error.
fn step(at: &Offset, worst: f64, q: &mut Joints) {
    let damping = f64::max(LEAST_DAMPING, DAMPING * worst.min(1.0).powi(2));
    let (mut a, mut x) = ([[0.0; DOF]; DOF], [0.0; DOF]);
    for (error, row) in at {
        for i in 0..DOF {
            x[i] += row[i] * error;
            for j in 0..DOF {
                a[i][j] += row[i] * row[j];
            }
        }
    }
    for (i, row) in a.iter_mut().enumerate() {
        row[i] += damping;
    }
    solve_symmetric(&mut a, &mut x);
    for j in 0..DOF {
        q[j] += x[j].clamp(-LARGEST_STEP, LARGEST_STEP);
    }
}

/// At most `steps` Newton steps; the error that is left.
fn newton(q: &mut Joints, target: &Pose, steps: usize) -> f64 {
    let (mut trial, mut best, mut stalled) = (*q, f64::INFINITY, 0);
    for i in 0.. {
        let at = offset_from(&trial, target);
        let worst = at.iter().map(|(error, _)| error.abs()).fold(0.0, f64::max);
        stalled = if worst < PROGRESS * best && worst > CONVERGED { 0 } else { stalled + 1 };
        if worst < best {
            best = worst;
            *q = trial;
        }
        if i == steps || stalled == PATIENCE || !(best > CONVERGED) {
            break;
        }
        step(&at, worst, &mut trial);
    }
    best
}

/// Whether Newton steps lead from q to the pose: only what is promising takes many. All digits
/// are wanted where they come easily, as rows may lie on a limit.
pub(crate) fn polish(q: &mut Joints, target: &Pose) -> bool {
    let mut error = f64::INFINITY;
    for (steps, fine, promising) in REFINEMENT {
        error = newton(q, target, steps);
        if error < fine || error >= promising {
            break;
        }
    }
    error < ARRIVED
}

/// Whether the moving joints' Jacobian has a singular value below `bound`: one-sided Jacobi rotations.
pub(crate) fn loses_rank(q: &Joints, bound: f64) -> bool {
    let at = offset_from(q, &[[0.0; 4]; 4]);
    let moving = (0..DOF).filter(|j| !FREE_JOINTS.contains(j));
    let mut columns: Vec<Vec<f64>> = moving.map(|j| at.iter().map(|(_, row)| row[j]).collect()).collect();
    for _sweep in 0..30 {
        let mut turned = false;
        for b in 1..columns.len() {
            for a in 0..b {
                turned |= make_orthogonal(&mut columns, a, b);
            }
        }
        if !turned {
            break;
        }
    }
    columns.iter().any(|v| dot(v, v) < bound * bound)
}

/// Turn two columns in their plane; false where they are orthogonal already.
fn make_orthogonal(columns: &mut [Vec<f64>], a: usize, b: usize) -> bool {
    let (left, right) = columns.split_at_mut(b);
    let (x, y) = (&mut left[a], &mut right[0]);
    let (xx, yy, xy) = (dot(x, x), dot(y, y), dot(x, y));
    if !(xy * xy > 1e-30 * xx * yy) {
        return false;
    }
    let z = (yy - xx) / (2.0 * xy);
    let t = 1f64.copysign(z) / (z.abs() + (1.0 + z * z).sqrt());
    let c = 1.0 / (1.0 + t * t).sqrt();
    for (u, v) in x.iter_mut().zip(y.iter_mut()) {
        (*u, *v) = (c * (*u - t * *v), c * (t * *u + *v));
    }
    true
}
