"""The same bytes whatever the surroundings: a matrix of builds that are compared with a first one.

    python -m benchmarks.determinism [--arms FILE ...] [--only WORDS ...] [--pythons PATH ...]
                                     [--record [--add]]

Each row changes one thing: the kernels that OpenBLAS chooses, the vector instructions that NumPy and the C
library may use, hash seed, locale, time zone, working directory, spelling of the path, number of processes.
The arms are solved by rules, from exact and from rounded files, and by eliminations, which are chosen by
probing. `--pythons` adds a row for each interpreter named, with the NumPy that it has; it needs what ikgen
imports to generate. With `--add` rows are added to what is recorded of the same arms. Exit code 1 where a
file differs.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from benchmarks.collection import CORPUS, load_arms
from benchmarks.command_line import FIXTURES, REPOSITORY
from benchmarks.results import read_result, write_result

__all__ = ["Row", "main", "rows"]

_WIDE = "AVX512F AVX512CD AVX512_SKX AVX512_CLX AVX512_CNL AVX512_ICL X86_V4 AVX512_SPR"


@dataclass(frozen=True, slots=True)
class Row:
    """One build: what is changed, in words, and how: environment, options of `ikgen build`, the working
    directory (by its place above the project) and how the config is named from there, the interpreter."""

    words: str
    environment: Mapping[str, str] = field(default_factory=dict)
    options: tuple[str, ...] = ("-j", "1")
    above: int = 0
    config: str = "ikgen.toml"
    python: str = sys.executable


_VERSIONS = (
    "import platform as p, numpy; print(f'Python {p.python_version()}, NumPy {numpy.__version__}')"
)


def row_of(python: str) -> Row:
    """A build by another interpreter, which takes ikgen from where this one has it."""
    words = subprocess.run([python, "-c", _VERSIONS], capture_output=True, text=True, check=True)
    return Row(words.stdout.strip(), {"PYTHONPATH": str(REPOSITORY / "src")}, python=python)


def rows() -> list[Row]:
    """The matrix; its first row is what the others are compared with."""
    found = [Row("as it is")]
    found += [Row(f"OpenBLAS for {name}", {"OPENBLAS_CORETYPE": name}) for name in _kernels()]
    found += [
        Row("two threads of OpenBLAS", {"OPENBLAS_NUM_THREADS": "2"}),
        Row("NumPy without AVX-512", {"NPY_DISABLE_CPU_FEATURES": _wide()}),
        Row("NumPy without AVX2", {"NPY_DISABLE_CPU_FEATURES": _wide("AVX2", "FMA3", "X86_V3")}),
        Row("C library without AVX-512", {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX512F"}),
    ]
    found += [Row(f"hash seed {seed}", {"PYTHONHASHSEED": seed}) for seed in ("0", "1", "4242")]
    found += [Row(f"locale {name}", {"LC_ALL": name}) for name in ("C", "C.UTF-8", "tr_TR.UTF-8")]
    found += [Row(f"time zone {name}", {"TZ": name}) for name in ("UTC", "Asia/Kathmandu")]
    found += [
        Row("from the folder above", above=1, config="project/ikgen.toml"),
        Row(
            "from two above, a long spelling",
            above=2,
            config="{up}/project/../project/./ikgen.toml",
        ),
        Row("an absolute path", above=1, config="{absolute}"),
        Row("two processes", options=("-j", "2")),
    ]
    return found


_KERNELS = {
    "SkylakeX": "AVX512F",
    "Haswell": "AVX2",
    "Sandybridge": "AVX",
    "Zen": "AVX2",
    "Prescott": "SSE3",
}


def _kernels() -> list[str]:
    """OpenBLAS's for processors that can no more than this one."""
    from numpy._core._multiarray_umath import __cpu_features__

    return [name for name, needed in _KERNELS.items() if __cpu_features__.get(needed)]


def _wide(*more: str) -> str:
    """Those of the features that this NumPy knows and the processor has."""
    from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__

    wanted = {*_WIDE.split(), *more}
    return " ".join(n for n in __cpu_dispatch__ if n in wanted and __cpu_features__.get(n))


@dataclass(frozen=True, slots=True)
class Arm:
    """A description, and the chain that is meant; empty where it has one only."""

    file: Path
    base: str = ""
    tip: str = ""

    @property
    def table(self) -> str:
        """Its part of a config beside which the file lies."""
        ends = f'base = "{self.base}"\ntip = "{self.tip}"\n' if self.base else ""
        text = (
            f'[[arm]]\nname = "{self.file.stem}"\nrobot = "{self.file.name}"\nout = "out"\n{ends}'
        )
        return text + 'emit = ["python", "cpp"]\n'


def built(row: Row, arms: Sequence[Arm]) -> dict[str, str]:
    """Digests of what a build in a new folder gives, by name."""
    place = Path(tempfile.mkdtemp(prefix="determinism-"))
    try:
        project = place / "up" / "project"
        project.mkdir(parents=True)
        for arm in arms:
            shutil.copy(arm.file, project)
        text = "".join(arm.table for arm in arms)
        (project / "ikgen.toml").write_text(text, encoding="utf-8")
        here = (project, place / "up", place)[row.above]
        config = row.config.format(up="up", absolute=project / "ikgen.toml")
        command = [row.python, "-m", "ikgen", "build", config, "-q", "--no-verify"]
        subprocess.run(
            [*command, *row.options], cwd=here, env={**os.environ, **row.environment}, check=True
        )
        files = sorted((project / "out").iterdir())
        return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in files}
    finally:
        shutil.rmtree(place, ignore_errors=True)


_NAMES = (
    "doosan_m1013", "ur5e", "franka_fr3",  # by rules
    "xarm6", "bravo7", "pm01_left_arm", "fanuc_crx30ia", "schunk_lwa4p",  # by eliminations
)  # fmt: skip


def default_arms() -> list[Arm]:
    """Arms of exact and of rounded files, solved by rules and by eliminations."""
    of_name = {row["name"]: row for row in load_arms()}
    rows = [of_name[name] for name in _NAMES if name in of_name]
    found = [Arm(CORPUS / row["file"], row["base_link"], row["tip_link"]) for row in rows]
    return [Arm(FIXTURES / "kuka_kr6r900sixx.urdf"), *found]


def main() -> int:
    """Print the matrix."""
    parser = argparse.ArgumentParser(description="The same bytes in all surroundings.")
    parser.add_argument("--arms", nargs="+", type=Path, default=None)
    parser.add_argument(
        "--only", nargs="+", default=None, help="rows whose words have one of these"
    )
    parser.add_argument("--pythons", nargs="+", default=[], help="interpreters to build with too")
    parser.add_argument("--record", action="store_true", help="write the recorded result")
    parser.add_argument("--add", action="store_true", help="to what is recorded")
    options = parser.parse_args()
    arms = [Arm(file) for file in options.arms] if options.arms else default_arms()
    first, *others = rows()
    expected = built(first, arms)
    others = [r for r in others if not options.only or any(o in r.words for o in options.only)]
    others += [row_of(python) for python in options.pythons]
    print(f"{len(expected)} files of {len(arms)} arms")
    differing: dict[str, int] = {}
    if options.add:
        before = read_result("determinism").found
        if (before["files"], before["arms"]) != (len(expected), len(arms)):
            raise SystemExit("what is recorded is of other arms")
        differing.update(before["differing"])
    for row in others:
        found = built(row, arms)
        names = [n for n in {**expected, **found} if expected.get(n) != found.get(n)]
        differing[row.words] = len(names)
        print(f"{row.words:34} {'differs: ' + ', '.join(names) if names else 'same'}", flush=True)
    if options.record:
        shown = {"files": len(expected), "arms": len(arms), "differing": differing}
        write_result("determinism", "python -m benchmarks.determinism", shown)
    return 1 if any(differing.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
