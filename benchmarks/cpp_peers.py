"""Other solvers' C++ sources, given by their paths, against emitted headers: in turns, in one process."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.cpp_speed import run_program

__all__ = ["Comparison", "against_ikfast", "against_opw"]

SOURCE = Path(__file__).resolve().parent / "cpp" / "against.cpp"


@dataclass(frozen=True, slots=True)
class Comparison:
    """ns a pose of the emitted header and of the peer; median of their ratio; mean rows a pose."""

    ours: float
    theirs: float
    ratio: float
    our_rows: float
    their_rows: float


def against_opw(
    header: Path, include: Path, parameters: dict[str, Any], flags: list[str]
) -> Comparison:
    """opw_kinematics; `include` is the folder that holds opw_kinematics/opw_kinematics.h."""
    lengths = ", ".join(repr(parameters[n]) for n in ("a1", "a2", "b", "c1", "c2", "c3", "c4"))
    offsets = ", ".join(repr(float(x)) for x in parameters["offsets"])
    signs = ", ".join("-1" if f else "1" for f in parameters.get("flip_axes", (False,) * 6))
    given = f"{{{lengths}, {{{{{offsets}}}}}, {{{{{signs}}}}}}}"
    return _run(header, ["-DPEER_OPW", f"-DPEER_PARAMETERS={given}", f"-I{include}"], flags)


def against_ikfast(header: Path, source: Path, flags: list[str]) -> Comparison:
    """A file that IKFast wrote; ikfast.h has to lie beside it."""
    options = [f'-DPEER_IKFAST="{source.name}"', f"-I{source.resolve().parent}"]
    return _run(header, options, flags, ("-llapack",))


def _run(
    header: Path, options: list[str], flags: list[str], libraries: tuple[str, ...] = ()
) -> Comparison:
    _, numbers = run_program(SOURCE, header, [*flags, *options], libraries)
    return Comparison(*numbers)
