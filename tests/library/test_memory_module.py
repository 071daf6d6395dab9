"""Modules without a file: what tracebacks and `inspect` show of them."""

from __future__ import annotations

import inspect
import linecache
import traceback

import pytest

from ikgen.library.memory_module import module_of


def fails(line: str) -> str:
    return f'"""Made up."""\n\n\ndef fail():\n    {line}\n'


def test_tracebacks_show_the_lines_of_each_module() -> None:
    lines = ("raise ValueError(1)  # the first", "raise ValueError(2)  # the second")
    modules = [module_of("made", fails(line)) for line in lines]
    linecache.checkcache()
    for module, line in zip(modules, lines, strict=True):
        with pytest.raises(ValueError) as caught:
            module.fail()
        last = traceback.extract_tb(caught.tb)[-1]
        assert last.line == line and last.filename == module.__file__
        assert inspect.getsource(module.fail) == f"def fail():\n    {line}\n"
        assert module.__doc__ == "Made up."


def test_a_text_that_is_no_python_is_named() -> None:
    with pytest.raises(SyntaxError) as caught:
        module_of("made", "def\n")
    assert str(caught.value.filename).startswith("made_ik.py")
