"""A Program and the facts of its arm as text of a language."""
