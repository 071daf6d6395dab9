"""Rows near singularities: where two meet, where a continuum was, and at joint limits."""
