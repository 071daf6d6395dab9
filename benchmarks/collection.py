"""Where the collection of robot files lies that benchmarks and some tests run on.

The collection is not part of the package: the variable IKGEN_CORPUS names its folder, by default
`../shared/robots` beside the checkout. benchmarks/README.md says what it must look like.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

__all__ = ["ABSENT", "ARMS_FILE", "CORPUS", "load_arms", "urdf_of"]

_BESIDE = Path(__file__).resolve().parents[2] / "shared" / "robots"
CORPUS = Path(os.environ.get("IKGEN_CORPUS") or _BESIDE).resolve()
ARMS_FILE = CORPUS / "arms.json"
ABSENT = "no collection of robots: IKGEN_CORPUS (default ../shared/robots) has no arms.json"


def load_arms() -> list[dict[str, Any]]:
    """The rows of `arms.json`, or none where the collection is absent."""
    return json.loads(ARMS_FILE.read_text(encoding="utf-8")) if ARMS_FILE.is_file() else []


def urdf_of(arm: dict[str, Any]) -> str:
    """A URDF with the digits of the arm's chain, for arms whose file is not distributable."""
    lines = [f'<robot name="{arm["name"]}">', f'<link name="{arm["base_link"]}"/>']
    for j in arm["chain"]:
        kind = j.get("base_type", j["type"])
        xyz, rpy = (" ".join(repr(float(x)) for x in j[k]) for k in ("xyz", "rpy"))
        lines.append(f'<link name="{j["child"]}"/>')
        lines.append(f'<joint name="{j["joint"]}" type="{kind}"><origin xyz="{xyz}" rpy="{rpy}"/>')
        lines.append(f'<parent link="{j["parent"]}"/><child link="{j["child"]}"/>')
        if kind != "fixed":
            lines.append(f'<axis xyz="{" ".join(repr(float(x)) for x in j["axis"])}"/>')
        if kind in ("revolute", "prismatic"):
            low, high = j.get("lower"), j.get("upper")
            span = f'lower="{low!r}" upper="{high!r}"' if low is not None else ""
            lines.append(f'<limit {span} effort="1" velocity="1"/>')
        if "mimic" in j:
            m = j["mimic"]
            lines.append(
                f'<mimic joint="{m["joint"]}" multiplier="{m.get("multiplier", 1)}" '
                f'offset="{m.get("offset", 0)}"/>'
            )
        lines.append("</joint>")
    return "\n".join([*lines, "</robot>"])
