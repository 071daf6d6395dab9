"""ikgen: verified, closed-form inverse kinematics code from a robot description.

>>> import ikgen
>>> arm = ikgen.load("robot.urdf")
>>> found = arm.solve(arm.forward([0.1] * arm.dof))
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ikgen.errors import (
        ArgumentError,
        BadDescriptionError,
        IkgenError,
        MissingToolError,
        PlugInError,
        UnknownNameError,
        UnsolvedChainError,
        UnsupportedJointError,
        UsageError,
        VerificationError,
    )
    from ikgen.library.compilation import compile
    from ikgen.library.load import load
    from ikgen.library.loaded_arm import Arm

__version__ = "0.1.0"

__all__ = [
    "ArgumentError",
    "Arm",
    "BadDescriptionError",
    "IkgenError",
    "MissingToolError",
    "PlugInError",
    "UnknownNameError",
    "UnsolvedChainError",
    "UnsupportedJointError",
    "UsageError",
    "VerificationError",
    "__version__",
    "compile",
    "load",
]

_PLACES = {
    "Arm": "ikgen.library.loaded_arm",
    "compile": "ikgen.library.compilation",
    "load": "ikgen.library.load",
}


def __getattr__(name: str) -> Any:
    """What the package offers, imported when it is asked for (PEP 562): `ikgen --help` needs none of it."""
    if name not in __all__:
        raise AttributeError(f"module 'ikgen' has no attribute '{name}'")
    from importlib import import_module

    value = getattr(import_module(_PLACES.get(name, "ikgen.errors")), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
