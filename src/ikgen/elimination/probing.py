"""What probing tells of eliminations: which solutions each finds, and how well."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ikgen.elimination.routine import FirstRun, Turning
from ikgen.model.arrays import Array

__all__ = ["Probe", "digits_lost", "distinct_of_runs", "joined", "probe_of"]

_SAME = 1e-5
_FINE = -8.0  # logarithm of errors below which they no longer count


@dataclass(frozen=True, slots=True)
class Probe:
    """hits (n_e, n) bool: which elimination finds which solution. rough (n_e,): how many digits more than
    need be its candidates' errors have, on average. enough (n_e,): see `FirstRun.often_enough`. shifts
    (n_r,) in rad: how far rounding moves the roots of the resultants, where there are any."""

    hits: Array
    rough: Array
    enough: Array
    shifts: Array


def joined(parts: Sequence[Probe]) -> Probe:
    """All solutions, the worst of the rest, and how often one is enough on average."""
    hits = np.concatenate([part.hits for part in parts], axis=1)
    rough, shifts = (
        np.max([getattr(p, name) for p in parts], axis=0) for name in ("rough", "shifts")
    )
    return Probe(hits, rough, np.mean([p.enough for p in parts], axis=0), shifts)


def probe_of(runs: Sequence[FirstRun], hits: Array, shifts: Array) -> Probe:
    """What first runs of eliminations with these `hits` tell, and the resultants' `shifts`."""
    rough = np.array([digits_lost(run.before) for run in runs])
    return Probe(hits, rough, np.array([run.often_enough for run in runs]), shifts)


def digits_lost(errors: Array) -> float:
    """How many digits more than need be the errors (n,) have, on average; all where there are none."""
    return (
        float(np.maximum(np.log10(errors + 1e-16) - _FINE, 0.0).mean()) if len(errors) else -_FINE
    )


def distinct_of_runs(runs: list[Array], turning: Turning) -> Array:
    """Which of the runs' rows (k, 6) has which of all distinct rows: (len(runs), n) bool. Joint values are
    compared modulo turns."""
    union = np.concatenate(runs)
    gap = union[:, None] - union
    apart = np.abs(np.where(turning, np.remainder(gap + np.pi, 2.0 * np.pi) - np.pi, gap))
    same = apart.max(axis=2, initial=0.0) < _SAME
    fresh = ~np.tril(same, -1).any(axis=1)
    ends = np.cumsum([len(rows) for rows in runs])[:-1]
    return np.array([part.any(axis=1) for part in np.split(same[fresh], ends, axis=1)])
