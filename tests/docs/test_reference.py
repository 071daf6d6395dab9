"""The reference names everything that there is, and its tables of options are those of the commands."""

from __future__ import annotations

import ast
import contextlib
import importlib.util
import io
import json
import pkgutil
import re
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from tests.support.snippets import blocks

from ikgen.cli.main import run
from ikgen.processes.termination import TERMINATED
from ikgen.projects.config import load_config
from ikgen.projects.new_config import ArmTable
from ikgen.projects.robot_list import ListedRobot
from ikgen.tasks import TASKS

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

pytestmark = pytest.mark.usefixtures("solved_once")

ROOT = Path(__file__).resolve().parents[2]
REFERENCE = ROOT / "docs/reference"
PAGES = [*sorted(ROOT.glob("*.md")), *sorted(ROOT.glob("docs/**/*.md"))]


def script(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def words(page: str, section: str = "") -> set[str]:
    """Names in code on a page, or in front of its first section and in one."""
    text = (REFERENCE / page).read_text(encoding="utf-8")
    if section:
        first, *others = re.split(r"^## ", text, flags=re.M)
        text = first + next(one for one in others if section in one.partition("\n")[0])
    fences = re.findall(r"^```\w+\n(.*?)^```", text, re.M | re.S)
    inline = re.findall(r"`([^`\n]+)`", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S))
    return {word for part in (*fences, *inline) for word in re.findall(r"\w+", part)}


def test_commands_and_options_are_those_of_the_program() -> None:
    reference = script(ROOT / "docs/cli_reference.py")
    text = reference.PAGE.read_text(encoding="utf-8")
    assert reference.filled_in(text) == text, "run python docs/cli_reference.py"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_rows_of_tables_have_the_columns_of_their_head(page: Path) -> None:
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    tables = re.findall(r"(?:^\|.*\n)+", text, re.M)
    for table in tables:
        pipes = {len(re.findall(r"(?<!\\)\|", line)) for line in table.splitlines()}
        assert len(pipes) == 1, table


def test_tasks_and_their_aliases_are_listed() -> None:
    page = (REFERENCE / "cli.md").read_text(encoding="utf-8")
    for task in TASKS:
        row = next(line for line in page.splitlines() if line.startswith(f"| `{task.name}` |"))
        assert all(f"`{alias}`" in row for alias in task.aliases)


def test_emitted_names_are_listed() -> None:
    module = (ROOT / "templates/python/public_names.py.jinja").read_text(encoding="utf-8")
    exported = re.search(r"__all__ = (\[.*?\])", module, re.S)
    assert exported is not None
    names = re.sub(r"\{%.*?%\}", "", exported.group(1))
    assert set(ast.literal_eval(names)) <= words("python-api.md")
    header = (ROOT / "templates/cpp/header.hpp.jinja").read_text(encoding="utf-8")
    public = header[: header.index("namespace detail")]
    constants = set(re.findall(r"constexpr [\w:<>, *]+? (k\w+) =", public))
    functions = set(re.findall(r"^[\w:<>, ]+ (\w+)\(const", public, re.M))
    assert len(constants) > 8 and "solve_batch" in functions
    assert constants | functions <= words("cpp-api.md")


def test_config_example_is_one_and_all_entries_are_listed(tmp_path: Path) -> None:
    example = blocks(REFERENCE / "config.md")[0]
    (tmp_path / "ikgen.toml").write_text(example.text)
    assert load_config(tmp_path / "ikgen.toml")[0].name == "ur5e"
    (tmp_path / "ikgen.toml").write_text("[[arm]]\nnonsense = 1\n")
    with pytest.raises(Exception, match="unknown entry") as caught:
        load_config(tmp_path / "ikgen.toml")
    known = caught.value.hint.removeprefix("there is: ").split(", ")
    assert len(known) > 8 and set(known) <= words("config.md")


OBJECT = re.compile(r"^::: (?P<name>[\w.]+)\n(?P<options>(?: {2,}.*\n)*)", re.M)
"""What a page takes from docstrings, and what of it."""


def described() -> list[str]:
    """Objects that pages take from docstrings, and the members that they name of one."""
    found = []
    for page in PAGES:
        for entry in OBJECT.finditer(page.read_text(encoding="utf-8") + "\n"):
            members = re.search(r"members: \[(.*)\]", entry["options"])
            names = re.findall(r"\w+", members[1]) if members is not None else []
            found += [entry["name"], *(f"{entry['name']}.{name}" for name in names)]
    return found


@pytest.mark.parametrize("name", described())
def test_objects_that_pages_describe_exist(name: str) -> None:
    assert pkgutil.resolve_name(name) is not None


def test_members_that_pages_name_are_looked_for() -> None:
    assert {"ikgen.program.ops.Op", "ikgen.program.liveness.live_names"} <= set(described())


def test_dh_example_is_one(tmp_path: Path) -> None:
    table = tmp_path / "table.toml"
    table.write_text(blocks(REFERENCE / "dh-table.md")[0].text)
    assert output("inspect", str(table), "--no-advice")["chain"]["dof"] == 1


NAMED_BY_DATA = {"verification", "histogram", "locked", "worst", "constants", "packages", "tools"}
"""Fields whose keys are names or numbers of the case at hand."""


def fields(value: Any) -> set[str]:
    """Keys of an output at all depths, but those that the data name."""
    if isinstance(value, list):
        return set().union(*map(fields, value))
    if not isinstance(value, dict):
        return set()
    found = set(value)
    for key, inner in value.items():
        parts = inner.values() if key in NAMED_BY_DATA and isinstance(inner, dict) else [inner]
        found |= set().union(*map(fields, parts))
    return found


def output(*arguments: str) -> Any:
    """What a command prints, whatever its exit code."""
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        run([*arguments, "--json"])
    return json.loads(said.getvalue())


def test_json_fields_are_listed(tmp_path: Path) -> None:
    fixtures = ROOT / "urdf_fixtures"
    table = tmp_path / "table.toml"
    table.write_text((fixtures / "scara_standard.toml").read_text())
    found = fields(output("from-dh", str(table), "-o", str(tmp_path), "--samples", "20"))
    found |= fields(output("verify", str(tmp_path), "--samples", "20"))
    table.write_text(re.sub(r"(?m)^(l_1 = ).*", r"\g<1>0.9", table.read_text()))
    wrong = output("verify", str(tmp_path), "--samples", "20")
    assert wrong["outputs"][0]["findings"][0]["deviation"]["m"] > 0.1
    found |= fields(wrong) | fields(output("inspect", str(table))) | fields(output("doctor"))
    found |= fields(output("inspect", str(fixtures / "doosan_m1013.urdf"), "--no-advice"))
    assert {"branches", "worst_case", "deviation", "before", "max_solutions", "mimic"} <= found
    assert found <= words("json.md"), found - words("json.md")


def test_json_fields_of_robots_with_several_arms_and_held_joints_are_listed(tmp_path: Path) -> None:
    fixtures, config = ROOT / "urdf_fixtures", tmp_path / "ikgen.toml"
    init = output("init", str(fixtures / "abb_yumi.urdf"), "-o", str(config))
    assert "other_ends" in init and fields(init) <= words("json.md", "init")
    build = output("build", str(config), "--check")
    assert build["stale"] and fields(build) <= words("json.md", "build")
    chain = (str(fixtures / "franka_fr3.urdf"), "--tip", "fr3_link8", "-o", str(tmp_path))
    made = output("from-urdf", *chain, "--samples", "20")
    assert made["chosen"]["held"] == ["fr3_joint7"]
    assert set(made["chosen"]) <= words("json.md", "from-urdf")
    assert fields(made) <= words("json.md")
    assert fields(output("report", *chain, "--no-verify")) <= words("json.md", "report")


@pytest.mark.parametrize("names", [True, False])
def test_json_fields_of_robots_known_by_name_are_listed(
    names: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    robot = ListedRobot("data:arm", () if names else (ArmTable("left", "base", "hand", 6),), "")
    monkeypatch.setattr("ikgen.projects.robot_list.listed_robots", lambda *_, **__: [robot])
    assert run(["robots", "--json", *["--names"] * names]) == 0
    found = json.loads(capsys.readouterr().out)
    assert fields(found) <= words("json.md", "robots")


def test_exit_codes_are_listed() -> None:
    page = (REFERENCE / "exit-codes.md").read_text(encoding="utf-8")
    assert str(TERMINATED) in re.findall(r"^\| (\d+) \|", page, re.M)


def test_extras_for_users_are_listed() -> None:
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    extras = tomllib.loads(text)["project"]["optional-dependencies"]
    own = {"test", "docs", "browser", "dev"}  # of this repository
    table = re.findall(r"^\| `(\w+)` \|", (REFERENCE / "library.md").read_text(), re.M)
    assert set(extras) - own <= set(table)


def test_pictures_are_those_that_the_script_draws() -> None:
    pictures = script(ROOT / "docs/pictures/make.py")
    for name, draw in pictures.PICTURES.items():
        committed = (ROOT / "docs/pictures" / name).read_text(encoding="utf-8")
        assert draw() == committed, f"{name}: run python docs/pictures/make.py"
