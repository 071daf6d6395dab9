"""Expressions as a graph with values at probes, and polynomials over it."""
