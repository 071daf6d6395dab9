"""Frozen dataclasses that the stages hand to each other, and nothing else."""
