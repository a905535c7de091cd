"""Folders for unfinished work, and what killed programs leave of them."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from webviz.data import working_folder as module
from webviz.data.working_folder import LOCK, working_folder

PROGRAM = """
import sys
from pathlib import Path
from webviz.data.working_folder import working_folder
with working_folder("own_", Path(sys.argv[1])) as folder:
    (folder / "large").write_bytes(bytes(1000))
    print(folder, flush=True)
    sys.stdin.read()
"""


@contextlib.contextmanager
def program(parent: Path) -> Iterator[tuple[subprocess.Popen[str], Path]]:
    """A program that works in a folder until its input ends."""
    process = subprocess.Popen(
        [sys.executable, "-c", PROGRAM, str(parent)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    with process:
        try:
            yield process, Path(process.stdout.readline().strip())
        finally:
            process.kill()


def test_the_folder_of_a_killed_program_is_removed_by_the_next(tmp_path: Path) -> None:
    with program(tmp_path) as (killed, folder), program(tmp_path) as (_, used):
        killed.kill()
        killed.wait()
        assert (folder / "large").exists()
        with working_folder("own_", tmp_path) as own, working_folder("own_", tmp_path) as other:
            assert not folder.exists()
            assert sorted(tmp_path.iterdir()) == sorted((used, own, other))
        assert [*tmp_path.iterdir()] == [used]
        assert {each.name for each in used.iterdir()} == {LOCK, "large"}


def test_nothing_else_is_removed(tmp_path: Path) -> None:
    others = [tmp_path / name for name in ("own_old_runs", "own_12345678x", "other_12345678")]
    for each in others:
        each.mkdir()
        if each.name != "own_old_runs":  # which is not locked, although it has such a name
            (each / LOCK).touch()
    (tmp_path / "own_abcdefgh").symlink_to(others[2])
    (tmp_path / "own_abcdefgi").touch()
    before = sorted(tmp_path.iterdir())
    with working_folder("own_", tmp_path):
        pass
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.skipif(os.geteuid() != 0, reason="only root may give a folder away")
def test_folders_of_other_users_stay(tmp_path: Path) -> None:
    foreign = tmp_path / "own_abcdefgh"
    foreign.mkdir()
    (foreign / LOCK).touch()
    os.chown(foreign, 4242, 4242)
    with working_folder("own_", tmp_path):
        assert foreign.exists()


def test_a_folder_removed_as_abandoned_before_its_lock_is_recreated(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lock, folders = module.lock, list[Path]()

    def late(descriptor: int) -> bool:
        if not folders:
            folders.extend(tmp_path.iterdir())
            module.remove_if_abandoned(folders[0])
        return lock(descriptor)

    monkeypatch.setattr(module, "lock", late)
    with working_folder("own_", tmp_path) as folder:
        assert folder.exists()
        assert folder not in folders
        assert len(folders) == 1
    assert [*tmp_path.iterdir()] == []
