"""What xacro's exceptions mean to the person who wrote the file."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from xml.parsers.expat import ExpatError

from ikgen.errors import BadDescriptionError
from ikgen.importers.packages import PackageNotFoundError
from ikgen.importers.unprefixed import LEFT_OUT, first_unprefixed
from ikgen.importers.urdf.attribute_values import shortened
from ikgen.importers.xacro.error_places import line_of, place_of, text_of
from ikgen.importers.xacro.refusal_errors import refused
from ikgen.importers.xml_document import line_at

__all__ = ["explain"]

_LONGEST_MESSAGE = 400

_CALL = r"<xacro:{macro}(?=[\s/>])"
_PLACES = (
    (r"when evaluating expression '(.*)'", r"\$\{{\s*{text}"),
    (r"unknown macro name: (\S+)", r"<{text}(?=[\s/>])"),
    (r"Undefined parameters \[([^],]+)", _CALL + r"(?![^>]*\s{text}\s*=)"),
    (r'Invalid parameter "([^"]+)"', _CALL + r"[^>]*\s{text}\s*="),
    (r'Undefined block "([^"]+)"', r"insert_block\s[^>]*[\"']{text}[\"']"),
    (r'conditional "(.*?)" evaluated', r"value\s*=\s*[\"']{text}[\"']"),
    (r"environment variable '([^']+)'", r"\$\(env\s+{text}"),
    (r"Unknown substitution command \[(.*?)\]", r"\$\({text}"),
)
"""What xacro says, with the text that it names, and what stands at the place that it is about: patterns,
the second one to be filled in. `macro` is the innermost that is being expanded."""

_ARGUMENT_TAG = re.compile(r"<xacro:arg\b[^>]*>")
_NAME = re.compile(r"""\bname\s*=\s*["']([^"']*)""")


def explain(
    error: Exception,
    files: Sequence[Path],
    includes: Sequence[Path],
    shown: Path,
    arguments: Mapping[str, str],
) -> BadDescriptionError:
    """The error to show for an exception out of an expansion.

    `files` is xacro's stack of files (absolute, innermost last), `includes` all that it opened
    beside the first, `shown` the top file as the user named it, `arguments` those with a value.
    """
    file = files[-1] if files else shown
    name = str(shown) if len(files) < 2 else str(file)
    for cause in _causes(error):
        found = refused(cause, [file, *includes], name)
        found = found or _explain_one(cause, file, name, arguments)
        if found is not None:
            return found
    return _unexplained(error, [file, *includes], name)


def _unexplained(error: Exception, files: Sequence[Path], name: str) -> BadDescriptionError:
    # xacro writes "<class 'NameError'>: text text" around what an expression raised.
    inner = getattr(error, "exc", None)
    outer = str(error).strip()
    message = str(inner) if inner is not None and outer.startswith("<class") else outer
    macros = [macro.body.getAttribute("name") for macro in getattr(error, "macros", ())]
    within = f" (in macro '{macros[0]}')" if macros else ""
    pattern = _pattern(message, macros[0] if macros else "")
    # The stack names the file that calls a macro, not the one with the macro's text.
    name, line = place_of(pattern, files, name) if pattern else (name, None)
    message = shortened(" ".join(message.split()), _LONGEST_MESSAGE)
    return BadDescriptionError(
        f"xacro cannot expand the file: {message or type(error).__name__}{within}",
        file=name,
        line=line,
        hint=_old_spelling(files) or "check the expression or macro that the message names",
    )


def _pattern(message: str, macro: str) -> str:
    """What stands where an expansion failed, as a pattern, "" where that is not known."""
    for said, place in _PLACES:
        found = re.search(said, message)
        if found is not None:
            name = re.escape(macro.removeprefix("xacro:"))
            return place.format(text=re.escape(found[1].strip()), macro=name)
    return ""


def _old_spelling(files: Sequence[Path]) -> str:
    """What to do where a file has instructions without xacro's prefix: what they define is unknown."""
    for file in files:
        text = text_of(file)
        found = first_unprefixed(text)
        if found is not None:
            tag, start = found
            where = f"line {line_at(text, start)} of {file.name}"
            return f"{where} has <{tag}>: {LEFT_OUT}; write <xacro:{tag}> there and in what follows"
    return ""


def _causes(error: BaseException) -> Iterator[BaseException]:
    """The exceptions that led to one, it first; xacro keeps them in `exc`."""
    seen: list[BaseException] = []
    waiting: list[BaseException | None] = [error]
    while waiting:
        cause = waiting.pop(0)
        if isinstance(cause, BaseException) and cause not in seen:
            seen.append(cause)
            yield cause
            waiting += [getattr(cause, "exc", None), cause.__cause__, cause.__context__]


def _explain_one(
    cause: BaseException, file: Path, name: str, arguments: Mapping[str, str]
) -> BadDescriptionError | None:
    if isinstance(cause, PackageNotFoundError):
        line = line_of(file, rf"(find\W+|package://){re.escape(cause.name)}\b")
        own = f"the package's folder (named '{cause.name}', or with a package.xml that says so)"
        searched = "; ".join(cause.searched)
        hint = f"give --package-path DIR, {own} or one that holds it; looked in: {searched}"
        return BadDescriptionError(str(cause), file=name, line=line, hint=hint)
    if type(cause).__name__ == "ArgException":
        return _missing_argument(str(cause), file, name, arguments)
    if isinstance(cause, RuntimeError) and "missing attribute 'default'" in str(cause):
        return _no_default(file, name)
    if isinstance(cause, ExpatError):
        reason = str(cause).partition(":")[0]
        return BadDescriptionError(
            f"not well-formed XML: {reason}",
            file=name,
            line=cause.lineno,
            hint="correct the XML at this line",
        )
    if isinstance(cause, RecursionError):
        return BadDescriptionError(
            "the macros or includes never end", file=name, hint="look for one that uses itself"
        )
    if isinstance(cause, OSError) and cause.filename is not None:
        return _unreadable(cause, file, name)
    return _bad_yaml(cause)


def _missing_argument(
    argument: str, file: Path, name: str, arguments: Mapping[str, str]
) -> BadDescriptionError:
    given = ", ".join(sorted(dict(arguments))) or "none"
    return BadDescriptionError(
        f"the xacro argument '{argument}' has no value",
        file=name,
        line=line_of(file, rf"arg\W+{re.escape(argument)}\b"),
        hint=f"give it: --arg {argument}:=VALUE (arguments with a value so far: {given})",
    )


def _no_default(file: Path, name: str) -> BadDescriptionError:
    text = text_of(file)
    tags = [tag for tag in _ARGUMENT_TAG.finditer(text) if not re.search(r"\bdefault\s*=", tag[0])]
    found = _NAME.search(tags[0][0]) if tags else None
    return BadDescriptionError(
        f'<xacro:arg name="{found[1] if found else "?"}"> has no default, which xacro requires',
        file=name,
        line=line_at(text, tags[0].start()) if tags else None,
        hint='write default="..." there; --arg still overrides it',
    )


def _unreadable(cause: OSError, file: Path, name: str) -> BadDescriptionError:
    missing = str(cause.filename)
    return BadDescriptionError(
        f"cannot read '{missing}': {cause.strerror}",
        file=name,
        line=line_of(file, re.escape(Path(missing).name)),
        hint="check the path, or the arguments that it is made of",
    )


def _bad_yaml(cause: BaseException) -> BadDescriptionError | None:
    mark = getattr(cause, "problem_mark", None)
    if mark is None:
        return None
    problem = getattr(cause, "problem", None) or "not valid YAML"
    return BadDescriptionError(
        f"not valid YAML: {problem}",
        file=str(mark.name),
        line=mark.line + 1,
        hint="correct the YAML at this line",
    )
