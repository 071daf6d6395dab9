"""The Python module."""
