"""Small changes of Python code, each of which some test should notice: what can be changed, and how.

The operators are those of mutation testing at large (DeMillo, Lipton and Sayward, "Hints on test data
selection", 1978; as in cosmic-ray and mutmut): other comparisons and operators, other constants, negated
conditions, statements left out. Left as they are: texts, annotations, imports, decorators, `__all__` and
what only type checkers read.
"""

from __future__ import annotations

import ast
import itertools
from dataclasses import dataclass

__all__ = ["CodeMutation", "code_mutations"]

_COMPARISONS: dict[type[ast.cmpop], tuple[str, ...]] = {
    ast.Lt: ("<=", ">"), ast.LtE: ("<", ">="), ast.Gt: (">=", "<"), ast.GtE: (">", "<="),
    ast.Eq: ("!=",), ast.NotEq: ("==",), ast.Is: ("is not",), ast.IsNot: ("is",),
    ast.In: ("not in",), ast.NotIn: ("in",),
}  # fmt: skip
_OPERATORS: dict[type[ast.operator], str] = {
    ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*", ast.FloorDiv: "*", ast.Mod: "*",
    ast.Pow: "*", ast.BitAnd: "|", ast.BitOr: "&",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class CodeMutation:
    """The change of `old`, from byte `start` of a module's text on, in line `line`, to `new`."""

    start: int
    line: int
    old: str
    new: str

    def applied(self, text: bytes) -> bytes:
        """The module's text with the change."""
        end = self.start + len(self.old.encode())
        if text[self.start : end] != self.old.encode():
            raise ValueError(f"line {self.line} has no {self.old!r}")
        return text[: self.start] + self.new.encode() + text[end:]


def code_mutations(text: bytes) -> list[CodeMutation]:
    """All of a module, by their place."""
    found = _Finder(text)
    found.visit(ast.parse(text))
    return sorted(found.mutations, key=lambda m: (m.start, m.old, m.new))


class _Finder(ast.NodeVisitor):
    """Collects the mutations of a module."""

    def __init__(self, text: bytes) -> None:
        self.mutations: list[CodeMutation] = []
        self._text = text
        self._lines = [0]
        for line in text.splitlines(keepends=True):
            self._lines.append(self._lines[-1] + len(line))

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        for default in (*node.args.defaults, *node.args.kw_defaults):
            if default is not None:
                self.visit(default)
        self._visit_all(node.body)

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        self._visit_all(node.body)

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        if node.value is not None:
            self.visit(node.value)

    def visit_Assign(self, node: ast.Assign) -> None:
        if not any(isinstance(t, ast.Name) and t.id == "__all__" for t in node.targets):
            self.generic_visit(node)

    def visit_If(self, node: ast.If) -> None:
        if not (isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"):
            self._negate(node.test)
            self.generic_visit(node)

    def visit_While(self, node: ast.While) -> None:
        self._negate(node.test)
        self.generic_visit(node)

    def visit_IfExp(self, node: ast.IfExp) -> None:
        self._negate(node.test)
        self.generic_visit(node)

    def visit_comprehension(self, node: ast.comprehension) -> None:
        for condition in node.ifs:
            self._negate(condition)
        self.generic_visit(node)

    def visit_Expr(self, node: ast.Expr) -> None:
        if isinstance(node.value, ast.Call):
            self._replace(node, "pass")
        self.generic_visit(node)

    def visit_Raise(self, node: ast.Raise) -> None:
        self._replace(node, "pass")

    def visit_AugAssign(self, node: ast.AugAssign) -> None:
        self._replace(node, "pass")
        self.generic_visit(node)

    def visit_Break(self, node: ast.Break) -> None:
        self._replace(node, "continue")

    def visit_Continue(self, node: ast.Continue) -> None:
        self._replace(node, "break")

    def visit_Compare(self, node: ast.Compare) -> None:
        sides = itertools.pairwise([node.left, *node.comparators])
        for sign, (left, right) in zip(node.ops, sides, strict=True):
            old = self._between(left, right).strip("() \n\t")
            for new in _COMPARISONS[type(sign)]:
                self._replace_between(left, right, old, new)
        self.generic_visit(node)

    def visit_BinOp(self, node: ast.BinOp) -> None:
        new = _OPERATORS.get(type(node.op))
        if new is not None and not _is_type(node):
            self._replace_between(node.left, node.right, self._sign(node.left, node.right), new)
        self.generic_visit(node)

    def visit_BoolOp(self, node: ast.BoolOp) -> None:
        old, new = ("and", "or") if isinstance(node.op, ast.And) else ("or", "and")
        for left, right in itertools.pairwise(node.values):
            self._replace_between(left, right, old, new)
        self.generic_visit(node)

    def visit_UnaryOp(self, node: ast.UnaryOp) -> None:
        if isinstance(node.op, ast.USub | ast.Not):
            self._replace(node, ast.unparse(node.operand), parentheses=True)
        self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> None:
        if isinstance(node.value, bool):
            self._replace(node, str(not node.value))
        elif isinstance(node.value, int):
            self._replace(node, str(node.value + 1))
        elif isinstance(node.value, float):
            self._replace(node, repr(node.value + 1.0))

    def visit_JoinedStr(self, node: ast.JoinedStr) -> None:
        """Texts stay."""

    def _visit_all(self, nodes: list[ast.stmt]) -> None:
        for node in nodes:
            self.visit(node)

    def _negate(self, test: ast.expr) -> None:
        if not isinstance(test, ast.Compare | ast.UnaryOp):  # those are negated by their operators
            self._replace(test, f"not ({self._of(test)})")

    def _replace(self, node: ast.stmt | ast.expr, new: str, *, parentheses: bool = False) -> None:
        old = self._of(node)
        self._add(self._start(node), node.lineno, old, f"({new})" if parentheses else new)

    def _replace_between(self, left: ast.expr, right: ast.expr, old: str, new: str) -> None:
        end = self._end(left)
        place = self._text.index(old.encode(), end, self._start(right))
        line = left.end_lineno
        assert line is not None
        self._add(place, line, old, new)

    def _add(self, start: int, line: int, old: str, new: str) -> None:
        self.mutations.append(CodeMutation(start, line, old, new))

    def _sign(self, left: ast.expr, right: ast.expr) -> str:
        return "".join(c for c in self._between(left, right) if c in "+-*/%&|")

    def _between(self, left: ast.expr, right: ast.expr) -> str:
        lines = self._text[self._end(left) : self._start(right)].decode().splitlines()
        return "\n".join(line.split("#")[0] for line in lines)

    def _of(self, node: ast.stmt | ast.expr) -> str:
        return self._text[self._start(node) : self._end(node)].decode()

    def _start(self, node: ast.stmt | ast.expr) -> int:
        return self._lines[node.lineno - 1] + node.col_offset

    def _end(self, node: ast.stmt | ast.expr) -> int:
        assert node.end_lineno is not None and node.end_col_offset is not None
        return self._lines[node.end_lineno - 1] + node.end_col_offset


def _is_type(node: ast.BinOp) -> bool:
    """Whether it may be a union of types, as in `isinstance` and in aliases."""
    return isinstance(node.op, ast.BitOr) and all(
        isinstance(n, ast.Name | ast.Attribute | ast.BinOp | ast.Subscript)
        or (isinstance(n, ast.Constant) and n.value is None)
        for n in (node.left, node.right)
    )
