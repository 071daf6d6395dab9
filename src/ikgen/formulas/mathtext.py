"""Formulas as tokens that print to LaTeX and to MathML, with the places where a line may break."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from html import escape

__all__ = [
    "Math", "Token", "close", "comma", "decimal", "dots", "fraction", "function", "group", "join", "minus",
    "name", "number", "operator", "plus", "power", "radical", "relation", "space", "text",
]  # fmt: skip

GREEK = {
    "alpha": "α", "al": "α", "beta": "β", "gamma": "γ", "theta": "θ", "th": "θ", "phi": "φ",
    "psi": "ψ", "sigma": "σ", "pi": "π",
}  # fmt: skip
_COMMAND = {"al": "alpha", "th": "theta"}


@dataclass(frozen=True, slots=True)
class Token:
    """One mark. `role` is "ord", "bin" or "rel" (a line may break before it), "comma" (after)."""

    latex: str
    mathml: str
    role: str = "ord"


@dataclass(frozen=True, slots=True)
class Math:
    """A formula."""

    tokens: tuple[Token, ...]

    def __add__(self, other: Math) -> Math:
        return Math(self.tokens + other.tokens)

    @property
    def latex(self) -> str:
        """LaTeX without the dollars; breaks are where TeX puts them, and after commas."""
        return "".join(t.latex for t in self.tokens)

    @property
    def mathml(self) -> str:
        """The inside of one MathML row."""
        return "".join(t.mathml for t in self.tokens)

    @property
    def chunks(self) -> list[str]:
        """The MathML in the pieces between which a line may break."""
        out: list[list[str]] = [[]]
        for token in self.tokens:
            if token.role in ("bin", "rel") and out[-1]:
                out.append([])
            out[-1].append(token.mathml)
            if token.role == "comma":
                out.append([])
        return ["".join(part) for part in out if part]


def _mark(latex: str, mathml: str, role: str = "ord") -> Math:
    return Math((Token(latex, mathml, role),))


def _word(word: str) -> tuple[str, str]:
    if word in GREEK:
        return f"\\{_COMMAND.get(word, word)} ", f"<mi>{GREEK[word]}</mi>"
    if word.isdigit():
        return word, f"<mn>{word}</mn>"
    if len(word) == 1:
        return word, f"<mi>{escape(word)}</mi>"
    return f"\\mathit{{{_safe(word)}}}", f'<mi mathvariant="italic">{escape(word)}</mi>'


def _safe(word: str) -> str:
    return "".join({"_": "\\_", "#": "\\#", "%": "\\%", "&": "\\&"}.get(ch, ch) for ch in word)


def name(base: str, index: str = "") -> Math:
    """A symbol with an index: `name("theta", "3s1")`."""
    latex, mathml = _word(base)
    if not index:
        return _mark(latex, mathml)
    kind = "mn" if index.isdigit() else "mi"
    style = ' mathvariant="normal"' if kind == "mi" and len(index) == 1 and index != "s" else ""
    shown = index.replace("-", "−")
    sub = _safe(index)
    return _mark(
        f"{latex.strip()}_{{{sub}}}",
        f"<msub>{mathml}<{kind}{style}>{escape(shown)}</{kind}></msub>",
    )


def number(value: float) -> Math:
    """A positive number: whole, a simple fraction, a root of 2 or 3, else six digits."""
    for label, size in (("", 1.0), ("2", 2.0**0.5), ("3", 3.0**0.5)):
        for below in (1, 2, 3, 4, 6):
            above = value / size * below
            if abs(above - round(above)) < 1e-12 and 0 < round(above) < 1000000:
                return _ratio(round(above), label, below)
    shown = f"{value:.6g}"
    if "e" in shown:
        mantissa, exponent = shown.split("e")
        return _mark(
            f"{mantissa}\\cdot 10^{{{int(exponent)}}}",
            f"<mn>{mantissa}</mn><mo>·</mo><msup><mn>10</mn><mn>{int(exponent)}</mn></msup>",
        )
    return _mark(shown, f"<mn>{shown}</mn>")


def decimal(digits: str) -> Math:
    """A positive number as it is written."""
    return _mark(digits, f"<mn>{digits}</mn>")


def _ratio(above: int, root: str, below: int) -> Math:
    top = _mark(str(above), f"<mn>{above}</mn>") if above != 1 or not root else Math(())
    if root:
        top = top + radical(_mark(root, f"<mn>{root}</mn>"))
    if below == 1:
        return top
    return fraction(top, _mark(str(below), f"<mn>{below}</mn>"), small=True)


def plus() -> Math:
    """+"""
    return _mark("+", '<mo form="infix">+</mo>', "bin")


def minus(*, sign: bool = False) -> Math:
    """- between terms, or as a sign before the first one."""
    if sign:
        return _mark("-", '<mo form="prefix">−</mo>')
    return _mark("-", '<mo form="infix">−</mo>', "bin")


def operator(latex: str, mark: str) -> Math:
    """Another operator between two terms, such as plus-minus."""
    return _mark(latex, f'<mo form="infix">{mark}</mo>', "bin")


def relation(latex: str = "=", mark: str = "=") -> Math:
    """=, or another relation."""
    return _mark(latex, f'<mo form="infix">{mark}</mo>', "rel")


def comma() -> Math:
    """, in a list of arguments"""
    return _mark(",\\penalty150\\,", "<mo>,</mo>", "comma")


def dots() -> Math:
    """What is left out of a product."""
    return _mark("\\cdots ", "<mo>⋯</mo>")


def close(mark: str = ")", *, tall: bool = False) -> Math:
    """A closing parenthesis."""
    return _mark(f"\\Bigr{mark}" if tall else mark, _fence(mark, "postfix", tall=tall))


def _fence(mark: str, form: str, *, tall: bool) -> str:
    size = ' stretchy="true" symmetric="true" minsize="2.1em"' if tall else ' stretchy="false"'
    return f'<mo{size} form="{form}">{mark}</mo>'


def group(inside: Math, marks: str = "()") -> Math:
    """Parentheses or brackets around a formula, larger ones around fractions."""
    tall = any("\\frac" in token.latex for token in inside.tokens)
    first = _mark(f"\\Bigl{marks[0]}" if tall else marks[0], _fence(marks[0], "prefix", tall=tall))
    return first + inside + close(marks[1], tall=tall)


def space() -> Math:
    """A thin space between factors."""
    return _mark("\\,", '<mspace width="0.14em"/>')


def text(words: str) -> Math:
    """Upright words."""
    return _mark(
        f"\\text{{{_safe(words)}}}", f"<mtext>{escape(words.replace(' ', chr(160)))}</mtext>"
    )


def function(word: str, *arguments: Math) -> Math:
    """atan2(y, x) and the like."""
    head = _mark(f"\\operatorname{{{word}}}", f"<mi>{word}</mi>")
    inside = arguments[0]
    for argument in arguments[1:]:
        inside = inside + comma() + argument
    return head + group(inside)


def radical(inside: Math) -> Math:
    """A square root."""
    return _mark(f"\\sqrt{{{inside.latex}}}", f"<msqrt>{inside.mathml}</msqrt>")


def fraction(above: Math, below: Math, *, small: bool = False) -> Math:
    """One over the other; `small` for numbers."""
    command = "tfrac" if small else "frac"
    return _mark(
        f"\\{command}{{{above.latex}}}{{{below.latex}}}",
        f"<mfrac><mrow>{above.mathml}</mrow><mrow>{below.mathml}</mrow></mfrac>",
    )


def power(base: Math, exponent: int) -> Math:
    """A whole power."""
    if exponent == 1:
        return base
    shown = str(exponent).replace("-", "−")
    only = base.tokens[0] if len(base.tokens) == 1 else None
    if only is not None and only.mathml.startswith("<msub>"):
        inside = only.mathml.removeprefix("<msub>").removesuffix("</msub>")
        return _mark(f"{only.latex}^{{{exponent}}}", f"<msubsup>{inside}<mn>{shown}</mn></msubsup>")
    return _mark(
        f"{{{base.latex}}}^{{{exponent}}}",
        f"<msup><mrow>{base.mathml}</mrow><mn>{shown}</mn></msup>",
    )


def join(parts: Iterable[Math], between: Math | None = None) -> Math:
    """The parts one after the other."""
    out = Math(())
    for i, part in enumerate(parts):
        out = out + (between if i and between is not None else Math(())) + part
    return out
