"""Emitted Python text as a module, without a file."""

from __future__ import annotations

import itertools
import sys
from importlib.abc import InspectLoader
from importlib.util import module_from_spec, spec_from_loader
from types import CodeType, ModuleType

__all__ = ["module_of"]

_serial = itertools.count()


class _TextLoader(InspectLoader):
    """Loads a module from its text; tracebacks ask it for the lines."""

    def __init__(self, file: str, text: str) -> None:
        self._file, self._text = file, text

    def get_source(self, fullname: str) -> str:
        """The text."""
        return self._text

    def get_code(self, fullname: str) -> CodeType:
        """The text compiled, as of a file of its own."""
        return self.source_to_code(self._text, self._file)


def module_of(name: str, text: str) -> ModuleType:
    """The module that the text of `<name>_ik.py` is; tracebacks show its lines."""
    number = next(_serial)
    file = f"{name}_ik.py (in memory, {number})"  # of names in <> tracebacks ask no loader
    loader = _TextLoader(file, text)
    spec = spec_from_loader(f"_ikgen_loaded_{number}_{name}_ik", loader, origin=file)
    assert spec is not None
    module = module_from_spec(spec)
    module.__file__ = file
    sys.modules[spec.name] = module  # dataclasses look their module up there
    loader.exec_module(module)
    return module
