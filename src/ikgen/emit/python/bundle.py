"""One self-contained module out of a shell and what it uses of the runtime."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache

from ikgen.emit.python.import_lines import External, import_lines
from ikgen.emit.python.runtime_source import (
    Definition,
    RuntimeSource,
    read_source,
    taken_apart,
)

__all__ = ["MARK", "bundle"]

MARK = "# <runtime>"
"""The line of a shell that the runtime's definitions replace."""

Key = tuple[str, str]  # a runtime module, and a name that it defines


@dataclass(frozen=True, slots=True)
class _Bundle:
    """The runtime's modules that are used, each after those that it imports, and the names that their
    used definitions get."""

    modules: tuple[RuntimeSource, ...]
    names: Mapping[Key, str]


def bundle(shell: str) -> str:
    """The shell's text with the runtime's definitions that it uses in place of `MARK`.

    A shell is a module that imports from `ikgen.runtime.python`, each name once. What it imports is called
    as it calls it, what that uses in turn gets an underscore in front, and its module's name where another
    has the name already. Imports of the standard library and of other packages are merged into the
    shell's, those that nothing uses are left out.
    Raises ValueError for a shell that defines what it imports.
    """
    source = taken_apart("shell", shell, moved=False)
    used = _used(source)
    body = "\n\n\n".join(_section(module, used) for module in used.modules)
    lines = shell.splitlines()
    first, last = source.imports
    head, rest = lines[: first - 1], "\n".join(lines[last:])
    imports = import_lines(_imports(source, used))
    return "\n".join([*head, *imports, rest.replace(MARK, body)]) + "\n"


def _used(shell: RuntimeSource) -> _Bundle:
    """What the shell's imports lead to."""
    names: dict[Key, str] = {}
    stack = [(key, alias) for alias, key in shell.internal.items()]
    own = {n for d in shell.definitions for n in d.defines}
    if own & set(shell.internal):
        raise ValueError(
            f"names imported and defined: {', '.join(sorted(own & set(shell.internal)))}"
        )
    taken = own | set(shell.internal)
    while stack:
        key, name = stack.pop(0)
        if key in names:
            continue
        if name in taken and shell.internal.get(name) != key:
            name = f"_{key[0]}_{name.lstrip('_')}"
        names[key] = name
        taken.add(name)
        module = read_source(key[0])
        definition = _definition(module, key[1])
        for other in sorted({*definition.uses, *definition.defines}):
            needed = _owner(module, other)
            if needed is not None:
                stack.append((needed, _private(needed[1])))
    order: dict[str, None] = {}
    for module_name in sorted({module_name for module_name, _ in names}):
        order |= dict.fromkeys(_after_imports(module_name))
    used = {module_name for module_name, _ in names}
    return _Bundle(tuple(read_source(name) for name in order if name in used), names)


def _private(name: str) -> str:
    return name if name.startswith("_") else f"_{name}"


def _definition(module: RuntimeSource, name: str) -> Definition:
    for one in module.definitions:
        if name in one.defines:
            return one
    raise ValueError(f"the runtime's module {module.name} does not define {name}")


def _owner(module: RuntimeSource, name: str) -> Key | None:
    """Where a name of a module is defined; None where not in the runtime."""
    if any(name in one.defines for one in module.definitions):
        return (module.name, name)
    return module.internal.get(name)


@cache
def _after_imports(name: str) -> tuple[str, ...]:
    """The modules that a module imports, each once and after its own, then itself."""
    order: dict[str, None] = {}
    for module, _ in read_source(name).internal.values():
        order |= dict.fromkeys(_after_imports(module))
    return (*order, name)


def _kept(module: RuntimeSource, used: _Bundle) -> list[Definition]:
    return [
        one
        for one in module.definitions
        if any((module.name, name) in used.names for name in one.defines)
    ]


def _section(module: RuntimeSource, used: _Bundle) -> str:
    """A module's used definitions under its docstring's first line as a comment."""
    names: dict[str, str] = {}
    for one in module.definitions:
        for name in one.defines:
            names[name] = used.names.get((module.name, name), name)
    for local, key in module.internal.items():
        names[local] = used.names.get(key, local)
    text = f"# {next(iter(module.docstring.splitlines()), module.name)}"
    before: Definition | None = None
    for one in _kept(module, used):
        if one.block or before is None or before.block:
            gap = "\n\n\n"
        else:
            gap = "\n" * (1 + (one.start > before.start + len(before.lines)))
        text += gap + one.text(names)
        before = one
    return text


def _imports(shell: RuntimeSource, used: _Bundle) -> Iterator[External]:
    """Imports that the shell or the used definitions need."""
    for module in (shell, *used.modules):
        kept = module.definitions if module is shell else _kept(module, used)
        needed = {name for one in kept for name in one.uses}
        for one in module.external:
            if one.module == "__future__" or one.binds in needed:
                yield one
