"""Lists (`<name>_report.json`, `<name>_reach.json`) of files that are no outputs of a record: what ikgen
wrote, so that what somebody else wrote, or edited since, is not replaced unasked."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path

from ikgen.errors import BadDescriptionError, UsageError
from ikgen.outputs.publish import Content, content_digest, publish
from ikgen.records.record import GENERATOR, digest, read_record, records_of

__all__ = ["Wrote", "check_written", "digests_listed", "publish_listed", "recorded"]

Wrote = Mapping[Path, Collection[str]]
"""Resolved path -> SHA-256 of what ikgen wrote there, one for each record or list."""


def publish_listed(
    out: Path,
    name: str,
    files: Mapping[str, Content],
    gone: Iterable[Path] = (),
    *,
    arm: str = "",
    force: bool = False,
) -> tuple[Path, ...]:
    """As `publish`, with the list `name`.json of the files; raises `UsageError` where one that would be
    replaced or removed is not as ikgen wrote it, unless it is a matter of `force`. Files may also be in
    records of the arm. The paths of `files`, without the list."""
    wrote, place, gone = (
        _both(digests_listed(out, name), recorded(out, arm)),
        out / f"{name}.json",
        tuple(gone),
    )
    if not force:
        check_written(out, {place.name: None, **files}, wrote, _own(place))
        check_written(out, {path.relative_to(out).as_posix(): None for path in gone}, wrote)
    kept = {
        path: found for path in digests_listed(out, name) if (found := digest(path)) in wrote[path]
    }
    digests = {path.relative_to(out.resolve()).as_posix(): text for path, text in kept.items()}
    removed = {path.relative_to(out).as_posix() for path in gone}
    digests |= {file: content_digest(content) for file, content in files.items()}
    digests = {file: text for file, text in sorted(digests.items()) if file not in removed}
    text = json.dumps({"generator": GENERATOR, "files": digests}, indent=2) + "\n"
    return publish(out, {**files, place.name: text}, gone)[:-1]


def digests_listed(out: Path, name: str) -> dict[Path, set[str]]:
    """What the list `name`.json of a folder holds; nothing where there is none."""
    files = _files(out / f"{name}.json") or {}
    inside = {(out / file).resolve(): {text} for file, text in files.items()}
    return {path: text for path, text in inside.items() if path.is_relative_to(out.resolve())}


def recorded(out: Path, arm: str) -> dict[Path, set[str]]:
    """What the records of an arm's outputs in a folder hold, without those that cannot be read."""
    found: dict[Path, set[str]] = {}
    for path in records_of(out, arm) if arm else ():
        try:
            record = read_record(path)
        except BadDescriptionError:
            continue
        for file, text in record.files.items():
            found.setdefault((record.folder / file).resolve(), set()).add(text)
    return found


def check_written(
    out: Path,
    files: Mapping[str, Content | None],
    wrote: Wrote,
    own: Collection[Path] = (),
    way_out: str = "write elsewhere with -o DIR, or replace it with --force",
) -> None:
    """Raises `UsageError` where a file of the folder is neither as ikgen wrote it nor as it is to become
    (None: removed), nor one of ikgen's `own` beside them; `way_out` is told then."""
    for name, content in files.items():
        path = (out / name).resolve()
        found, known = digest(path), set(wrote.get(path, ()))
        if content is not None:
            known.add(content_digest(content))
        if found is None or path in own or found in known:
            continue
        what = "was edited after it was generated" if path in wrote else "is in no record of ikgen"
        raise UsageError(
            f"{out / name} {what}",
            hint=f"keep it by another name, {way_out}",
        )


def _own(place: Path) -> tuple[Path, ...]:
    return () if _files(place) is None else (place.resolve(),)


def _files(place: Path) -> dict[str, str] | None:
    """File -> SHA-256 of a list; None where it is none."""
    try:
        data = json.loads(place.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    files = data.get("files") if isinstance(data, dict) else None
    if not isinstance(files, dict) or data.get("generator") != GENERATOR:
        return None
    return {str(file): str(text) for file, text in files.items()}


def _both(one: Wrote, other: Wrote) -> dict[Path, set[str]]:
    paths = {*one, *other}
    return {path: {*one.get(path, ()), *other.get(path, ())} for path in paths}
