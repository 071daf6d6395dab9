"""Workers that are asked to end: their programs and temporary folders go with them."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

WORKER = """
import os, signal, sys, time
from pathlib import Path
from ikgen.processes import termination
from ikgen.processes.outside_program import run_program
from ikgen.processes.scratch_folder import ScratchFolder

class Asking:
    def __del__(self):
        os.kill(os.getpid(), signal.SIGTERM)  # what is raised here would be lost
        time.sleep(0.01)

termination.end_with_parent()
folder = ScratchFolder("x-", Path(sys.argv[1]))
(folder.path / "file").write_text("")
if sys.argv[2] == "in a finalizer":
    Asking()
else:
    run_program(["sh", "-c", f"kill -TERM {os.getpid()}; sleep 30; touch {folder.path}/late"])
time.sleep(30)
"""


@pytest.mark.skipif(os.name == "nt", reason="needs signals")
@pytest.mark.parametrize("when", ["in a finalizer", "while a program runs"])
def test_nothing_of_a_worker_is_left(when: str, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", WORKER, str(tmp_path), when], capture_output=True, timeout=25
    )
    assert done.returncode == 143 and not done.stderr
    assert not list(tmp_path.iterdir())
