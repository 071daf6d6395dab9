"""Parts that other packages offer by entry points: listed without loading them, loaded when used."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, field
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from typing import Any, TypeVar

from ikgen.errors import IkgenError, PlugInError

__all__ = ["GROUPS", "PlugIn", "blaming", "find_plug_in", "named_object", "plug_ins"]


GROUPS = {
    "ikgen.importers": "importer",  # found by suffix
    "ikgen.emitters": "emitter",
    "ikgen.leaves": "leaf",  # all are taken
    "ikgen.tasks": "task",
    "ikgen.trees": "behavior tree",  # takes ikgen's place
}
"""What an entry of each group is, in words."""

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class PlugIn:
    """One entry point: its group and name, where it points to ("module:attribute"), and the package
    ("name version") that has it."""

    group: str
    name: str
    target: str
    package: str
    entry: EntryPoint = field(repr=False, compare=False)

    @property
    def words(self) -> str:
        """What it is, for messages."""
        return f"{GROUPS[self.group]} '{self.name}' of {self.package} ({self.target})"

    def load(self, kind: type[T]) -> T:
        """The object of the entry point, or what it returns if it is a function without arguments.

        Raises `PlugInError` if that fails or gives anything else than a `kind`.
        """
        with self.blamed("cannot be loaded"):
            found = self.entry.load()
            if not isinstance(found, kind) and callable(found):
                found = found()
        if not isinstance(found, kind):
            raise self._error(
                f"is of type {type(found).__name__}, not {kind.__module__}.{kind.__name__}"
            )
        return found

    @contextmanager
    def blamed(self, what: str = "failed") -> Iterator[None]:
        """Turn failures inside into a `PlugInError` that names package and entry point; errors meant
        for the user pass."""
        try:
            yield
        except IkgenError:
            raise
        except Exception as error:
            text = " ".join(str(error).split())
            raise self._error(f"{what}: {type(error).__name__}: {text}") from error

    def _error(self, what: str) -> PlugInError:
        name = self.package.split(" ")[0]
        return PlugInError(
            f"{self.words} {what}", hint=f"update or remove that package (pip uninstall {name})"
        )


def plug_ins(group: str) -> tuple[PlugIn, ...]:
    """The entry points of a group, by name; none of them is loaded."""
    found = [_plug_in(group, entry) for entry in entry_points(group=group)]
    return tuple(sorted(found, key=lambda one: (one.name, one.package)))


def find_plug_in(group: str, name: str) -> PlugIn | None:
    """The entry point of a name. Raises `PlugInError` where several packages offer it."""
    found = [one for one in plug_ins(group) if one.name == name]
    if len(found) > 1:
        packages = " and ".join(one.package for one in found)
        raise PlugInError(
            f"{GROUPS[group]} '{name}' is offered by {packages}",
            hint="keep one of the packages",
        )
    return found[0] if found else None


def _plug_in(group: str, entry: EntryPoint) -> PlugIn:
    dist = entry.dist
    package = f"{dist.name} {dist.version}" if dist is not None else "an unnamed package"
    return PlugIn(group, entry.name, entry.value, package, entry)


def blaming(plug_in: PlugIn | None) -> AbstractContextManager[None]:
    """`PlugIn.blamed` of a row of another package; of ikgen's own (None) failures are ikgen's."""
    return nullcontext() if plug_in is None else plug_in.blamed()


def named_object(target: str) -> Any:
    """What "module:name" names; the module is imported for it."""
    module, name = target.split(":")
    return getattr(import_module(module), name)
