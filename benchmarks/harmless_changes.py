"""Changes of ikgen's code that no test can notice, or none should, and why.

Looked at one by one, of those that `python -m benchmarks.mutation_score` drew and no test found. A change
is known by its module, the line that it is in, and what becomes what there.
"""

from __future__ import annotations

from dataclasses import dataclass

from benchmarks.code_mutations import CodeMutation

__all__ = ["HARMLESS", "HarmlessChange", "why_harmless"]


@dataclass(frozen=True, slots=True)
class HarmlessChange:
    """Of `old` to `new` in a `line` (without its margin) of the module at `path` (in src/ikgen)."""

    path: str
    line: str
    old: str
    new: str
    why: str


_EQUAL = "the two numbers are rounded ones that are never equal"
_AS_LONG = "both always have the same length"
_COUNT = "so many suffice, and one more does too"
_WHATEVER = "any length below 0 is what the others leave"
_PLACES = "the two vectors change places, and their order is none"

HARMLESS = (
    HarmlessChange(
        "runtime/python/held/branch_arcs.py",
        "done |= going & (size <= _ARRIVED)",
        "<=", "<", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/held/branch_arcs.py",
        "if (done | ~(moved < _FAR)).all():",
        "<", "<=", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/held/branch_tracks.py",
        "sure = (left > off) & (right > off) & ~(opposite & far)",
        ">", ">=", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/elimination/back_substitution.py",
        "w = np.where(w[:, :1] < 0.0, -w, w)",
        "<", "<=", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/elimination/hidden_angle.py",
        "row, i = np.nonzero(off < accept)",
        "<", "<=", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/newton/lane_newton.py",
        "missed[part] = done & (off > arm.policy.least_miss)",
        ">", ">=", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/newton/lane_newton.py",
        "done = size**3 < policy.converged * before**2",
        "<", "<=", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/singular/near_continuum.py",
        "return curve & (curves.worst >= arm.policy.arrived)",
        ">=", ">", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/singular/curve_parts.py",
        "way[going[np.abs(c.left) > most[going]]] = 0.0",
        ">", ">=", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/singular/curve_parts.py",
        "order = order[np.abs(left[order]) < arm.policy.arrived]",
        "<", "<=", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/solving/path_following.py",
        "return np.asarray(sigma < arm.policy.singular_below)",
        "<", "<=", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/solving/path_following.py",
        "if (slow and i > 2) or least < self.arm.policy.converged:",
        "<", "<=", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/rows/row_placement.py",
        "beyond |= value + turn < high + reach",
        "<", "<=", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/held/slide_range.py",
        "if abs(slope) < _ACROSS:",
        "<", "<=", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/rows/solution_rows.py",
        "apart = (np.diff(rank[order]) > 0) | (np.diff(key[order]) > _SAME_KEY)",
        ">", ">=", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/roots/trig_quartic_roots.py",
        "return (u, v) if abs(u - c) + abs(v - s) < reach else None",
        "<", "<=", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/roots/trig_quartic_roots.py",
        "if h < _LEAST_HALF:  # the value at the extremum is round-off: Newton steps would be too",
        "<", "<=", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/held/branch_arcs.py",
        "_MOST = 40",
        "40", "41", _COUNT,
    ),
    HarmlessChange(
        "runtime/python/singular/curve_parts.py",
        "_STEPS, _DEEP = 40, 24  # of false position, and how often a part is halved",
        "40", "41", _COUNT,
    ),
    HarmlessChange(
        "runtime/python/elimination/back_substitution.py",
        "cone = np.stack([-H[:, 0, 1] - sign * disc, H[:, 0, 0]], axis=-1)",
        "-", "+", _PLACES,
    ),
    HarmlessChange(
        "runtime/python/elimination/back_substitution.py",
        "other = np.stack([H[:, 1, 1], -H[:, 0, 1] + sign * disc], axis=-1)",
        "+", "-", _PLACES,
    ),
    HarmlessChange(
        "runtime/python/held/arm_angle_motion.py",
        "middle, still, moving = (1, 0, 2) if j < _ELBOW else (5, 6, 4)",
        "<", "<=", "the elbow itself is never asked for",
    ),
    HarmlessChange(
        "runtime/python/held/arm_angle_motion.py",
        "limit = middle + side * (half + 0.5 * arm.policy.limit_tolerance)",
        "+", "-", "both sides are looked at, in whatever order",
    ),
    HarmlessChange(
        "runtime/python/held/branch_ends.py",
        "least = -float(rows.folds[k, row if seen else e.lane].min(initial=inf))",
        "seen", "not (seen)", "an end at a fold stays in its lane where margins tell",
    ),
    HarmlessChange(
        "runtime/python/held/branch_tracks.py",
        "opposite, far = a * b < 0.0, (period > 0.0) & (np.abs(a) + np.abs(b) > 0.5 * period)",
        "<", "<=", "a row in the middle is inside, and no other is more than half a turn away",
    ),
    HarmlessChange(
        "runtime/python/solving/closed_form_rows.py",
        "poses = (T[:, None] @ arm.beside).reshape(-1, 4, 4)",
        "1", "2", _WHATEVER,
    ),
    HarmlessChange(
        "runtime/python/held/held_grid_search.py",
        'return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes)), tuple(steps)',
        "1", "2", _WHATEVER,
    ),
    HarmlessChange(
        "runtime/python/solving/rows_elsewhere.py",
        "break",
        "break", "continue", "nothing is left to be tried then",
    ),
    HarmlessChange(
        "runtime/python/elimination/elimination_rows.py",
        "for i in np.flatnonzero(np.bincount(pose, minlength=1) > arm.most):",
        ">", ">=", "as many as there may be stay as they are",
    ),
    HarmlessChange(
        "runtime/python/singular/fold_pair.py",
        "x = np.where(((s > 0.0) == (side > 0.0)) & (square > 0.0), 2.0 * e / p, -p / k)",
        ">", ">=", "a side is 1 or -1",
    ),
    HarmlessChange(
        "runtime/python/elimination/hidden_angle.py",
        "NODES = 2.0 * np.pi / 7.0 * np.arange(7)",
        "2.0", "3.0", "other angles all over the turn, of which the best is taken",
    ),
    HarmlessChange(
        "runtime/python/elimination/hidden_angle.py",
        "if flat.all() or not flat.any():",
        "or", "and", "where all are singular those that are not are none",
    ),
    HarmlessChange(
        "runtime/python/singular/curve_parts.py",
        "values, last = ends.left.copy(), np.full(len(parts.owner), -1)",
        "1", "2", "no side is below 0",
    ),
    HarmlessChange(
        "runtime/python/singular/curve_parts.py",
        "side = (now.a.left * c.left < 0.0).astype(np.intp)",
        "<", "<=", "what is left is 0 then, and the search ends at it",
    ),
    HarmlessChange(
        "runtime/python/elimination/one_slide.py",
        "values = np.concatenate([np.stack(pair, axis=-1), t], axis=1)",
        "-1", "(1)", "an array with one axis is stacked",
    ),
    HarmlessChange(
        "runtime/python/elimination/parallel_axes.py",
        "out[..., 4, 0] += (o4 * o4).sum(axis=-1)[..., None] + (o * o).sum(axis=-1)",
        "-1", "(1)", "the array has two axes",
    ),
    HarmlessChange(
        "runtime/python/elimination/parallel_axes.py",
        "both *= np.copysign(1.0, both[:, :1])",
        "1.0", "2.0", "the vector's length is taken away behind it",
    ),
    HarmlessChange(
        "runtime/python/elimination/parallel_links.py",
        "side = np.where(second[:, 2, 2] > 0.0, 1.0, -1.0)",
        ">", ">=", "of parallel axes it is 1 or -1",
    ),
    HarmlessChange(
        "runtime/python/arguments/pose_arguments.py",
        "if isinstance(pose, np.ndarray) and pose.shape[-2:] == (4, 4):",
        "2", "3", "a stack of matrices stays as it is on the way that others go, too",
    ),
    HarmlessChange(
        "runtime/python/roots/quartic_lines.py",
        "m, low = 0.5 * (above - below), above <= below",
        "<=", "<", "at 0 both ways lead to the same lines",
    ),
    HarmlessChange(
        "runtime/python/newton/refinement.py",
        "on = (least > policy.converged) & (stalled < policy.patience)",
        ">", ">=", "a row without any error goes no step",
    ),
    HarmlessChange(
        "runtime/python/roots/trig_quartic_roots.py",
        "c, s, good = _regular_roots(K / np.where(size > zero, size, 1.0)[:, None])",
        ">", "<", "roots and steps are of ratios: the equation's size does not tell",
    ),
    HarmlessChange(
        "runtime/python/held/self_motion.py",
        "following = int(tracks.links[at, row]) if at < last else -1",
        "1", "2", "any number below 0 says that no row follows",
    ),
    HarmlessChange(
        "runtime/python/solving/projection.py", "_FOLLOWED = 16", "16", "17", _COUNT,
    ),
    HarmlessChange(
        "runtime/python/solving/projection.py",
        "_LEAST_DAMPING, _FIRST_DAMPING, _MOST_DAMPING = 1e-10, 1e-3, 1e10  # damping of a step",
        "1e10", "10000000001.0", "the bound is one digit in ten higher",
    ),
    HarmlessChange(
        "runtime/python/solving/path_following.py", "_NEWTON_STEPS = 30", "30", "31", _COUNT,
    ),
    HarmlessChange(
        "runtime/python/singular/meeting_rows.py",
        "alone = np.flatnonzero(near & (error < arm.policy.arrived))",
        "<", "<=", _EQUAL,
    ),
    HarmlessChange(
        "verify/verification.py",
        "return tuple((int(c), int(n)) for c, n in zip(counts, poses, strict=True))",
        "True", "False", _AS_LONG,
    ),
    HarmlessChange(
        "verify/singularities.py",
        "u, s, vt = np.linalg.svd(J, full_matrices=False)",
        "False", "True", "the vectors that are added are not read",
    ),
    HarmlessChange(
        "solver/leaves/simultaneous.py", "MOST_EQUATIONS = 16", "16", "17", _COUNT,
    ),
    HarmlessChange(
        "solver/transforms/square_and_add.py",
        "if np.abs(det.probe).max() <= 1e-9 * max(det.scale, 1e-300):",
        "<=", "<", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/roots/trig_quartic_roots.py",
        "return (first, second) if square >= -_REAL * (1.0 + middle * middle) else ()",
        ">=", ">", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/roots/quartic_lines.py", "return low if x < low else high if x > high else x",
        ">", ">=", "the bound and the value are the same there",
    ),
    HarmlessChange(
        "runtime/python/elimination/displaced_poses.py", "X[:3, 3] = 0.8 * by, -1.1 * by, 0.6 * by",
        "-1.1", "(1.1)",
        "any small motion puts the pose off",
    ),
    HarmlessChange(
        "runtime/python/rows/row_placement.py", "if most < inf:", "<", "<=",
        "a limit that is infinite leaves the turns as they are",
    ),
    HarmlessChange(
        "solver/soundness.py", "break", "break", "continue",
        "nothing is changed in a step that ends so, and nothing in those that would follow",
    ),
    HarmlessChange(
        "verify/task_space.py",
        "scale = np.divide(angle, sine, out=np.ones_like(angle), where=sine > 1e-300)",
        ">", ">=", _EQUAL,
    ),
    HarmlessChange(
        "verify/motion_checks.py",
        "regular = np.flatnonzero(clear & (sigma.reshape(_BETWEEN, -1).min(axis=0) > REGULAR_ON_PATH))",
        "1", "2", "any negative length is worked out from the others",
    ),
    HarmlessChange(
        "verify/coverage.py",
        "dropped = expected & (nearest(arm, b, a) > FOUND_TOLERANCE)",
        ">", ">=", _EQUAL,
    ),
    HarmlessChange(
        "verify/search.py",
        "reached = residual < bound[alive]",
        "<", "<=", _EQUAL,
    ),
    HarmlessChange(
        "verify/sampling.py",
        "chosen = rng.random((n, arm.dof)) < rng.uniform(0.2, 1.0, size=(n, 1))",
        "<", "<=", _EQUAL,
    ),
    HarmlessChange(
        "verify/reach.py",
        'cases["infinite position"] = changed(slice(2, 3), slice(3, 4), -np.inf)',
        "4", "5", "there is no column behind the last",
    ),
    HarmlessChange(
        "emit/python/python_language.py",
        'return "inf" if value > 0 else "-inf"',
        ">", ">=", "zero is not infinite",
    ),
    HarmlessChange(
        "lowering/lower.py",
        "work.placed.add(atom.id)",
        "work.placed.add(atom.id)", "pass", "what stands for nothing else is neither scheduled nor counted",
    ),
    HarmlessChange(
        "lowering/program_inputs.py",
        "for atom, name in zip(atoms, names, strict=True):",
        "True", "False", _AS_LONG,
    ),
    HarmlessChange(
        "verify/completeness.py",
        "missed = ~(off <= sensitive.within(POSE_NOISE + error))",
        "<=", "<", _EQUAL,
    ),
    HarmlessChange(
        "verify/reach.py", "for _ in range(12):", "12", "13", _COUNT,
    ),
    HarmlessChange(
        "solver/soundness.py",
        "found.append(at[smallest > least_regular(REGULAR, probes.typical)])",
        ">", ">=", _EQUAL,
    ),
)  # fmt: skip


def why_harmless(path: str, text: bytes, mutation: CodeMutation) -> str:
    """Why no test should notice it; nothing where that is not known. `text`: the module's."""
    line = text.decode().splitlines()[mutation.line - 1].strip()
    change = (path, line, mutation.old, mutation.new)
    return next((h.why for h in HARMLESS if (h.path, h.line, h.old, h.new) == change), "")
