"""xacro's instructions without the prefix `xacro:`: the first releases of xacro expanded them, those of
today leave them in the text, where nothing reads them."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ikgen.importers.xml_document import Element, Place, local_name

__all__ = ["LEFT_OUT", "first_unprefixed", "require_expanded"]

LEFT_OUT = "xacro no longer expands instructions without its prefix"

_IN_JOINTS = frozenset({"if", "insert_block", "unless"})
_IN_ROBOTS = frozenset({"include", "macro", "property", *_IN_JOINTS})
_TAG = re.compile(rf"<({'|'.join(sorted(_IN_ROBOTS))})[\s/>]")


def first_unprefixed(text: str) -> tuple[str, int] | None:
    """The first instruction of a file's text (without comments) that has no prefix, and where it stands."""
    found = _TAG.search(text)
    return (found[1], found.start()) if found else None


def require_expanded(root: Element, place: Place) -> None:
    """Raise `BadDescriptionError` where a joint would be read without what an instruction stands for; one
    warning where others are left, as there is more to see then than what is read."""
    for joint in _named(root, {"joint"}):
        for element in _named(joint, _IN_JOINTS):
            tag = local_name(element)
            message = f"<{tag}> left in joint '{joint.get('name')}': {LEFT_OUT}"
            raise place.error(element, message, f"write <xacro:{tag}>")
    left = list(_named(root, _IN_ROBOTS))
    if left:
        tag = local_name(left[0])
        more = f" and {len(left) - 1} more" if len(left) > 1 else ""
        place.warn(left[0], f"<{tag}>{more} not read: {LEFT_OUT}; write <xacro:{tag}>")


def _named(element: Element, names: set[str] | frozenset[str]) -> Iterator[Element]:
    """The children with one of the names and no namespace."""
    return (child for child in element if child.tag in names)
