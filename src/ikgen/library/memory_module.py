"""Emitted Python text as a module, without a file."""

from __future__ import annotations

import itertools
import linecache
import sys
from types import ModuleType

__all__ = ["module_of"]

_serial = itertools.count()


def module_of(name: str, text: str) -> ModuleType:
    """The module that the text of `<name>_ik.py` is; tracebacks show its lines."""
    unique = f"_ikgen_loaded_{next(_serial)}_{name}_ik"
    file = f"<{name}_ik.py>"
    module = ModuleType(unique, f"Inverse kinematics of {name}.")
    module.__file__ = file
    lines = text.splitlines(keepends=True)
    linecache.cache[file] = (len(text), None, lines, file)
    sys.modules[unique] = module  # dataclasses look their module up there
    exec(compile(text, file, "exec"), module.__dict__)
    return module
