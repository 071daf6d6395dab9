"""Solve a chain: rounds of transforms, leaves and ranking until every joint is known."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ikgen.equations.build import EquationSet
from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.solver.candidate import Candidate
from ikgen.solver.leaves import LEAVES
from ikgen.solver.ranker import judge, rank_key
from ikgen.solver.transforms import square_and_add, substitution
