"""Two axes at right angles that turn alike, on a slide: the tip is at x = 0.4 cos(u)^2."""

from __future__ import annotations

from ikgen.tasks import Task

__all__ = ["REACH", "TWIST"]

REACH = Task("reach", frozenset({"px", "pz"}), 2, "position in the base's x-z plane")

TWIST = """
<robot name="twist">
  <link name="base"/><link name="rail"/><link name="first"/><link name="second"/><link name="tip"/>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="rail"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="turn" type="revolute"><parent link="rail"/><child link="first"/>
    <axis xyz="0 -1 0"/><limit lower="-3.1" upper="3.1" effort="1" velocity="1"/></joint>
  <joint name="follower" type="revolute"><parent link="first"/><child link="second"/>
    <axis xyz="0 0 1"/><limit lower="-3.1" upper="3.1" effort="1" velocity="1"/>
    <mimic joint="turn"/></joint>
  <joint name="flange" type="fixed"><parent link="second"/><child link="tip"/>
    <origin xyz="0.4 0 0"/></joint>
</robot>
"""
