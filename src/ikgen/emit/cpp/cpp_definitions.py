"""C++ text of the runtime by its definitions, and which of them a text needs."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from ikgen.emit.cpp.cpp_tokens import masked, past_brackets, past_declaration

__all__ = ["Definition", "definitions", "needed", "words"]

_WORD = re.compile(r"[A-Za-z_]\w*")
_APART = re.compile(r"\s*\n|#(?:[^\n]*\\\n)*[^\n]*\n| *(?:public|private):\n")
_ATTRIBUTE = re.compile(r"\[\[[^\]]*\]\]|\balignas\(\w+\)")
_TYPE = re.compile(r"(struct|class|enum class|namespace)\s+(\w+)")
_ALIAS = re.compile(r"using\s+(\w+)\s*=")
_CONSTANT = re.compile(
    r"(?:inline |static )?constexpr\b[^(]*?[\w>] (\w+)(?:<[^=]*>)?(?:\[[^=]*\])*(?: = |\{)"
)
_FUNCTION = re.compile(r"[\w>&*\])] [&*]*(\w+)\(")


@dataclass(frozen=True, slots=True, eq=False)
class Definition:
    """A statement of a namespace or class: the `names` without which it is of no use (none where it has to
    stay), its `text` up to its `members` and the text `behind` them."""

    names: frozenset[str]
    text: str
    members: tuple[Definition, ...] = ()
    behind: str = ""

    def without(self, kept: set[int]) -> str:
        """Its text with those of its members alone whose identities are `kept`."""
        inner = "".join(one.without(kept) for one in self.members if id(one) in kept)
        return self.text + inner + self.behind

    def needed_by_name(self, kept: set[int]) -> bool:
        """Whether it, or one of its members that are kept, has a name."""
        inner = (one.needed_by_name(kept) for one in self.members if id(one) in kept)
        return bool(self.names) or any(inner)


def words(text: str) -> set[str]:
    """All that may be a name in a text."""
    return set(_WORD.findall(text))


def definitions(text: str, around: str = "") -> Iterator[Definition]:
    """The definitions of a namespace, or of the class `around` them, in order."""
    code, at = masked(text), 0
    while at < len(text):
        apart = _APART.match(code, at)
        end = apart.end() if apart is not None else past_declaration(code, at)
        plain = Definition(frozenset(), text[at:end])
        yield plain if apart is not None else _definition(text[at:end], code[at:end], around)
        at = end


def needed(given: Iterable[Definition], wanted: set[str]) -> set[int]:
    """Identities of the definitions, and of their members, that names lead to."""
    reached, kept = set(wanted), set[int]()
    asleep: dict[str, list[Definition]] = defaultdict(list)
    awake = list(given)
    while awake:
        one = awake.pop()
        if id(one) in kept:
            continue
        if one.names and not one.names & reached:
            for name in one.names:
                asleep[name].append(one)
            continue
        kept.add(id(one))
        awake += one.members
        for name in words(masked(one.text)) - reached:
            reached.add(name)
            awake += asleep.pop(name, ())
    return kept


def _definition(text: str, code: str, around: str) -> Definition:
    head = _without_parameters(_ATTRIBUTE.sub(lambda m: " " * len(m[0]), code))
    kind = _TYPE.match(head)
    if kind is None:
        return Definition(_names(head, around), text)
    names = frozenset((kind[2],)) if kind[1] != "namespace" else frozenset[str]()
    begin = len(code) - len(head) + head.find("{")
    inside = code.find("\n", begin) + 1
    if "{" not in head or kind[1] == "enum class" or code[begin + 1 : inside].strip():
        return Definition(names, text)
    end = code.rfind("\n", 0, past_brackets(code, begin)) + 1
    members = tuple(definitions(text[inside:end], kind[2]))
    return Definition(names, text[:inside], members, text[end:])


def _names(head: str, around: str) -> frozenset[str]:
    """The names of what is no class: none where others may need it without naming it."""
    if head.startswith("typedef "):
        return frozenset()
    found = _ALIAS.match(head) or _CONSTANT.match(head)
    if found is None and "operator" not in head.partition("{")[0]:
        found = _FUNCTION.search(head.partition("{")[0])
    if found is None or found[1] in (around, "begin", "end", "size"):
        return frozenset()
    more = re.findall(r", (\w+) = ", head) if found[0].endswith(" = ") else ()
    return frozenset((found[1], *more))


def _without_parameters(code: str) -> str:
    """What follows `template <...>`, and blanks."""
    code = code.lstrip()
    while (found := re.match(r"template <", code)) is not None:
        depth, at, brackets = 1, found.end(), 0
        while depth:
            brackets += {"(": 1, ")": -1}.get(code[at], 0)
            depth += {"<": 1, ">": -1}.get(code[at], 0) if not brackets else 0
            at += 1
        code = code[at:].lstrip()
    return code
