"""What of the runtime a shell's imports lead to, and under which names."""

from __future__ import annotations

from collections.abc import Mapping

from ikgen.emit.python.runtime_source import Definition, Member, RuntimeSource, read_source
from ikgen.emit.python.settled_branches import Facts

__all__ = ["Key", "Reached"]

Key = tuple[str, str]
"""A runtime module, and a name that it defines."""


class Reached:
    """`names`: what definitions that are used get called, by their keys. Of private classes methods come
    along whose names stand behind a dot somewhere."""

    def __init__(self, shell: RuntimeSource, facts: Facts, instead: Mapping[Key, Key]) -> None:
        own = set(shell.defining)
        if own & set(shell.internal):
            twice = ", ".join(sorted(own & set(shell.internal)))
            raise ValueError(f"names imported and defined: {twice}")
        self.names: dict[Key, str] = {}
        self._shell, self._facts, self._instead = shell, facts, instead
        self._taken = own | set(shell.internal)
        self._dotted = {name for one in shell.definitions for _, name in one.attributes}
        self._asleep: dict[Key, tuple[Member, ...]] = {}
        self._waiting = [(key, alias) for alias, key in shell.internal.items()]
        self._add_all()

    @property
    def modules(self) -> tuple[RuntimeSource, ...]:
        """The modules of which something is used, each after those that it imports."""
        order: dict[str, None] = {}
        used = {module for module, _ in self.names}
        for module in sorted(used, key=_alone):
            self._add_after_imports(module, order)
        return tuple(self._source(name) for name in order if name in used)

    def _add_after_imports(self, name: str, order: dict[str, None]) -> None:
        """Adds a module, and before it those that it imports, each after its own, but for what is there."""
        if name not in order:
            imported = {module for module, _ in self._source(name).internal.values()}
            for module in sorted(imported, key=_alone):
                self._add_after_imports(module, order)
            order[name] = None

    def kept(self, module: RuntimeSource) -> list[Definition]:
        """A module's definitions that are used, without members that are not."""
        return [
            one.without(self._asleep.get((module.name, one.defines[0]), ()))
            for one in module.definitions
            if any((module.name, name) in self.names for name in one.defines)
        ]

    def local_names(self, module: RuntimeSource) -> dict[str, str]:
        """What the names that a module defines or imports are in the bundle."""
        own = {name: (module.name, name) for name in module.defining}
        keys = {**own, **module.internal}
        return {n: self.names.get(self._instead.get(k, k), n) for n, k in keys.items()}

    def _source(self, name: str) -> RuntimeSource:
        return read_source(name, self._facts)

    def _add_all(self) -> None:
        while self._waiting:
            while self._waiting:
                self._add(*self._waiting.pop(0))
            for key, members in self._asleep.items():
                awake = [one for one in members if one.name in self._dotted]
                if awake:
                    self._asleep[key] = tuple(one for one in members if one not in awake)
                    self._lead_on(key)

    def _add(self, key: Key, name: str) -> None:
        if key in self.names:
            return
        if name in self._taken and self._shell.internal.get(name) != key:
            name = f"_{_alone(key[0])}_{name.lstrip('_')}"
        self.names[key] = name
        self._taken.add(name)
        one = _definition(self._source(key[0]), key[1])
        if one.members and one.private({key[1]: name}):
            self._asleep[key] = one.members
        self._lead_on(key)

    def _lead_on(self, key: Key) -> None:
        """To what a definition uses, but for members that are not reached."""
        module = self._source(key[0])
        one = _definition(module, key[1]).without(self._asleep.get(key, ()))
        self._dotted |= {name for _, name in one.attributes}
        for other in sorted({*one.uses, *one.defines}):
            needed = _owner(module, other)
            if needed is not None:
                needed = self._instead.get(needed, needed)
                self._waiting.append((needed, _private(needed[1])))


def _alone(module: str) -> str:
    """A module's name without its folder: no two have the same."""
    return module.rpartition(".")[2]


def _private(name: str) -> str:
    return name if name.startswith("_") else f"_{name}"


def _definition(module: RuntimeSource, name: str) -> Definition:
    if name not in module.defining:
        raise ValueError(f"the runtime's module {module.name} does not define {name}")
    return module.defining[name]


def _owner(module: RuntimeSource, name: str) -> Key | None:
    """Where a name of a module is defined; None where not in the runtime."""
    if name in module.defining:
        return (module.name, name)
    return module.internal.get(name)
