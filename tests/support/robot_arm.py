"""A robot of two links, and how tests bring it to a display."""

from __future__ import annotations

from collections.abc import Callable

from waiting import until

from webviz.shell.testing import DisplayBench

ARM = """
<robot name="arm">
  <material name="blue"><color rgba="0 0 1 1"/></material>
  <link name="base">
    <visual><geometry><box size="1 1 1"/></geometry><material name="blue"/></visual>
    <collision><geometry><sphere radius="2"/></geometry></collision>
    <inertial><mass value="6"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="tool">
    <visual name="grip">
      <origin xyz="0 0 2"/><geometry><box size="1 1 1"/></geometry><material name="blue"/>
    </visual>
  </link>
  <joint name="wrist" type="continuous"><parent link="base"/><child link="tool"/></joint>
</robot>
"""


def wait(at: DisplayBench, ready: Callable[[], bool]) -> None:
    """Turn the frame loop until slow work is done."""
    at.turn()
    until(ready, at.statuses, turn=at.turn, seconds=90.0)


def is_loaded(at: DisplayBench) -> bool:
    statuses = at.statuses()
    return "URDF" in statuses and "Loading" not in statuses


def describe(at: DisplayBench, text: str) -> None:
    at.send("std_msgs/msg/String", {"data": text}, topic="/robot_description")
    wait(at, lambda: is_loaded(at))


def place_arm(at: DisplayBench) -> None:
    at.transform("map", "base", (1.0, 0.0, 0.0))
    # Half a turn about x: what is 2 above the tool is then 2 below it.
    at.transform("base", "tool", (0.0, 3.0, 0.0), (1.0, 0.0, 0.0, 0.0), stamp_ns=at.now_ns)
