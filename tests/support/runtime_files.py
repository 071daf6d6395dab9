"""The runtime's own files, as the emitters name them."""

from ikgen.emit.cpp.header_bundle import RUNTIME

__all__ = ["HEADERS", "MODULES"]

HEADERS = sorted(path.relative_to(RUNTIME).as_posix() for path in RUNTIME.rglob("*.hpp"))
_PYTHON = RUNTIME.with_name("python")
MODULES = sorted(
    ".".join(path.relative_to(_PYTHON).with_suffix("").parts)
    for path in _PYTHON.rglob("*.py")
    if path.name != "__init__.py"
)
