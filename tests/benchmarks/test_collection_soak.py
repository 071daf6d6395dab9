"""The sums over all arms of a class."""

from __future__ import annotations

from benchmarks.collection_soak import by_class
from benchmarks.soak_counts import Soak


def test_counts_are_added_by_class() -> None:
    first = Soak(10, 0, ((5, 0, 0, 2, 1, 0), (1, 1, 1, 0, 0, 0)), ())
    second = Soak(7, 1, ((4, 0, 0, 2, 0, 0), (0, 0, 0, 3, 2, 2)), ("wrong",))
    found = by_class([("b", first), ("a", first), ("b", second)])
    assert found == [
        {"family": "a", "arms": 1, "rows": 10, "wrong": 0, "poses": [6, 1, 1, 2, 1, 0]},
        {"family": "b", "arms": 2, "rows": 17, "wrong": 1, "poses": [10, 1, 1, 7, 3, 2]},
    ]
