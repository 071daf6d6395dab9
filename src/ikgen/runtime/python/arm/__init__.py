"""What the runtime is told about one arm: its chain, what of a pose counts, limits, what is held."""
