"""Expressions as a reader would write them: sums of products in textbook notation, as LaTeX or MathML."""
