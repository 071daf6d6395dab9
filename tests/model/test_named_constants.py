"""Constants by name, and the numbers of these names."""

from __future__ import annotations

from dataclasses import replace

from tests.support.tables import table

from ikgen.model.dh import Length


def test_signs_are_those_of_the_places_not_of_the_names() -> None:
    dh = table(("R", 0, 0.0, 0.3), ("P", 1, 0.2, 0.0), ("R", 1, 0.0, 0.0))
    first, second, third = dh.rows
    second = replace(second, offset=Length(-0.05, "d_offset_2", -1))
    third = replace(third, a=Length(-0.4, "a_2", -1), d=Length(-0.3, "d_0", -1))
    dh = replace(dh, rows=(first, second, third))
    table_s = {"d_0": 0.3, "a_1": 0.2, "a_2": 0.4}
    assert dh.named_constants(offsets=False) == table_s
    assert dh.named_constants() == table_s | {"d_offset_2": 0.05}
    assert list(dh.named_constants()) == ["d_0", "a_1", "d_offset_2", "a_2"]
