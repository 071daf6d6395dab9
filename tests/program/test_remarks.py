"""Comments go along with the statements that stand under them."""

from __future__ import annotations

from ikgen.program.remarks import remarked, with_remarks
from ikgen.program.statements import Comment, Let, Statement


def shown(body: list[Statement]) -> list[Statement]:
    return list(with_remarks(remarked(body)))


def test_comments_of_nothing_are_left_out() -> None:
    one, two, let = Comment("one"), Comment("two"), Let("x", 1.0)
    assert shown([one, two, let, one]) == [two, let]
    assert shown([one, let, two, let]) == [one, let, two, let]
    assert shown([one]) == [] == shown([])


def test_a_comment_stands_above_the_first_of_its_statements() -> None:
    x, y = Let("x", 1.0), Let("y", 2.0)
    assert list(remarked([x, Comment("one"), y, x])) == [("", x), ("one", y), ("one", x)]
    assert shown([x, Comment("one"), y, x]) == [x, Comment("one"), y, x]


def test_what_stands_under_none_needs_none() -> None:
    x, y = Let("x", 1.0), Let("y", 2.0)
    assert with_remarks([("one", x), ("", y)]) == (Comment("one"), x, y)
