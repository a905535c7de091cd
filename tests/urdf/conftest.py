"""A mesh that loading takes long for."""

from __future__ import annotations

from pathlib import Path

import pytest
from small_robots import tetrahedron_dae


@pytest.fixture
def slow_dae(tmp_path: Path) -> Path:
    """A COLLADA file that takes a while to read."""
    corners = "0 0 2 2 1 1 0 0 1 1 3 3 0 0 3 3 2 2 1 1 2 2 3 3 "
    text = tetrahedron_dae().replace(corners.strip(), corners * 30_000)
    path = tmp_path / "slow.dae"
    path.write_text(text.replace('count="4">\n      <input', 'count="120000">\n      <input'))
    return path
