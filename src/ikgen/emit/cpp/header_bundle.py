"""The runtime's C++ headers as text inside an emitted header."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from ikgen.emit.cpp.cpp_definitions import Definition, definitions, needed, words
from ikgen.emit.cpp.cpp_tokens import masked
from ikgen.emit.cpp.settled_conditions import ArmFacts, without_other_arms

__all__ = ["RUNTIME", "Bundle", "bundle", "bundle_for"]

RUNTIME = Path(__file__).resolve().parents[2] / "runtime" / "cpp"
"""Where the headers are: `namespace ikgen_runtime`, local includes as `folder/name.hpp`."""

_LOCAL = re.compile(r'#include "([\w./]+)"\n')
_SYSTEM = re.compile(r"#include <[\w./]+>\n")
_CHOSEN = re.compile(r"#if [^\n]*\n(?:(?:#include|#elif|#else)[^\n]*\n)+#endif\n")
_DROPPED = re.compile(
    r"^(?:#pragma once|namespace ikgen_runtime \{|\}  // namespace ikgen_runtime| *//.*)\n",
    re.MULTILINE,
)


@dataclass(frozen=True, slots=True)
class Bundle:
    """`includes`: lines of system headers, sorted, Eigen's last, then those that the processor chooses;
    `body`: the headers' text, each once and behind what it includes, without the namespace around it and
    without comments that have a line of their own: those are for who works on the runtime."""

    includes: str
    body: str


@dataclass(frozen=True, slots=True)
class _Header:
    local: tuple[str, ...]
    system: tuple[str, ...]
    chosen: tuple[str, ...]
    body: str
    title: str


def bundle(names: Iterable[str], system: Iterable[str] = ()) -> Bundle:
    """The named headers of the runtime with all that they include, and other system headers to include.

    Raises `OSError` for a header that the runtime has not.
    """
    headers = [_header(name) for name in _in_order(names)]
    body = "\n".join(header.title + header.body for header in headers)
    return Bundle(_includes(headers, system), body)


def bundle_for(
    shell: str, facts: ArmFacts, names: Iterable[str], system: Iterable[str] = ()
) -> Bundle:
    """The bundle of what one shell, and the types of an arm of which `facts` are known, lead to."""
    order = _in_order(names)
    parts = [(_header(name).title, _definitions(name, facts)) for name in order]
    kept = needed((one for _, given in parts for one in given), words(masked(shell)))
    texts = []
    for title, given in parts:
        if any(id(one) in kept and one.needed_by_name(kept) for one in given):
            left = "".join(one.without(kept) for one in given if id(one) in kept)
            texts.append(title + _tidy(left) + "\n")
    return Bundle(_includes([_header(name) for name in order], system), "\n".join(texts))


def _includes(headers: Iterable[_Header], system: Iterable[str]) -> str:
    """The lines that include the system's headers, sorted."""
    headers = list(headers)
    plain = {f"#include <{name}>\n" for name in system}
    plain.update(line for header in headers for line in header.system)
    chosen = dict.fromkeys(block for header in headers for block in header.chosen)
    standard = sorted(line for line in plain if "/" not in line)
    others = sorted(plain.difference(standard))
    return "".join([*standard, "\n", *others, *chosen])


def _in_order(names: Iterable[str]) -> list[str]:
    """The headers and all that they include, each behind its own includes."""
    found: dict[str, None] = {}

    def visit(name: str) -> None:
        if name not in found:
            for other in _header(name).local:
                visit(other)
            found[name] = None

    for name in names:
        visit(name)
    return list(found)


@cache
def _header(name: str) -> _Header:
    text = (RUNTIME / name).read_text(encoding="utf-8")
    chosen = tuple(block for block in _CHOSEN.findall(text) if "#include" in block)
    for block in chosen:
        text = text.replace(block, "")
    local, system = _LOCAL.findall(text), _SYSTEM.findall(text)
    for pattern in (_LOCAL, _SYSTEM, _DROPPED):
        text = pattern.sub("", text)
    title = f"// --- {Path(name).stem.replace('_', ' ')} "
    return _Header(tuple(local), tuple(system), chosen, f"{_tidy(text)}\n", f"{title:-<100}\n")


@cache
def _definitions(name: str, facts: ArmFacts) -> tuple[Definition, ...]:
    return tuple(definitions(without_other_arms(_header(name).body, facts)))


def _tidy(text: str) -> str:
    """The text without empty lines at the ends of blocks, and without two in a row."""
    text = re.sub(r"\n *(?:private|public):\n+(?= *\})", "\n", text)
    text = re.sub(r"\n{3,}", "\n\n", text)
    return re.sub(r"\n\n(?=(?: *\};?|#endif)\n)", "\n", re.sub(r"(?<=\{\n)\n", "", text)).strip()
