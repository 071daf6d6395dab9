"""Where a ROS package lies, found without ROS: `$(find pkg)` and `package://pkg`.

Looked for in this order: the package that holds the file, the directories that the user gave, the
directories above the file and the siblings of its package, the ament index of a sourced workspace,
the folders of a sourced ROS 1 workspace.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

__all__ = [
    "AMENT", "PACKAGE_URL", "PackageFinder", "PackageNotFoundError", "holds_home", "manifest_name",
    "sourced",
]  # fmt: skip

PACKAGE_URL = "package://"
AMENT, ROS_1 = "AMENT_PREFIX_PATH", "ROS_PACKAGE_PATH"
"""What a sourced workspace sets: the prefixes of ROS 2, the folders of packages of ROS 1."""

# workspace / src / repository / group / package
_SEARCH_DEPTH = 4
_MANIFEST = "package.xml"
_NAME = re.compile(r"\w[\w.+-]*")
_LARGEST_MANIFEST = 2**20


class PackageNotFoundError(LookupError):
    """A package that no search path holds; says where it was looked for."""

    def __init__(self, name: str, searched: Sequence[str]) -> None:
        super().__init__(f"package '{name}' not found")
        self.name = name
        self.searched = tuple(searched)


@dataclass(frozen=True, slots=True)
class PackageFinder:
    """Finds packages for the file `start`; `found` remembers the answers."""

    start: Path
    package_paths: tuple[Path, ...] = ()
    environment: Mapping[str, str] = field(default_factory=lambda: os.environ)
    found: dict[str, Path] = field(default_factory=dict)

    def find(self, name: str) -> Path:
        """The absolute directory of a package (that of its package.xml, or its share directory)."""
        if name not in self.found:
            self.found[name] = self._search(name)
        return self.found[name]

    def resolve(self, url: str) -> Path:
        """The file that `package://pkg/path` names, there or not."""
        package, _, rest = url.removeprefix(PACKAGE_URL).partition("/")
        return self.find(package) / rest

    def url(self, file: Path) -> str | None:
        """`package://pkg/path` of a file in a package found so far that does not hold `start`."""
        start = self.start.resolve()
        for name, directory in sorted(self.found.items()):
            if file.is_relative_to(directory) and not start.is_relative_to(directory):
                return f"{PACKAGE_URL}{name}/{file.relative_to(directory).as_posix()}"
        return None

    def _search(self, name: str) -> Path:
        # A name, not a path: it becomes part of one.
        for directory in self._candidates(name) if _NAME.fullmatch(name) else ():
            return directory.resolve()
        searched = [str(path) for path in self.package_paths]
        searched.append(f"the directories above {self.start} and beside its package")
        searched += [AMENT, ROS_1]
        raise PackageNotFoundError(name, searched)

    def _candidates(self, name: str) -> Iterator[Path]:
        above = list(self.start.resolve().parents)
        home = next((path for path in above if (path / _MANIFEST).is_file()), None)
        if home is not None and _is_package(home, name):
            yield home
        for path in self.package_paths:
            yield from _inside(path, name, _SEARCH_DEPTH)
        beside = _subdirectories(home.parent) if home is not None else []
        nearby = [*above[:_SEARCH_DEPTH], *beside]
        yield from (directory for directory in nearby if _is_package(directory, name))
        yield from (directory for directory in above if manifest_name(directory) == name)
        for prefix in sourced(AMENT, self.environment):
            if (prefix / "share/ament_index/resource_index/packages" / name).is_file():
                yield prefix / "share" / name
        for folder in sourced(ROS_1, self.environment):
            yield from _inside(folder, name, _SEARCH_DEPTH)


def sourced(variable: str, environment: Mapping[str, str] = os.environ) -> list[Path]:
    """The folders that a sourced workspace names."""
    return [Path(one) for one in environment.get(variable, "").split(os.pathsep) if one]


def _inside(directory: Path, name: str, depth: int) -> Iterator[Path]:
    """The package in a directory, which is the package itself or holds it some levels down."""
    if _is_package(directory, name):
        yield directory
    if depth == 0 or (directory / _MANIFEST).is_file():
        return  # packages do not nest
    for child in _subdirectories(directory):
        yield from _inside(child, name, depth - 1)


def _is_package(directory: Path, name: str) -> bool:
    if (directory / _MANIFEST).is_file():
        return manifest_name(directory) == name
    # Copies of a package's urdf/ folder often lack the manifest but keep the directory's name.
    return directory.name == name and directory.is_dir() and not holds_home(directory)


def holds_home(directory: Path) -> bool:
    """Whether the user's home is or lies in a directory: then it is no package, whatever its name."""
    try:
        return Path.home().is_relative_to(directory)
    except RuntimeError:  # nobody has a home here
        return directory == directory.parent


def manifest_name(directory: Path) -> str | None:
    """The name in a directory's package.xml; None where there is none that can be read."""
    # not lxml: `ikgen build --check` finds packages too and has to start in no time
    from xml.etree import ElementTree

    manifest = directory / _MANIFEST
    try:
        if not manifest.is_file() or manifest.stat().st_size > _LARGEST_MANIFEST:
            return None
        name = ElementTree.fromstring(manifest.read_bytes()).findtext("name")
    except (OSError, ElementTree.ParseError):
        return None
    return None if name is None else name.strip()


def _subdirectories(directory: Path) -> list[Path]:
    try:
        entries = sorted(directory.iterdir())  # sorted: the same package on every machine
    except OSError:
        return []
    return [entry for entry in entries if not entry.name.startswith(".") and entry.is_dir()]
