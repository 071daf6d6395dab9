"""The flow from a robot file to verified outputs, one function a stage."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen import __version__
from ikgen.errors import UnsolvedChainError

if TYPE_CHECKING:
    from ikgen.emit.module import SolverModule
    from ikgen.kinematics.classify import GeometryClass
    from ikgen.model.chain import Chain
    from ikgen.model.dh import DHChain
    from ikgen.model.joint_tree import JointTree
    from ikgen.solver.graph import SolutionGraph

__all__ = ["Derivation", "Request", "derive", "read_robot"]

Progress = Callable[[str, str], None]


@dataclass(frozen=True, slots=True)
class Request:
    """What the user asked for: one robot, one chain, one task."""

    robot: Path
    base: str | None = None
    tip: str | None = None
    task: str | None = None
    free: tuple[tuple[str, float | None], ...] = ()
    locked: Mapping[str, float] = field(default_factory=dict)
    arguments: Mapping[str, str] = field(default_factory=dict)
    package_paths: tuple[Path, ...] = ()
    name: str | None = None


@dataclass(frozen=True, slots=True)
class Derivation:
    """Everything between the file and the emitted text."""

    tree: JointTree
    chain: Chain
    dh: DHChain
    geometry: GeometryClass
    graph: SolutionGraph
    module: SolverModule


def read_robot(request: Request) -> tuple[JointTree, Chain, DHChain]:
    """Read the file, choose the chain and convert it to modified DH form."""
    from ikgen.importers import load_tree
    from ikgen.importers.chain import select_chain
    from ikgen.kinematics.modified_dh import to_dh

    tree = load_tree(
        request.robot, arguments=request.arguments, package_paths=request.package_paths
    )
    chain = select_chain(tree, request.base, request.tip, dict(request.locked))
    dh = to_dh(chain, free=tuple(name for name, _ in request.free))
    return tree, chain, dh


def derive(request: Request, progress: Progress | None = None) -> Derivation:
    """From the file to a solver module, not yet written or verified."""
    from ikgen.kinematics.classify import classify

    note = progress or (lambda stage, detail: None)
    note("read", str(request.robot.name))
    tree, chain, dh = read_robot(request)
    geometry = classify(dh)
    note("derive", geometry.name)
    graph = _solve(dh, note)
    module = _module(request, tree, dh, geometry.words, graph)
    return Derivation(tree, chain, dh, geometry, graph, module)


def _solve(dh: DHChain, note: Progress) -> SolutionGraph:
    from ikgen.solver.run import solve_chain

    graph = solve_chain(dh, progress=lambda text: note("derive", text))
    if graph.open_joints:
        raise UnsolvedChainError(*_unsolved(dh, graph))
    return graph


def _unsolved(dh: DHChain, graph: SolutionGraph) -> tuple[str]:
    left = ", ".join(dh.joints[j].name for j in graph.open_joints)
    solved = ", ".join(s.candidate.unknown.text for s in graph.steps) or "nothing"
    return (f"no closed form found: solved {solved}; left are the joints {left}",)


def _module(
    request: Request, tree: JointTree, dh: DHChain, geometry: str, graph: SolutionGraph
) -> SolverModule:
    from ikgen.emit.module import EXACT, SolverModule
    from ikgen.ir.lower import lower

    deviation = max(dh.deviation)
    slack = 2.0 * deviation if deviation > EXACT else 0.0
    values = dict(request.free)
    free = tuple(j for j, joint in enumerate(dh.joints) if joint.name in dh.free)
    return SolverModule(
        name=request.name or identifier(tree.name),
        program=lower(graph, slack=slack),
        dh=dh,
        task=request.task or "pose",
        free=free,
        free_defaults=tuple(_inside(dh, j, values.get(dh.joints[j].name)) for j in free),
        source_name=request.robot.name,
        source_sha256=tree.source.sha256,
        generator_version=__version__,
        geometry=geometry,
        order=tuple(f"{s.candidate.unknown.text} ({s.candidate.leaf})" for s in graph.steps),
    )


def _inside(dh: DHChain, joint: int, value: float | None) -> float:
    """The default of a held joint: the given value, or 0 brought inside its limits."""
    limits = dh.joints[joint].limits
    if value is not None:
        return value
    if limits.lower <= 0.0 <= limits.upper:
        return 0.0
    return 0.5 * (limits.lower + limits.upper)


def identifier(name: str) -> str:
    """A robot's name as a module name: lower case, letters, digits and underscores."""
    text = "".join(ch if ch.isascii() and ch.isalnum() else "_" for ch in name).strip("_").lower()
    return text if text and not text[0].isdigit() else f"robot_{text}".rstrip("_")
