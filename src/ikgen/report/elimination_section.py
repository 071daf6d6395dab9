"""The section of arms that no rule solves: the elimination for any six joints."""

from __future__ import annotations

from collections.abc import Sequence

from ikgen.formulas import mathtext as m
from ikgen.formulas.mathtext import Math
from ikgen.report.document import Block, Formulas, Paragraph

__all__ = ["elimination_section"]


_SLIDE = (
    "Of this arm one joint slides. The loop is begun so that this is its first joint or its second, "
    "where its length to the powers 0, 1 and 2 takes the place of 1, cosine and sine of an angle, and "
    "is eliminated like them."
)
_BOTH = (
    "Of this arm the twelve equations have the same rank at every angle, at solutions as elsewhere. "
    "Multiplied by the fifth angle's exponential as well they are 24 in sixteen monomials, and lose "
    "rank at solutions alone. Times their pseudo-inverse at an angle where they have full rank they "
    "are a square matrix with 32 roots; those at which the 24 keep their rank are left out."
)
_TWO_SLIDES = (
    "No unknown of this arm can be solved alone. Slides leave rotations alone: the rotation of the "
    "four revolute joints leaves one angle free, which is hidden. The opposite angle has two values, "
    "from its cosine, and the two between follow. The lengths of the slides are eliminated by the "
    "triple product g of their directions and of the displacement of the closed loop without them. "
    "With h = 1 − m², m the cosine between the axes beside the hidden one, the product of h and of "
    "both values of g is a trigonometric polynomial of degree 4 in the hidden angle: at most 8 "
    "solutions (Raghavan and Roth, 1993), those on the unit circle being real. Newton steps sharpen "
    "each, and forward kinematics decides. Which angle is hidden was chosen by trying all four on "
    "configurations of this arm."
)
_THREE_SLIDES = (
    "Slides leave rotations alone: the rotation gives the three angles, two solutions at most, the "
    "middle one from its cosine. The position is linear in the lengths of the three slides. Newton "
    "steps sharpen each solution, and forward kinematics decides."
)
_COUPLED = (
    "One joint of this arm turns several axes. Its angle is hidden: for a value of it the loop of the"
    " other five joints closes only where twelve equations without three of their angles are "
    "singular, those of Raghavan and Roth (1990), with the coupled axes in the links behind the "
    "second, third and fourth of the five. The determinant is a trigonometric polynomial of degree "
    "{degree} in that angle, which was measured on this arm; its roots on the unit circle are real. "
    "The null vector gives two of the other angles, linear equations two more, the pose the last; "
    "Newton steps sharpen each solution, and forward kinematics decides. Where the loop begins, and "
    "in which direction it is read, was chosen by trying all ways on configurations of this arm."
)
_SHARED = (
    "Of this arm {share} solutions have each value of that angle in common, and the twelve equations lose "
    "as much rank there: {size} sums of them, and as many of their unknowns, have the determinant meant, "
    "with simple roots, some of which are no solutions. In place of the null vector three sums of the six "
    "equations behind give the one angle, as roots of degree 3, and the largest of the six the other."
)
_PARALLEL = (
    "Two axes of this arm are parallel. An elimination about these is tried first: the directions of the "
    "axes beside, and the way from one to the other, turn with the two angles that are left. Products of "
    "these with the parallel axes' direction are constants, as is the parallel axes' distance: two "
    "equations in both angles, which meet in the roots of one polynomial, of degree 4 or 8. The other "
    "angles follow in closed form. A pose whose roots are not clearly real or not is left to what follows."
)


def elimination_section(
    slides: int = 0,
    order: Sequence[str] = (),
    *,
    parallel: bool = False,
    coupled: int = 0,
    both: bool = False,
    share: int = 1,
) -> list[Block]:
    """The elimination of six joints of which some slide, in words and equations; `order` names the joints
    as this arm's loop reads them; `parallel`: an elimination about two parallel axes comes first;
    `coupled`: the degree in the angle of a joint that turns several axes, 0 where none does; `both`: by
    half angles of both angles beside the hidden one; `share`: how many solutions have an angle of the
    coupled joint in common."""
    if coupled:
        more = [_SHARED.format(share=share, size=13 - share)] * (share > 1)
        return [Paragraph((text,)) for text in (_COUPLED.format(degree=coupled), *more)]
    if slides >= 2:
        return [Paragraph((_TWO_SLIDES if slides == 2 else _THREE_SLIDES,))]
    first = [Paragraph((_PARALLEL,))] if parallel else []
    read = f"The loop of this arm reads its joints in the order {', '.join(order)}."
    words = [_BOTH] * both + [read] * bool(order) + [_SLIDE] * bool(slides)
    ways = 24 if not slides else 4 if both else 8
    return [*first, *_revolute(ways), *(Paragraph((text,)) for text in words)]


def _revolute(ways: int) -> list[Block]:
    """Raghavan and Roth's elimination, in words and in its three equations; in how many `ways` a loop is
    written."""
    return [
        Paragraph((
            "No unknown of this arm can be solved alone. Its six angles come from the "
            "elimination of "
            "Raghavan and Roth (1993), written with ", m.name("z", "i"), " for the "
            "complex exponential "
            "of the angle ", m.name("theta", "i"), ". The closed loop of the six joints "
            "is regrouped, "
            "three matrices to the left and three to the right:",
        )),
        Formulas((_loop(),)),
        Paragraph((
            "The last angle is not in columns 3 and 4 of it (l and p). The 14 "
            "combinations of these "
            "that stay bilinear, p, l, p·p, p·l, p×l and (p·p) l − 2 (p·l) p, are "
            "linear in the "
            "8 monomials of ", m.name("theta", "1"), " and ", m.name("theta", "2"), ": "
            "six equations "
            "without them are left. Multiplied by ", m.name("z", "4"), " they make "
            "twelve equations "
            "in the twelve monomials of ", m.name("z", "4"), " and ", m.name("z", "5"), ":",
        )),
        Formulas((_system(),)),
        Paragraph((
            "Its determinant has degree 16 in ", m.name("z", "3"), ": at most 16 "
            "solutions, those on "
            "the unit circle being real. The null vector gives ", m.name("z", "4"), " and ",
            m.name("z",
            "5"), ", linear equations ", m.name("z", "1"), " and ", m.name("z", "2"),
            ", the pose ", m.name("z", "6"), "; Newton steps sharpen each, and forward "
            "kinematics "
            "decides. Which angle is hidden, and in which direction the loop is read, "
            f"was chosen by trying all {ways} ways on configurations of this arm.",
        )),
    ]  # fmt: skip


def _loop() -> Math:
    def matrix(i: int, inverse: bool = False) -> Math:
        b = m.name("B", str(i))
        return m.power(b, -1) if inverse else b

    left = m.join([matrix(3), matrix(4), matrix(5)], m.space())
    right = m.join([matrix(2, True), matrix(1, True), m.name("T"), matrix(6, True)], m.space())
    return left + m.relation() + right


def _system() -> Math:
    z = m.name("z", "3")
    return (
        m.name("M")
        + m.group(z)
        + m.space()
        + m.name("v")
        + m.relation()
        + m.name("0")
        + m.comma()
        + m.function("det", m.name("M"))
        + m.relation()
        + m.name("0")
    )
