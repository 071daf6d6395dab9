"""Workers that are to end: their temporary folders go, also where unwinding does not get that far."""

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
from ikgen.processes.scratch_folder import ScratchFolder

class Folder(ScratchFolder):
    def __del__(self):
        os.kill(os.getpid(), signal.SIGTERM)  # what a finalizer raises is lost
        time.sleep(0.01)

termination._GRACE = 0.5
termination.end_with_parent()
folder = ScratchFolder("x-", Path(sys.argv[1]))
(folder.path / "file").write_text("")
if sys.argv[2] == "lost":
    Folder("x-", Path(sys.argv[1]))
    time.sleep(30)
else:
    try:
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(30)
    except termination.Terminated:
        termination.end_now()
"""


@pytest.mark.skipif(os.name == "nt", reason="needs signals")
@pytest.mark.parametrize("how", ["unwound", "lost"])
def test_folders_of_a_worker_go_with_it(how: str, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", WORKER, str(tmp_path), how], capture_output=True, timeout=60
    )
    assert done.returncode == 143
    assert (b"Terminated" in done.stderr) is (how == "lost")  # it was raised, and lost
    assert not list(tmp_path.iterdir())
