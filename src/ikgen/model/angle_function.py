"""Cosines and sines of constant angles, which are constants of an arm like its lengths."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

__all__ = ["AngleFunction", "cosine_and_sine"]


@dataclass(frozen=True, slots=True)
class AngleFunction:
    """The cosine or sine of the constant angle with the symbol `angle` (`alpha_2`)."""

    function: Literal["cos", "sin"]
    angle: str

    @property
    def name(self) -> str:
        """The constant's name: `cos_alpha_2`. Others may have names that look the same, so what a
        constant stands for is never read from its name."""
        return f"{self.function}_{self.angle}"


def cosine_and_sine(angle: str) -> tuple[AngleFunction, AngleFunction]:
    """Both functions of an angle."""
    return AngleFunction("cos", angle), AngleFunction("sin", angle)
