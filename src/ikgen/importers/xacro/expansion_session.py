"""One run of the xacro package, which keeps its state in module globals: set, used and put back."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout, suppress
from functools import cache
from pathlib import Path
from types import TracebackType
from typing import Any

from ikgen.errors import MissingToolError
from ikgen.importers.packages import PACKAGE_URL, PackageFinder, PackageNotFoundError
from ikgen.importers.xacro.guarded_xacro import GuardedXacro

__all__ = ["Arguments", "Session"]

_MARK = "warning: "


class Arguments(dict[str, str]):
    """xacro's arguments; `used` names those that the file asked for, `<xacro:arg>` included."""

    def __init__(self, values: dict[str, str]) -> None:
        super().__init__(values)
        self.used: set[str] = set()

    def __contains__(self, name: object) -> bool:
        self.used.add(str(name))
        return super().__contains__(name)

    def __getitem__(self, name: str) -> str:
        self.used.add(name)
        return super().__getitem__(name)


class Session:
    """Context in which xacro resolves packages through a `PackageFinder`, with its readers and
    evaluators replaced by guarded ones unless the files are trusted.

    `environment` maps the variables that `$(env)` and `$(optenv)` asked for to values (None: not set),
    `files` is xacro's stack of files being read (the innermost last, also after a failure),
    `includes` every file that it opened beside the first, `warnings` what it printed.
    """

    def __init__(self, top: Path, finder: PackageFinder, *, trust: bool = False) -> None:
        self._top = top
        self._finder = finder
        self._trust = trust
        self._saved: list[tuple[Any, str, Any]] = []
        self._output = io.StringIO()
        self.environment: dict[str, str | None] = {}
        self.files: list[Path] = []
        self.includes: list[Path] = []
        self.warnings: tuple[str, ...] = ()

    def __enter__(self) -> Session:
        import xacro
        from xacro import substitution_args

        try:
            self._replace(xacro, substitution_args)
        except BaseException:
            self._put_back()
            raise
        return self

    def _replace(self, xacro: Any, substitution_args: Any) -> None:
        @cache
        def find(package: str) -> str:
            with suppress(PackageNotFoundError):
                return str(self._finder.find(package))
            return f"{PACKAGE_URL}{package}"  # an error where a file of it is read, and only there

        resolve = xacro.abs_filename_spec

        def resolve_file(spec: str) -> str:
            if spec.startswith(PACKAGE_URL):
                return str(self._finder.resolve(spec))
            return str(resolve(spec))

        self._set(substitution_args, "_eval_find", find)
        for name in ("_eval_env", "_eval_optenv"):
            self._set(substitution_args, name, self._noting(substitution_args, name))
        self._set(xacro, "abs_filename_spec", resolve_file)
        self._set(xacro, "all_includes", [])
        self._set(xacro, "filestack", None)
        self._set(xacro, "macrostack", None)
        self._set(xacro, "verbosity", 1)
        self._set(xacro, "substitution_args_context", {})
        if not self._trust:
            guarded = GuardedXacro(self._top, self._finder)
            for owner, name, value in guarded.replacements(xacro, substitution_args):
                self._set(owner, name, value)

    def _noting(self, substitution_args: Any, function: str) -> Callable[..., str]:
        """A function that reads an environment variable, and notes which."""
        read = getattr(substitution_args, function, None)  # an absent one is refused by `_set`

        def noting(name: str, *default: str, **named: str) -> str:
            self.environment[name] = os.environ.get(name)
            assert read is not None
            return str(read(name, *default, **named))

        return noting

    def _set(self, owner: Any, name: str, value: Any) -> None:
        if not hasattr(owner, name):  # never run unguarded because a name has changed
            raise MissingToolError(
                f"the package xacro has no '{owner.__name__}.{name}'",
                hint="install a version that ikgen knows: pip install 'xacro>=2.1,<3'",
            )
        self._saved.append((owner, name, getattr(owner, name)))
        setattr(owner, name, value)

    def process(self, arguments: Arguments) -> str:
        """The expanded XML text of the file.

        Not `xacro.process_file`: that adds a banner with the absolute path of the file.
        """
        import xacro

        top = str(self._top)
        xacro.init_stacks(top)
        context: dict[str, Any] = xacro.substitution_args_context
        context["filename"] = top
        with redirect_stderr(self._output), redirect_stdout(self._output):
            document = xacro.parse(None, top)
            xacro.process_doc(document, mappings=arguments)
        return str(document.toprettyxml(indent="  "))

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        xacro = sys.modules["xacro"]
        self.files[:] = [Path(name) for name in xacro.filestack or () if name]
        self.includes[:] = [Path(name) for name in xacro.all_includes]
        printed = [line for line in self._output.getvalue().splitlines() if line.startswith(_MARK)]
        self.warnings = tuple(f"xacro: {line[len(_MARK) :]}" for line in dict.fromkeys(printed))
        self._put_back()

    def _put_back(self) -> None:
        for owner, name, value in reversed(self._saved):
            setattr(owner, name, value)
