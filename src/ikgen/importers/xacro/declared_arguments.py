"""The arguments that a xacro file takes, by its text: for messages where it cannot be expanded."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from ikgen.importers.packages import PackageFinder, PackageNotFoundError

__all__ = ["declared_arguments"]

_COMMENT = re.compile(r"<!--.*?-->", re.S)
_ELEMENT = re.compile(r"<xacro:(arg|include)\b([^>]*?)/?>", re.S)
_ATTRIBUTE = re.compile(r"""([\w:]+)\s*=\s*("[^"]*"|'[^']*')""")
_USE = re.compile(r"\$\(arg\s+([^)\s]+)\s*\)")
_FIND = re.compile(r"\$\(find\s+([^)\s]+)\s*\)")


def declared_arguments(path: Path, package_paths: Sequence[Path] = ()) -> dict[str, str | None]:
    """Argument -> its default (None: it has none), declared or used in a file and in those that it includes
    by a name without expressions; empty where nothing can be read."""
    finder = PackageFinder(path.resolve(), tuple(package_paths))
    named = list(_arguments(path, finder, set()))
    found: dict[str, str | None] = {}
    for name, default in named:
        found[name] = default if found.get(name) is None else found[name]
    return found


def _arguments(
    path: Path, finder: PackageFinder, seen: set[Path]
) -> Iterator[tuple[str, str | None]]:
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return
    seen.add(path)
    text = _COMMENT.sub("", text)
    for element, attributes in _ELEMENT.findall(text):
        given = {name: value[1:-1] for name, value in _ATTRIBUTE.findall(attributes)}
        if element == "arg" and "name" in given:
            yield given["name"], given.get("default")
        elif element == "include":
            included = _included(given.get("filename", "$"), path, finder)
            if included is not None and included not in seen:
                yield from _arguments(included, finder, seen)
    yield from ((name, None) for name in _USE.findall(text))


def _included(name: str, path: Path, finder: PackageFinder) -> Path | None:
    """The file that an include names; None where its name holds other expressions."""
    try:
        name = _FIND.sub(lambda found: str(finder.find(found.group(1))), name)
    except PackageNotFoundError:
        return None
    return None if "$" in name else path.parent / name
