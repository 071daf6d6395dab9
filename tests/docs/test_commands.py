"""What the README and every page tell to type works, and prints what they show."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from tests.support.snippets import Block, blocks, differing, follow, page_marks

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", *sorted(DOCS.rglob("*.md"))]


def typed(page: Path) -> list[Block]:
    """The blocks of commands of a page that is run."""
    if any(mark.startswith("not run") for mark in page_marks(page)):
        return []
    return [block for block in blocks(page) if block.language in ("sh", "console")]


def with_commands() -> list[object]:
    """Pages with something to type that is run."""
    return [
        pytest.param(
            page,
            id=str(page.relative_to(ROOT)),
            marks=pytest.mark.long if "long" in page_marks(page) else (),
        )
        for page in PAGES
        if any(not block.mark.startswith("not run") for block in typed(page))
    ]


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> Callable[[Path], Path]:
    """Does what a page says, once, in a folder of its own or that of the page it goes on from."""
    folders: dict[Path, Path] = {}

    def do(page: Path) -> Path:
        if page not in folders:
            before = [mark.split()[1] for mark in page_marks(page) if mark.startswith("after ")]
            folder = do(DOCS / before[0]) if before else tmp_path_factory.mktemp(page.stem)
            if not any(block.command for block in typed(page)):
                pytest.skip("needs programs that are not here")
            follow(page, folder, ROOT)
            folders[page] = folder
        return folders[page]

    return do


@pytest.mark.parametrize("page", with_commands())
def test_commands_do_what_the_page_says(page: Path, done: Callable[[Path], Path]) -> None:
    done(page)


def test_pages_with_commands_are_there() -> None:
    assert len(with_commands()) >= 10


def test_stale_output_is_found() -> None:
    printed = "solutions:  at most 8; 4 / 7.4 / 8\ntime: 1.9 s\nclosure 3.0e-15 m\nikgen 0.1.0"
    assert differing(printed, printed) == ""
    assert differing("time: 12 s\nclosure 9e-16 m\nikgen 2.0.1.dev3", printed) == ""
    stale = "solutions:  at most 8; 4 / 7.8 / 8"
    assert differing(stale, printed) == stale
    assert differing("time: 1.9 s\nsolutions:  at most 8; 4 / 7.4 / 8", printed) != ""
    assert differing("closure 3.0e-15 rad", printed) != ""


def test_a_mark_that_is_not_understood_is_told() -> None:
    with pytest.raises(AssertionError, match="what is"):
        _ = Block("sh", "", "ls", "nevermind").command
    with pytest.raises(AssertionError, match="is not in"):
        _ = Block("sh", "", "ls", 'run without "pwd": it is not there').command
    assert Block("sh", "", "a && b", 'run without "a && ": it installs').command == "b"
    assert Block("sh", "", "a", "needs no-such-program").command == ""
    assert Block("console", "", "$ a\nprinted\n$ b").command == "a\nb"
