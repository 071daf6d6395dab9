"""The names that expressions know before a file defines its own.

Those of the xacro package, with functions that are bounded in place of Python's: `vars` and `hash`
are left out, as the one opens objects and the other differs from run to run.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ikgen.importers.xacro.safe_functions import MATH, PYTHON, tokenize

__all__ = ["global_symbols", "substitution_names"]

_PLAIN = (
    *("list", "dict", "map", "len", "str", "float", "int", "bool", "True", "False"),
    *("min", "max", "round"),
)
_OLD_HOME = "Using {name}() directly is deprecated. Use {ns}.{name}() instead."
_MESSAGES = ("arg", "error", "fatal", "message", "print_location", "warning")


def global_symbols(xacro: Any, load_yaml: Callable[[str], Any]) -> dict[str, Any]:
    """The root of xacro's symbol tables; `xacro` is the package."""
    own = xacro.create_global_symbols()["xacro"]
    here = {
        "load_yaml": load_yaml,
        "abs_filename": lambda spec: xacro.abs_filename_spec(spec),
        "dotify": xacro.YamlDictWrapper,
    }
    symbols: dict[str, Any] = {name: PYTHON[name] for name in _PLAIN}
    symbols.update(MATH)
    for name, space in (("sorted", "python"), ("range", "python"), *((n, "xacro") for n in here)):
        function = here.get(name) or PYTHON[name]
        symbols[name] = _deprecated(xacro, function, _OLD_HOME.format(name=name, ns=space))
    messages = {name: dict.__getitem__(own, name) for name in _MESSAGES}
    for space, names in (
        ("python", PYTHON),
        ("math", MATH),
        ("xacro", {**messages, **here, "tokenize": tokenize}),
    ):
        symbols[space] = xacro.NameSpace()
        symbols[space].update(names)
    return symbols


def _deprecated(xacro: Any, function: Callable[..., Any], message: str) -> Callable[..., Any]:
    def call(*arguments: Any, **named: Any) -> Any:
        xacro.warning(message)
        return function(*arguments, **named)

    return call


def substitution_names(
    substitution_args: Any, arguments: Mapping[str, str], directory: Callable[[], str]
) -> dict[str, Any]:
    """The names in `$(eval ...)`: the file's arguments, and functions for what `$(...)` knows."""
    plain = ("list", "dict", "map", "str", "float", "int", "True", "False")
    return {
        **{name: substitution_args.convert_value(arguments[name], "auto") for name in arguments},
        **MATH,
        **{name: PYTHON[name] for name in plain},
        "true": True,
        "false": False,
        "arg": lambda name: substitution_args.convert_value(
            substitution_args._eval_arg(name, arguments), "auto"
        ),
        "dirname": directory,
        "env": substitution_args._eval_env,
        "optenv": substitution_args._eval_optenv,
        "find": lambda name: substitution_args._eval_find(name),
    }
