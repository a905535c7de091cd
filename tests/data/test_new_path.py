"""Files and folders that are named by the time."""

from __future__ import annotations

from pathlib import Path

from webviz.data.names import new_path


def test_names_of_the_same_second_differ(tmp_path: Path) -> None:
    names: set[str] = set()
    for _ in range(5):
        path = new_path("webviz_run", ".html", tmp_path)
        path.write_text("")
        names.add(path.name)
    assert len(names) == 5
    assert all(name.endswith(".html") for name in names)


def test_a_folder_has_a_name_without_a_suffix(tmp_path: Path) -> None:
    path = new_path("webviz", folder=tmp_path)
    path.mkdir()
    assert new_path("webviz", folder=tmp_path).name != path.name
