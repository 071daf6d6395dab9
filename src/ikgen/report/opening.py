"""The report's opening: the robot, its DH table and its forward kinematics."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

import numpy as np

from ikgen.emit.derivation import Reading
from ikgen.equations.symbolic_transforms import link, multiply
from ikgen.formulas import mathtext as m
from ikgen.formulas.mathtext import Math
from ikgen.formulas.normal_form import Symbol
from ikgen.formulas.normalizer import Normalizer
from ikgen.formulas.notation import show, symbol
from ikgen.kinematics.kept import kept_constants
from ikgen.model.arrays import Array
from ikgen.model.dh import Angle, DHChain, DHRow, Length
from ikgen.model.joint_tree import Source
from ikgen.report.document import Block, Formulas, Heading, Matrix, Paragraph, Rows, Text
from ikgen.solver.solution_graph import SolutionGraph
from ikgen.tasks import Task

__all__ = ["forward_section", "robot_section"]

_MOST_WRITTEN = 900
"""Symbols in all entries of the pose together, above which they are not written out."""


def robot_section(reading: Reading, task: Task) -> list[Block]:
    """The table of the robot, its constants and what was made of the file's."""
    dh = reading.dh
    blocks: list[Block] = [Heading(("Robot",), anchor="robot"), _table(dh)]
    if dh.free or dh.locked:
        held = [f"{name} is held free: its value is given with the pose" for name in dh.free]
        held += [f"{name} is locked at {value:g}" for name, value in dh.locked]
        blocks.append(Paragraph(("; ".join(held) + ".",)))
    values = _parameters(dh)
    if values:
        blocks.append(values)
    blocks += [Paragraph((f"Note: {w}.",), note=True) for w in _warnings(reading.source)]
    blocks += _ends(dh, task)
    return blocks + _kept(dh) + _snaps(dh)


def _warnings(source: Source) -> list[str]:
    """What was odd in the file, named without its folder: the report is the same wherever that lies."""
    return [warning.replace(str(source.path), source.path.name) for warning in source.warnings]


def _table(dh: DHChain) -> Rows:
    header = (
        "joint",
        "name",
        m.name("alpha", "i-1"),
        m.name("a", "i-1"),
        m.name("d", "i"),
        m.name("theta", "i"),
    )
    rows = tuple(
        (
            (str(i),), (row.name,), (_angle(row.alpha),), (_length(row.a),),
            (_d(dh, row),), (_theta(dh, row),),
        )
        for i, row in enumerate(dh.rows, start=1)
    )  # fmt: skip
    return Rows(
        tuple((h,) for h in header),
        rows,
        "Denavit-Hartenberg parameters, modified convention (Craig)",
    )


def _angle(a: Angle) -> Math:
    if a.exact is None:
        return symbol(Symbol("param", a.name or "alpha"))
    return _turns(a.exact)


def _turns(x: Fraction) -> Math:
    """A multiple of pi."""
    if not x:
        return m.name("0")
    top = m.name("pi") if abs(x.numerator) == 1 else m.number(abs(x.numerator)) + m.name("pi")
    size = top if x.denominator == 1 else m.fraction(top, m.number(x.denominator), small=True)
    return m.minus(sign=True) + size if x < 0 else size


def _length(a: Length) -> Math:
    if a.name is None:
        return m.name("0")
    s = symbol(Symbol("param", a.name))
    return m.minus(sign=True) + s if a.sign < 0 else s


def _driven(dh: DHChain, row: DHRow, letter: str) -> Math:
    """The row's variable by that of its joint."""
    ratio, shift = dh.follows(row)
    v = m.name(letter, str(row.driver + 1))
    return _linear([(ratio, v)], shift, turns=row.revolute)


def _d(dh: DHChain, row: DHRow) -> Math:
    return _length(row.d) if row.revolute else _driven(dh, row, "d")


def _theta(dh: DHChain, row: DHRow) -> Math:
    return _driven(dh, row, "theta") if row.revolute else _angle(row.theta)


def _parameters(dh: DHChain) -> Rows | None:
    """The numbers of the named constants, and how joint values become variables of the table."""
    values = dh.named_constants(offsets=False)  # offsets are written as numbers
    if not values:
        return None
    cells = tuple(
        ((symbol(Symbol("param", n)),), ("symbolic" if n in dh.symbols else f"{v:.6g}",))
        for n, v in values.items()
    )
    return Rows((("constant",), ("value (m, rad)",)), cells, "Constants of the arm")


def _ends(dh: DHChain, task: Task) -> list[Block]:
    """Base and tool transforms, and the joints whose values are not the table's variables."""
    out: list[Block] = []
    for letter, T in (("B", dh.X_base), ("E", dh.X_tip)):
        if not np.array_equal(T, np.eye(4)):
            out.append(Matrix(m.name(letter), _numbers(T)))
    if out:
        pose = (
            "that of the table's last frame in frame 0: the constant transforms of base and tool "
            "(B, E) are taken off the given pose first."
            if task.whole_pose
            else "that of the tool in frame 0: the constant transform of the base (B) is taken off the "
            "given pose first, that of the tool (E) ends the chain, since the task does not read "
            "the whole pose."
        )
        out.insert(0, Paragraph((f"The pose in what follows is {pose}",)))
    leads = [dh.lead_row(joint) for joint in range(dh.dof)]
    lines = [_conversion(row) for row in leads if row.scale != 1.0 or row.offset.value]
    if lines:
        out += [
            Paragraph(("The variables of the table from the joint values q:",)),
            Formulas(tuple(lines)),
        ]
    return out + _motors(dh)


def _motors(dh: DHChain) -> list[Block]:
    """How motors move the joints, where several move one."""
    if dh.transmission is None:
        return []
    lines = []
    rows = zip(dh.transmission.matrix.tolist(), dh.transmission.offset.tolist(), strict=True)
    for place, (row, c) in enumerate(rows, start=1):
        terms = [(k, m.name("m", str(j))) for j, k in enumerate(row, start=1) if k]
        lines.append(m.name("q", str(place)) + m.relation() + _linear(terms, c))
    text = (
        "The joint values q from the motors' values m, which the emitted code takes and gives; all else "
        "here, limits too, is of the joints:"
    )
    return [Paragraph((text,)), Formulas(tuple(lines))]


def _linear(terms: Sequence[tuple[float, Math]], constant: float, *, turns: bool = False) -> Math:
    """A sum of multiples and a number; that as a multiple of pi where it `turns` and is one of pi/12."""
    out = Math(())
    for k, what in [*terms, *([(constant, Math(()))] if constant else [])]:
        sign = m.minus(sign=not out.tokens) if k < 0 else m.plus() if out.tokens else Math(())
        bare = not what.tokens
        size = m.number(abs(k)) if bare or abs(k) != 1.0 else Math(())
        part = Fraction(round(12.0 * abs(k) / math.pi), 12)
        if bare and turns and math.isclose(abs(k), float(part) * math.pi, rel_tol=1e-15):
            size = _turns(part)
        gap = m.space() if size.tokens and not bare else Math(())
        out = out + sign + size + gap + what
    return out


def _conversion(row: DHRow) -> Math:
    """A joint's variable by its value, of the row that leads it."""
    letter, place = "theta" if row.revolute else "d", str(row.driver + 1)
    right = _linear([(row.scale, m.name("q", place))], row.offset.value, turns=row.revolute)
    return m.name(letter, place) + m.relation() + right


def _numbers(T: Array) -> tuple[tuple[Math, ...], ...]:
    def one(x: float) -> Math:
        if abs(x) < 1e-15:
            return m.name("0")
        return m.minus(sign=True) + m.number(-x) if x < 0 else m.number(x)

    return tuple(tuple(one(float(x)) for x in row) for row in T)


def _kept(dh: DHChain) -> list[Block]:
    """Constants that the closed form takes as the file rounds them."""
    kept = kept_constants(dh)
    if not kept:
        return []
    rows: tuple[tuple[Text, ...], ...] = tuple(
        ((symbol(Symbol("param", s.what)),), (s.texts[0],), (s.texts[1],)) for s in kept
    )
    text = (
        "The closed form does not need the exact value of these: cosine and sine of such an angle are "
        "constants like others."
    )
    header: tuple[Text, ...] = (("constant",), ("in the file",), ("meant",))
    return [Rows(header, rows, "Constants kept as in the file"), Paragraph((text,))]


def _snaps(dh: DHChain) -> list[Block]:
    if not dh.snaps:
        return []
    rows: tuple[tuple[Text, ...], ...] = tuple(
        ((s.what,), (s.texts[0],), (s.texts[1],)) for s in dh.snaps
    )
    text = (
        f"The file's numbers were taken for exact ones: its forward kinematics differs from "
        f"that of the table by at most {dh.deviation[0]:.1e} m and {dh.deviation[1]:.1e} rad. The "
        "emitted code ends with Newton steps on the file's own chain: its answers are the file's."
    )
    header: tuple[Text, ...] = (("constant",), ("in the file",), ("taken as",))
    return [Rows(header, rows, "Constants made exact"), Paragraph((text,))]


def forward_section(graph: SolutionGraph, normal: Normalizer) -> list[Block]:
    """The pose, and what the table makes of it."""
    system = graph.workspace().equations
    g, n = system.graph, system.n
    T = multiply(g, link(system.variables, 0), system.right(0, n))
    pose = [[m.name("r", f"{i}{j}") for j in (1, 2, 3)] for i in (1, 2, 3)]
    rows = [(*pose[i], m.name("p", "xyz"[i])) for i in range(3)]
    rows.append(tuple(m.name(x) for x in "0001"))
    left = m.name("T", "d")
    sums = [*(normal(T.R[i][j]) for j in range(3) for i in range(3)), *map(normal, T.p)]
    if sum(s.weight for s in sums) > _MOST_WRITTEN:
        return _unwritten(Matrix(left, tuple(rows)), n)
    entries = [*(pose[i][j] for j in range(3) for i in range(3)), *(row[3] for row in rows[:3])]
    lines = [a + m.relation() + show(s) for a, s in zip(entries, sums, strict=True)]
    words = (
        "The desired pose, and its entries by the table. ",
        m.name("c", "i"), " and ", m.name("s", "i"), " are cosine and sine of ", m.name("theta", "i"),
        *_sums_words(graph.dh),
    )  # fmt: skip
    return [
        Heading(("Forward kinematics",), anchor="forward"),
        Paragraph(words),
        Matrix(left, tuple(rows)),
        Formulas(tuple(lines)),
    ]


def _sums_words(dh: DHChain) -> Text:
    """How sums of angles are written, for an arm where some come up: the first pair of parallel axes."""
    pairs = [
        i
        for i, (one, two) in enumerate(pairwise(dh.rows), start=1)
        if one.revolute and two.revolute and two.alpha.exact == 0
    ]
    if not pairs:
        return (".",)
    first, second = str(pairs[0]), str(pairs[0] + 1)
    total = m.name("theta", first) + m.plus() + m.name("theta", second)
    words = "; angles of parallel axes come as sums: "
    return (words, m.name("theta", first + second) + m.relation() + total, ".")


def _unwritten(pose: Matrix, n: int) -> list[Block]:
    """Forward kinematics whose entries are too long to be read: the product alone."""
    factors = [m.name("A", str(i)) for i in range(1, n + 1)]
    return [
        Heading(("Forward kinematics",), anchor="forward"),
        Paragraph((
            "The desired pose is the product of the matrices of the table's rows (below); without "
            "parallel axes and right angles its entries are too long to be written out.",
        )),
        pose,
        Formulas((pose.name + m.relation() + m.join(factors, m.space()),)),
    ]  # fmt: skip
