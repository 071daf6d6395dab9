"""Six joints without a closed form by rules: one angle hidden in a resultant, and the others from it."""
