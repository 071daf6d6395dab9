"""What `ikgen build` says of an arm names entries of its config, and the line where they stand."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from tests.support.solving import FIXTURES

from ikgen.cli.main import run
from ikgen.projects.entry_words import EntryWords
from ikgen.records.codec import entries_of
from ikgen.records.request import Outputs, Request

ARM = """# an arm with tip and task
[[arm]]
name = "other"
robot = "missing.urdf"

[[arm]]
name = "arm"
robot = "ur5e.urdf"
out = "made"
"""


@pytest.mark.parametrize(
    ("typed", "written"),
    [
        ("by --base and --tip", "by base and tip"),
        ("give --tip 'the tool': no", 'give tip = "the tool": no'),
        ("--free JOINT, or --task TASK", 'free = ["JOINT"], or task = "TASK"'),
        ("--free a --free b", 'free = ["a", "b"]'),
        ("--free a=0.5 --free b: no", "free = { a = 0.5, b = VALUE }: no"),
        ("--lock a=1e-3 --lock 'b c=45deg'", 'lock = { a = 1e-3, "b c" = "45deg" }'),
        ("--couple: joint 'a'", "couple: joint 'a'"),
        ("--couple b=a*1+0", 'couple = { b = "a*1+0" }'),
        ("leave --emit sympy out", 'leave emit = ["sympy"] out'),
        ("--emit cpp -o DIR", 'emit = ["cpp"], out = "DIR"'),
        ("take-off, --trust and x --tips y", None),
        ("ikgen from-urdf a.urdf --tip x --free JOINT", 'free = ["JOINT"]'),
        ("ikgen from-urdf a.urdf --tip y", 'tip = "y"'),
        ("ikgen from-urdf a.urdf --tip x", "ikgen build"),
        ("ikgen from-urdf a.urdf", "ikgen build"),
    ],
)
def test_options_are_entries(typed: str, written: str | None) -> None:
    words = EntryWords(Request(Path("a.urdf"), tip="x")).words(typed)
    assert words == (typed if written is None else written)


def test_they_are_entries_that_a_config_reads() -> None:
    known = {*entries_of(Request), *entries_of(Outputs)}
    for option in EntryWords().options:
        assert EntryWords().words(option) in known, option


@pytest.mark.parametrize(
    ("entry", "message", "hint"),
    [
        ('tip = "tool1"', "arm: no link named 'tool1'", "there is: tool0"),
        ("lock = { elbw = 1.0 }", "arm: no joint named 'elbw'", "elbow_joint"),
        ("lock = { elbow_joint = 10.0 }", "arm: lock = { elbow_joint = 10 }: outside", "inside"),
        (
            'lock = { elbow_joint = "999 deg" }',
            'arm: lock = { elbow_joint = "999deg" }: outside',
            "",
        ),
        (
            'free = { elbow_joint = "9cm" }',
            "arm: free = { elbow_joint = \"9cm\" }: 'cm' is no",
            "rad",
        ),
        ('[arm.lock]\nelbow_joint = "9cm"', "arm: lock = { elbow_joint = \"9cm\" }: 'cm'", "rad"),
        ('args = { ur5e = "b" }', "arm: ur5e.urdf: a URDF file takes no", "give args only with"),
        ('task = "poes"', "arm: no task named 'poes'", "there is: pose"),
        ('emit = ["pyton"]', "arm: no emitter named 'pyton'", "there is: python"),
    ],
)
def test_errors_of_a_build_name_the_entry_and_its_line(
    entry: str,
    message: str,
    hint: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copy(FIXTURES / "ur5e.urdf", tmp_path)
    Path("ikgen.toml").write_text(ARM + entry + "\n")
    assert run(["build", "--json", "--jobs", "1"]) == 2
    error = json.loads(capsys.readouterr().out)["error"]
    line = 8 if entry.startswith("args") else 10
    lost = "ikgen.toml:4: other: missing.urdf: no such file"
    assert error["message"].startswith(f"{lost}; ikgen.toml:{line}: {message}")
    assert hint in error["hint"] and "--" not in error["hint"]
    # what there is not to be asked for is told without generating
    asked = entry.startswith(("task", "emit"))
    assert run(["build", "--check"]) == (2 if asked else 1)
    told = capsys.readouterr()
    assert f"ikgen.toml:10: {message}" in told.err if asked else "arm: stale: not" in told.out


def test_what_was_chosen_is_told_in_words_of_the_config(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copy(FIXTURES / "kuka_kr6r900sixx.urdf", tmp_path / "arm.urdf")
    entries = ('name = "arm"', 'robot = "arm.urdf"', 'free = ["joint_a4"]', "samples = 50")
    Path("ikgen.toml").write_text("\n".join(["[[arm]]", *entries]))
    assert run(["build"]) == 0
    said = capsys.readouterr().err
    assert "arm: position and direction of the tool's " in said
    assert '(task = "position-direction:' in said and ": what fits 5 joints)" in said
    assert "arm: by default (joint_a4 = 0) " in said and " of 50 random poses have any" in said
    Path("ikgen.toml").write_text(
        "\n".join(["[[arm]]", *entries[:2], 'lock = { joint_a4 = "1deg" }'])
    )
    assert run(["build", "--check"]) == 1
    assert "arm: stale: 'free' was [\"joint_a4\"], is not given" in capsys.readouterr().out
