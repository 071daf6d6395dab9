"""Changes of real robot files that a seed draws: odd numbers, lost and doubled parts, references, bytes."""

from __future__ import annotations

import random
import re

__all__ = ["mutant"]

_NUMBERS = (
    "0", "-0.0", "1e308", "-1e308", "1e309", "1e-320", "5e-324", "1e17", "-1e17", "1e16", "1e200", "1e-200",
    "1e9", "1e5", "1e4", "nan", "inf", "-inf", "", " ", "1e", "0x10", "1_000", "1,5", "½", "٣",
    "3.14159265358979",
    "1.5707963", "-1.57", "0.5235987755982988", "1e-7", "1e-9", "1e-12", "0.0001", "-0.5", "2", "180",
    "1e6", "1e7",
    "9" * 400, "--1", "${pi}", "$(arg x)", "1 2", "\u202e1",
)  # fmt: skip
_TYPES = (
    "revolute",
    "continuous",
    "prismatic",
    "fixed",
    "floating",
    "planar",
    "spherical",
    "",
    "Revolute",
)
_NUMBER = re.compile(r"(?<=[\s\"'])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?=[\s\"'])")
_ATTRIBUTE = re.compile(r"\s[\w:]+\s*=\s*(?:\"[^\"]*\"|'[^']*')")
_ELEMENT = re.compile(r"<(\w+)\b[^<>]*/>")
_JOINT = re.compile(r"<joint\b.*?</joint>", re.S)
_NAME = re.compile(r"(?<=(?:name|link)=\")[^\"]+(?=\")")


def mutant(text: str, draw: random.Random) -> str:
    """The text with one to three changes."""
    for _ in range(draw.choice((1, 1, 1, 2, 3))):
        text = draw.choice(_CHANGES)(text, draw)
    return text


def _one(pattern: re.Pattern[str], text: str, draw: random.Random) -> re.Match[str] | None:
    found = list(pattern.finditer(text))
    return draw.choice(found) if found else None


def _replaced(text: str, match: re.Match[str] | None, new: str) -> str:
    return text if match is None else text[: match.start()] + new + text[match.end() :]


def _number(text: str, draw: random.Random) -> str:
    """Another number; half the time one inside a joint, where it counts."""
    joint = _one(_JOINT, text, draw)
    if joint is not None and draw.random() < 0.8:
        inner = joint.group()
        return _replaced(text, joint, _replaced(inner, _one(_NUMBER, inner, draw), _odd(draw)))
    return _replaced(text, _one(_NUMBER, text, draw), _odd(draw))


def _odd(draw: random.Random) -> str:
    return draw.choice((*_NUMBERS, repr(draw.uniform(-4, 4)), repr(10 ** draw.uniform(-16, 18))))


def _attribute(text: str, draw: random.Random) -> str:
    return _replaced(text, _one(_ATTRIBUTE, text, draw), "")


def _lost(text: str, draw: random.Random) -> str:
    return _replaced(text, _one(draw.choice((_ELEMENT, _JOINT)), text, draw), "")


def _doubled(text: str, draw: random.Random) -> str:
    match = _one(draw.choice((_ELEMENT, _JOINT)), text, draw)
    return _replaced(text, match, match.group() * 2) if match else text


def _named(text: str, draw: random.Random) -> str:
    """Another of the file's names, or an odd one."""
    match, other = _one(_NAME, text, draw), _one(_NAME, text, draw)
    odd = (
        "",
        "a b",
        "const_cast",
        "M_PI",
        "π",
        "a&quot;b",
        "x" * 2000,
        "\u202eabc",
        "__class__",
        "1",
        "None",
    )
    chosen = other.group() if other and draw.random() < 0.7 else draw.choice(odd)
    return _replaced(text, match, chosen)


def _typed(text: str, draw: random.Random) -> str:
    match = _one(re.compile(r"(?<=type=\")\w*(?=\")"), text, draw)
    return _replaced(text, match, draw.choice(_TYPES))


def _mimic(text: str, draw: random.Random) -> str:
    """A joint follows another one."""
    joint, other = _one(_JOINT, text, draw), _one(_JOINT, text, draw)
    name = re.search(r'name="([^"]*)"', other.group()) if other else None
    if joint is None or name is None:
        return text
    odd = [draw.choice(("1", "-1", "0.5", "-0.5", "2", "0", _odd(draw))) for _ in range(2)]
    mimic = f'<mimic joint="{name.group(1)}" multiplier="{odd[0]}" offset="{odd[1]}"/>'
    return _replaced(text, joint, joint.group().replace("</joint>", mimic + "</joint>"))


def _limits(text: str, draw: random.Random) -> str:
    """Another range of a joint."""
    limit = _one(re.compile(r"<limit\b[^>]*>"), text, draw)
    low, high = _odd(draw), _odd(draw)
    return _replaced(text, limit, f'<limit lower="{low}" upper="{high}" effort="1" velocity="1"/>')


def _axis(text: str, draw: random.Random) -> str:
    axis = _one(re.compile(r"<axis\b[^>]*>"), text, draw)
    parts = " ".join(draw.choice(("0", "1", "-1", _odd(draw))) for _ in range(3))
    return _replaced(text, axis, f'<axis xyz="{parts}"/>')


def _bytes(text: str, draw: random.Random) -> str:
    at = draw.randrange(max(len(text), 1))
    junk = draw.choice(("\x00", "\x1b", "<", "&", '"', "\ufeff", "\u202e", "<!--", "]]>", "\udc80"))
    return draw.choice((text[:at], text[:at] + junk + text[at:], text[:at] + text[at + 1 :]))


_CHANGES = (
    *(_number,) * 6, _attribute, _lost, _doubled, _named, _typed, *(_mimic,) * 2, *(_limits,) * 2,
    _axis, _bytes,
)  # fmt: skip
