"""Defects planted in an emitted module, each of which verification must find.

    python -m benchmarks.planted [--arm FILE] [--record]

Every defect is a few lines behind the module's text: signs, swapped joints, small offsets, whole turns,
lost and doubled rows, limits, statuses, flags, constants. Exit code 1 where one is not found.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from benchmarks.command_line import FIXTURES
from benchmarks.results import write_result

__all__ = ["defects", "main", "unfound"]

_ROWS = """
_right_solve, _right_batch = solve, solve_batch


def solve(pose, **options):
    found = _right_solve(pose, **options)
    q, status, singular = found.q.copy(), found.status, found.singular.copy()
    if len(q):
        {change}
    return Solutions(q, status, singular)


def solve_batch(poses, **options):
    Q, count, status = _right_batch(poses, **options)
    for i in range(len(Q)):
        q = Q[i, : count[i]].copy()
        singular = np.zeros(len(q), dtype=bool)
        if len(q):
            {change}
            q = q[: Q.shape[1]]
            Q[i], count[i] = np.nan, len(q)
            Q[i, : len(q)] = q
    return Q, count, status
"""


def defects(dof: int) -> Iterator[tuple[str, str]]:
    """Words and lines of each, for an arm of `dof` joints."""
    for j in range(dof):
        yield f"sign of joint {j}", _ROWS.format(change=f"q[:, {j}] *= -1.0")
        yield f"joint {j} off by 1e-6", _ROWS.format(change=f"q[:, {j}] += 1e-6")
        yield f"joint {j} a turn off", _ROWS.format(change=f"q[:, {j}] += 2.0 * np.pi")
        yield f"joint {j} of one row off by 1e-5", _ROWS.format(change=f"q[-1, {j}] += 1e-5")
        yield f"upper limit of joint {j}", f"\nUPPER = UPPER.copy()\nUPPER[{j}] += 0.1\n"
        yield f"lower limit of joint {j}", f"\nLOWER = LOWER.copy()\nLOWER[{j}] += 0.1\n"
    for j in range(dof - 1):
        order = [*range(j), j + 1, j, *range(j + 2, dof)]
        yield f"joints {j} and {j + 1} swapped", _ROWS.format(change=f"q = q[:, {order}]")
    yield "the last row lost", _ROWS.format(change="q, singular = q[:-1], singular[:-1]")
    yield "the first row lost", _ROWS.format(change="q, singular = q[1:], singular[1:]")
    two = "q, singular = (q[1:], singular[1:]) if len(q) > 2 else (q, singular)"
    yield "a row of more than two lost", _ROWS.format(change=two)
    again = "q, singular = np.vstack([q, q[:1]]), np.append(singular, singular[0])"
    yield "a row twice", _ROWS.format(change=again)
    yield "rows of another order", _ROWS.format(change="q, singular = q[::-1], singular[::-1]")
    yield (
        "limits ignored",
        (
            "\n_right = solve\n\n\ndef solve(pose, **options):\n"
            "    return _right(pose, **{**options, 'limits': False})\n"
        ),
    )
    yield (
        "the seed ignored",
        (
            "\n_right = solve\n\n\ndef solve(pose, **options):\n"
            "    return _right(pose, **{**options, 'seed': None})\n"
        ),
    )
    for name in ("OK", "LIMITS", "INVALID"):
        yield (
            f"{name} in place of UNREACHABLE",
            (
                "\n_right = solve\n\n\ndef solve(pose, **options):\n"
                "    found = _right(pose, **options)\n"
                "    wrong = found.status is Status.UNREACHABLE\n"
                f"    return Solutions(found.q, Status.{name}, found.singular) if wrong else found\n"
            ),
        )
    forward = "\n_right = forward\n\n\ndef forward(q):\n    T = _right(q).copy()\n"
    yield "forward off by 1e-7 m", forward + "    T[..., 0, 3] += 1e-7\n    return T\n"
    yield "forward transposed", forward + "    return T.swapaxes(-1, -2)\n"
    jacobian = "\n_right_J = jacobian\n\n\ndef jacobian(q):\n    J = _right_J(q).copy()\n"
    yield "halves of the Jacobian swapped", jacobian + "    return np.roll(J, 3, axis=-2)\n"
    yield "sign of the Jacobian", jacobian + "    return -J\n"
    yield "joint names swapped", "\nJOINT_NAMES = JOINT_NAMES[::-1]\n"


def unfound(robot: Path, every: int = 1) -> tuple[list[str], int]:
    """Those (each `every`th of them) that verification passes, and how many there were."""
    from ikgen.derivation.derive import derive
    from ikgen.derivation.progress import silent
    from ikgen.emit.python.python_emitter import emit_module
    from ikgen.errors import IkgenError
    from ikgen.generation.emitted_arm import EmittedArm
    from ikgen.generation.emitted_checks import oracle_for, verify_one
    from ikgen.records.request import Outputs, Request
    from ikgen.verify.runners.python_module import PythonModule

    derivation = derive(Request(robot))
    text, oracle = emit_module(derivation.module), oracle_for(derivation.reading)
    arm, outputs = EmittedArm.of(derivation.module), Outputs(samples=100)
    passed = []
    planted = [("", ""), *list(defects(derivation.module.dh.dof))[::every]]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "arm_ik.py")
        for words, lines in planted:
            path.write_text(text + lines, encoding="utf-8")
            try:
                if verify_one(PythonModule(path), oracle, arm, outputs, silent).passed:
                    passed.append(words)
            except IkgenError:
                pass  # not even run: found
    if "" not in passed:
        raise RuntimeError("the module fails without a defect")
    return [words for words in passed if words], len(planted) - 1


def main() -> int:
    """Plant all of them."""
    parser = argparse.ArgumentParser(description="Defects that verification must find.")
    parser.add_argument("--arm", type=Path, default=FIXTURES / "kuka_kr6r900sixx.urdf")
    parser.add_argument("--record", action="store_true", help="write the recorded result")
    options = parser.parse_args()
    left, count = unfound(options.arm)
    print(f"{count - len(left)} of {count} found", *left, sep="\n")
    if options.record:
        write_result("planted", "python -m benchmarks.planted", {"planted": count, "unfound": left})
    return 1 if left else 0


if __name__ == "__main__":
    sys.exit(main())
