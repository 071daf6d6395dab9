"""Where the files lie that recorded outputs were made from: by digests and paths alone."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from ikgen.importers.packages import PACKAGE_URL, PackageFinder, PackageNotFoundError
from ikgen.records.record import Record, relative_to_cwd

__all__ = ["Input", "Packages"]


@dataclass(frozen=True, slots=True)
class Input:
    """One file that was read: its name in messages, where it lies here, and its recorded SHA-256."""

    name: str
    path: Path
    sha256: str


@dataclass(frozen=True, slots=True)
class Packages:
    """Resolves the recorded inputs of many arms, each package being looked for once."""

    finders: dict[tuple[Path, ...], PackageFinder] = field(default_factory=dict)

    def inputs(self, record: Record) -> Iterator[Input]:
        """The recorded inputs; those of a package that is not on this machine are left out."""
        for name, sha256 in record.inputs.items():
            if not name.startswith(PACKAGE_URL):
                path = relative_to_cwd(record.folder / name)
                yield Input(str(path), path, sha256)
                continue
            try:
                yield Input(name, self._finder(record).resolve(name), sha256)
            except PackageNotFoundError:
                continue

    def _finder(self, record: Record) -> PackageFinder:
        """The finder that the description was read with, by all that its answers depend on."""
        robot = record.request.robot.resolve()
        paths = tuple(path.resolve() for path in record.request.package_paths)
        return self.finders.setdefault((robot.parent, *paths), PackageFinder(robot, paths))
