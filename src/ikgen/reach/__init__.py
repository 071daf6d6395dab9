"""Maps of what an arm reaches: solved over a grid of positions and directions."""
