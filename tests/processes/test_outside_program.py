"""Programs that crash, hang, or print without end."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

import pytest
from tests.support.waiting_program import assert_ended, script_of, wait_until_started

from ikgen.errors import MissingToolError, UsageError
from ikgen.processes.outside_program import RunningProgram, run_program


def python(text: str) -> list[str]:
    return [sys.executable, "-c", text]


def test_the_beginning_of_what_it_prints_is_kept() -> None:
    done = run_program(python("import sys; sys.stderr.write('first' + 'x' * 50_000_000)"))
    assert done.code == 0 and done.printed.startswith("firstxxx")
    assert len(done.printed) <= 64 * 1024


@pytest.mark.skipif(os.name == "nt", reason="needs signals")
def test_one_that_crashes() -> None:
    done = run_program(python("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)"))
    assert done.crashed and done.words == "was ended by SIGSEGV"


def runs(state: Path) -> bool:
    """Whether a process runs, by its file in /proc; False where there are none."""
    try:
        return state.read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


@pytest.mark.skipif(os.name == "nt", reason="needs process groups")
def test_one_that_hangs_ends_with_all_that_it_started(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("IKGEN_TOOL_SECONDS", "1")
    child = tmp_path / "child"
    text = (
        "import subprocess, sys, time\n"
        "p = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(600)'])\n"
        f"open({str(child)!r}, 'w').write(str(p.pid))\n"
        "time.sleep(600)\n"
    )
    started = time.monotonic()
    done = run_program(python(text))
    assert done.late and done.words == "takes more than 1 s"
    assert time.monotonic() - started < 20.0
    state = Path(f"/proc/{child.read_text()}/stat")
    while runs(state) and time.monotonic() - started < 20.0:
        time.sleep(0.05)  # what was killed ends when its turn comes
    assert not runs(state)


@pytest.mark.skipif(os.name == "nt", reason="needs process groups")
@pytest.mark.parametrize("how", ["end", "del"])
def test_one_that_runs_meanwhile_is_ended_where_nobody_waits(how: str, tmp_path: Path) -> None:
    number = tmp_path / "number"
    running = RunningProgram(["sh", "-c", script_of(number)])
    wait_until_started(number)
    if how == "end":
        running.end()
        assert running.finished().words == "was ended by SIGKILL"
    else:
        del running
    assert_ended(number)


def test_its_time_counts_from_its_start(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("IKGEN_TOOL_SECONDS", "1")
    quick, slow = (RunningProgram(python(text)) for text in ("", "import time; time.sleep(600)"))
    time.sleep(1.0)
    started = time.monotonic()
    assert quick.finished().code == 0 and not quick.finished().late
    assert slow.finished().late and time.monotonic() - started < 0.9


@pytest.mark.parametrize("told", [True, False])
def test_its_end_where_the_system_tells_it_and_elsewhere(
    told: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not told:
        monkeypatch.delattr(os, "pidfd_open", raising=False)
    monkeypatch.setenv("IKGEN_TOOL_SECONDS", "5")
    gone = RunningProgram(python("import sys; sys.exit(3)"))
    time.sleep(0.3)
    assert gone.finished().code == 3
    assert run_program(python("import time; time.sleep(0.2)")).code == 0
    monkeypatch.setenv("IKGEN_TOOL_SECONDS", "0.2")
    assert run_program(python("import time; time.sleep(600)")).late


def test_one_that_cannot_be_started(tmp_path: Path) -> None:
    (tmp_path / "text").write_text("no program")
    with pytest.raises(MissingToolError, match="cannot be started"):
        run_program([str(tmp_path / "text")])


@pytest.mark.parametrize("text", ["soon", "-1", "inf", "nan"])
def test_limits_that_are_none(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("IKGEN_TOOL_SECONDS", text)
    with pytest.raises(UsageError, match="no number of seconds"):
        run_program(python(""))
