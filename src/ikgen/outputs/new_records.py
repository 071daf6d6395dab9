"""The records of a generation: one beside its outputs, and one inside each package."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen.outputs.publish import content_digest
from ikgen.records.record import (
    GENERATOR,
    Asked,
    Record,
    environment_digest,
    record_name,
    record_text,
    seen_from,
)

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation
    from ikgen.model.joint_tree import Source
    from ikgen.records.request import Outputs, Request

__all__ = ["record_texts"]


def record_texts(
    request: Request,
    outputs: Outputs,
    derivation: Derivation,
    made: Mapping[str, Mapping[str, str]],
) -> dict[str, str]:
    """Path (relative to the outputs' folder) -> text of each record; `made` are the texts by output."""
    packages: dict[str, list[str]] = {}
    for name, texts in made.items():
        packages.setdefault(_package(texts), []).append(name)
    found = {}
    for package, names in packages.items():
        texts = {path: text for name in names for path, text in made[name].items()}
        record = _record(request, outputs, derivation, outputs.out / package)
        record = replace(record, emit=tuple(names), files=_digests(texts, package))
        found[(Path(package) / record.path.name).as_posix()] = record_text(record)
    return found


def _package(texts: Mapping[str, str]) -> str:
    """The folder that holds all of an output's files; "" where there is none."""
    tops = {path.partition("/")[0] if "/" in path else "" for path in texts}
    return tops.pop() if len(tops) == 1 else ""


def _digests(texts: Mapping[str, str], package: str) -> dict[str, str]:
    """Path relative to the package -> SHA-256."""
    start = len(package) + 1 if package else 0
    return {path[start:]: content_digest(text) for path, text in sorted(texts.items())}


def _record(request: Request, outputs: Outputs, derivation: Derivation, folder: Path) -> Record:
    """What outputs in a folder were made from: enough to make and to verify them again."""
    module = derivation.module
    dh = module.dh
    held = {name: request.free.get(name) for name in dh.free}
    explicit = replace(
        request,
        base=dh.base_link,
        tip=dh.tip_link,
        task=module.task,
        tool_axis=None,
        name=module.name,
        free=held,
    )
    return Record(
        generator=GENERATOR,
        version=module.generator_version,
        request=explicit,
        source_sha256=module.source_sha256,
        asked=Asked(request.base, request.tip, request.task, dict(request.free), request.tool_axis),
        emit=(),
        verified=outputs.verify,
        joints=tuple(joint.name for joint in dh.joints),
        max_solutions=module.max_solutions,
        inputs=_inputs(derivation.reading.source, folder),
        files={},
        environment={
            name: environment_digest(value) for name, value in derivation.reading.source.environment
        },
        out=outputs.out,
        path=folder / record_name(module.name),
    )


def _inputs(source: Source, folder: Path) -> dict[str, str]:
    """Digest of each file that was read, by its path relative to the record; by its URL where
    another package holds it, since where packages lie is not the project's to say."""
    urls = dict(source.package_urls)
    files = source.dependencies or (source.path,)
    found = {
        urls.get(p) or seen_from(p, folder): hashlib.sha256(p.read_bytes()).hexdigest()
        for p in files
    }
    return dict(sorted(found.items()))
