"""What runs in place of xacro's own functions for files that nobody vouched for.

Expressions are computed by `expression`, files are read behind `package_fence`, and everything that
expands counts against a `Budget`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ikgen.importers.packages import PackageFinder
from ikgen.importers.xacro.budget import Budget
from ikgen.importers.xacro.macro_copies import counted_copies
from ikgen.importers.xacro.macro_expression import Evaluator
from ikgen.importers.xacro.package_fence import PackageFence
from ikgen.importers.xacro.refusals import ExpansionLimitError, RefusedFileError
from ikgen.importers.xacro.symbol_table import global_symbols, substitution_names
from ikgen.importers.xacro.yaml_values import LARGEST_YAML, parse_yaml
from ikgen.importers.xml_document import parse_xml, read_text

__all__ = ["LARGEST_XACRO", "GuardedXacro"]

LARGEST_XACRO = 8 * 2**20
"""The most bytes of one xacro file."""

_WILDCARD = re.compile(r"[*?[]")
_DEEPEST_PATTERN = 4
_MOST_WORK = 10**9
# xacro's own pattern of a macro's parameter, without the alternatives that fail in exponential time.
_MACRO_ARGUMENT = re.compile(
    r"""^\s*([^\s:=]+?)\s*:?=\s*(\^\|?)?"""
    r"""(\$\{.*?\}|\$\(.*?\)|(?:'[^']*'|"[^"]*"|[^\s'"])+|)(?:\s+|$)(.*)"""
)


@dataclass(frozen=True, slots=True)
class GuardedXacro:
    """The guarded functions of one expansion of the file `top` (absolute)."""

    top: Path
    finder: PackageFinder
    budget: Budget = field(default_factory=Budget)

    def replacements(self, xacro: Any, substitution_args: Any) -> Iterator[tuple[Any, str, Any]]:
        """(module, name, what to put there) for the package `xacro` and its `substitution_args`."""
        evaluator = Evaluator(self.budget)
        fence = PackageFence(self.top, self.finder)

        def evaluate(text: str, names: Any, local: Any = None) -> Any:
            return evaluator.evaluate(text, names)

        def evaluate_substitution(text: str, context: dict[str, Any]) -> str:
            directory = lambda: substitution_args._eval_dirname(context["filename"])  # noqa: E731
            arguments = context.setdefault("arg", {})
            return str(evaluate(text, substitution_names(substitution_args, arguments, directory)))

        load_yaml = _yaml_loader(xacro, fence, self.budget, evaluate)
        yield xacro, "safe_eval", evaluate
        yield substitution_args, "_eval", evaluate_substitution
        yield xacro, "_global_symbols", global_symbols(xacro, load_yaml)
        yield xacro, "load_yaml", load_yaml
        yield xacro, "eval_text", _counted(xacro.eval_text, self.budget)
        yield xacro, "parse", _parser(xacro, fence, self.budget)
        yield xacro, "get_include_files", _include_finder(xacro, fence)
        yield xacro, "re_macro_arg", _MACRO_ARGUMENT
        yield from counted_copies(xacro, self.budget)


def _counted(eval_text: Callable[[str, Any], Any], budget: Budget) -> Callable[[str, Any], Any]:
    def counted(text: str, symbols: Any) -> Any:
        if len(text) * text.count("$") > _MOST_WORK:  # xacro copies the rest of the text at each
            raise ExpansionLimitError(f"has a text of {len(text):,} characters full of expressions")
        value = eval_text(text, symbols)
        budget.add_text(len(value) if isinstance(value, str) else 1)
        return value

    return counted


def _parser(xacro: Any, fence: PackageFence, budget: Budget) -> Callable[..., Any]:
    def parse(content: Any, filename: str) -> Any:
        from xml.dom import minidom

        del content  # xacro gives names only
        budget.look_at_clock()
        file = Path(filename)
        including = xacro.filestack[:-1] or xacro.filestack
        try:
            file.stat()
            real = fence.require(file)
        except OSError as error:
            xacro.filestack = including  # as xacro does: the file at fault is the one that includes
            raise xacro.XacroException(f"{error.strerror}: {filename}", exc=error) from error
        except RefusedFileError:
            xacro.filestack = including
            raise
        text = read_text(real, LARGEST_XACRO)
        parse_xml(text, filename)  # limits of depth and entities, errors in words
        budget.add_nodes(text.count("<"))
        return minidom.parseString(text)

    return parse


def _include_finder(xacro: Any, fence: PackageFence) -> Callable[[str, Any], Iterator[str]]:
    def include_files(spec: str, symbols: Any) -> Iterator[str]:
        name = str(xacro.abs_filename_spec(xacro.eval_text(spec, symbols)))
        names = [name]
        if _WILDCARD.search(name):
            names = _matching(name, fence)
            if not names:
                xacro.warning(xacro.include_no_matches_msg.format(name))
        for found in names:
            xacro.all_includes.append(found)
            yield found

    return include_files


def _matching(pattern: str, fence: PackageFence) -> list[str]:
    """The files of a pattern, sorted: its wildcards may only look around inside the packages."""
    parts = Path(pattern).parts
    first = next(i for i, part in enumerate(parts) if _WILDCARD.search(part))
    folder = fence.require(Path(*parts[:first]))
    if ".." in parts[first:] or len(parts) - first > _DEEPEST_PATTERN:
        raise RefusedFileError(Path(pattern))
    # Here "**" is one folder as in xacro, not any number of them.
    onward = "/".join(re.sub(r"\*+", "*", part) for part in parts[first:])
    return sorted(str(file) for file in folder.glob(onward))


def _yaml_loader(
    xacro: Any, fence: PackageFence, budget: Budget, evaluate: Callable[[str, Any], Any]
) -> Callable[[str], Any]:
    def unit(factor: float) -> Callable[[str], float]:
        return lambda text: float(evaluate(text, xacro._global_symbols)) * factor

    units: Mapping[str, Callable[[str], float]] = {
        one.value.tag: unit(one.value.conversion_constant) for one in xacro.ConstructUnits
    }

    def load_yaml(filename: str) -> Any:
        budget.look_at_clock()
        name = str(xacro.abs_filename_spec(filename))
        file = Path(name)
        file.stat()  # an absent file is an error before one outside is
        text = read_text(fence.require(file), LARGEST_YAML, may_be_empty=True)
        xacro.filestack.append(name)
        try:
            return xacro.YamlListWrapper.wrap(parse_yaml(text, name, units))
        finally:
            xacro.filestack.pop()
            xacro.all_includes.append(name)

    return load_yaml
