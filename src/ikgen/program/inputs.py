"""What a Program is handed, by kind; its statements read each by its name."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["ArmAngle", "HeldValue", "Input", "PoseEntry", "SeedValue"]


@dataclass(frozen=True, slots=True)
class PoseEntry:
    """An entry of the pose of the tip in the base, counted from 0; column 3 is the position (m)."""

    row: int
    column: int

    @property
    def name(self) -> str:
        """t03, ..."""
        return f"t{self.row}{self.column}"


@dataclass(frozen=True, slots=True)
class SeedValue:
    """The value (rad or m) that a joint takes where the pose leaves it free."""

    joint: int

    @property
    def name(self) -> str:
        """seed_q1, ... for joint 0, ..."""
        return f"seed_q{self.joint + 1}"


@dataclass(frozen=True, slots=True)
class HeldValue:
    """The value (rad or m) of a held joint."""

    joint: int

    @property
    def name(self) -> str:
        """held_q7, ... for joint 6, ..."""
        return f"held_q{self.joint + 1}"


@dataclass(frozen=True, slots=True)
class ArmAngle:
    """The arm angle (rad) where that is held; it comes after the held joints."""

    @property
    def name(self) -> str:
        """arm_angle"""
        return "arm_angle"


Input = PoseEntry | SeedValue | HeldValue | ArmAngle
