"""A fleet of calibrated arms: one `[[arm]]` with a list of files."""

from __future__ import annotations

from pathlib import Path

import pytest

from ikgen.errors import BadDescriptionError
from ikgen.projects.config import load_config

TABLE = '[[arm]]\nname = "cell"\nrobot = "ur5e.urdf"\ncalibration = {files}\n'


def test_a_list_of_calibrations_is_an_arm_each(tmp_path: Path) -> None:
    config = tmp_path / "ikgen.toml"
    config.write_text(TABLE.format(files='["own/left-1.yaml", "own/right.yaml"]'))
    one, two = load_config(config)
    assert (one.name, two.name) == ("cell_left_1", "cell_right")
    assert one.request.calibration == tmp_path / "own/left-1.yaml"
    assert two.request.robot == tmp_path / "ur5e.urdf" == one.request.robot


def test_one_calibration_keeps_the_name(tmp_path: Path) -> None:
    config = tmp_path / "ikgen.toml"
    config.write_text(TABLE.format(files='"own.yaml"'))
    (arm,) = load_config(config)
    assert arm.name == "cell" and arm.request.calibration == tmp_path / "own.yaml"


@pytest.mark.parametrize("files", ["[]", "[1]"])
def test_what_is_no_list_of_files_is_refused(files: str, tmp_path: Path) -> None:
    config = tmp_path / "ikgen.toml"
    config.write_text(TABLE.format(files=files))
    with pytest.raises(BadDescriptionError, match=r"ikgen.toml:4: arm\[0\].calibration"):
        load_config(config)


def test_a_name_that_is_taken_behind_a_fleet_is_told_with_its_line(tmp_path: Path) -> None:
    config = tmp_path / "ikgen.toml"
    fleet = TABLE.format(files='["left.yaml", "right.yaml"]')
    config.write_text(f'{fleet}[[arm]]\nname = "cell_left"\nrobot = "ur5e.urdf"\n')
    with pytest.raises(BadDescriptionError, match=r"ikgen.toml:6: arm\[1\].name: two arms named"):
        load_config(config)
