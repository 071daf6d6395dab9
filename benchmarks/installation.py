"""What an installation brings: its packages with their sizes, and what each extra adds.

    python -m benchmarks.installation

Counts the files of the packages that are installed here, as their records list them (compiled Python
included); pip and what else an environment has does not count. An editable installation's own files are
not listed, so measure where a wheel is installed.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable
from importlib.metadata import Distribution, PackageNotFoundError, distribution

from packaging.requirements import Requirement

__all__ = ["closure", "megabytes"]

VERIFIER = "pin"


def closure(name: str, extra: str = "") -> dict[str, Distribution]:
    """The packages that `name[extra]` brings, itself included, by name; those that are not installed are
    left out."""
    found: dict[str, Distribution] = {}
    wanted = [(name, extra)]
    while wanted:
        one, with_extra = wanted.pop()
        key = re.sub(r"[-_.]+", "-", one).lower()
        try:
            found[key] = found.get(key) or distribution(one)
        except PackageNotFoundError:
            continue
        for text in found[key].requires or ():
            need = Requirement(text)
            plain = need.marker is None or need.marker.evaluate({"extra": ""})
            asked = need.marker is not None and need.marker.evaluate({"extra": with_extra})
            new = re.sub(r"[-_.]+", "-", need.name).lower() not in found
            if asked or (plain and new):
                wanted += [(need.name, x) for x in need.extras or ("",) if asked or new]
    return found


def megabytes(packages: Iterable[Distribution]) -> float:
    """The sum of their files."""
    paths = (one.locate_file(file) for one in packages for file in one.files or ())
    return sum(path.stat().st_size for path in paths if path.is_file()) / 1e6  # type: ignore[attr-defined]


def main() -> int:
    """Print the tables."""
    plain = closure("ikgen")
    sizes = {name: megabytes([one]) for name, one in plain.items()}
    verifier = closure(VERIFIER).keys() - {"numpy"}
    for name, size in sorted(sizes.items(), key=lambda item: -item[1]):
        print(f"{name:24} {size:7.1f} MB{'  by Pinocchio' if name in verifier else ''}")
    own = sum(sizes[name] for name in verifier)
    print(
        f"\n{len(plain)} packages, {sum(sizes.values()):.0f} MB; {own:.0f} MB of them Pinocchio's"
    )
    for extra in sorted(plain["ikgen"].metadata.get_all("Provides-Extra") or ()):
        more = {n: one for n, one in closure("ikgen", extra).items() if n not in plain}
        if more:
            size = f"{len(more)} more, {megabytes(more.values()):.0f} MB"
            print(f"[{extra}]: {size}: {', '.join(sorted(more))}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
