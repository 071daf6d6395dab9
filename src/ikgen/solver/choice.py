"""Which candidate becomes a step: one that holds everywhere, alone or with fallbacks."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ikgen.equations.equation_set import EquationSet
from ikgen.equations.knowledge import Variable
from ikgen.equations.probes import Probes
from ikgen.solver.candidate import Candidate
from ikgen.solver.ranker import WEAK_MARGIN
from ikgen.solver.soundness import conditions, weak_configurations

__all__ = ["Chooser", "Step"]

MOST_TRIED = 6
MOST_FALLBACKS = 40
SAFE_MARGIN = 1e-3
"""Relative size of a divisor from which a candidate counts as well-conditioned at a configuration."""


@dataclass(frozen=True, slots=True)
class Step:
    """One solved unknown: the chosen candidate, fallbacks where its divisor vanishes at regular
    configurations, and the candidates that the ranker rejected. `sound`: no regular configuration was
    found at which all of them fail. `round`: the session's in which it was chosen."""

    candidate: Candidate
    fallbacks: tuple[Candidate, ...]
    rejected: tuple[Candidate, ...]
    sound: bool = True
    round: int = 0

    @property
    def branches(self) -> int:
        """Number of alternatives, over all its forms."""
        return max(c.branches for c in (self.candidate, *self.fallbacks))


class Chooser:
    """Chooses among ranked candidates; remembers where each of them fails."""

    def __init__(self, system: EquationSet, probes: Probes) -> None:
        self._system = system
        self._probes = probes
        self._weak: dict[tuple[Variable, tuple[object, ...]], NDArray[np.float64]] = {}

    def choose(self, ranked: list[Candidate], *, anything: bool) -> Step | None:
        """The best candidate that holds at every regular configuration, alone or with fallbacks where
        its divisor vanishes; failing that, with `anything`, the best there is."""
        step = self._sound(ranked) or self._covered(ranked)
        if step is None and anything and ranked:
            holds = [c for c in ranked if not c.is_weak]
            best = min(holds or ranked, key=_last_resort)
            step = _step(best, (), ranked, sound=self._divides(best))
        return step

    def _divides(self, candidate: Candidate) -> bool:
        """Whether its divisor was not found to vanish at a regular configuration. Branches that meet at
        one are no failure: they lose digits, which Newton steps win back."""
        values = self._probes.values[: self._probes.regular]
        looked_at = np.concatenate([values, self._weak_at(candidate)])
        divisor = conditions(candidate, self._system, looked_at)[0]
        return bool(np.all(np.abs(divisor).max(axis=0) > WEAK_MARGIN)) and not candidate.is_weak

    def _weak_at(self, candidate: Candidate) -> NDArray[np.float64]:
        """Regular configurations where a candidate fails, sought once."""
        form = (candidate.form.name, *(e.id for e in candidate.coefficients))
        key = (candidate.unknown, form)  # where branches meet follows from both
        if key not in self._weak:
            found = weak_configurations(candidate, self._system, self._probes)
            special = self._probes.values[: self._probes.regular]
            holds = self._holds(candidate, special)
            self._weak[key] = np.concatenate([found, special[~holds]])
        return self._weak[key]

    def _holds(self, candidate: Candidate, values: NDArray[np.float64]) -> NDArray[np.bool_]:
        """At which configurations (N, dof) a candidate is well-conditioned."""
        parts = conditions(candidate, self._system, values)
        sizes = [np.abs(p).max(axis=0) for p in parts]
        return np.asarray(np.all([s > SAFE_MARGIN for s in sizes], axis=0))

    def _sound(self, ranked: list[Candidate]) -> Step | None:
        tried = 0
        for c in ranked:
            if c.branches > 2 or not c.is_sound:
                continue
            tried += 1
            found = weak_configurations(c, self._system, self._probes)
            if not len(found):
                return _step(c, (), ranked)
            if tried >= MOST_TRIED:
                break
        return None

    def _covered(self, ranked: list[Candidate]) -> Step | None:
        """A weak candidate and others of the same unknown that hold where it does not."""
        tried: Counter[tuple[Variable, int]] = Counter()
        for best in ranked:
            tried[best.unknown, best.branches] += 1
            if best.branches > 2 or tried[best.unknown, best.branches] > 2:
                continue
            same = [c for c in ranked if c.unknown == best.unknown and c.branches <= best.branches]
            fallbacks = self._fallbacks(best, same[:MOST_FALLBACKS])
            if fallbacks is not None:
                return _step(best, fallbacks, ranked)
        return None

    def _fallbacks(self, best: Candidate, others: list[Candidate]) -> tuple[Candidate, ...] | None:
        """Candidates that cover all regular configurations where `best` fails; None if none do."""
        uncovered = self._weak_at(best)
        out: list[Candidate] = []
        while len(uncovered) and len(out) < 2:
            gains = [(int(self._holds(c, uncovered).sum()), -i) for i, c in enumerate(others)]
            gain, index = max(gains, default=(0, 0))
            if gain == 0:
                return None
            chosen = others[-index]
            out.append(chosen)
            uncovered = uncovered[~self._holds(chosen, uncovered)]
        return None if len(uncovered) else tuple(out)


def _last_resort(candidate: Candidate) -> tuple[bool, bool, bool]:
    """What comes first of candidates none of which holds everywhere. Folds are no reason to take more
    branches; a divisor that nearly vanishes is."""
    judged = candidate.judgement
    poor = judged is not None and judged.margin < SAFE_MARGIN
    return poor, candidate.branches > 2, not candidate.is_sound


def _step(
    best: Candidate,
    fallbacks: tuple[Candidate, ...],
    ranked: list[Candidate],
    *,
    sound: bool = True,
) -> Step:
    rejected = [c for c in ranked if c is not best and c.unknown == best.unknown]
    return Step(best, fallbacks, tuple(rejected[:8]), sound)
