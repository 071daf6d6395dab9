"""Real roots of trigonometric polynomials."""
