"""The robot's visual meshes in the scene, where they are at hand: those of the chain's joints follow it."""

from __future__ import annotations

import contextlib
import io
import logging
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from lxml import etree

from ikgen.chains.mimic import Coupling, couple
from ikgen.emit.derivation import Reading
from ikgen.errors import IkgenError
from ikgen.importers.packages import PACKAGE_URL, PackageFinder, PackageNotFoundError
from ikgen.importers.xacro.package_fence import PackageFence
from ikgen.importers.xacro.refusals import RefusedFileError
from ikgen.importers.xml_document import children, parse_xml, shown_file
from ikgen.kinematics.quaternion_rotation import quaternion
from ikgen.model.arrays import Array
from ikgen.model.joint_tree import JointTree, Source

__all__ = ["RobotMeshes", "robot_meshes"]


_NODE = "/robot"


class RobotMeshes:
    """The robot as viser draws it; `urdf` is yourdfpy's model of the same description, in which no joint
    follows another: who follows whom is the tree's to say, through others too."""

    def __init__(
        self, server: Any, reading: Reading, urdf: Any, couplings: dict[str, Coupling]
    ) -> None:
        from viser.extras import ViserUrdf

        self._reading, self._urdf, self._couplings = reading, urdf, couplings
        self._root = server.scene.add_frame(_NODE, show_axes=False)
        self._drawn = ViserUrdf(server, urdf, root_node_name=_NODE)

    def show(self, q: Array) -> None:
        """Put the chain to joint values `q` (dof,), all other joints to 0 or what they follow; the base
        link stays where poses are given from."""
        self._drawn.update_cfg(self._configuration(q))
        T = np.asarray(self._urdf.get_transform(self._urdf.base_link, self._reading.dh.base_link))
        self._root.position, self._root.wxyz = tuple(T[:3, 3]), tuple(quaternion(T[:3, :3]))

    @property
    def visible(self) -> bool:
        """Whether it is drawn."""
        return bool(self._root.visible)

    @visible.setter
    def visible(self, shown: bool) -> None:
        self._root.visible = shown

    def _configuration(self, q: Array) -> Array:
        """Values of all joints that have one, in the order of `urdf`."""
        dh = self._reading.dh
        known = dict(dh.locked) | dict(zip((j.name for j in dh.joints), q.tolist(), strict=True))
        values: dict[str, float] = {}
        for name, coupling in self._couplings.items():
            driver = known.get(coupling.driver.name, 0.0)
            values[name] = known.get(name, coupling.multiplier * driver + coupling.offset)
        return np.array([values.get(name, 0.0) for name in self._urdf.actuated_joint_names])


def _couplings(tree: JointTree) -> dict[str, Coupling]:
    """What each moving joint of the robot follows; one beside the chain may be wrong, and stays at 0."""
    found: dict[str, Coupling] = {}
    for joint in tree.joints:
        with contextlib.suppress(IkgenError):
            found |= couple(tree, [joint])
    return found


def robot_meshes(
    server: Any, reading: Reading, package_paths: Sequence[Path] = ()
) -> RobotMeshes | None:
    """The meshes of a description's visuals; None where it has none, or none that can be read. Only files
    that the description itself may read are opened (its package's, and those of packages that it names)."""
    if reading.tree is None:
        return None
    try:
        import yourdfpy
    except ImportError:
        return None
    files = _Files(reading.source.path, package_paths)
    logging.getLogger("yourdfpy").setLevel(logging.ERROR)  # meshes that are not there
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            text = io.BytesIO(_without_mimics(reading.source))
            urdf = yourdfpy.URDF.load(text, filename_handler=files.place)
            if urdf.scene is None or not urdf.scene.geometry:
                return None
            return RobotMeshes(server, reading, urdf, _couplings(reading.tree))
    except Exception as error:  # of third-party readers of many formats: the skeleton is enough
        logging.getLogger(__name__).warning("no meshes: %s", error)
        return None


def _without_mimics(source: Source) -> bytes:
    """The description with joints of which each has a value of its own."""
    root = parse_xml(source.text, shown_file(source))
    for joint in children(root, "joint"):
        for mimic in list(children(joint, "mimic")):
            joint.remove(mimic)
    return bytes(etree.tostring(root))


class _Files:
    """Where the meshes of a description lie."""

    def __init__(self, path: Path, package_paths: Sequence[Path]) -> None:
        self._path = path.resolve()
        self._finder = PackageFinder(self._path, tuple(package_paths))
        self._fence = PackageFence(self._path, self._finder)

    def place(self, fname: str) -> str:
        """The file of a mesh's name; "" where there is none that the description may read."""
        try:
            if fname.startswith(PACKAGE_URL):
                file = self._in_package(fname)
            else:
                file = self._path.parent / fname.removeprefix("file://")
            return str(self._fence.require(file))
        except (PackageNotFoundError, RefusedFileError, OSError):
            return ""

    def _in_package(self, url: str) -> Path:
        """The file that `package://pkg/path` names; `pkg` may be the name of a folder above the description
        too, where the manifest there has another."""
        try:
            return self._finder.resolve(url)
        except PackageNotFoundError:
            package, _, rest = url.removeprefix(PACKAGE_URL).partition("/")
            for folder in self._path.parents:
                if folder.name == package:
                    return folder / rest
            raise
