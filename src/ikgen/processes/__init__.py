"""Processes and the folders that they work in: ended and removed however ikgen ends."""
