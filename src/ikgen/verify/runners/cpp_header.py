"""Runs an emitted C++ header through a small driver program, thousands of poses per process."""

from __future__ import annotations

import weakref
from pathlib import Path

from ikgen.errors import BadDescriptionError
from ikgen.processes.scratch_folder import ScratchFolder
from ikgen.verify.runners.cpp_driver import driver
from ikgen.verify.runners.cpp_toolchain import LIGHT, Compilation
from ikgen.verify.runners.program_runner import ProgramRunner
from ikgen.verify.runners.runner import ArmConstants

__all__ = ["CppHeader"]


class CppHeader(ProgramRunner):
    """A `Runner` over an emitted `<name>_ik.hpp`. From construction on it is compiled, into a temporary
    folder, while this process goes on; what is asked first waits for it.

    Limits and names are read from the header, `constants` of the arm say the rest. Raises
    `BadDescriptionError` for a missing file, `MissingToolError` without compiler or Eigen; when it is used
    first, `VerificationError` if it does not compile, `BadDescriptionError` for other joint counts.
    """

    def __init__(self, path: Path | str, constants: ArmConstants) -> None:
        self.path = Path(path).resolve()
        if not self.path.is_file():
            hint = "check the path, or generate it with --emit cpp"
            raise BadDescriptionError("no such C++ header", file=str(path), hint=hint)
        folder = ScratchFolder("ikgen-")
        source, program = folder.path / "driver.cpp", folder.path / "driver"
        text = self.path.read_text(encoding="utf-8")
        batch, known = "solve_batch(" in text, "kLower" in text
        moves = {"motions": "Path follow(" in text, "intervals": "SelfMotion self_motion(" in text}
        text = driver(self.path.name, self.path.stem, batch=batch, constants=known, **moves)
        source.write_text(text, encoding="utf-8")
        compilation = Compilation(source, program, [self.path.parent], LIGHT)
        self._close = weakref.finalize(self, _closed, compilation, folder)
        made = compilation.finish
        super().__init__(
            "cpp", program, constants, batch=batch, source=str(path), made=made, **moves
        )

    def close(self) -> None:
        """End the compiler, if it still runs, and remove the folder; both go with this object anyway."""
        self._close()


def _closed(compilation: Compilation, folder: ScratchFolder) -> None:
    compilation.end()  # first: it writes into the folder
    folder.close()
