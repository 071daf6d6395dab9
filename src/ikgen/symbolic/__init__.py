"""A derivation in SymPy: solutions and equations to read and to change, and exact proofs of them.

SymPy is imported with this package, and nowhere else; nothing else of ikgen imports it unless asked to.
"""

from __future__ import annotations

from ikgen.errors import MissingToolError

try:
    import sympy as _sympy  # noqa: F401
except ImportError as error:
    raise MissingToolError(
        "symbolic views and proofs need SymPy", hint="pip install 'ikgen[symbolic]'"
    ) from error

from ikgen.symbolic.joint_solutions import Branch, solutions
from ikgen.symbolic.matrix_equations import equations
from ikgen.symbolic.proof import Proof, prove
from ikgen.symbolic.sympy_leaf import sympy_leaf

__all__ = ["Branch", "Proof", "equations", "prove", "solutions", "sympy_leaf"]
