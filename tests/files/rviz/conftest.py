"""Real .rviz files."""

from __future__ import annotations

from pathlib import Path

import pytest
from rviz_files import FILES, FOLDER


@pytest.fixture(params=FILES or [None], ids=lambda path: path.stem if path else "none")
def real_file(request: pytest.FixtureRequest) -> Path:
    """Each of the real .rviz files."""
    if request.param is None:
        pytest.skip(f"no .rviz files in {FOLDER}")
    return request.param
