"""Names of a file in every output: nothing is there that a plain name would not give."""

from __future__ import annotations

import ast
import html.parser
import json
import re
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.sax.saxutils import escape

import pytest
import tomllib
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree

from ikgen.cli.main import run
from ikgen.emit.rendering import TURNING_MARKS

pytestmark = pytest.mark.usefixtures("solved_once")

ELBOW = Path(__file__).resolve().parents[2] / "examples/setuptools_robot/urdf/elbow.urdf"
EMIT = "python,cpp,nanobind,cpp-package,moveit"
ODD = (
    '"; import os; os.system("x") #',
    "'''\"\"\" \\",
    "&lt;script&gt;alert(1)&lt;/script&gt;",
    "]]&gt; --&gt; &lt;!ENTITY x&gt; &amp;amp;",
    "{{ x }} {% if 1 %} ${y} $(touch z) `id` %s {0}",
    "*/ int main(); // ??/ #error",
    "\\input{x} \\end{document} $ # _ ^ ~ %",
    "a: [b] - &amp;c !d | e",
    "\u202eabc\u2066\u200f\u061c",
    "é \U0001f9be ﬁ \u2028\u0085 end",
    "-o --emit ../../up /etc",
    "message(FATAL_ERROR) ;[[x]]",
)


class Tags(html.parser.HTMLParser):
    """The tags and attributes' names of a document."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[object] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, [name for name, _ in attrs]))


class NoTexts(ast.NodeTransformer):
    def visit_Constant(self, node: ast.Constant) -> ast.Constant:
        return ast.Constant("") if isinstance(node.value, str) else node


def bones(path: Path) -> object:
    """What is left of a file without its texts."""
    text = path.read_text("utf-8")
    assert not {ord(c) for c in text} & set(TURNING_MARKS), path
    if path.suffix in (".py", ".pyi"):
        return ast.dump(NoTexts().visit(ast.parse(text)))
    if path.suffix in (".hpp", ".cpp"):
        code = re.sub(r"//[^\n]*|\"(?:\\.|[^\"\\\n])*\"", "", text)
        return [line.strip() for line in code.splitlines() if line.strip()]
    if path.suffix == ".json":
        return sorted(json.loads(text))
    if path.suffix == ".xml":
        return [element.tag for element in etree.fromstring(text.encode()).iter()]
    if path.suffix == ".yaml":
        return type(yaml.safe_load(text))
    if path.suffix == ".toml":
        return sorted(tomllib.loads(text))
    if path.suffix == ".html":
        return sorted({str(tag) for tag in Tags(text).found})
    if path.name == "CMakeLists.txt":
        return re.findall(r"^\w+(?=\()", text, re.M)
    return None


def outputs(name: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, object]:
    """Bones of all outputs of an arm whose links and joints end in a name, as XML writes it."""
    folder.mkdir()
    monkeypatch.chdir(folder)
    name = name.replace('"', "&quot;")
    named = re.compile(r'((?:name|link|joint)="[^"]+)"')
    text = named.sub(lambda match: f'{match[1]}{name}"', ELBOW.read_text())
    Path("arm.urdf").write_text(text, "utf-8")
    quiet = ["--task", "position", "--no-verify", "-q", "-o", "out"]
    assert run(["from-urdf", "arm.urdf", "--name", "arm", "--emit", EMIT, *quiet]) == 0
    assert run(["report", "arm.urdf", "--name", "arm", *quiet]) == 0
    assert run(["init", "arm.urdf", "-o", "out/ikgen.toml"]) == 0
    assert {p.name for p in folder.iterdir()} == {"arm.urdf", "out"}
    files = [p for p in sorted(Path("out").rglob("*")) if p.is_file() and p.suffix != ".pdf"]
    return {p.as_posix(): bones(p) for p in files}


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> dict[str, object]:
    with pytest.MonkeyPatch.context() as monkeypatch:
        found = outputs("_plain", tmp_path_factory.mktemp("plain") / "out", monkeypatch)
    assert len(found) > 20
    return found


def test_outputs_have_the_bones_of_plain_names(
    plain: dict[str, object], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for number in range(2):  # six at once: what they cost is the runs
        odd = " ".join(ODD[number::2])
        found = outputs(odd, tmp_path / str(number), monkeypatch)
        assert sorted(found) == sorted(plain), odd
        for file, expected in plain.items():
            assert found[file] == expected, (odd, file)


MARKS = "\"'\\<>&%#;:()/\u2028\u202e "
PARTS = st.sampled_from(["*/", "/*", "//", "{{", "}}", "{%", "${", "$(", "]]", "--", "..", *MARKS])
LETTERS = st.characters(exclude_categories=("Cc", "Cs", "Cn"))


@settings(max_examples=3, deadline=None)
@given(name=st.lists(PARTS | LETTERS, min_size=1, max_size=12).map("".join))
def test_outputs_have_the_bones_of_plain_names_whatever_the_name(
    plain: dict[str, object], name: str
) -> None:
    with pytest.MonkeyPatch.context() as monkeypatch, TemporaryDirectory() as folder:
        found = outputs(escape(name), Path(folder) / "odd", monkeypatch)
    assert found == plain
