"""What the symbols of a derivation are called in SymPy."""

from __future__ import annotations

import sympy

from ikgen.algebra.polynomial import AngleCombination
from ikgen.equations.knowledge import Variable
from ikgen.model.dh import DHChain

__all__ = ["SymbolNames"]


class SymbolNames:
    """Symbols of a chain, all of them real: `theta_2`, `theta_23` for a sum of angles, `d_3` for a
    prismatic variable, `r_11` ... `p_z` for the pose of the last DH frame in frame 0, lengths and
    angles by name."""

    def __init__(self, dh: DHChain) -> None:
        self.dh = dh
        self._constants = {name: _real(name) for name in dh.named_constants()}

    def constant(self, name: str) -> sympy.Symbol:
        """A length or angle of the arm."""
        return self._constants[name]

    @property
    def constants(self) -> dict[str, sympy.Symbol]:
        """The constants of the whole chain by name."""
        return dict(self._constants)

    def pose(self, entry: str) -> sympy.Symbol:
        """An entry of the pose, "r11" or "px"."""
        return self._free(f"{entry[0]}_{entry[1:]}")

    def variable(self, variable: Variable) -> sympy.Symbol:
        """An unknown."""
        letter = "theta" if variable.kind == "angle" else "d"
        return self._free(f"{letter}_{self._places(variable.combination)}")

    def joint(self, joint: int) -> sympy.Symbol:
        """The DH variable of a joint (from 0)."""
        row = self.dh.lead_row(joint)
        unit = tuple(int(j == joint) for j in range(self.dh.dof))
        return self.variable(Variable("angle" if row.revolute else "prismatic", unit))

    def _places(self, combination: AngleCombination) -> str:
        used = [(j + 1, k) for j, k in enumerate(combination) if k]
        if all(k == 1 for _, k in used):
            return ("_" if len(combination) > 9 else "").join(str(j) for j, _ in used)
        words = (f"{'m' if k < 0 else 'p'}{abs(k) if abs(k) > 1 else ''}_{j}" for j, k in used)
        return "_".join(words)

    def _free(self, name: str) -> sympy.Symbol:
        """A symbol that no constant of the arm is called by."""
        while name in self._constants:
            name += "_"
        return _real(name)


def _real(name: str) -> sympy.Symbol:
    return sympy.Symbol(name, real=True)
