"""The errors to show for what an expansion was refused for."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from ikgen.errors import BadDescriptionError
from ikgen.importers.urdf.attribute_values import shortened
from ikgen.importers.xacro.error_places import place_of
from ikgen.importers.xacro.refusals import (
    ExpansionLimitError,
    RefusedExpressionError,
    RefusedFileError,
)

__all__ = ["refused"]

_TRUST = "for a file of your own that needs it: --trust"


def refused(cause: BaseException, files: Sequence[Path], name: str) -> BadDescriptionError | None:
    """The error for a refusal, None for any other exception. `files` are those that were read, the
    one at fault first, which messages call `name`."""
    if isinstance(cause, BadDescriptionError):
        return cause
    if isinstance(cause, RefusedExpressionError):
        place, line = place_of(re.escape(cause.expression.strip()), files, name)
        return BadDescriptionError(
            f"the expression '{shortened(cause.expression)}' {cause}",
            file=place,
            line=line,
            hint="expressions may compute with numbers, texts, lists and dictionaries; " + _TRUST,
        )
    if isinstance(cause, RefusedFileError):
        read = [file for file in files if file != cause.path]
        place, line = place_of(re.escape(cause.path.name), read, name)
        return BadDescriptionError(
            str(cause),
            file=place,
            line=line,
            hint="give --package-path DIR for the package that holds it; " + _TRUST,
        )
    if isinstance(cause, ExpansionLimitError):
        hint = "look for macros or texts that multiply; " + _TRUST
        return BadDescriptionError(f"the file {cause}", file=name, hint=hint)
    return None
