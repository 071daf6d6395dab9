"""What messages say of options of the command line, in the words of the library: as arguments of `load`, so
that who calls `ikgen.load` reads `tip="LINK"`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from types import MappingProxyType

from ikgen.errors import BadDescriptionError, IkgenError
from ikgen.records.option_words import Notation, quoted

__all__ = ["ARGUMENTS", "argument_words", "in_argument_words"]


class _Arguments(Notation):
    """Arguments of `ikgen.load`."""

    flags = MappingProxyType({"--trust": "trust=True", "--no-verify": "verify=False"})

    def generating(self, robot: str, words: Sequence[str]) -> str:
        """A call."""
        return f"ikgen.load({', '.join([quoted(robot), *words])})"

    def alone(self, name: str, *, heading: bool) -> str:
        """The name, with its sign but where it begins a sentence."""
        return name if heading else f"{name}="

    def assigned(self, name: str, value: str) -> str:
        """A keyword argument."""
        return f"{name}={value}"

    def names(self, names: Sequence[str]) -> str:
        """One name, or a list of several."""
        return quoted(names[0]) if len(names) == 1 else super().names(names)

    def table(self, values: Mapping[str, str | None]) -> str:
        """A dict."""
        return f"{{{', '.join(f'{quoted(name)}: {_number(x)}' for name, x in values.items())}}}"


ARGUMENTS = _Arguments()

argument_words = ARGUMENTS.words


@contextmanager
def in_argument_words() -> Iterator[None]:
    """Errors that pass speak of arguments."""
    try:
        yield
    except IkgenError as error:
        error.message, error.hint = argument_words(error.message), argument_words(error.hint)
        error.warnings = tuple(map(argument_words, error.warnings))
        error.args = (error.message,)
        if isinstance(error, BadDescriptionError):
            error.problem = argument_words(error.problem)
        raise


def _number(text: str | None) -> str:
    """A value as Python writes it: a number, the word VALUE that stands for one, or else a text."""
    if not text:
        return "None"
    if text == "VALUE":
        return text
    try:
        float(text)
    except ValueError:
        return quoted(text)
    return text
