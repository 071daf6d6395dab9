"""Text of the C++ runtime without what `if constexpr` leaves out for one arm."""

from __future__ import annotations

import re
import textwrap

from ikgen.emit.cpp.cpp_tokens import masked, past_brackets, past_statement

__all__ = ["ArmFacts", "without_other_arms"]

ArmFacts = tuple[tuple[str, bool], ...]
"""Constants of an `Arm` and whether they are true, or not 0 (`kNewton`)."""

_CONDITION = re.compile(r"^( *)(?:\} (else ))?if constexpr (?=\()", re.MULTILINE)
_TERM = re.compile(r"(!?)A(?:rm)?::(k\w+)(?: > 0)?")


def without_other_arms(text: str, facts: ArmFacts) -> str:
    """The text with what conditions of `if constexpr` lead to in place of those that the facts decide."""
    known, at = dict(facts), 0
    while (found := _CONDITION.search(text, at)) is not None:
        code = masked(text)
        behind = past_brackets(code, found.end())
        value = _value(text[found.end() + 1 : behind - 1], known)
        if value is None or found[2]:
            at = found.end()
            continue
        first = past_statement(code, behind)
        other = re.compile(r"\s*else\b").match(code, first)
        end = first if other is None else past_statement(code, other.end())
        stays = text[behind:first] if value else text[other.end() : end] if other else ""
        text = text[: found.start()] + _plain(stays, found[1]) + text[end:].removeprefix("\n")
        at = found.start()
    return text


def _value(condition: str, known: dict[str, bool]) -> bool | None:
    """Whether all terms of the condition hold; None where that is not known."""
    terms = [_TERM.fullmatch(part) for part in condition.split(" && ")]
    values = [_truth(known.get(t[2]), t[1]) if t is not None else None for t in terms]
    if False in values:
        return False
    return None if None in values else True


def _truth(value: bool | None, sign: str) -> bool | None:
    return value if value is None or not sign else not value


def _plain(statement: str, indent: str) -> str:
    """The lines of a statement, those of a block without its braces."""
    if statement.startswith(" if "):
        return f"{indent}{statement.strip()}\n"
    inner = textwrap.dedent(statement.strip("\n")).strip()
    if inner.startswith("{") and past_brackets(masked(inner), 0) == len(inner):
        inner = textwrap.dedent(inner[1:-1].strip("\n").rstrip())
    return textwrap.indent(inner, indent) + "\n" if inner.strip() else ""
