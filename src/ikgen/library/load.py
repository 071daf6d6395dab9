"""`ikgen.load`: a robot description into an arm that solves, made and verified in memory."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from ikgen.derivation.progress import Progress, silent
from ikgen.library.argument_words import in_argument_words
from ikgen.library.load_arguments import checked_count, checked_flag, checked_request, wrong
from ikgen.library.solver_cache import SolverCache, SolverEntry
from ikgen.records.request import Outputs

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation
    from ikgen.library.loaded_arm import Arm
    from ikgen.records.request import Request

__all__ = ["load"]


@in_argument_words()
def load(
    robot: str | os.PathLike[str],
    *,
    base: str | None = None,
    tip: str | None = None,
    task: str | None = None,
    tool_axis: str | None = None,
    free: str | Iterable[str] | Mapping[str, float | str | None] | None = None,
    lock: Mapping[str, float | str] | None = None,
    couple: Mapping[str, str] | None = None,
    args: Mapping[str, object] | None = None,
    calibration: str | os.PathLike[str] | None = None,
    verify: bool = True,
    samples: int = 1000,
    package_paths: Iterable[str | os.PathLike[str]] = (),
    name: str | None = None,
    trust: bool = False,
    cache: bool = True,
    progress: Progress = silent,
) -> Arm:
    """The arm of a URDF or xacro file, of a DH table, or of a robot by name.

    `base` and `tip` are links (poses are those of the tip in the base), `task` says what of a pose
    counts, `tool_axis` by which of the tool's axes where that is a direction. `free` names joints whose
    values become an input of `solve`, with default values or without, `lock` fixes joints; values are in
    rad or m, or texts with a unit ("45deg"). `couple` makes joints follow others ({"JOINT": "SOURCE*k+c"}).
    `args` are xacro's arguments, `calibration` is the file of
    the one arm's own kinematics, `package_paths` are where packages are found. What is left out is
    chosen: the one chain that there is, a task that fits it, joints to hold.

    The solver is verified on `samples` random poses unless `verify` is false, and kept in the cache
    (`ikgen.library.solver_cache`) unless `cache` is false. `trust` lets a xacro file do whatever xacro
    can. `progress` is called with a stage and a detail.

    Raises errors of `ikgen.errors` alone: `ArgumentError` for a wrong argument, `BadDescriptionError` for
    a file that cannot be read, `UnsolvedChainError` where there is no closed form, `VerificationError`
    where a check fails, `PlugInError` where another package's part does.
    """
    request = checked_request(
        robot, base=base, tip=tip, task=task, tool_axis=tool_axis, free=free, lock=lock,
        couple=couple, args=args, calibration=calibration, package_paths=package_paths,
        name=name, trust=trust,
    )  # fmt: skip
    outputs = Outputs(
        samples=checked_count("samples", samples), verify=checked_flag("verify", verify)
    )
    if not callable(progress):
        raise wrong("progress", progress, "a function of a stage and a detail")
    store = SolverCache.default() if checked_flag("cache", cache) else None
    return _arm(request, outputs, store, progress)


def _arm(request: Request, outputs: Outputs, store: SolverCache | None, progress: Progress) -> Arm:
    """The arm of a request, from the cache where it has it."""
    from ikgen.library.loaded_arm import Arm

    key = "" if store is None else store.key(request, outputs)
    entry = None if store is None else store.read(key)
    if entry is not None:
        return Arm(request, outputs, entry)
    entry, derivation = _made(request, outputs, progress)
    if store is not None:
        store.write(key, entry)
    return Arm(request, outputs, entry, derivation)


def _made(request: Request, outputs: Outputs, progress: Progress) -> tuple[SolverEntry, Derivation]:
    """The solver of a request, made now."""
    from ikgen.derivation.read import read
    from ikgen.derivation.remedies import advised
    from ikgen.generation.emitters import find_emitter
    from ikgen.generation.generate import make_texts

    progress("read", request.robot.name)
    with advised(request, progress):
        made = make_texts(request, read(request), [find_emitter("python")], outputs, progress)
    return SolverEntry.of(made), made.derivation
