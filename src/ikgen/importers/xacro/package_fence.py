"""Which files a description may read: those of its own package, and of packages that were found.

A file is where it really is: symbolic links are followed first. What they lead to counts as inside
where it lies in a package that bears the name of one that was found, as workspaces that install by
symbolic links have it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from ikgen.importers.packages import PackageFinder, holds_home, manifest_name
from ikgen.importers.xacro.refusals import RefusedFileError

__all__ = ["PackageFence"]

# Folders of a package that descriptions lie in; without a manifest, the package is what holds them.
_DESCRIPTION_FOLDERS = frozenset(
    {"description", "model", "models", "robot", "robots", "urdf", "urdfs", "xacro", "xacros"}
)
_DEEPEST = 3


@dataclass(frozen=True, slots=True)
class PackageFence:
    """The folders that the file `top` (absolute) may read from; `finder` knows its packages."""

    top: Path
    finder: PackageFinder

    def require(self, file: Path) -> Path:
        """Where a file really is; raises `RefusedFileError` outside the folders, for hidden files in
        them too, `OSError` where links never end."""
        real = file.resolve()
        if not (self._inside(real) or self._linked(real)):
            raise RefusedFileError(file)
        return real

    def _inside(self, real: Path) -> bool:
        return any(
            real.is_relative_to(folder)
            and not any(part.startswith(".") for part in real.relative_to(folder).parts)
            for folder in self._folders()
        )

    def _folders(self) -> Iterator[Path]:
        yield _home(self.top)
        yield from (path.resolve() for path in self.finder.package_paths)
        yield from self.finder.found.values()

    def _linked(self, real: Path) -> bool:
        package = _enclosing(real)
        return package is not None and manifest_name(package) in self.finder.found


def _enclosing(file: Path) -> Path | None:
    return next((path for path in file.parents if (path / "package.xml").is_file()), None)


def _home(top: Path) -> Path:
    """The package that holds a file; without a manifest the folder around its folder of
    descriptions, else the file's own folder."""
    package = _enclosing(top)
    if package is not None:
        return package
    for folder in top.parents[:_DEEPEST]:
        if folder.name in _DESCRIPTION_FOLDERS and not holds_home(folder.parent):
            return folder.parent
    return top.parent
