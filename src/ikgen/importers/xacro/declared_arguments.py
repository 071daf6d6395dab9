"""The arguments that a xacro file takes, read from its text: known also where expanding it fails."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from ikgen.errors import IkgenError
from ikgen.importers.packages import PACKAGE_URL, PackageFinder, PackageNotFoundError
from ikgen.importers.xacro.package_fence import PackageFence
from ikgen.importers.xacro.refusals import RefusedFileError
from ikgen.importers.xml_document import local_name, parse_xml, read_text

__all__ = ["declared_arguments"]

_USE = re.compile(r"\$\(arg\s+([^)\s$]+)\s*\)")
_FIND = re.compile(r"\$\(find\s+([^)\s]+)\s*\)")
_MOST_FILES = 50


def declared_arguments(path: Path, package_paths: Sequence[Path] = ()) -> dict[str, str | None]:
    """Argument -> the text of its default (None: it has none), of a xacro file and of what it includes
    by plain names, in the files' order.

    Nothing is evaluated: includes whose names hang on arguments are passed over, and so is what cannot
    be read.
    """
    top = path.resolve()
    finder = PackageFinder(top, tuple(package_paths))
    found: dict[str, str | None] = {}
    for name, default in _arguments(top, finder, PackageFence(top, finder), set()):
        if found.get(name) is None:
            found[name] = default
    return found


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
