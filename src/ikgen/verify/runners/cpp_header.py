"""Runs an emitted C++ header through a small driver program, thousands of poses per process."""

from __future__ import annotations

from pathlib import Path

from ikgen.errors import BadDescriptionError
from ikgen.processes.scratch_folder import ScratchFolder
from ikgen.verify.runners.cpp_driver import driver
from ikgen.verify.runners.cpp_toolchain import compile_program
from ikgen.verify.runners.program_runner import ProgramRunner
from ikgen.verify.runners.runner import ArmConstants

__all__ = ["CppHeader"]


class CppHeader(ProgramRunner):
    """A `Runner` over an emitted `<name>_ik.hpp`, compiled at construction into a temporary folder.

    Limits and names are read from the header, `constants` of the arm say the rest. Raises
    `BadDescriptionError` for a missing file or other joint counts, `MissingToolError` without compiler or
    Eigen, `VerificationError` if it does not compile.
    """

    def __init__(self, path: Path | str, constants: ArmConstants) -> None:
        self.path = Path(path).resolve()
        if not self.path.is_file():
            hint = "check the path, or generate it with --emit cpp"
            raise BadDescriptionError("no such C++ header", file=str(path), hint=hint)
        self._folder = ScratchFolder("ikgen-")  # goes with this object
        work = self._folder.path
        source, program = work / "driver.cpp", work / "driver"
        text = self.path.read_text(encoding="utf-8")
        batch, known = "solve_batch(" in text, "kLower" in text
        text = driver(self.path.name, self.path.stem, batch=batch, constants=known)
        source.write_text(text, encoding="utf-8")
        compile_program(source, program, [self.path.parent])
        super().__init__("cpp", program, constants, batch=batch, source=str(path))
