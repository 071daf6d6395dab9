"""Which ends of branches are taken for no arm's."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import pytest

from ikgen.chains.arms import candidate_chains
from ikgen.chains.other_ends import other_ends
from ikgen.cli.main import run
from ikgen.importers.urdf.urdf_tree import parse_urdf

pytestmark = pytest.mark.usefixtures("solved_once")

PALM = {"thumb": 4, "index": 2, "ring": 2}


def hand(fingers: Mapping[str, int], arm: int = 0) -> str:
    """A palm, behind so many joints, with fingers of so many joints each."""
    text, palm = '<link name="base_link"/>', "base_link"

    def joint(name: str, parent: str) -> str:
        limit = '<limit lower="0" upper="1.2" effort="1" velocity="1"/>'
        return (
            f'<link name="{name}_link"/><joint name="{name}" type="revolute"><parent link="{parent}"/>'
            f'<child link="{name}_link"/><origin xyz="0.03 0.01 0.02"/><axis xyz="0 1 0"/>{limit}</joint>'
        )

    for k in range(arm):
        text += joint(f"arm_{k}", palm)
        palm = f"arm_{k}_link"
    for finger, count in fingers.items():
        link = palm
        for k in range(count):
            text += joint(f"{finger}_{k}", link)
            link = f"{finger}_{k}_link"
    return f'<robot name="hand">{text}</robot>'


def test_short_fingers_beside_a_long_one_are_told() -> None:
    tree = parse_urdf(hand(PALM), path=Path("hand.urdf"))
    chains = candidate_chains(tree)
    assert [chain.tip for chain in chains] == ["thumb_3_link"]
    assert other_ends(tree, chains) == ("index_1_link", "ring_1_link")


def test_fingers_behind_an_arm_are_its_gripper() -> None:
    tree = parse_urdf(hand({"left_finger": 1, "right_finger": 1}, arm=6), path=Path("hand.urdf"))
    assert other_ends(tree, candidate_chains(tree)) == ()


def test_the_command_line_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, out = tmp_path / "hand.urdf", tmp_path / "ikgen.toml"
    path.write_text(hand(PALM))
    told = "taken for fingers or side branches: index_1_link, ring_1_link; --tip LINK"
    assert run(["inspect", str(path)]) == 0
    assert told in capsys.readouterr().out
    assert run(["init", str(path), "-o", str(out)]) == 0
    assert f"{told} --add adds one" in capsys.readouterr().err
    assert run(["init", str(path), "--tip", "ring_1_link", "--add", "-o", str(out)]) == 0
    assert "index" not in capsys.readouterr().err and 'tip = "ring_1_link"' in out.read_text()


def test_a_generation_names_the_fingers_that_it_left_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "hand.urdf"
    command = ["from-urdf", str(path), "-o", str(tmp_path), "--no-verify"]
    path.write_text(hand(PALM))
    told = "; other branches end at index_1_link, ring_1_link (--tip)"
    for options, shown in (([], True), (["--tip", "ring_1_link", "--force"], False)):
        assert run([*command, *options]) == 0
        (line,) = (x for x in capsys.readouterr().out.splitlines() if x.startswith("robot:"))
        assert line.endswith(told) is shown
        assert run([*command, *options, "--force", "--json"]) == 0
        ends = json.loads(capsys.readouterr().out)["other_ends"]
        assert ends == (["index_1_link", "ring_1_link"] if shown else [])
    path.write_text(hand({**PALM, "middle": 4}))
    assert run(command) == 2
    said = capsys.readouterr().err
    assert "several chains" in said
    assert "taken for fingers or side branches: index_1_link, ring_1_link; --tip LINK" in said
