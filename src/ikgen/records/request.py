"""What the user asks for: one robot, one chain, one task; and what is written of it.

The same fields are the options of the command line, the entries of an `[[arm]]` in a config, and those of a
record (`ikgen.records.record`): one spelling, read and written by `ikgen.records.codec`.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ikgen.errors import IkgenError
from ikgen.model.joint_relation import Mimic, Relation, checked_relation, read_relation
from ikgen.model.joint_value import parse_joint_value
from ikgen.model.maintainer import checked_maintainer
from ikgen.model.module_name import checked_module_name
from ikgen.records.codec import CodecError, coded, read_free, uncoded
from ikgen.tasks import checked_axis

__all__ = ["Outputs", "Request", "is_table", "xacro_texts"]


def is_table(robot: Path) -> bool:
    """Whether a file is a DH table, by its suffix."""
    return robot.suffix.lower() == ".toml"


def _passes(check: Callable[[str], str]) -> Callable[[Any, str], Any]:
    """The reader of an entry whose text has to pass a check."""

    def read(value: Any, where: str) -> Any:
        try:
            return check(value) if isinstance(value, str) else value
        except IkgenError as error:
            raise CodecError(where, error.message, error.hint) from None

    return read


def xacro_texts(args: Mapping[str, Any]) -> dict[str, str]:
    """Arguments of xacro as texts; booleans as xacro writes them."""
    return {n: str(x).lower() if isinstance(x, bool) else str(x) for n, x in args.items()}


def _arguments(value: Any, where: str) -> Any:
    return xacro_texts(value) if isinstance(value, Mapping) else value


def _relations(value: Any, where: str) -> Any:
    """Relations between joints, each a text that can be read."""
    read = _passes(checked_relation)
    for joint, text in value.items() if isinstance(value, Mapping) else ():
        read(text, f"{where}.{joint}")
    return value


def _joint_values(value: Any, where: str) -> Any:
    """Values of joints: numbers, or texts of a number and its unit."""
    if not isinstance(value, Mapping):
        return value
    found = dict(value)
    for joint, text in value.items():
        if isinstance(text, str):
            try:
                found[joint] = parse_joint_value(text)
            except ValueError as error:
                hint = 'write a number in rad or m, or one with its unit in quotes: "45deg"'
                raise CodecError(f"{where}.{joint}", str(error), hint) from None
    return found


def _held_joints(value: Any, where: str) -> Any:
    return _joint_values(read_free(value, where), where)


def _some(value: Any, where: str) -> Any:
    if value == []:
        raise CodecError(where, "names no output", 'leave it out, or write for example ["python"]')
    return value


def _positive(value: Any, where: str) -> Any:
    if isinstance(value, int) and value < 1:
        raise CodecError(where, f"{value} is less than 1", "give a whole number from 1 on")
    return value


@dataclass(frozen=True, slots=True)
class Request:
    """One robot file or DH table, one chain, one task, by the tool's axis `tool_axis` where it is one with
    a direction (None: the one that suits). `free` maps held joints to their default value
    (None: chosen), `lock` fixed joints to their value (rad or m), `couple` joints to what
    they follow (`SOURCE*k+c`, rad or m) or to what motors move them by (`A*k1+B*k2+c`), `args` are
    xacro's, `calibration` is a file of the one arm's own kinematics; `name` is the prefix of the files
    (None: made from the robot's);
    `maintainer` (`NAME <EMAIL>`) and `license` go into the manifest of a ROS package; `trust` lets the
    file do whatever xacro can."""

    robot: Path
    base: str | None = None
    tip: str | None = None
    task: str | None = None
    tool_axis: str | None = field(default=None, metadata=coded(_passes(checked_axis)))
    free: Mapping[str, float | None] = field(default_factory=dict, metadata=coded(_held_joints))
    lock: Mapping[str, float] = field(default_factory=dict, metadata=coded(_joint_values))
    couple: Mapping[str, str] = field(default_factory=dict, metadata=coded(_relations))
    args: Mapping[str, str] = field(default_factory=dict, metadata=coded(_arguments))
    package_paths: tuple[Path, ...] = ()
    calibration: Path | None = None
    name: str | None = field(default=None, metadata=coded(_passes(checked_module_name)))
    maintainer: str | None = field(default=None, metadata=coded(_passes(checked_maintainer)))
    license: str | None = None
    # Only who runs ikgen may trust a file: neither a config nor a record says so.
    trust: bool = field(default=False, metadata=uncoded())

    @property
    def table(self) -> bool:
        """Whether the robot is a DH table."""
        return is_table(self.robot)

    @property
    def without_task(self) -> Request:
        """As if no task were asked for."""
        return replace(self, task=None, tool_axis=None)

    @property
    def relations(self) -> dict[str, Mimic]:
        """What joints follow that follow one other."""
        read = {joint: relation.mimic(joint) for joint, relation in self._couplings.items()}
        return {joint: mimic for joint, mimic in read.items() if mimic is not None}

    @property
    def sums(self) -> dict[str, Relation]:
        """What joints follow that follow several others: those whose motor moves none."""
        return {joint: one for joint, one in self._several.items() if joint not in self.motors}

    @property
    def motors(self) -> dict[str, Relation]:
        """What motors move the other coupled joints by."""
        left = self._several
        while idle := left.keys() - {name for one in left.values() for name, _ in one.terms}:
            left = {joint: one for joint, one in left.items() if joint not in idle}
        return left

    @property
    def _several(self) -> dict[str, Relation]:
        read = self._couplings.items()
        return {joint: relation for joint, relation in read if relation.mimic(joint) is None}

    @property
    def _couplings(self) -> dict[str, Relation]:
        return {joint: read_relation(text) for joint, text in self.couple.items()}

    @property
    def named_task(self) -> str | None:
        """The task's name with the tool's axis; None where the task is left to ikgen."""
        if self.task is None or self.tool_axis is None or ":" in self.task:
            return self.task
        return f"{self.task}:{self.tool_axis}"

    def command(self, *more: str) -> str:
        """The command that generates what is asked for, with `more` options."""
        words = ["ikgen", "from-dh" if self.table else "from-urdf", str(self.robot)]
        return shlex.join([*words, *self.options, *more])

    @property
    def field_without_use(self) -> str:
        """The first field that says something and that a DH table, one chain without arguments, has no use
        for; "" for none."""
        fields = ("base", "tip", "args", "package_paths")
        return next((one for one in fields if getattr(self, one)), "")

    @property
    def options(self) -> list[str]:
        """What a command line says behind the robot."""
        words: list[str] = []
        for option in ("base", "tip", "task", "tool_axis", "name", "maintainer", "license"):
            value = getattr(self, option)
            if value is not None:
                words += [f"--{option.replace('_', '-')}", value]
        for joint, held in self.free.items():
            words += ["--free", joint if held is None else f"{joint}={held!r}"]
        for joint, locked in self.lock.items():
            words += ["--lock", f"{joint}={locked!r}"]
        for joint, relation in self.couple.items():
            words += ["--couple", f"{joint}={relation}"]
        for name, text in self.args.items():
            words += ["--arg", f"{name}:={text}"]
        if self.calibration is not None:
            words += ["--calibration", str(self.calibration)]
        for folder in self.package_paths:
            words += ["--package-path", str(folder)]
        if self.trust:
            words.append("--trust")
        return words


@dataclass(frozen=True, slots=True)
class Outputs:
    """What to write and how to check it.

    `emit` names outputs, `out` is the folder that they go to, `samples` random poses are drawn from `seed`.
    `only`: earlier outputs of the same name are not made again. By default a file is replaced only if ikgen
    wrote it, unedited, for the same robot, chain and task; with `ours` if ikgen wrote it at all, with
    `force` always. `verify`: whether outputs are verified before they are written.
    """

    emit: tuple[str, ...] = field(default=("python",), metadata=coded(_some))
    out: Path = Path()
    samples: int = field(default=1000, metadata=coded(_positive))
    seed: int = field(default=0, metadata=uncoded())
    verify: bool = field(default=True, metadata=uncoded())
    only: bool = field(default=False, metadata=uncoded())
    force: bool = field(default=False, metadata=uncoded())
    ours: bool = field(default=False, metadata=uncoded())
