"""The emitted MoveIt package, compiled against stub interfaces and called through them."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio
from numpy.typing import ArrayLike, NDArray

from ikgen.model.joint_tree import JointTree
from ikgen.verify.runners.cpp_toolchain import find_eigen

__all__ = ["Answer", "Plugin", "Search", "compile_driver", "own_test", "warnings_of"]

Array = NDArray[np.float64]

STUBS = Path(__file__).resolve().parents[1] / "conformance" / "moveit_stubs"
_STRICT = ["-std=c++17", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]

SUCCESS, TIMED_OUT, GOAL_IN_COLLISION, NO_IK_SOLUTION = 1, -6, -12, -31
NO_DISCRETIZATION, ALL_DISCRETIZED, ALL_RANDOM_SAMPLED = 1, 2, 4


def _command(compiler: str, package: Path, style: str) -> list[str]:
    includes = [package / "include", STUBS / "common", STUBS / style]
    found = shutil.which(compiler)
    assert found is not None
    return [found, *_STRICT, *(f"-I{path}" for path in includes), "-isystem", str(find_eigen())]


def _together(sources: Sequence[str], whole: Path) -> Path:
    """One source of several."""
    whole.write_text("".join(f'#include "{source}"\n' for source in sources))
    return whole


def warnings_of(compiler: str, package: Path, style: str) -> str:
    """What a compiler has to say about the package's sources, checked as one but not built."""
    whole = str(_together(_sources(package), package.parent / f"{style}.cpp"))
    command = [*_command(compiler, package, style), "-fsyntax-only", whole]
    return subprocess.run(command, capture_output=True, text=True, check=False).stderr


def compile_driver(package: Path, style: str, program: Path, *, apart: bool = False) -> None:
    """The plugin and the program that calls it; warnings are errors. Compiled as one source, which reads
    the solver once, or each by itself."""
    sources = [*_sources(package), str(STUBS / "driver.cpp")]
    if not apart:
        sources = [str(_together(sources, program.with_suffix(".cpp")))]
    command = [*_command("g++", package, style), "-O1", *sources, "-o", str(program)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[:4000]


def own_test(package: Path, program: Path) -> subprocess.CompletedProcess[str]:
    """What came of the program that the package tests its solver with; warnings are errors."""
    source = str(package / "test/solver_test.cpp")
    command = [*_command("g++", package, "hpp"), "-O1", source, "-o", str(program)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[:4000]
    return subprocess.run([program], capture_output=True, text=True, check=False)


def _sources(package: Path) -> list[str]:
    return [str(path) for path in sorted(package.glob("src/*.cpp"))]


@dataclass(frozen=True)
class Answer:
    """What a call gave: its flag, its error code, numbers and what the plugin logged."""

    good: bool
    code: int
    values: Array
    log: str


@dataclass(frozen=True)
class Search:
    """What a search gave, and the candidates that its callback saw (N, dof)."""

    good: bool
    code: int
    q: Array
    seen: Array


class Plugin:
    """A running driver with a robot model; see `driver.cpp` for the calls."""

    def __init__(self, program: Path, dof: int) -> None:
        self.dof = dof
        self._process = subprocess.Popen(
            [program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
        )

    def close(self) -> None:
        """End the driver."""
        self._process.communicate(timeout=10)

    def tell(self, *words: object) -> None:
        """A call without an answer."""
        assert self._process.stdin is not None
        self._process.stdin.write(" ".join(map(str, words)) + "\n")

    def ask(self, *words: object) -> tuple[list[float], str]:
        """A call's numbers, and what was logged on the way."""
        self.tell(*words)
        assert self._process.stdout is not None
        log = []
        for line in self._process.stdout:
            if line.startswith("= "):
                return [float(word) for word in line.split()[1:]], "".join(log)
            if line.startswith("="):
                return [], "".join(log)
            log.append(line.removeprefix("! "))
        raise AssertionError("the driver ended: " + "".join(log))

    def call(self, *words: object) -> Answer:
        """A call whose answer starts with flag and code."""
        numbers, log = self.ask(*words)
        return Answer(bool(numbers[0]), int(numbers[1]), np.array(numbers[2:]), log)

    def load(self, tree: JointTree, frame: str | None = None, root_joint: str = "fixed") -> None:
        """A robot model of all links, whose own frame a joint connects with the root link."""
        self.tell("model", frame or tree.root_link, root_joint, tree.root_link)
        known, waiting = {tree.root_link}, list(tree.joints)
        while waiting:
            for joint in [joint for joint in waiting if joint.parent in known]:
                numbers = [*joint.T_parent_child.ravel(), *joint.axis]
                numbers += [joint.limits.lower, joint.limits.upper]
                words = [joint.child, joint.parent, joint.name, joint.type.value]
                self.tell("link", *words, *(repr(float(x)) for x in numbers))
                known.add(joint.child)
                waiting.remove(joint)

    def group(self, name: str, joints: Sequence[str]) -> None:
        """A planning group."""
        self.tell("group", name, len(joints), *joints)

    def initialize(
        self, base: str, *tips: str, group: str = "arm", resolution: float = 0.1
    ) -> Answer:
        """`initialize` of the plugin."""
        return self.call("initialize", group, base, len(tips), *tips, resolution)

    def get(self, pose: Array, seed: ArrayLike) -> Answer:
        """`getPositionIK` for one solution."""
        return self.call("get", *_pose(pose), *_counted(seed))

    def get_all(
        self, poses: Sequence[Array], seed: ArrayLike, method: int = NO_DISCRETIZATION
    ) -> tuple[Answer, Array]:
        """`getPositionIK` for all solutions: the answer (values: the percentage) and rows (N, dof)."""
        words = [word for pose in poses for word in _pose(pose)]
        answer = self.call("get_all", len(poses), *words, *_counted(seed), method)
        rows = answer.values[1:].reshape(-1, self.dof)
        return Answer(answer.good, answer.code, answer.values[:1], answer.log), rows

    def search(
        self,
        pose: Array,
        seed: ArrayLike,
        *words: str,
        limits: ArrayLike = (),
        timeout: float = 0.1,
        rejections: int = 0,
        wait: float = 0.0,
    ) -> Search:
        """`searchPositionIK`; `words` choose the overload and the options."""
        head = ["search", len(words), *words, *_pose(pose), *_counted(seed), *_counted(limits)]
        answer = self.call(*head, timeout, rejections, wait)
        found = int(answer.values[0])
        seen = answer.values[1 + found :].reshape(-1, self.dof)
        return Search(answer.good, answer.code, answer.values[1 : 1 + found], seen)

    def forward(self, links: Sequence[str], q: ArrayLike) -> tuple[bool, list[Array]]:
        """`getPositionFK`: flag and poses (4, 4)."""
        answer = self.call("forward", len(links), *links, *_counted(q))
        return answer.good, [
            np.asarray(pinocchio.XYZQUATToSE3(row).homogeneous)
            for row in answer.values.reshape(-1, 7)
        ]


def _pose(T: Array) -> list[float]:
    return [float(x) for x in pinocchio.SE3ToXYZQUAT(pinocchio.SE3(np.asarray(T)))]


def _counted(values: ArrayLike) -> list[object]:
    numbers = [float(x) for x in np.asarray(values, dtype=float)]
    return [len(numbers), *map(repr, numbers)]
