"""`--trust`: only who types a command may trust a file."""

from __future__ import annotations

import pytest

from ikgen.cli.main import run
from ikgen.errors import IkgenError
from ikgen.projects.config import load_config

LINKS = "".join(f'<link name="{name}"/>' for name in "abcd")
SLIDE = (
    '<joint name="{0}{1}" type="prismatic"><parent link="{0}"/><child link="{1}"/>'
    '<origin xyz="{2} 0 0.1"/><axis xyz="{3}"/><limit lower="-1" upper="1"/></joint>'
)
JOINTS = (
    SLIDE.format("a", "b", "0", "0 0 1")
    + SLIDE.format("b", "c", "0", "0 1 0")
    + SLIDE.format("c", "d", "${(lambda: 0.4)()}", "1 0 0")
    + '<link name="t"/><joint name="dt" type="fixed"><parent link="d"/><child link="t"/>'
    '<origin xyz="0.3 0 0"/></joint>'
)
CONFIG = '[[arm]]\nname = "bot"\nrobot = "bot.urdf.xacro"\ntask = "position"\nout = "gen"\nsamples = 20\n'


@pytest.fixture
def folder(tmp_path, monkeypatch):
    namespace = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    text = f'<robot name="bot" {namespace}>\n{LINKS}{JOINTS}</robot>'
    (tmp_path / "bot.urdf.xacro").write_text(text)
    (tmp_path / "ikgen.toml").write_text(CONFIG)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_each_command_asks_for_trust_anew(folder, capsys):
    commands = (
        ["from-urdf", "bot.urdf.xacro", "--task", "position", "-o", "out", "--no-verify"],
        ["verify", "out", "--samples", "50"],
        ["inspect", "bot.urdf.xacro", "--no-advice"],
        ["build", "-j", "1"],
        ["verify", "ikgen.toml", "--samples", "50"],
    )
    for command in commands:
        assert run(command) == 2
        told = capsys.readouterr().err
        assert "uses a lambda" in told and "--trust" in told
        assert run([*command, "--trust"]) == 0
    capsys.readouterr()
    assert run(["build", "--check"]) == 0


def test_a_config_cannot_trust(folder):
    (folder / "ikgen.toml").write_text(CONFIG + "trust = true\n")
    with pytest.raises(IkgenError, match="trust"):
        load_config(folder / "ikgen.toml")
