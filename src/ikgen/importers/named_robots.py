"""Robots by name: those of packages that hold robot descriptions, as `example-robot-data:panda`.

Known are `example-robot-data`, which holds URDF files, and `robot_descriptions`, whose modules fetch theirs
when they are imported. Nothing but the standard library is imported here.
"""

from __future__ import annotations

import difflib
import importlib
import importlib.util
import os
import sys
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from types import ModuleType

from ikgen.errors import BadDescriptionError, MissingToolError, UnknownNameError
from ikgen.importers.packages import AMENT, sourced
from ikgen.importers.robot_table import RENAMED

__all__ = [
    "SOURCES",
    "NamedRobot",
    "find_robot",
    "is_lost",
    "is_named",
    "name_asked",
    "names_meant",
    "robot_names",
]

DATA, DESCRIPTIONS = "example-robot-data", "robot_descriptions"
SOURCES = {
    DATA: "pip install 'ikgen[robots]'",
    DESCRIPTIONS: "pip install robot_descriptions",
}
"""The packages, each with how to get it."""


_ALIKE = 0.8
"""From which ratio of `difflib` on a package's name is one misspelt."""


@dataclass(frozen=True, slots=True)
class NamedRobot:
    """Where a robot's `file` lies in a package that lies in `folder`, and what reading it takes."""

    file: Path
    package: str
    folder: Path
    arguments: Mapping[str, str] = field(default_factory=dict)
    package_paths: tuple[Path, ...] = ()

    def url_of(self, file: Path) -> str:
        """A name of a file that was read without this machine's paths."""
        place = os.path.relpath(file.resolve(), self.folder.resolve())
        return f"package://{self.package}/{Path(place).as_posix()}"


def is_named(robot: str | os.PathLike[str]) -> bool:
    """Whether a robot is told by a package and a name, not by a path."""
    source, colon, _ = os.fspath(robot).partition(":")
    return bool(colon) and source in SOURCES


def is_lost(robot: Path) -> bool:
    """Whether there is nothing where a path names a robot's file."""
    return not (is_named(robot) or robot.exists())


def find_robot(robot: str | os.PathLike[str]) -> NamedRobot:
    """The robot of `package:name`. Raises `MissingToolError` without the package, `UnknownNameError` for a
    name that it lacks."""
    source, _, name = os.fspath(robot).partition(":")
    return _of_descriptions(name) if source == DESCRIPTIONS else _of_data(name)


def names_meant(robot: str | os.PathLike[str]) -> tuple[str, ...]:
    """What may be meant by a text that is no robot's name and no file's: the package's name spelled as it
    is, or robots of that name in the packages that are installed."""
    source, colon, name = os.fspath(robot).partition(":")
    if colon:
        close = difflib.get_close_matches(source.lower(), SOURCES, 1, _ALIKE)
        return tuple(f"{package}:{name}" for package in close)
    plain, found = source.lower().replace("-", "_"), []
    for package in SOURCES:
        with suppress(MissingToolError):
            names = robot_names(package)
            found += [f"{package}:{one}" for one in names if one in (plain, f"{plain}_description")]
    return tuple(found)


def name_asked(robot: str | os.PathLike[str]) -> str:
    """A question after what may be meant, for a hint; "" where nothing is."""
    meant = " or ".join(names_meant(robot))
    return f"a robot by name? {meant}" if meant else ""


def robot_names(source: str) -> tuple[str, ...]:
    """The robots of a package by name; raises `MissingToolError` without it."""
    if source == DESCRIPTIONS:
        known = _module(DESCRIPTIONS).DESCRIPTIONS
        return tuple(sorted(name for name, one in known.items() if one.has_urdf))
    return tuple(sorted(_files(_robots_folder())))


def _of_data(name: str) -> NamedRobot:
    folder = _robots_folder()
    files = _files(folder)
    if name not in files:
        raise UnknownNameError(f"robot in {DATA}", name, sorted(files))
    return NamedRobot(files[name], DATA, folder)


def _robots_folder() -> Path:
    """The folder of example-robot-data's robots: of this environment, or of a sourced workspace."""
    share = f"share/{DATA}/robots"
    places = [Path(sys.prefix, share)]
    with suppress(PackageNotFoundError):
        places.insert(0, Path(str(distribution(DATA).locate_file(f"cmeel.prefix/{share}"))))
    places += [prefix / share for prefix in sourced(AMENT)]
    for place in places:
        if place.is_dir():
            return place
    raise _missing(DATA)


def _files(folder: Path) -> dict[str, Path]:
    """Name -> URDF file: the loaders' names, else the file's own."""
    renamed = {place: name for name, place in RENAMED.items()}
    found: dict[str, Path] = {}
    plain: dict[str, Path] = {}
    for path in sorted(folder.rglob("*.urdf")):
        name = renamed.get(path.relative_to(folder).as_posix())
        if name is not None:
            found[name] = path
        else:
            plain.setdefault(path.stem.removesuffix("_robot").replace("-", "_").lower(), path)
    return plain | found


def _of_descriptions(name: str) -> NamedRobot:
    names = robot_names(DESCRIPTIONS)
    whole = name if name in names else f"{name}_description"
    if whole not in names:
        raise UnknownNameError(f"robot in {DESCRIPTIONS}", name, names)
    module = _module(f"{DESCRIPTIONS}.{whole}")
    file = getattr(module, "URDF_PATH", None) or getattr(module, "XACRO_PATH", None)
    if not file:
        raise BadDescriptionError(
            f"{DESCRIPTIONS}:{name} has no URDF",
            hint=f"ikgen robots {DESCRIPTIONS} lists those that do",
        )
    arguments = {str(k): str(v) for k, v in getattr(module, "XACRO_ARGS", {}).items()}
    paths = [Path(module.REPOSITORY_PATH), Path(module.PACKAGE_PATH)]
    return NamedRobot(Path(file), DESCRIPTIONS, paths[0], arguments, tuple(paths))


def _module(name: str) -> ModuleType:
    """A module of robot_descriptions, which may fetch a repository."""
    if importlib.util.find_spec(DESCRIPTIONS) is None:
        raise _missing(DESCRIPTIONS)
    try:
        return importlib.import_module(name)
    except Exception as error:  # git's, of a network that is not there
        text = " ".join(str(error).split())
        raise MissingToolError(
            f"{name} cannot be fetched: {type(error).__name__}: {text[:200]}",
            hint="it clones a repository at first use: try again with a network",
        ) from error


def _missing(source: str) -> MissingToolError:
    return MissingToolError(f"{source} is not installed", hint=SOURCES[source])
