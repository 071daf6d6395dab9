"""What a shell is told to complete, as the shell asks for it."""

from __future__ import annotations

from pathlib import Path

import pytest

from ikgen.cli.main import COMMANDS, run

ROOT = Path(__file__).resolve().parents[2]
FR3 = ROOT / "urdf_fixtures/franka_fr3.urdf"


def completed(
    words: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> list[str]:
    """The completions of the last word, "" where the words end in a blank."""
    typed = f"ikgen {words}"
    monkeypatch.setenv("_IKGEN_COMPLETE", "bash_complete")
    monkeypatch.setenv("COMP_WORDS", typed)
    monkeypatch.setenv("COMP_CWORD", str(len(typed.split(" ")) - 1))
    with pytest.raises(SystemExit):
        run([])
    return [line.partition(",")[2] for line in capsys.readouterr().out.splitlines() if line]


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("com", ["completion"]),
        ("inspect r --task position-", ["position-direction", "position-pitch", "position-yaw"]),
        ("report r --calib", ["--calibration"]),
        ("from-urdf r --emit cpp", ["cpp", "cpp-package"]),
        ("from-urdf r --emit python,cpp,mo", ["python,cpp,moveit"]),
        ("from-urdf r --emit python,py", []),
        (f"inspect {FR3} --tip fr3_hand", ["fr3_hand", "fr3_hand_tcp"]),
        (f"view {FR3} --base fr3_link0 --free fr3_joint7", ["fr3_joint7"]),
        (f"view --tip fr3_link8 {FR3} --lock fr3_joint1", ["fr3_joint1="]),
        ("inspect no_such_file.urdf --tip ", []),
        ("inspect table.toml --free ", []),
    ],
)
def test_words(
    words: str,
    expected: list[str],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert completed(words, monkeypatch, capsys) == expected


def test_commands(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    assert set(completed("", monkeypatch, capsys)) == set(COMMANDS)


def test_fixed_joints_cannot_be_held(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    held = completed(f"inspect {FR3} --free ", monkeypatch, capsys)
    assert held == [
        *(f"fr3_joint{i}" for i in range(1, 8)),
        "fr3_finger_joint1",
        "fr3_finger_joint2",
    ]


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_script_of_a_shell(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["completion", shell]) == 0
    text = capsys.readouterr().out
    assert "_IKGEN_COMPLETE" in text and f"{shell}_complete" in text
