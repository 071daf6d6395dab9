"""What an emitted module answers to drawn poses, with times and sizes; kept in one compressed file."""

from __future__ import annotations

import json
import tempfile
import time
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.command_line import Source, emit, load_module
from benchmarks.cpp_speed import FLAGS, measure
from benchmarks.drawn import draw, held_joints, revolute, smallest_singular

__all__ = ["STATUS", "ArmRecord", "load", "record_arm", "save"]

Array = NDArray[np.float64]
STATUS = ("OK", "UNREACHABLE", "LIMITS", "INVALID")


@dataclass(frozen=True, slots=True)
class ArmRecord:
    """One arm. `facts`: exit code, options, seconds to derive, ms a pose, C++ ns, bytes of the files,
    task, largest closure error, message. `data`: configurations q (N, dof), poses (N, 4, 4), all rows
    one after the other (M, dof) with `count` (N,), `status` (N,) into `STATUS`; `inside` and
    `inside_status` (N,) are count and status with limits; `singular` (M,) flags; `sigma` (M,): the rows'
    smallest singular values; `turning` (dof,)."""

    key: str
    family: str
    facts: dict[str, Any]
    data: dict[str, NDArray[Any]] = field(default_factory=dict)

    @property
    def solved(self) -> bool:
        """Whether there is a module that runs: one of a table without numbers does not."""
        return bool(self.data)


def record_arm(
    source: Source, count: int, old: ArmRecord | None = None, *, compiled: bool = False
) -> ArmRecord:
    """Emit and solve. With an `old` record of the arm: its poses and its options."""
    if old is not None:
        source = replace(source, choices=(tuple(old.facts["options"]),))
    with tempfile.TemporaryDirectory(prefix="ikgen-rows-") as name:
        made = emit(source, Path(name))
        facts: dict[str, Any] = {
            "code": made.code, "options": list(made.options), "derive": made.seconds,
            "sizes": list(made.sizes), "task": made.answer.get("task", ""),
            "message": str(made.answer.get("error", ""))[:200],
        }  # fmt: skip
        if made.module is None:
            return ArmRecord(source.key, source.family, facts)
        try:
            module = load_module(made.module)
            data = _answers(module, *_drawn(module, source.key, count, old))
        except (
            Exception
        ) as error:  # what emitted code raises is a finding, and must not end the run
            facts["message"] = f"{type(error).__name__}: {error}".replace(name, "")[:200]
            return ArmRecord(source.key, source.family, facts)
        facts["solve"], facts["batch"] = _times(module, data["poses"])
        facts["closure"] = _closure(module, data)
        if compiled and made.header is not None:
            facts["cpp"] = measure(made.header.resolve(), FLAGS["native"], limits=False)[1][0]
        return ArmRecord(source.key, source.family, facts, data)


def _drawn(module: ModuleType, key: str, count: int, old: ArmRecord | None) -> tuple[Array, Array]:
    """Configurations and poses: those of an old record, else drawn."""
    if old is not None and old.solved:
        return old.data["q"], old.data["poses"]
    q = draw(module, key, count)
    return q, module.forward(q)


def _closure(module: ModuleType, data: dict[str, NDArray[Any]]) -> float | None:
    """The largest difference of an entry of a pose that a row gives; None where the task is another."""
    if module.TASK != "pose" or not len(data["rows"]):
        return None
    index = np.repeat(np.arange(len(data["poses"])), data["count"])
    return float(np.abs(module.forward(data["rows"]) - data["poses"][index]).max())


def _answers(module: ModuleType, q: Array, poses: Array) -> dict[str, NDArray[Any]]:
    free = held_joints(module)
    rows, count, status, inside, inside_status, singular = [], [], [], [], [], []
    for at, pose in zip(q, poses, strict=True):
        held = at[free] if free else None
        found = module.solve(pose, free=held, limits=False)
        limited = module.solve(pose, free=held)
        rows.append(found.q)
        singular.append(found.singular)
        count.append(len(found))
        status.append(STATUS.index(found.status.name))
        inside.append(len(limited))
        inside_status.append(STATUS.index(limited.status.name))
    together = np.concatenate(rows)
    return {
        "q": q, "poses": poses, "rows": together, "count": np.array(count),
        "status": np.array(status), "inside": np.array(inside),
        "inside_status": np.array(inside_status), "singular": np.concatenate(singular),
        "sigma": smallest_singular(module, together) if len(together) else np.empty(0),
        "turning": revolute(module),
    }  # fmt: skip


def _times(module: ModuleType, poses: Array) -> tuple[float, float]:
    """Milliseconds of processor time a pose of `solve` and of `solve_batch` on the random poses."""
    some = poses[: max(len(poses) // 2, 1)]
    single, batch = [], []
    for _ in range(3):
        started = time.process_time()
        for pose in some:
            module.solve(pose, limits=False)
        single.append(time.process_time() - started)
        started = time.process_time()
        module.solve_batch(some, limits=False)
        batch.append(time.process_time() - started)
    return 1e3 * min(single) / len(some), 1e3 * min(batch) / len(some)


def save(path: Path, records: Iterable[ArmRecord], about: dict[str, Any]) -> None:
    """One `.npz` with a table of facts as JSON and the arrays of every arm."""
    arrays: dict[str, NDArray[Any]] = {}
    table = []
    for n, record in enumerate(records):
        table.append({"key": record.key, "family": record.family, "facts": record.facts})
        arrays |= {f"{n}/{name}": value for name, value in record.data.items()}
    text = json.dumps({"about": about, "arms": table})
    np.savez_compressed(path, table=np.array(text), **arrays)


def load(path: Path) -> dict[str, ArmRecord]:
    """The records of a file by their keys."""
    with np.load(path, allow_pickle=False) as file:
        table = json.loads(str(file["table"]))["arms"]
        arrays: dict[int, dict[str, NDArray[Any]]] = {n: {} for n in range(len(table))}
        for name in file.files:
            place, slash, which = name.partition("/")
            if slash:
                arrays[int(place)][which] = file[name]
    return {row["key"]: ArmRecord(**row, data=arrays[n]) for n, row in enumerate(table)}
