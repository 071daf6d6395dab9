"""xacro files: expanded by the xacro package, then read as URDF."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ikgen.errors import BadDescriptionError, IkgenError
from ikgen.importers.packages import PACKAGE_URL, PackageFinder
from ikgen.importers.urdf.urdf_tree import NO_LINKS, parse_urdf
from ikgen.importers.xacro.expansion_errors import explain
from ikgen.importers.xacro.expansion_session import Arguments, Session
from ikgen.importers.xml_document import Element, children, local_name, parse_xml, read_text
from ikgen.model.counted import listed
from ikgen.model.joint_tree import JointTree
from ikgen.model.oddity import Oddity

__all__ = ["Expansion", "expand", "read"]

_ARGUMENT = re.compile(r"\$\(arg\s+([^)\s]+)\s*\)")


@dataclass(frozen=True, slots=True)
class Expansion:
    """A xacro file's URDF text, the files read for it (absolute, itself first), the URLs of those
    that another package holds, the environment variables that it asked for, warnings, and the names of the
    macros that it defines."""

    text: str
    dependencies: tuple[Path, ...]
    package_urls: tuple[tuple[Path, str], ...] = ()
    warnings: tuple[Oddity, ...] = ()
    environment: tuple[tuple[str, str | None], ...] = ()
    macros: tuple[str, ...] = ()


def read(
    path: Path,
    *,
    arguments: Mapping[str, str],
    package_paths: Sequence[Path],
    trust: bool = False,
) -> JointTree:
    """Expand a xacro file and build the tree of the resulting URDF; `trust` as in `expand`.

    Raises `BadDescriptionError` naming the missing argument, package or include, with its place.
    """
    expansion = expand(path, arguments=arguments, package_paths=package_paths, trust=trust)
    try:
        return parse_urdf(
            expansion.text,
            path=path,
            kind="xacro",
            dependencies=expansion.dependencies,
            package_urls=expansion.package_urls,
            arguments=arguments,
            warnings=expansion.warnings,
            environment=expansion.environment,
        )
    except BadDescriptionError as error:
        if error.problem == NO_LINKS and expansion.macros:
            names, calls = listed(expansion.macros), f"<xacro:{expansion.macros[0]} ...>"
            error.hint = (
                f"the file only defines macros ({names}): give the file that calls them, by {calls}"
            )
        raise


def expand(
    path: Path,
    *,
    arguments: Mapping[str, str],
    package_paths: Sequence[Path] = (),
    trust: bool = False,
) -> Expansion:
    """Expand a xacro file with arguments NAME: VALUE.

    Unless `trust`, its expressions may only compute, its files lie in its package or one that was
    found, and time and size are bounded. With it, xacro evaluates the file, which then can do
    whatever Python can.

    The text has no absolute paths: what lies in a package becomes `package://`, so that the same
    sources give the same digest wherever they are checked out.
    """
    root = parse_xml(read_text(path), str(path))
    top = path.resolve()
    finder = PackageFinder(top, tuple(package_paths))
    known = Arguments({**_name_defaults(root), **arguments})
    session = Session(top, finder, trust=trust)
    try:
        with session:
            text = session.process(known)
    except IkgenError:
        raise
    except Exception as error:  # the file's own expressions can raise anything
        raise explain(error, session.files, session.includes, path, known) from error
    warnings = list(session.warnings)
    for name in sorted(set(arguments) - known.used):
        declared = ", ".join(sorted(known.used)) or "none"
        warnings.append(f"{path}: argument '{name}' is not used by the file; it takes: {declared}")
    dependencies = dict.fromkeys((top, *(included.resolve() for included in session.includes)))
    urls = {i.resolve(): url for i in session.includes if (url := finder.url(i)) is not None}
    return Expansion(
        _without_paths(text, finder, top),
        tuple(dependencies),
        tuple(urls.items()),
        tuple(map(Oddity, warnings)),
        tuple(sorted(session.environment.items())),
        tuple(e.get("name") for e in root.iter() if local_name(e) == "macro" and e.get("name")),
    )


def _name_defaults(root: Element) -> dict[str, str]:
    """Defaults of the arguments in `<robot name="$(arg x)">`.

    xacro evaluates the root's attributes before it reads `<xacro:arg name="x" default="..."/>`
    below it, and would refuse the file unless the argument is given.
    """
    needed = {name for value in root.attrib.values() for name in _ARGUMENT.findall(value)}
    return {
        element.get("name"): element.get("default")
        for element in children(root, "arg")
        if element.get("name") in needed and "$" not in element.get("default", "$")
    }


def _without_paths(text: str, finder: PackageFinder, top: Path) -> str:
    """Replace the directories that `$(find)` and `$(dirname)` put into the text; longest first."""
    places = {str(directory): f"package://{name}" for name, directory in finder.found.items()}
    places.setdefault(str(top.parent), ".")
    for directory in sorted(places, key=len, reverse=True):
        place = places[directory]
        if place != ".":
            text = text.replace(f"file://{directory}/", f"{place}/")
        text = re.sub(rf"{re.escape(directory)}(?![\w.+-])", place, text)
    return text.replace(f"file://{PACKAGE_URL}", PACKAGE_URL)  # of packages that were not found
