"""A config for a robot: one `[[arm]]` for each arm that it has."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen.derivation.read import arm_name, read, read_tree
from ikgen.emit.rendering import TURNING_MARKS
from ikgen.errors import UsageError
from ikgen.importers.named_robots import is_named
from ikgen.model.module_name import identifier
from ikgen.outputs.publish import publish
from ikgen.projects.config import CONFIG, PYPROJECT, load_config
from ikgen.records.record import seen_from
from ikgen.records.request import Request

if TYPE_CHECKING:
    from ikgen.chains.arms import ChainCandidate
    from ikgen.model.joint_tree import JointTree

__all__ = [
    "ArmTable",
    "add_to_config",
    "config_path",
    "ends_left_out",
    "robot_arms",
    "write_config",
]

_ESCAPED = {code: f"\\u{code:04x}" for code in (0x7F, *TURNING_MARKS)}
_FOLDER = "generated"
"""Where the outputs go, from the config's folder."""


@dataclass(frozen=True, slots=True)
class ArmTable:
    """One arm: its name and ends, None for a DH table; `trunk` is the base of the chain that begins with
    joints that other arms share ("": it shares none)."""

    name: str
    base: str | None
    tip: str | None
    dof: int
    trunk: str = ""


def config_path(out: Path) -> Path:
    """The file that is meant: a folder stands for the config in it."""
    return out / CONFIG if out.is_dir() else out


def robot_arms(request: Request, tree: JointTree | None = None) -> tuple[ArmTable, ...]:
    """Every arm of the request's robot, of those from its base if it names one, or the chain to its tip;
    raises `UsageError` where none is found. `tree`: the robot's, where it is read already."""
    if request.table:
        dh = read(request).dh
        return (ArmTable(arm_name(dh.robot), None, None, dh.dof),)
    from ikgen.chains.arms import candidate_chains
    from ikgen.model.chain import MOST_AXES

    tree = tree or read_tree(request)
    chains: dict[str, list[ChainCandidate]] = {}
    every = candidate_chains(tree)
    several = len({chain.tip for chain in every}) > 1
    if request.tip is not None:
        return (_chain(tree, request.base, request.tip, several),)
    for chain in every if request.base is None else candidate_chains(tree, request.base):
        chains.setdefault(chain.tip, []).append(chain)
    if not chains:
        below = "" if request.base is None else f" below '{request.base}'"
        raise UsageError(
            f"no arm found in '{tree.name}'{below}",
            hint="write [[arm]] tables with base and tip by hand; ikgen inspect shows the links",
        )
    arms = [_arm(tree, tip, ways, several) for tip, ways in chains.items()]
    fit = [arm for arm in arms if arm.dof <= MOST_AXES]
    if not fit:
        _chain(tree, arms[0].base, arms[0].tip or "", several)  # says what is too many
    return tuple(_told_apart(fit))


def ends_left_out(request: Request, tree: JointTree) -> tuple[str, ...]:
    """The last links of branches of the request's tree that `robot_arms` takes for no arm's."""
    if request.tip is not None:
        return ()
    from ikgen.chains.arms import candidate_chains
    from ikgen.chains.other_ends import other_ends

    return other_ends(tree, candidate_chains(tree, request.base), request.base)


def _chain(tree: JointTree, base: str | None, tip: str, several: bool) -> ArmTable:
    """The chain to a tip, from where it begins by convention where no base is given."""
    from ikgen.chains.selection import select_chain

    chain = select_chain(tree, base, tip)
    name = arm_name(tree.name, tip if several else "")
    return ArmTable(name, chain.base_link, tip, chain.dof)


def _arm(tree: JointTree, tip: str, ways: Sequence[ChainCandidate], several: bool) -> ArmTable:
    """The arm to a tip: from where it parts from others, if enough of it is left to be an arm."""
    from ikgen.chains.grippers import ARM_JOINTS

    whole = max(ways, key=lambda chain: chain.dof)
    own = min(ways, key=lambda chain: (chain.dof < ARM_JOINTS, chain.dof))
    apart = own is not whole and own.dof >= ARM_JOINTS and _leaves_a_plane(tree, own)
    taken, trunk = (own, whole.base) if apart else (whole, "")
    return ArmTable(arm_name(tree.name, tip if several else ""), taken.base, tip, taken.dof, trunk)


def _leaves_a_plane(tree: JointTree, chain: ChainCandidate) -> bool:
    """Whether the joints of a chain take its tip anywhere: those of one side of a parallelogram, behind the
    joint that turns both, move it in a plane."""
    from ikgen.chains.selection import select_chain
    from ikgen.kinematics.modified_dh import to_dh
    from ikgen.tasks import POSITION
    from ikgen.tasks.fitting import freedoms_moved

    dh = to_dh(select_chain(tree, chain.base, chain.tip))
    return freedoms_moved(dh, POSITION) == POSITION.freedoms


def _told_apart(arms: Iterable[ArmTable], taken: Iterable[str] = ()) -> list[ArmTable]:
    """The arms, those whose names are taken, or an earlier one has, with their tip, or numbered."""
    found: list[ArmTable] = []
    names = set(taken)
    for arm in arms:
        tip = arm.tip or ""
        longer = arm.name if arm.name.endswith(identifier(tip)) else arm_name(arm.name, tip)
        candidates = (arm.name, longer, *(f"{longer}_{k}" for k in range(2, len(names) + 3)))
        name = next(name for name in candidates if name not in names)
        names.add(name)
        found.append(replace(arm, name=name))
    return found


def write_config(
    path: Path, request: Request, arms: Sequence[ArmTable], emit: Sequence[str], *, force: bool
) -> None:
    """Write the config of a robot's arms; raises `UsageError` for a file that is there already."""
    if path.exists() and not force:
        raise UsageError(
            f"{path} is there already",
            hint="add to it with --add, replace it with --force, or name another by -o",
        )
    tables = [_table(arm, request, emit, path.parent) for arm in arms]
    publish(path.parent, {path.name: "\n".join(tables)})


def add_to_config(
    path: Path, request: Request, arms: Sequence[ArmTable], emit: Sequence[str]
) -> tuple[ArmTable, ...]:
    """Append a robot's arms to a config, as they are then named: apart from those that it has. Nothing else
    of it changes. Raises `UsageError` where it lists one of them already, or is no list of arms alone."""
    if path.name == PYPROJECT:
        raise UsageError(
            f"{path} is not of ikgen alone", hint="write its [[tool.ikgen.arm]] by hand"
        )
    there = load_config(path)
    known = {_chain_of(one.request, one.request.base, one.request.tip): one.name for one in there}
    for arm in arms:
        if name := known.get(_chain_of(request, arm.base, arm.tip)):
            raise UsageError(
                f"{path} lists this arm already, as {name}",
                hint="change its entry there, or name another config by -o",
            )
    arms = _told_apart(arms, [one.name for one in there])
    tables = ["", *(_table(arm, request, emit, path.parent) for arm in arms)]
    before = path.read_text(encoding="utf-8").rstrip("\n") + "\n"
    publish(path.parent, {path.name: before + "\n".join(tables)})
    return tuple(arms)


def _chain_of(request: Request, base: str | None, tip: str | None) -> tuple[object, ...]:
    """What tells one arm of a description, with its arguments, from another."""
    return _place(request.robot), tuple(sorted(request.args.items())), base, tip


def _place(robot: Path) -> Path:
    """A robot's file, however it is spelled; its name where it has one."""
    return robot if is_named(robot) else robot.resolve()


def _table(arm: ArmTable, request: Request, emit: Sequence[str], folder: Path) -> str:
    """One `[[arm]]`; paths as seen from the config."""
    entries: dict[str, object] = {"name": arm.name, "robot": seen_from(request.robot, folder)}
    if request.args:
        entries["args"] = request.args
    if request.package_paths:
        entries["package_paths"] = [seen_from(place, folder) for place in request.package_paths]
    if arm.base is not None:
        entries |= {"base": arm.base, "tip": arm.tip}
    entries |= {"emit": list(emit), "out": _FOLDER}
    lines = ["[[arm]]", *(f"{key} = {_value(value)}" for key, value in entries.items())]
    if arm.trunk:
        place = next(i for i, line in enumerate(lines) if line.startswith("base = "))
        lines[place] += f"  # with the joints that arms share: {_value(arm.trunk)}"
    return "\n".join(lines) + "\n"


def _value(value: object) -> str:
    """A text, list or table of texts as TOML; JSON's strings are TOML's basic strings."""
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{_value(k)} = {_value(v)}' for k, v in value.items())} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    return json.dumps(value, ensure_ascii=False).translate(_ESCAPED)
