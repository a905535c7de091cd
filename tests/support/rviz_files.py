"""The real .rviz files, which are not part of the project."""

from __future__ import annotations

from pathlib import Path

FOLDER = Path(__file__).parents[3] / "shared" / "data" / "rviz"
FILES = sorted(FOLDER.glob("*.rviz"))
