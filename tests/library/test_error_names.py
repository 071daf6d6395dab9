"""The errors that the package offers by name."""

from __future__ import annotations

import ikgen
from ikgen import errors


def test_every_error_is_a_name_of_the_package() -> None:
    named = {name for name in errors.__all__ if name.endswith("Error")}
    assert named <= set(ikgen.__all__)
    assert all(getattr(ikgen, name) is getattr(errors, name) for name in named)
