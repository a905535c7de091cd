"""Starts the robot of a provocation, or records a bag of it."""

from __future__ import annotations

import sys
from pathlib import Path

from tests.doctor_trial.__main__ import ALL


def main() -> None:
    """Run the robot with this name over DDS, or write it to a bag."""
    name, *path = sys.argv[1:]
    robot = next(each for each in ALL if each.name == name).robot()
    if path:
        robot.record(Path(path[0]))
    else:
        robot.run(Path("started"))


if __name__ == "__main__":
    main()
