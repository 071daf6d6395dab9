"""Where the collection of robot files lies that benchmarks and some tests run on.

The collection is not part of the package: the variable IKGEN_CORPUS names its folder, by default
`../shared/robots` beside the checkout. benchmarks/README.md says what it must look like.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

__all__ = ["ABSENT", "ARMS_FILE", "CORPUS", "load_arms"]

_BESIDE = Path(__file__).resolve().parents[2] / "shared" / "robots"
CORPUS = Path(os.environ.get("IKGEN_CORPUS") or _BESIDE).resolve()
ARMS_FILE = CORPUS / "arms.json"
ABSENT = "no collection of robots: IKGEN_CORPUS (default ../shared/robots) has no arms.json"


def load_arms() -> list[dict[str, Any]]:
    """The rows of `arms.json`, or none where the collection is absent."""
    return json.loads(ARMS_FILE.read_text(encoding="utf-8")) if ARMS_FILE.is_file() else []
