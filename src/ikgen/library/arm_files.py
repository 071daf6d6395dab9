"""Files of an arm in memory: its outputs, and the page of its derivation."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen.errors import ArgumentError, MissingToolError
from ikgen.library.load_arguments import wrong
from ikgen.outputs.publish import Content, check_folder, publish

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation
    from ikgen.records.request import Outputs, Request
    from ikgen.verify.verification_report import VerificationReport

__all__ = ["save", "write_page"]

_PAGES = {
    ".html": "_report.html",
    ".tex": "_report.tex",
    ".pdf": "_report.tex",
    ".svg": "_graph.svg",
}
"""Suffix of a page -> end of the name of the text that it is made from."""


def save(
    request: Request, outputs: Outputs, folder: Path, emit: str | Iterable[str]
) -> tuple[Path, ...]:
    """Write outputs (and their records) as the command line does."""
    from ikgen.generation.emitters import find_emitter
    from ikgen.generation.generate import generate

    names = (emit,) if isinstance(emit, str) else emit
    asked = tuple(names) if isinstance(names, Iterable) else ()
    if not asked or not all(isinstance(name, str) for name in asked):
        raise wrong("emit", emit, "names of outputs: python, cpp")
    for name in asked:
        find_emitter(name)
    with _writing("folder", folder):
        return generate(request, replace(outputs, emit=asked, out=folder)).files


def write_page(
    derived: Callable[[], Derivation], verification: VerificationReport | None, file: Path
) -> Path:
    """Write the derivation report, in the format of the file's suffix. `derived` makes the derivation,
    which may take its time: it is called where the suffix and the folder will do."""
    from ikgen.report import emit_report

    end = _PAGES.get(file.suffix.lower())
    if end is None:
        known = ", ".join(_PAGES)
        raise ArgumentError(
            f"file: '{file}' has none of the suffixes of a report",
            hint=f"name it with one of {known}",
        )
    check_folder(file.parent)
    reports = {} if verification is None else {"python": verification}
    texts = emit_report(derived(), reports)
    found = next((text for name, text in texts.items() if name.endswith(end)), None)
    if found is None:
        what = f"file: '{file}' would be a graph of unknowns, and none of this arm is solved alone"
        raise ArgumentError(what, hint="name a page: .html, .tex or .pdf")
    content: Content = found
    if file.suffix.lower() == ".pdf":
        content = _pdf(file.with_suffix(".tex").name, str(content))
    with _writing("file", file):
        return publish(file.parent, {file.name: content})[0]


@contextmanager
def _writing(argument: str, path: Path) -> Iterator[None]:
    """What the system refuses to write is an argument that does not do."""
    try:
        yield
    except OSError as error:
        raise ArgumentError(
            f"{argument}: '{path}' cannot be written: {error.strerror or error}",
            hint="name another place",
        ) from error


def _pdf(name: str, text: str) -> bytes:
    from ikgen.report.pdf import typeset

    result = typeset(name, text)
    if result.pdf is None:
        raise MissingToolError(
            f"no PDF: {result.failure or 'LaTeX is not installed'}",
            hint="apt-get install texlive-latex-base; or write .tex or .html",
        )
    return result.pdf
