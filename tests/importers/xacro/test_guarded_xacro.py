"""xacro files that want to run code, read what is none of theirs, or never end."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest
import xacro
from xacro import substitution_args

from ikgen.errors import BadDescriptionError, MissingToolError
from ikgen.importers import load_tree
from ikgen.importers.packages import PackageFinder
from ikgen.importers.xacro import budget as budgets
from ikgen.importers.xacro.expansion import expand
from ikgen.importers.xacro.guarded_xacro import GuardedXacro

pytestmark = pytest.mark.usefixtures("solved_once")

OPEN = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
SHELL = (
    "${(lambda: [s for s in ().__class__.__base__.__subclasses__() if s.__name__=='_wrap_close'][0]"
    ".__init__.__globals__['system']('touch MARK'))()}"
)


@pytest.fixture
def bot(tmp_path):
    """A file in a package with a manifest."""
    path = tmp_path / "ws" / "pkg" / "urdf" / "bot.urdf.xacro"
    path.parent.mkdir(parents=True)
    (path.parents[1] / "package.xml").write_text("<package><name>pkg</name></package>")
    return path


def write(path, *lines):
    path.write_text(OPEN + "\n".join([*lines, '<link name="a"/>', "</robot>"]))
    return path


def refusal(path, **options):
    with pytest.raises(BadDescriptionError) as caught:
        load_tree(path, **options)
    return caught.value


@pytest.mark.parametrize(
    "place",
    [
        '<link name="{}"/>',
        '<xacro:property name="p" value="{}"/><link name="${{p}}"/>',
        '<xacro:if value="{}"><link name="b"/></xacro:if>',
        '<xacro:include filename="{}"/>',
        '<xacro:macro name="m" params="p"><link name="${{p}}"/></xacro:macro><xacro:m p="{}"/>',
        '<xacro:macro name="m" params="p:={}"><link name="${{p}}"/></xacro:macro><xacro:m/>',
        '<xacro:arg name="x" default="{}"/><link name="$(arg x)"/>',
    ],
)
def test_no_code_runs_wherever_an_expression_stands(bot, tmp_path, place):
    mark = tmp_path / "mark"
    text = place.format(SHELL.replace("MARK", str(mark)))
    error = refusal(write(bot, "", text))
    assert "uses a lambda" in error.message and "--trust" in error.hint
    assert error.file == str(bot) and error.line == 3
    assert not mark.exists()


def test_no_code_runs_out_of_eval_and_yaml_units(bot, tmp_path):
    error = refusal(write(bot, '<link name="$(eval [x for x in [1].__class__])"/>'))
    assert "reaches for '__class__'" in error.message and error.line == 2
    (bot.parent / "a.yaml").write_text("a: !degrees (1).__class__\n")
    error = refusal(write(bot, "<link name=\"${xacro.load_yaml('a.yaml')}\"/>"))
    assert "reaches for '__class__'" in error.message


def test_arguments_of_the_command_are_no_way_in(bot):
    write(bot, '<xacro:arg name="x" default="1"/>', '<link name="${$(arg x)}"/>')
    assert "names '__import__'" in refusal(bot, arguments={"x": "__import__('os')"}).message


def test_trust_hands_the_file_to_xacro(bot, tmp_path):
    mark = tmp_path / "mark"
    (tmp_path / "outside.yaml").write_text("name: b\n")
    outside = f"<link name=\"${{xacro.load_yaml('{tmp_path}/outside.yaml').name}}\"/>"
    write(bot, f'<link name="{SHELL.replace("MARK", str(mark))}"/>', outside)
    assert load_tree(bot, trust=True).links == ("0", "b", "a")
    assert mark.exists()


@pytest.mark.parametrize(
    "name",
    ["{out}/secret.yaml", "../../../secret.yaml", "link.yaml", ".hidden.yaml", "links/secret.yaml"],
)
def test_files_outside_the_package_are_refused(bot, tmp_path, name):
    (tmp_path / "secret.yaml").write_text("a: 1\n")
    (bot.parent / ".hidden.yaml").write_text("a: 1\n")
    (bot.parent / "link.yaml").symlink_to(tmp_path / "secret.yaml")
    (bot.parent / "links").symlink_to(tmp_path)
    name = name.format(out=tmp_path)
    for text in (
        f"<link name=\"${{xacro.load_yaml('{name}')}}\"/>",
        f'<xacro:include filename="{name}"/>',
        f'<xacro:include filename="{name}" optional="true"/>',
    ):
        error = refusal(write(bot, text))
        assert "lies outside the package" in error.message and error.line == 2
        assert "--package-path" in error.hint and "--trust" in error.hint


def test_what_is_in_the_package_or_a_package_path_is_read(bot, tmp_path):
    (bot.parents[1] / "config.yaml").write_text("name: b\n")
    there = tmp_path / "elsewhere"
    there.mkdir()
    (there / "more.yaml").write_text("name: c\n")
    write(
        bot,
        "<link name=\"${xacro.load_yaml('../config.yaml').name}\"/>",
        f"<link name=\"${{xacro.load_yaml('{there}/more.yaml').name}}\"/>",
    )
    assert load_tree(bot, package_paths=[there]).links == ("b", "c", "a")


@pytest.mark.parametrize("pattern", ["/etc/*", "../../../*", "*/../../../../*", "*/*/*/*/*.xacro"])
def test_wildcards_look_around_in_the_package_only(bot, pattern):
    assert "lies outside" in refusal(write(bot, f'<xacro:include filename="{pattern}"/>')).message


def test_wildcards_in_the_package_are_read_in_order(bot):
    for name in ("part_b", "part_a"):
        text = OPEN + f'<link name="{name}"/></robot>'
        (bot.parent / f"{name}.xacro").write_text(text)
    tree = load_tree(write(bot, '<xacro:include filename="part_*.xacro"/>'))
    assert tree.links == ("part_a", "part_b", "a")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes on this system")
def test_pipes_are_not_waited_for(bot):
    os.mkfifo(bot.parent / "pipe.yaml")
    error = refusal(write(bot, "<link name=\"${xacro.load_yaml('pipe.yaml')}\"/>"))
    assert "no regular file" in error.message
    assert "no regular file" in refusal(write(bot, '<xacro:include filename="pipe.yaml"/>')).message


def test_entities_of_included_files_are_refused(bot):
    (bot.parent / "part.xacro").write_text('<!DOCTYPE robot [<!ENTITY e "x">]>' + OPEN + "</robot>")
    assert "<!DOCTYPE>" in refusal(write(bot, '<xacro:include filename="part.xacro"/>')).message


def doubled(step):
    rows = [f'<xacro:property name="p{i + 1}" value="{step.format(i=i)}"/>' for i in range(60)]
    return ['<xacro:property name="p0" value="ab"/>', *rows, '<link name="${p60}"/>']


def macros(width, depth):
    rows = ['<xacro:macro name="m0" params=""><c/></xacro:macro>']
    for i in range(depth):
        calls = f"<xacro:m{i}/>" * width
        rows.append(f'<xacro:macro name="m{i + 1}" params="">{calls}</xacro:macro>')
    return [*rows, f"<xacro:m{depth}/>"]


MULTIPLIES = {
    "texts": doubled("${{p{i}}}${{p{i}}}"),
    "values": doubled("${{p{i} + p{i}}}"),
    "lists": doubled("${{[p{i}, p{i}]}}"),
    "macros": macros(4, 15),
    "a macro's hidden body": [
        '<xacro:macro name="m" params=""><xacro:if value="0">'
        + "<c/>" * 50_000
        + "</xacro:if></xacro:macro>",
        "<xacro:m/>" * 100,
    ],
    "blocks": [
        '<xacro:macro name="m" params="*b">'
        + '<xacro:insert_block name="b"/>' * 100
        + "</xacro:macro>",
        "<xacro:m><d>" + "<c/>" * 20_000 + "</d></xacro:m>",
    ],
    "elements": ["<c/>" * 400_000],
    "a text of expressions": ["<c>" + "$${" * 50_000 + "</c>"],
    "a macro's parameters": [
        f'<xacro:macro name="m" params="a:={"x" * 60}\'"><c/></xacro:macro>' + macros(4, 15)[0],
        *macros(9, 9)[1:],
    ],
    "endless macro": ['<xacro:macro name="m" params=""><xacro:m/></xacro:macro><xacro:m/>'],
    "endless include": ['<xacro:include filename="bot.urdf.xacro"/>'],
}


@pytest.mark.parametrize("case", MULTIPLIES)
def test_what_multiplies_ends_with_an_error(bot, monkeypatch, case):
    monkeypatch.setattr(budgets, "MOST_SECONDS", 1.0)
    write(bot, *MULTIPLIES[case])
    started = time.process_time()
    error = refusal(bot)
    assert time.process_time() - started < 5.0
    assert error.file == str(bot) and error.hint


def layers(row):
    """YAML in which each of sixty rows uses the one before it."""
    rows = [row.format(this=f"a{i + 1}", last=f"a{i}") for i in range(60)]
    return "".join(["a0: &a0 {x: 1}\n", *rows])


YAML = {
    "bomb": layers("{this}: &{this} [*{last}, *{last}]\n"),
    "merge": layers("{this}: &{this}\n  <<: [*{last}, *{last}]\n"),
    "itself": "a: &a [*a]\n",
    "deep": "[" * 20_000 + "]" * 20_000,
    "long": "a: " + "x" * 600_000,
    "digits": "a: " + "9" * 400_000,
}


@pytest.mark.parametrize("case", YAML)
def test_yaml_that_multiplies_is_refused(bot, case):
    (bot.parent / "a.yaml").write_text(YAML[case])
    started = time.process_time()
    error = refusal(write(bot, "<link name=\"${xacro.load_yaml('a.yaml')}\"/>"))
    assert time.process_time() - started < 6.0
    assert error.hint


def test_an_empty_yaml_file_is_nothing(bot):
    (bot.parent / "a.yaml").write_text("")
    tree = load_tree(write(bot, "<link name=\"${xacro.load_yaml('a.yaml') is None}\"/>"))
    assert tree.links == ("True", "a")


def test_macro_parameters_are_split_as_xacro_does():
    guarded = GuardedXacro(Path("bot"), PackageFinder(Path("bot")))
    patterns = {name: value for _, name, value in guarded.replacements(xacro, substitution_args)}
    for text in (
        "a b c", "a:=1 b", "a:=^ b:=^|2", "a:='x y' b", 'a:="x y"z b:=${1 + 2} c', "a= b:=$(arg x)",
        "*block **blocks", "a:=x'y z'w b", "a := 1", "a:=", "",
    ):  # fmt: skip
        ours, theirs = patterns["re_macro_arg"].match(text), xacro.re_macro_arg.match(text)
        assert (ours and ours.groups()) == (theirs and theirs.groups()), text


def test_the_environment_is_open(bot, monkeypatch):
    monkeypatch.setenv("IKGEN_TEST_NAME", "b")
    tree = load_tree(write(bot, '<link name="$(env IKGEN_TEST_NAME)"/>'))
    assert tree.links == ("b", "a")


def test_guards_are_taken_off_again(bot):
    names = ("safe_eval", "eval_text", "parse", "load_yaml", "get_include_files", "re_macro_arg")
    before = [getattr(xacro, name) for name in (*names, "resolve_macro", "replace_node")]
    evaluate = substitution_args._eval
    expand(write(bot), arguments={})
    assert [getattr(xacro, name) for name in (*names, "resolve_macro", "replace_node")] == before
    assert substitution_args._eval is evaluate


def test_a_xacro_package_without_the_guarded_names_is_not_run(bot, monkeypatch):
    monkeypatch.delattr(xacro, "safe_eval")
    before = (xacro.abs_filename_spec, substitution_args._eval_find)
    with pytest.raises(MissingToolError, match=r"no 'xacro\.safe_eval'"):
        load_tree(write(bot))
    assert (xacro.abs_filename_spec, substitution_args._eval_find) == before
