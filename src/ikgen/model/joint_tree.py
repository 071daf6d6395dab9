"""The robot description as read: links, joints, and where it came from."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from ikgen.model.arrays import Array
from ikgen.model.joint_relation import Mimic
from ikgen.model.oddity import Oddity

__all__ = ["DH_TABLE", "Joint", "JointTree", "JointType", "Limits", "Mimic", "Source"]

DH_TABLE = "dh-table"
"""The kind of a source that is a DH table."""


class JointType(Enum):
    """URDF joint types."""

    REVOLUTE = "revolute"
    CONTINUOUS = "continuous"
    PRISMATIC = "prismatic"
    FIXED = "fixed"
    FLOATING = "floating"
    PLANAR = "planar"

    @property
    def moves_on_one_axis(self) -> bool:
        """Whether the joint has one axis and one value."""
        return self in (JointType.REVOLUTE, JointType.CONTINUOUS, JointType.PRISMATIC)

    @property
    def moves_on_more_axes(self) -> bool:
        """Whether the joint moves, but has no single axis."""
        return self in (JointType.FLOATING, JointType.PLANAR)


@dataclass(frozen=True, slots=True)
class Limits:
    """Range of a joint value, rad or m; infinite where the file sets none."""

    lower: float
    upper: float

    @property
    def middle_text(self) -> str:
        """The middle of finite limits in as few digits as lie inside them."""
        middle = 0.5 * (self.lower + self.upper)
        texts = (f"{middle:.{digits}g}" for digits in range(3, 17))
        return next((x for x in texts if self.lower <= float(x) <= self.upper), repr(middle))


@dataclass(frozen=True, slots=True)
class Joint:
    """One joint. `T_parent_child` (4, 4) is the child link's frame in the parent's at value 0;
    `axis` (3,) is a unit vector in the child's frame; `line` is its line in the (expanded) file."""

    name: str
    type: JointType
    parent: str
    child: str
    T_parent_child: Array
    axis: Array
    limits: Limits
    mimic: Mimic | None = None
    line: int | None = None


@dataclass(frozen=True, slots=True)
class Source:
    """Where a description came from.

    `path` is the file the user named, `dependencies` every file read (itself included, absolute),
    `package_urls` names those of them that another package holds (file, `package://pkg/path`),
    `environment` the variables that it asked for and their values (None: not set),
    `text` the description after expansion (URDF XML, or the TOML of a DH table), `sha256` the digest
    of `text`, `warnings` what was odd in it but could be read, and `example` joint values (rad, m) that the
    description proposes to look at, none of it that says nothing.
    """

    path: Path
    kind: str
    text: str
    sha256: str
    dependencies: tuple[Path, ...] = ()
    package_urls: tuple[tuple[Path, str], ...] = ()
    arguments: tuple[tuple[str, str], ...] = ()
    warnings: tuple[Oddity, ...] = ()
    example: tuple[float, ...] = ()
    environment: tuple[tuple[str, str | None], ...] = ()

    @property
    def has_links(self) -> bool:
        """Whether its links have names of their own, unlike those of a DH table."""
        return self.kind != DH_TABLE


@dataclass(frozen=True, slots=True)
class JointTree:
    """All links and joints of a robot description, in file order. `root_link` is the base of the tree."""

    name: str
    links: tuple[str, ...]
    joints: tuple[Joint, ...]
    root_link: str
    source: Source
