"""Which angle combinations follow from solved ones, each found when it is asked for.

A combination follows where it is a sum of solved ones of its group with factors from -2 to 2, or beyond
where mimic joints turn faster. Their number grows as 5^n with the solved ones, so they are not listed: the
factors of one are those of the linear system in an independent part of the solved ones, for each choice of
factors of the few others.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from ikgen.algebra.polynomial import AngleCombination

__all__ = ["LARGEST", "KnownCombinations", "Terms"]

Terms: TypeAlias = tuple[tuple[int, AngleCombination], ...]

_FACTORS = (0, 1, -1, 2, -2)
LARGEST = 2
"""The largest factor of arms whose mimic joints turn no faster than what they follow."""


class KnownCombinations:
    """The combinations that follow from `solved`, in `groups` that no combination reaches beyond; as a
    mapping to (factor, solved combination) pairs, the fewest and smallest factors first. Factors of an
    independent part of them are at most `largest`."""

    def __init__(
        self,
        solved: Iterable[AngleCombination],
        groups: tuple[int, ...],
        largest: int = LARGEST,
    ) -> None:
        self._groups = groups
        members: dict[int, list[AngleCombination]] = {}
        for combination in solved:
            members.setdefault(self._group_of(combination), []).append(combination)
        self._places = {group: place for place, group in enumerate(members)}
        self._spans = {group: _Span(found, largest) for group, found in members.items()}
        self._found: dict[AngleCombination, Terms | None] = {}

    def _group_of(self, combination: AngleCombination) -> int:
        return next((g for g, k in zip(self._groups, combination, strict=True) if k), -1)

    def get(self, combination: AngleCombination) -> Terms | None:
        """The pairs; None if the combination does not follow."""
        if combination not in self._found:
            self._found[combination] = self._terms(combination)
        return self._found[combination]

    def __contains__(self, combination: AngleCombination) -> bool:
        return self.get(combination) is not None

    def __getitem__(self, combination: AngleCombination) -> Terms:
        terms = self.get(combination)
        if terms is None:
            raise KeyError(combination)
        return terms

    def _terms(self, combination: AngleCombination) -> Terms | None:
        if not any(combination):
            return ()
        span = self._spans.get(self._group_of(combination))
        factors = span.factors(combination) if span else None
        if span is None or factors is None:
            return None
        return tuple((f, k) for f, k in zip(factors, span.members, strict=True) if f)

    def order(self, combination: AngleCombination) -> tuple[object, ...]:
        """What known combinations sort by: group by group as they were solved, small factors first."""
        group = self._group_of(combination)
        factors = self._spans[group].factors(combination)
        assert factors is not None
        return self._places[group], *_size(factors)


class _Span:
    """The solved combinations of one group."""

    def __init__(self, members: list[AngleCombination], largest: int) -> None:
        self.members = members
        self._largest = largest
        self._independent: list[int] = []
        for i in range(len(members)):
            if np.linalg.matrix_rank(self._rows([*self._independent, i])) > len(self._independent):
                self._independent.append(i)
        self._others = [i for i in range(len(members)) if i not in self._independent]
        self._basis = self._rows(self._independent)
        self._inverse = np.linalg.pinv(self._basis)

    def _rows(self, indices: list[int]) -> NDArray[np.float64]:
        return np.array([self.members[i] for i in indices], dtype=float)

    def factors(self, combination: AngleCombination) -> tuple[int, ...] | None:
        """The smallest factors that give the combination; None if none do."""
        return min(self._all_factors(np.array(combination, dtype=float)), key=_size, default=None)

    def _all_factors(self, wanted: NDArray[np.float64]) -> Iterator[tuple[int, ...]]:
        for chosen in itertools.product(_FACTORS, repeat=len(self._others)):
            rest = wanted
            for factor, i in zip(chosen, self._others, strict=True):
                rest = rest - factor * np.array(self.members[i], dtype=float)
            solution = np.rint(rest @ self._inverse)
            if (abs(solution) > self._largest).any() or (solution @ self._basis != rest).any():
                continue
            factors = dict(zip(self._others, chosen, strict=True))
            factors.update(zip(self._independent, map(int, solution), strict=True))
            yield tuple(factors[i] for i in range(len(self.members)))


def _size(factors: tuple[int, ...]) -> tuple[int, tuple[int, ...]]:
    return sum(map(abs, factors)), factors
