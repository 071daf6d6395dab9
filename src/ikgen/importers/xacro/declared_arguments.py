"""The arguments that a xacro file takes, read from its text: known also where expanding it fails."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ikgen.errors import BadDescriptionError, IkgenError
from ikgen.importers.packages import PACKAGE_URL, PackageFinder, PackageNotFoundError
from ikgen.importers.xacro.package_fence import PackageFence
from ikgen.importers.xacro.refusals import RefusedFileError
from ikgen.importers.xml_document import local_name, parse_xml, read_text

__all__ = ["DeclaredArgument", "declared_arguments", "with_arguments"]

_USE = re.compile(r"\$\(arg\s+([^)\s$]+)\s*\)")
_FIND = re.compile(r"\$\(find\s+([^)\s]+)\s*\)")
_MOST_FILES = 50
_MOST_SHOWN = 12


@dataclass(frozen=True, slots=True)
class DeclaredArgument:
    """One `<xacro:arg>`: its name and the text of its default, None where a value must be given."""

    name: str
    default: str | None


def declared_arguments(
    path: Path, package_paths: Sequence[Path] = ()
) -> tuple[DeclaredArgument, ...]:
    """The arguments of a xacro file and of what it includes by plain names, in the files' order.

    Nothing is evaluated: includes whose names hang on arguments are passed over, and so is what
    cannot be read.
    """
    top = path.resolve()
    return _declared(top, PackageFinder(top, tuple(package_paths)))


def with_arguments(
    error: BadDescriptionError, path: Path, finder: PackageFinder
) -> BadDescriptionError:
    """An error of an expansion, its hint with the arguments that the file takes."""
    taken = _declared(path.resolve(), finder)
    if not taken:
        return error
    words = [
        one.name if one.default is None else f"{one.name} ({one.default or 'empty'})"
        for one in taken[:_MOST_SHOWN]
    ]
    more = [f"and {len(taken) - _MOST_SHOWN} more"] if len(taken) > _MOST_SHOWN else []
    hint = f"{error.hint}; the file takes the arguments: {', '.join([*words, *more])}"
    return BadDescriptionError(error.problem, file=error.file, line=error.line, hint=hint)


def _declared(top: Path, finder: PackageFinder) -> tuple[DeclaredArgument, ...]:
    found: dict[str, str | None] = {}
    for name, default in _arguments(top, finder, PackageFence(top, finder), set()):
        if found.get(name) is None:
            found[name] = default
    return tuple(DeclaredArgument(name, default) for name, default in found.items())


def _arguments(
    file: Path, finder: PackageFinder, fence: PackageFence, seen: set[Path]
) -> Iterator[tuple[str, str | None]]:
    if file in seen or len(seen) >= _MOST_FILES:
        return
    seen.add(file)
    try:
        root = parse_xml(read_text(fence.require(file)), str(file))
    except (OSError, IkgenError, RefusedFileError):
        return
    for element in root.iter():
        tag = local_name(element)
        if tag == "arg" and element.get("name"):
            yield element.get("name"), element.get("default")
        elif tag == "include":
            included = _plain_file(element.get("filename") or "", file, finder)
            if included is not None:
                yield from _arguments(included, finder, fence, seen)
        for value in (element.text or "", *element.attrib.values()):
            yield from ((name, None) for name in _USE.findall(value))


def _plain_file(spec: str, file: Path, finder: PackageFinder) -> Path | None:
    """The file that an include names, where it does so without arguments or expressions."""
    try:
        spec = _FIND.sub(lambda match: str(finder.find(match[1])), spec)
        if spec.startswith(PACKAGE_URL):
            spec = str(finder.resolve(spec))
    except PackageNotFoundError:
        return None
    return None if "$" in spec or not spec else (file.parent / spec)
