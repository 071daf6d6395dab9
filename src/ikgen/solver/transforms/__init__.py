"""Transforms make equations with fewer unknowns out of pairs of equations (IKBT, section 3.1)."""
