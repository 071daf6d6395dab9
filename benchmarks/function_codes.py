"""Functions of a module by what Python compiles of them: which one a change is in."""

from __future__ import annotations

from types import CodeType

from benchmarks.code_mutations import CodeMutation

__all__ = ["functions_of", "surrounding"]


def surrounding(text: bytes, mutation: CodeMutation) -> str | None:
    """The qualified name of the outermost function whose body has the change; None outside of all."""
    old, new = (compile(t, "", "exec") for t in (text, mutation.applied(text)))
    if _rest(old) != _rest(new):
        return None
    here, there = functions_of(old), functions_of(new)
    changed = [name for name, code in here.items() if _key(there.get(name)) != _key(code)]
    return changed[0] if len(changed) == 1 and "<" not in changed[0] else None


def functions_of(module: CodeType) -> dict[str, CodeType]:
    """Functions of a module and of its classes, not those inside functions."""
    found: dict[str, CodeType] = {}
    for code in module.co_consts:
        if isinstance(code, CodeType):
            if code.co_flags & 0x2:  # CO_NEWLOCALS: a function
                found[code.co_qualname] = code
            else:
                found.update(functions_of(code))
    return found


def _key(code: CodeType | None) -> object:
    """What a code does, without its place in the file."""
    if code is None:
        return None
    parts = tuple(
        _key(c) if isinstance(c, CodeType) else (type(c), repr(c)) for c in code.co_consts
    )
    return code.co_code, code.co_names, code.co_varnames, code.co_freevars, parts


def _rest(code: CodeType) -> object:
    """What a module and its classes do when they are imported."""
    inside = [
        _rest(c) if not c.co_flags & 0x2 else c.co_qualname
        for c in code.co_consts
        if isinstance(c, CodeType)
    ]
    plain = [(type(c), repr(c)) for c in code.co_consts if not isinstance(c, CodeType)]
    return code.co_code, code.co_names, inside, plain
