"""What tables of figures call classes and arms."""

from __future__ import annotations

__all__ = ["ARMS", "CLASSES", "RANDOM", "SOAKED"]

CLASSES = {
    "3 DOF": "3 joints",
    "4 DOF other": "4 joints, other",
    "4 SCARA (RRPR)": "SCARA",
    "6R general (no triple)": "6R, general",
    "6R offset wrist, 2||3 (CRX/Jaco/xArm)": "6R, offset wrist, axes 2 and 3 parallel",
    "6R spherical shoulder (legs)": "6R, spherical shoulder",
    "6R spherical wrist + ortho-parallel base (OPW)": "6R, spherical wrist and ortho-parallel base",
    "6R three parallel 2-4, offset wrist": "6R, axes 2-4 parallel, offset wrist",
    "6R three parallel 2-4, orthogonal wrist (UR)": "6R, axes 2-4 parallel, orthogonal wrist",
    "6R three parallel 2-4, orthogonal wrist": "6R, axes 2-4 parallel, orthogonal wrist",
    "coupled: mimic joints inside the chain": "coupled by mimic joints",
    "gantry (P P ..)": "gantry",
    "redundant >7R": "more than 7R",
    "redundant with prismatic": "redundant, with slides",
}
"""What the collection calls a class -> what the README calls it, where that is not the same with a comma
after the kinds of joints."""
RANDOM = {
    "3-6": "3 to 6, a quarter slides, right angles",
    "6R": "6R, any twists",
    "5R1P": "5R1P, any twists",
    "4R2P": "4R2P, any twists",
}
"""Classes of random tables -> what the README calls them."""
ARMS = {
    "IRB 2400": "ABB IRB 2400",
    "KR 6 R900": "KUKA KR 6 R900",
    "UR5e": "UR5e",
    "Panda": "Panda, joint 7 held",
    "WAM": "Barrett WAM, joint 3 held",
    "M1013": "Doosan M1013",
    "CRX-10iA": "FANUC CRX-10iA",
}
"""The arms of the comparison that the README shows, with its names for them."""

SOAKED = (
    "rows", "wrong", "random poses", "missed", "without a row",
    "beside singularities", "missed", "without a row",
)  # fmt: skip
"""What is counted of poses that were put through code."""
