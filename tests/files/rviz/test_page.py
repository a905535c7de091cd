"""The page on .rviz files tells the truth about what is carried over."""

from __future__ import annotations

from pathlib import Path

import pytest
from rviz_files import FILES, FOLDER

from webviz.files.rviz.docs import COMMAND, PAGE, page


@pytest.mark.skipif(not FILES, reason=f"no .rviz files in {FOLDER}")
def test_the_page_counts_as_the_import_does() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(FILES), f"run {COMMAND}"


def test_every_kind_of_thing_is_counted(tmp_path: Path) -> None:
    path = tmp_path / "own.rviz"
    path.write_text("Visualization Manager: {Displays: [{Class: x/Y}], Tools: [{Class: x/Z}]}")
    html = page([path])
    assert "| own.rviz | 0 of 1 | 0 of 0 | 1 of 1 | 0 of 1 | 0 of 0 |" in html
    assert "| `x/Y` | 1 |" in html
