"""What is odd in a description that could be read anyway."""

from __future__ import annotations

from enum import Enum

__all__ = ["Oddity", "OddityKind"]


class OddityKind(Enum):
    """What follows from an oddity: nothing but its words; that its joint can be locked; that a pose has
    infinitely many solutions."""

    TOLD = "told"
    LOCKABLE = "lockable"
    ENDLESS = "endless"


class Oddity(str):
    """One line for the user. `joint`: the name of the joint that it is about ("": no single one)."""

    __slots__ = ("joint", "kind")
    joint: str
    kind: OddityKind

    def __new__(cls, text: str, joint: str = "", kind: OddityKind = OddityKind.TOLD) -> Oddity:
        """The text, and what decisions go by."""
        made = super().__new__(cls, text)
        made.joint, made.kind = joint, kind
        return made
