"""What is proved of a derivation, for every pose and not only for those tried."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

from ikgen.kinematics.whole_turns import most_parts
from ikgen.solver.solution_graph import SolutionGraph
from ikgen.symbolic.form_proofs import FormProof, kinds_of, prove_form
from ikgen.symbolic.identities import Identity, prove_identities
from ikgen.symbolic.trig_polynomial_root import MOST_DEGREE

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation

__all__ = ["Proof", "prove"]

Parts: TypeAlias = tuple[Identity, ...] | tuple[FormProof, ...]


@dataclass(frozen=True, slots=True)
class Proof:
    """`equations`: every matrix equation that was used holds for the pose of any joint values.
    `patterns`: so does every equation in one unknown that a form solves, with its coefficients.
    `forms`: each form's formula gives all solutions of its equation and nothing else, under the
    conditions named.

    Together: wherever no divisor vanishes, the joint values that made a pose are among the branches.
    `reason` says why there is nothing to prove. `deviation` (m, rad) is how far the file's own geometry
    is off the exact one that all this is about.
    """

    equations: tuple[Identity, ...] = ()
    patterns: tuple[Identity, ...] = ()
    forms: tuple[FormProof, ...] = ()
    reason: str = ""
    deviation: tuple[float, float] = (0.0, 0.0)

    @property
    def proved(self) -> bool:
        """Whether all of it is."""
        identities = all(one.proved for one in (*self.equations, *self.patterns))
        return not self.reason and identities and all(one.proved for one in self.forms)

    @property
    def wrong(self) -> bool:
        """Whether something was found not to hold."""
        return any(one.wrong for one in (*self.equations, *self.patterns))

    @property
    def words(self) -> str:
        """One line."""
        if self.reason:
            return f"not proved: {self.reason}"
        counts = [_count(self.equations, "equation"), _count(self.patterns, "solved equation")]
        counts.append(_count(self.forms, "form"))
        return f"{'proved' if self.proved else 'NOT ALL PROVED'}: {', '.join(counts)}"

    @property
    def remarks(self) -> tuple[str, ...]:
        """What could not be proved and why, one line each."""
        lines = [f"{one.label}: {one.reason}" for one in (*self.equations, *self.patterns)]
        lines += [f"form '{one.form}': {one.reason}" for one in self.forms]
        return tuple(dict.fromkeys(line for line in lines if not line.endswith(": ")))

    def to_dict(self) -> dict[str, Any]:
        """For --json."""
        parts: dict[str, Parts] = {
            "equations": self.equations,
            "solved_equations": self.patterns,
            "forms": self.forms,
        }
        counts = {
            name: {"proved": sum(one.proved for one in found), "total": len(found)}
            for name, found in parts.items()
        }
        conditions = {one.form: [str(c) for c in one.conditions] for one in self.forms}
        remarks = [self.reason] if self.reason else list(self.remarks)
        return {"proved": self.proved, **counts, "conditions": conditions, "remarks": remarks}


def prove(derivation: Derivation) -> Proof:
    """Prove a derivation in exact arithmetic: rational numbers, lengths as symbols, right angles and
    others whose cosines are square roots exactly, any other twist by its cosine and sine with `c^2 +
    s^2 = 1`."""
    if derivation.module.plan is not None:
        return Proof(
            reason="the elimination solves a polynomial in floating-point numbers; "
            "its rows are checked by forward kinematics, one by one"
        )
    parts = most_parts(derivation.graph.dh)
    if parts > MOST_DEGREE:
        return Proof(
            reason=f"gears make polynomials of degree {parts:,}, too long to be multiplied out; rows are "
            "checked by forward kinematics, one by one"
        )
    return prove_graph(derivation.graph)


def prove_graph(graph: SolutionGraph) -> Proof:
    """`prove` for a solution graph whose rules solve every joint."""
    matrix, patterns = prove_identities(graph)
    forms = [c.form for step in graph.steps for c in (step.candidate, *step.fallbacks)]
    kinds = dict.fromkeys((type(form), kinds_of(form)) for form in forms)
    proofs = tuple(dict.fromkeys(prove_form(*kind) for kind in kinds))
    return Proof(matrix, patterns, proofs, deviation=graph.dh.deviation)


def _count(parts: Parts, what: str) -> str:
    done = sum(part.proved for part in parts)
    return f"{done} of {len(parts)} {what}s"
