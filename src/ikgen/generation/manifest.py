"""The text of the record beside the outputs; `ikgen.generation.record` reads it."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ikgen.generation.generation import Outputs
    from ikgen.generation.pipeline import Derivation, Request
    from ikgen.model.joint_tree import Source

__all__ = ["manifest"]


def manifest(
    request: Request, outputs: Outputs, derivation: Derivation, texts: Mapping[str, str]
) -> str:
    """What the outputs were made from: enough to make and to verify them again."""
    module = derivation.module
    record = {
        "generator": "ikgen",
        "version": module.generator_version,
        "name": module.name,
        "robot": _place(request.robot, outputs.out),
        "source_sha256": module.source_sha256,
        "base": module.dh.base_link,
        "tip": module.dh.tip_link,
        "task": module.task,
        "free": dict(request.free),
        "lock": dict(request.locked),
        "args": dict(request.arguments),
        "package_paths": [_place(path, outputs.out) for path in request.package_paths],
        "asked": {"base": request.base, "tip": request.tip, "task": request.task},
        "emit": list(outputs.emit),
        "verified": outputs.verify,
        "joints": [joint.name for joint in module.dh.joints],
        "max_solutions": module.max_solutions,
        "inputs": _inputs(derivation.reading.source, outputs.out),
        "files": {
            name: hashlib.sha256(text.encode()).hexdigest() for name, text in sorted(texts.items())
        },
    }
    return json.dumps(record, indent=2) + "\n"


def _inputs(source: Source, out: Path) -> dict[str, str]:
    """Digest of each file that was read, by its path relative to the outputs; by its URL where
    another package holds it, since where packages lie is not the project's to say."""
    urls = dict(source.package_urls)
    files = source.dependencies or (source.path,)
    found = {
        urls.get(p) or _place(p, out): hashlib.sha256(p.read_bytes()).hexdigest() for p in files
    }
    return dict(sorted(found.items()))


def _place(path: Path, out: Path) -> str:
    """A path relative to the outputs, with slashes on every system."""
    return Path(os.path.relpath(path.resolve(), out.resolve())).as_posix()
