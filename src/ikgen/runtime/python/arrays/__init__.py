"""Arrays, vectors and rigid motions: what knows nothing of arms."""
