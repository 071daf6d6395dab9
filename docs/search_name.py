"""Hook of mkdocs: the theme's search dialog gets a name for those who do not see it."""

from __future__ import annotations

from typing import Any

__all__ = ["on_post_page"]

_DIALOG = 'data-md-component="search" role="dialog"'


def on_post_page(output: str, **_: Any) -> str:
    """The page with the dialog named."""
    return output.replace(_DIALOG, f'{_DIALOG} aria-label="Search"')
