"""An arm that turns its tool about a point which the tool's tip can be at, but for what the file rounds."""

from __future__ import annotations

REMOTE_CENTER = """<robot name="remote_center"><link name="base"/>
<link name="yaw"/><joint name="j1" type="revolute"><parent link="base"/><child link="yaw"/>
<origin xyz="0 0 0" rpy="1.5708 -1.5708 0"/><axis xyz="0 0 1"/>
<limit lower="-1.6" upper="1.6" effort="1" velocity="1"/></joint>
<link name="back"/><joint name="j2" type="revolute"><parent link="yaw"/><child link="back"/>
<origin xyz="0 0 0.03" rpy="-1.5708 -0.2699 0"/><axis xyz="0 0 1"/>
<limit lower="-0.9" upper="0.9" effort="1" velocity="1"/></joint>
<link name="bottom"/><joint name="bar" type="revolute"><parent link="back"/><child link="bottom"/>
<origin xyz="0.15 0 0" rpy="0 0 1.8407"/><axis xyz="0 0 -1"/>
<limit lower="-0.9" upper="0.9" effort="1" velocity="1"/><mimic joint="j2" multiplier="-1"/></joint>
<link name="end"/><joint name="rod" type="revolute"><parent link="bottom"/><child link="end"/>
<origin xyz="0.5 0 0" rpy="0 0 0"/><axis xyz="0 0 -1"/>
<limit lower="-0.9" upper="0.9" effort="1" velocity="1"/><mimic joint="j2"/></joint>
<link name="slide"/><joint name="j3" type="prismatic"><parent link="end"/><child link="slide"/>
<origin xyz="0.04 -0.29 0" rpy="1.5708 1.5708 3.1416"/><axis xyz="0 0 -1"/>
<limit lower="0" upper="0.24" effort="1" velocity="1"/></joint>
<link name="tool"/><joint name="j4" type="revolute"><parent link="slide"/><child link="tool"/>
<origin xyz="0 0 0.416" rpy="0 0 -1.5708"/><axis xyz="0 0 -1"/>
<limit lower="-3.14" upper="3.14" effort="1" velocity="1"/></joint>
</robot>
"""
"""Bars that remain parallel turn the slide about a point of the first axis, within 1e-5 m."""

AT_THE_CENTER = [
    [0.32479227225391238, 0.14438099394557222, 0.12531244285084267, 1.362557288380512],
    [-0.58409434547200922, 0.19616807050511201, 0.1763453818361487, 1.2880975132940711],
]
"""Configurations with the tip there, where two solutions meet."""
