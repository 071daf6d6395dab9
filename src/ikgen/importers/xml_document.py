"""A file's text and its XML, with every failure turned into an error that has a file and a line."""

from __future__ import annotations

import re
import stat
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lxml import etree

from ikgen.errors import BadDescriptionError, place_in
from ikgen.importers.merge_conflict import conflict_or
from ikgen.model.joint_tree import Source
from ikgen.model.oddity import Oddity, OddityKind

__all__ = [
    "LARGEST_FILE",
    "WEB_PAGE_HINT",
    "Element",
    "Place",
    "children",
    "line_at",
    "local_name",
    "parse_xml",
    "read_text",
    "shown_file",
]

Element = Any
"""An lxml element; lxml has no type stubs."""

LARGEST_FILE = 16 * 2**20
"""The most bytes that a description may have; published ones have up to some 200 kB."""

WEB_PAGE_HINT = "this is a web page: save the file itself, on GitHub by its 'Raw' button"

_WEB_PAGE = re.compile(r"\s*(<!--.*?-->\s*)*(<!doctype\s+html|<html)\b", re.IGNORECASE | re.DOTALL)
_BYTE_ORDER_MARKS = (
    (b"\xef\xbb\xbf", "utf-8-sig"),
    (b"\xff\xfe", "utf-16"),
    (b"\xfe\xff", "utf-16"),
)
_DECLARED_ENCODING = re.compile(rb"""^\s*<\?xml[^>]*?encoding\s*=\s*["']([\w.\-]+)["']""")
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_SYNTAX_HINTS = (
    ("Extra content", "the file holds two documents: keep one <robot> element"),
    ("prefix xacro", 'add xmlns:xacro="http://www.ros.org/wiki/xacro" to <robot>'),
    ("declaration", "something stands before the XML declaration: remove it"),
    ("Start tag expected", "the file is not XML, or has text before its first tag"),
    ("Excessive depth", "elements of a description do not nest that deep"),
    ("entity", "write entities out: a description needs no document type"),
)


@dataclass(frozen=True, slots=True)
class Place:
    """Where messages about a document point: its file, and the warnings collected so far."""

    file: str
    warnings: list[Oddity] = field(default_factory=list)

    def error(self, element: Element, message: str, hint: str = "") -> BadDescriptionError:
        """The error to raise about an element, with the file and the element's line."""
        line = None if element is None else element.sourceline
        return BadDescriptionError(message, file=self.file, line=line, hint=hint)

    def warn(
        self,
        element: Element,
        message: str,
        joint: str = "",
        kind: OddityKind = OddityKind.TOLD,
    ) -> None:
        """Record an oddity that could be read anyway, about one `joint` where it is named."""
        self.warn_at(None if element is None else element.sourceline, message, joint, kind)

    def warn_at(
        self,
        line: int | None,
        message: str,
        joint: str = "",
        kind: OddityKind = OddityKind.TOLD,
    ) -> None:
        """Record an oddity of a line."""
        self.warnings.append(Oddity(f"{place_in(self.file, line)}{message}", joint, kind))


def shown_file(source: Source) -> str:
    """The name of a source in messages; lines of a xacro file are those of its expansion."""
    return f"{source.path} (expanded)" if source.kind == "xacro" else str(source.path)


def read_text(path: Path, largest: int = LARGEST_FILE, *, may_be_empty: bool = False) -> str:
    """The decoded text of a file of at most `largest` bytes; line ends are as in Unix, whatever git
    made of them. Raises `BadDescriptionError`, also for pipes and devices, which may never end."""
    try:
        status = path.stat()
        if stat.S_ISREG(status.st_mode) and status.st_size <= largest:
            data = path.read_bytes()
        else:
            raise _not_readable(path, status.st_mode, status.st_size, largest)
    except FileNotFoundError:
        raise BadDescriptionError("no such file", file=str(path), hint="check the path") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        hint = "check the path and its permissions"
        raise BadDescriptionError(reason, file=str(path), hint=hint) from None
    text = _decode(data, path).replace("\r\n", "\n").replace("\r", "\n")
    if not text.strip() and not may_be_empty:
        hint = "check the path, and that the file was saved"
        raise BadDescriptionError("the file is empty", file=str(path), hint=hint)
    return text


def _not_readable(path: Path, mode: int, size: int, largest: int) -> BadDescriptionError:
    if stat.S_ISDIR(mode):
        return BadDescriptionError(
            "is a directory, not a file",
            file=str(path),
            hint="name the file inside it",
        )
    if not stat.S_ISREG(mode):
        return BadDescriptionError(
            "is no regular file but a pipe or a device",
            file=str(path),
            hint="save the description as a file",
        )
    return BadDescriptionError(
        f"the file has {size / 2**20:.0f} MB, more than {largest / 2**20:.3g} MB",
        file=str(path),
        hint="a description names its meshes by file: move what is inlined out of it",
    )


def _decode(data: bytes, path: Path) -> str:
    declared = _DECLARED_ENCODING.match(data)
    encoding = declared.group(1).decode("ascii") if declared else "utf-8"
    for mark, name in _BYTE_ORDER_MARKS:
        if data.startswith(mark):
            encoding = name
    try:
        return data.decode(encoding)
    except (UnicodeDecodeError, LookupError) as error:
        raise BadDescriptionError(
            f"cannot decode the file as {encoding}: {error}",
            file=str(path),
            hint="save it as UTF-8, or declare its encoding in <?xml ... encoding=...?>",
        ) from None


def parse_xml(text: str, file: str) -> Element:
    """The root element of an XML text. Nothing is fetched; a document type that declares or names
    something is refused, as entities are declared there."""
    # The text is decoded already, so its own encoding declaration must not be applied again.
    data = text.encode("utf-8", "replace")
    parser = _parser()
    try:
        root = etree.fromstring(data, parser)
    except etree.XMLSyntaxError as error:
        faults = [fault for fault in parser.error_log if not _is_undeclared_prefix(fault)]
        bare = _without_comments(text) if any(map(_is_of_comment, faults)) else text
        if bare != text:
            return parse_xml(bare, file)
        if faults or not len(parser.error_log):
            message = faults[0].message if faults else error.msg or "not XML"
            raise BadDescriptionError(
                f"not well-formed XML: {message.partition(', line')[0]}",
                file=file,
                line=(faults[0].line if faults else error.lineno) or None,
                hint=_syntax_hint(text, message),
            ) from None
        root = etree.fromstring(data, _parser(recover=True))
    _check_document_type(root, text, file)
    return root


def _parser(*, recover: bool = False) -> Any:
    return etree.XMLParser(
        resolve_entities=False, no_network=True, huge_tree=False, encoding="utf-8", recover=recover
    )


def _is_undeclared_prefix(fault: Any) -> bool:
    """Whether a parser's complaint is of a prefix that no xmlns declares, as in `<sensor:camera>` of files
    for old simulators: other readers take it as part of the name. xacro's says what is to be expanded."""
    undeclared = fault.type == etree.ErrorTypes.NS_ERR_UNDEFINED_NAMESPACE
    return undeclared and "prefix xacro" not in fault.message


def _is_of_comment(fault: Any) -> bool:
    """Whether a parser's complaint is of `--` in a comment, which other readers take."""
    return bool(fault.type == etree.ErrorTypes.ERR_HYPHEN_IN_COMMENT)


def _without_comments(text: str) -> str:
    """The text with its comments blank, lines as they were."""
    return _COMMENT.sub(lambda found: "\n" * found[0].count("\n"), text)


def _check_document_type(root: Element, text: str, file: str) -> None:
    about = root.getroottree().docinfo
    declared = about.internalDTD
    if declared is None:
        return
    if about.system_url or about.public_id or any(declared.iterentities()):
        raise BadDescriptionError(
            "<!DOCTYPE> declares entities or names a DTD",
            file=file,
            line=line_at(text, text.find("<!DOCTYPE")),
            hint=WEB_PAGE_HINT
            if _WEB_PAGE.match(text)
            else "a description needs no document type: remove it and write entities out",
        )


def line_at(text: str, position: int) -> int:
    """The line, counted from 1, of a position in a text."""
    return text.count("\n", 0, position) + 1


def _syntax_hint(text: str, message: str) -> str:
    if text.startswith("version https://git-lfs"):
        return "this is a Git LFS pointer: run 'git lfs pull'"
    if _WEB_PAGE.match(text):
        return WEB_PAGE_HINT
    hints = (hint for key, hint in _SYNTAX_HINTS if key in message)
    return conflict_or(text, next(hints, "correct the XML at this line"))


def local_name(element: Element) -> str:
    """An element's tag without its namespace; empty for comments and processing instructions."""
    tag = element.tag
    return tag.rpartition("}")[2] if isinstance(tag, str) else ""


def children(element: Element, name: str) -> Iterator[Element]:
    """The direct children of an element with this local name, in file order."""
    return (child for child in element if child.tag == name or local_name(child) == name)
