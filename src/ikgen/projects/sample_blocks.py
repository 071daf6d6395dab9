"""Many samples of a verification in blocks, each by whatever worker is free."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from ikgen.derivation.progress import silent
from ikgen.derivation.read import read
from ikgen.processes.executors import Workers, run_pieces
from ikgen.projects.output_checks import Checked, OutputChecks
from ikgen.records.record import read_record
from ikgen.records.request import Outputs

__all__ = ["BLOCK", "SampleBlock", "blocks_checked"]

BLOCK = 50_000
"""Samples that one process draws at a time: what they take of memory stays below a gigabyte or so."""


@dataclass(frozen=True, slots=True)
class SampleBlock:
    """So many `samples` from a `seed` for the outputs of a record, against its description or another
    `robot`."""

    record: Path
    robot: Path | None
    trust: bool
    fix: str
    samples: int
    seed: int


def _checked(block: SampleBlock) -> Checked:
    """What a worker does: everything is read again, so that nothing but names travels."""
    record = read_record(block.record)
    reading = read(replace(record.again(block.robot), trust=block.trust))
    outputs = Outputs(samples=block.samples, seed=block.seed)
    return OutputChecks(record, reading, block.fix, outputs, silent).run()


def blocks_checked(
    first: Checked,
    block: SampleBlock,
    workers: Workers,
    done: Callable[[int, int], None],
) -> Checked:
    """`first`, what came of the first `BLOCK` samples, and of the rest of those that `block` asks for in
    all; the same whoever computes them. Where the first found something the rest is left."""
    from ikgen.verify.merged_reports import merged_reports

    if first.findings or block.samples <= BLOCK:
        return first
    starts = range(BLOCK, block.samples, BLOCK)
    pieces = [
        replace(block, samples=min(BLOCK, block.samples - start), seed=_seed(block.seed, i))
        for i, start in enumerate(starts, start=1)
    ]
    parts = [first, *run_pieces(workers, _checked, pieces, done)]
    merged = {
        name: merged_reports([part.reports[name] for part in parts if name in part.reports])
        for name in first.reports
    }
    return Checked(tuple(dict.fromkeys(f for part in parts for f in part.findings)), merged)


def _seed(seed: int, block: int) -> int:
    """The seed of a block, far from the seeds that people give."""
    import numpy as np

    return int(np.random.SeedSequence([seed, block]).generate_state(1)[0])
