"""Helps another process to solve stacks of poses with an emitted Python module:

    python -m ikgen.verify.runners.module_program MODULE FOLDER NAME

FOLDER holds the work and takes the answers, in a file of that NAME.
"""

from __future__ import annotations

import sys
from pathlib import Path

from ikgen.verify.runners.module_helpers import help_out
from ikgen.verify.runners.python_module import PythonModule

__all__ = ["main"]


def main() -> None:
    """Do what the command line says."""
    module, folder, name = sys.argv[1:]
    help_out(Path(folder), name, PythonModule(module).answers)


if __name__ == "__main__":
    main()
