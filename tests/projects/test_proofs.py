"""`ikgen verify --prove`: the derivation of what was generated is proved, or it says why not."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest
from tests.support.solving import FIXTURES

from ikgen.cli.main import run
from ikgen.symbolic import identities

pytestmark = pytest.mark.usefixtures("solved_once")

ROOT = Path(__file__).resolve().parents[2]
SCHEMA = json.loads((ROOT / "docs/reference/verify.schema.json").read_text())


@pytest.fixture
def out(tmp_path: Path) -> Path:
    """The outputs of the paper's Puma."""
    table = FIXTURES / "puma560_paper.toml"
    assert run(["from-dh", str(table), "-o", str(tmp_path), "--no-verify", "-q"]) == 0
    return tmp_path


def _verified(out: Path, *options: str) -> int:
    return run(["verify", str(out), "--samples", "5", *options])


def test_text_and_json_have_the_proof(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert _verified(out, "--prove") == 0
    assert "proved: 10 of 10 equations" in capsys.readouterr().out
    assert _verified(out, "--prove", "--json") == 0
    found = json.loads(capsys.readouterr().out)
    jsonschema.validate(found, SCHEMA)
    proof = found["outputs"][0]["proof"]
    assert proof["proved"] and proof["equations"] == {"proved": 10, "total": 10}
    assert proof["conditions"]["sincos"] and not proof["remarks"]


def test_no_proof_unless_asked(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert _verified(out, "--json") == 0
    assert "proof" not in json.loads(capsys.readouterr().out)["outputs"][0]


def test_what_does_not_hold_is_an_error(
    out: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    used = identities.used_equations
    monkeypatch.setattr(
        identities, "used_equations", lambda graph: [_swapped(e) for e in used(graph)]
    )
    assert _verified(out, "--prove") == 1
    assert "its derivation does not hold: (3,4) py" in capsys.readouterr().err


def _swapped(equation: object) -> object:
    """The equation with the pose's x in place of its right side."""
    from dataclasses import replace

    return replace(equation, right=equation.left.args[0])  # type: ignore[type-var,attr-defined]
