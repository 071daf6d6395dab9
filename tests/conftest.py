"""Test helpers are importable from everywhere below `tests`, and so is the package `benchmarks`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parent / "unit"))
sys.path.append(str(Path(__file__).parents[1]))
