"""Runs the emitted crate, built with rustc, for ikgen's verification."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path

from ikgen.emit.solver_module import SolverModule
from ikgen.errors import MissingToolError, VerificationError
from ikgen.generation.emitted_runners import arm_constants
from ikgen.verify.runners.program_runner import ProgramRunner

__all__ = ["RustCrate", "rust_runner"]


class RustCrate(ProgramRunner):
    """A `Runner` over a crate's `src/lib.rs`.

    Raises `MissingToolError` without rustc, `VerificationError` where the crate does not compile.
    """

    def __init__(self, library: Path, module: SolverModule) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="ikgen-rust-")
        work = Path(self._folder.name)
        built = work / "libsolver.rlib"
        _compile(library, "--crate-type=rlib", "--crate-name=solver", "-o", built)
        driver = Path(__file__).with_name("driver.rs")
        _compile(driver, "--extern", f"solver={built}", "-o", work / "driver")
        constants = arm_constants(module)
        super().__init__("rust", work / "driver", constants, batch=False, source=str(library))


def rust_runner(module: SolverModule, folder: Path) -> RustCrate:
    """What verification calls: `folder` holds the emitted files."""
    return RustCrate(folder / f"{module.name}_ik_rs/src/lib.rs", module)


def _compile(source: Path, *options: str | Path) -> None:
    rustc = shutil.which("rustc")
    if rustc is None:
        raise MissingToolError("rustc was not found", hint="apt-get install rustc")
    command = [rustc, "--edition=2021", "-O", str(source), *map(str, options)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise VerificationError("the emitted crate does not compile: " + done.stderr[:1000])
