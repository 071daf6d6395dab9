"""Joint trees out of a few words."""

from __future__ import annotations

from pathlib import Path

from ikgen.importers.urdf.urdf_tree import parse_urdf
from ikgen.model.joint_tree import JointTree


def tree_of(*joints: tuple[str, ...]) -> JointTree:
    """A tree out of `(name, type, parent, child[, inner])`."""
    links = dict.fromkeys(link for joint in joints for link in joint[2:4])
    text = "".join(f'<link name="{link}"/>' for link in links) + "\n"
    for name, type_, parent, child, *inner in joints:
        text += f'<joint name="{name}" type="{type_}"><parent link="{parent}"/>'
        text += f'<child link="{child}"/><origin xyz="0.1 0.2 0.3" rpy="0.3 0.2 0.1"/>'
        text += f'<axis xyz="0 0.6 0.8"/><limit lower="-1" upper="1"/>{"".join(inner)}</joint>\n'
    return parse_urdf(f'<robot name="r">{text}</robot>', path=Path("r.urdf"))


def serial_joints(base: str, *names: str, type_: str = "revolute") -> list[tuple[str, ...]]:
    """Joints in a row below a link, each with the link `<name>_link`."""
    parents = [base, *(f"{name}_link" for name in names)]
    return [(n, type_, p, f"{n}_link") for n, p in zip(names, parents, strict=False)]
