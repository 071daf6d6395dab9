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

HARMLESS = (
    HarmlessChange(
        "runtime/python/projection.py", "_FOLLOWED = 16", "16", "17", _COUNT,
    ),
    HarmlessChange(
        "runtime/python/projection.py",
        "_LEAST_DAMPING, _FIRST_DAMPING, _MOST_DAMPING = 1e-10, 1e-3, 1e10  # damping of a step",
        "1e10", "10000000001.0", "the bound is one digit in ten higher",
    ),
    HarmlessChange(
        "runtime/python/path_following.py", "_NEWTON_STEPS = 30", "30", "31", _COUNT,
    ),
    HarmlessChange(
        "runtime/python/meeting_rows.py",
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
        "verify/coverage.py",
        "if all(arm.distance(candidate, other) > FOUND_TOLERANCE for other in known):",
        ">", ">=", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/trig_quartic_roots.py",
        "return (first, second) if square >= -1e-6 * (1.0 + middle * middle) else ()",
        ">=", ">", _EQUAL,
    ),
    HarmlessChange(
        "runtime/python/quartic_lines.py", "return low if x < low else high if x > high else x",
        ">", ">=", "the bound and the value are the same there",
    ),
    HarmlessChange(
        "runtime/python/general_6r.py", "X[:3, 3] = 8e-4, -1.1e-3, 6e-4", "-1.1e-3", "(0.0011)",
        "any small motion puts the pose off",
    ),
    HarmlessChange(
        "runtime/python/row_placement.py", "if limits and most < inf:", "<", "<=",
        "a limit that is infinite leaves the turns as they are",
    ),
    HarmlessChange(
        "solver/soundness.py", "break", "break", "continue",
        "nothing is changed in a step that ends so, and nothing in those that would follow",
    ),
    HarmlessChange(
        "solver/session.py",
        "def get(self, support: int, default: float = 1.0) -> float:  # type: ignore[override]",
        "1.0", "2.0", "every support has a weight: the default is not read",
    ),
    HarmlessChange(
        "verify/task_space.py",
        "(np.remainder(difference[0] - difference[1] + np.pi, 2 * np.pi) - np.pi)[:, None]",
        "+", "-", "the two are a whole turn apart, of which the remainder is taken",
    ),
    HarmlessChange(
        "verify/task_space.py",
        "scale = np.divide(angle, sine, out=np.ones_like(angle), where=sine > 1e-300)",
        ">", ">=", _EQUAL,
    ),
    HarmlessChange(
        "verify/motion_checks.py",
        "regular = np.flatnonzero(clear & (sigma.reshape(_BETWEEN, -1).min(axis=0) > CLEARLY_REGULAR))",
        "1", "2", "any negative length is worked out from the others",
    ),
    HarmlessChange(
        "verify/coverage.py",
        "dropped = expected & (nearest(arm, b, a) > FOUND_TOLERANCE)",
        ">", ">=", _EQUAL,
    ),
    HarmlessChange(
        "verify/search.py",
        "reached = residual < CONVERGED",
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
    HarmlessChange(
        "forms/quartic_form.py", "out = np.full((4, 2, len(a2)), np.nan)", "4", "5",
        "a place behind the last root is not read",
    ),
    HarmlessChange(
        "runtime/python/trig_quartic_roots.py",
        "return (u, v) if abs(u - c) + abs(v - s) < reach else (c, s)",
        "<", "<=", _EQUAL,
    ),
)  # fmt: skip


def why_harmless(path: str, text: bytes, mutation: CodeMutation) -> str:
    """Why no test should notice it; nothing where that is not known. `text`: the module's."""
    line = text.decode().splitlines()[mutation.line - 1].strip()
    change = (path, line, mutation.old, mutation.new)
    return next((h.why for h in HARMLESS if (h.path, h.line, h.old, h.new) == change), "")
