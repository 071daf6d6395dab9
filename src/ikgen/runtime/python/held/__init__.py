"""Held joints: their values at which a pose is reached, branches over them, searches."""
