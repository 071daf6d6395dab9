"""One self-contained module out of a shell and what it uses of the runtime."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ikgen.emit.python.docstrings import comment_lines, summary
from ikgen.emit.python.import_lines import External, import_lines
from ikgen.emit.python.reached_definitions import Key, Reached
from ikgen.emit.python.runtime_source import Definition, RuntimeSource, taken_apart
from ikgen.emit.python.settled_branches import Facts

__all__ = ["MARK", "bundle"]

MARK = "# <runtime>"
"""The line of a shell that the runtime's definitions replace."""


def bundle(shell: str, facts: Facts = (), instead: Mapping[Key, Key] | None = None) -> str:
    """The shell's text with the runtime's definitions that it uses in place of `MARK`.

    A shell is a module that imports from `ikgen.runtime.python`, each name once. What it imports is called
    as it calls it, what that uses in turn gets an underscore in front, and its module's name where another
    has the name already. Imports of the standard library and of other packages are merged into the
    shell's, those that nothing uses are left out. So is what an arm of which `facts` are known never
    reaches; some definitions come `instead` of others.
    Raises ValueError for a shell that defines what it imports.
    """
    source = taken_apart("shell", shell, moved=False)
    reached = Reached(source, facts, instead or {})
    kept = [(module, reached.kept(module)) for module in reached.modules]
    body = "\n\n\n".join(_section(m, part, reached.local_names(m)) for m, part in kept)
    lines = shell.splitlines()
    first, last = source.imports
    head, rest = lines[: first - 1], "\n".join(lines[last:])
    imports = import_lines(_imports([(source, list(source.definitions)), *kept]))
    return "\n".join([*head, *imports, rest.replace(MARK, body)]) + "\n"


def _section(module: RuntimeSource, kept: list[Definition], names: Mapping[str, str]) -> str:
    """A module's used definitions under its docstring's first sentence as a comment."""
    text = "\n".join(comment_lines(summary(module.docstring, short=False) or module.name))
    before: Definition | None = None
    for one in kept:
        if one.block or before is None or before.block:
            gap = "\n\n\n"
        else:
            gap = "\n" * (1 + (one.start > before.start + len(before.lines)))
        text += gap + one.text(names)
        before = one
    return text


def _imports(kept: list[tuple[RuntimeSource, list[Definition]]]) -> Iterator[External]:
    """Imports that the shell or the used definitions need."""
    for module, part in kept:
        needed = {name for one in part for name in one.uses}
        for one in module.external:
            if one.module == "__future__" or one.binds in needed:
                yield one
