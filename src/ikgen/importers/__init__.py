"""Readers of robot descriptions: one row of the registry a format, imported only when it reads.

The only packages that know file formats. `load_tree` picks the importer by the file's suffix; a
chain is then chosen out of the tree by `ikgen.chains.selection`. Other packages add formats through
the entry-point group `ikgen.importers`, each entry an `Importer`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Protocol, cast

from ikgen.errors import BadDescriptionError, IkgenError, PlugInError, UsageError
from ikgen.importers.named_robots import find_robot, is_named, name_asked
from ikgen.plugins import PlugIn, blaming, named_object, plug_ins

if TYPE_CHECKING:
    from ikgen.model.joint_tree import JointTree

__all__ = [
    "IMPORTERS",
    "Importer",
    "argument_hint",
    "importer_of",
    "load_tree",
    "taken_arguments",
]

_NOTHING: Mapping[str, str] = MappingProxyType({})


class _Reader(Protocol):
    """What an importer's module offers."""

    def read(
        self, path: Path, *, arguments: Mapping[str, str], package_paths: Sequence[Path]
    ) -> JointTree: ...


class _CarefulReader(Protocol):
    """What the module of an importer offers whose files can compute, and are held back from it."""

    def read(
        self,
        path: Path,
        *,
        arguments: Mapping[str, str],
        package_paths: Sequence[Path],
        trust: bool,
    ) -> JointTree: ...


@dataclass(frozen=True, slots=True)
class Importer:
    """One format by name: the lower-case suffixes of its files and the module with its `read`.
    `plug_in` is set for a format of another package, which its failures then name. `computes` says
    that files of the format compute: its `read` takes `trust`. `self_contained`: no file takes in others.
    `arguments_target` "module:function" takes a file and the package paths and gives the arguments that
    the file takes, each with the text of its default (None: it has none)."""

    kind: str
    suffixes: tuple[str, ...]
    module: str
    plug_in: PlugIn | None = None
    computes: bool = False
    self_contained: bool = False
    arguments_target: str | None = None

    def accepts(self, path: Path) -> bool:
        """Whether the file's name ends in one of the suffixes."""
        return path.name.lower().endswith(self.suffixes)

    def taken_arguments(self, path: Path, package_paths: Sequence[Path]) -> dict[str, str | None]:
        """The arguments that a file takes, with their defaults."""
        if self.arguments_target is None:
            return {}
        with blaming(self.plug_in):
            found: dict[str, str | None] = named_object(self.arguments_target)(path, package_paths)
        return found

    def read(
        self,
        path: Path,
        *,
        arguments: Mapping[str, str],
        package_paths: Sequence[Path],
        trust: bool = False,
    ) -> JointTree:
        """What the module's `read` gives; see `load_tree`."""
        with blaming(self.plug_in):
            module = import_module(self.module)
            if self.computes:
                careful = cast(_CarefulReader, module)
                return careful.read(
                    path, arguments=arguments, package_paths=package_paths, trust=trust
                )
            reader = cast(_Reader, module)
            return reader.read(path, arguments=arguments, package_paths=package_paths)


IMPORTERS: tuple[Importer, ...] = (
    Importer(
        "xacro",
        (".xacro",),
        "ikgen.importers.xacro.expansion",
        computes=True,
        arguments_target="ikgen.importers.xacro.declared_arguments:declared_arguments",
    ),
    Importer("urdf", (".urdf", ".xml"), "ikgen.importers.urdf.urdf_tree", self_contained=True),
)


def importer_of(path: Path) -> Importer:
    """The importer for a file, by its suffix; raises `UsageError` where no format has it.

    Formats of other packages are looked at only for suffixes that ikgen does not read itself; one that
    cannot be loaded is passed over, and named where no other reads the file.
    """
    for importer in IMPORTERS:
        if importer.accepts(path):
            return importer
    others: list[Importer] = []
    broken: PlugInError | None = None
    for plug_in in plug_ins("ikgen.importers"):
        try:
            others.append(replace(plug_in.load(Importer), plug_in=plug_in))
        except PlugInError as error:
            broken = broken or error
            continue
        if others[-1].accepts(path):
            return others[-1]
    if path.is_dir():
        raise UsageError(
            f"{path} is a folder", hint=f"name the robot's file in it: {path}/ROBOT.urdf"
        )
    if not path.exists():
        raise BadDescriptionError(
            "no such file",
            file=str(path),
            hint=name_asked(path) or "check the path; ikgen robots lists names",
        )
    known = ", ".join(suffix for row in (*IMPORTERS, *others) for suffix in row.suffixes)
    raise UsageError(
        f"{path}: cannot tell the format of a robot description by the suffix '{path.suffix}'",
        hint=f"what is read has one of {known}; convert others, as SDF, to URDF"
        + (f"; {broken.message}" if broken else ""),
    )


def load_tree(
    path: str | Path,
    *,
    arguments: Mapping[str, str] = _NOTHING,
    package_paths: Sequence[Path] = (),
    trust: bool = False,
) -> JointTree:
    """Read a robot description, a file or a robot by name, into a `JointTree`.

    `arguments` are xacro's NAME:=VALUE; `package_paths` are directories that are or contain the
    packages which `$(find pkg)` and `package://pkg` name. `trust` lets a xacro file run any code and
    read any file, without bounds: only for files of one's own. Raises `BadDescriptionError` with file
    and line for anything in the file that cannot be read, `UsageError` for an unknown suffix.
    """
    if not is_named(path):
        file = Path(path)
        return importer_of(file).read(
            file, arguments=arguments, package_paths=package_paths, trust=trust
        )
    robot = find_robot(path)
    tree = importer_of(robot.file).read(
        robot.file,
        arguments={**robot.arguments, **arguments},
        package_paths=(*package_paths, *robot.package_paths),
        trust=trust,
    )
    known = dict(tree.source.package_urls)
    urls = {file: known.get(file) or robot.url_of(file) for file in tree.source.dependencies}
    source = replace(tree.source, package_urls=tuple(urls.items()))
    return replace(tree, source=source)


def taken_arguments(path: str | Path, package_paths: Sequence[Path] = ()) -> dict[str, str | None]:
    """Argument -> the text of its default (None: it has none), of a description as for `load_tree`; none
    where it takes none, or where that cannot be told."""
    try:
        if not is_named(path):
            return importer_of(Path(path)).taken_arguments(Path(path), package_paths)
        robot = find_robot(path)
        paths = (*package_paths, *robot.package_paths)
        found = importer_of(robot.file).taken_arguments(robot.file, paths)
    except IkgenError:
        return {}
    return {name: robot.arguments.get(name, default) for name, default in found.items()}


def argument_hint(
    path: str | Path, given: Mapping[str, str], package_paths: Sequence[Path] = ()
) -> str:
    """The arguments that a description takes, and which of those given are none of them; "" where there
    are none."""
    found = taken_arguments(path, package_paths)
    words = (f"{n}:={x}" if x is not None else f"{n} (no default)" for n, x in found.items())
    others = " and ".join(f"'{name}'" for name in given if name not in found)
    none = f"; not among them: {others}" if others else ""
    return f"arguments that the file takes (--arg): {', '.join(words)}{none}" if found else ""
