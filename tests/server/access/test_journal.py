"""The journal, and its file."""

from __future__ import annotations

import os
import re
import threading
from pathlib import Path
from typing import Any

import pytest

from webviz.api.errors import Error
from webviz.api.roles import Role
from webviz.server.access import journal, journal_file
from webviz.server.access.journal import MAX_TEXT, Journal
from webviz.server.access.journal_file import JournalFile
from webviz.server.access.visitors import Visitor

ADA = Visitor("Ada", Role.OWNER, "192.0.2.1", 0.0)


def test_entries_are_lines_of_a_file_that_others_cannot_read(tmp_path: Path) -> None:
    path = tmp_path / "journal.txt"
    path.touch(0o644)
    for text in ("Saved a.yaml.", "Opened \n\x1b[2J.yaml."):
        journal_file = JournalFile(path)
        Journal(journal_file.write).note(ADA if "Saved" in text else None, text)
        journal_file.close()
    assert path.stat().st_mode & 0o777 == 0o600
    save, opening = path.read_text().splitlines()
    time = r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\+00:00"
    assert re.fullmatch(time + r" Ada \(owner, 192\.0\.2\.1\): Saved a\.yaml\.", save)
    assert re.fullmatch(time + r" \(a page that is gone\): Opened \?\?\[2J\.yaml\.", opening)


def test_the_newest_entries_come_first_and_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(journal, "MAX_ENTRIES", 3)
    recent = Journal()
    before = recent.entries
    for number in range(5):
        before = recent.entries
        recent.note(ADA if number % 2 else None, f"{number}" * (MAX_TEXT + 1))
    assert [entry.text for entry in recent.entries] == [f"{n}" * MAX_TEXT for n in (4, 3, 2)]
    gone, ada, _ = recent.entries
    assert (ada.name, ada.role, ada.address) == ("Ada", "owner", "192.0.2.1")
    assert (gone.name, gone.role, gone.address) == ("", "", "")
    assert recent.entries is recent.entries
    assert [entry.text[0] for entry in before] == ["3", "2", "1"]  # what was read stays


def test_the_files_have_a_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(journal_file, "MAX_BYTES", 1000)
    path = tmp_path / "journal.txt"
    journal = JournalFile(path)
    for number in range(100):
        journal.write(f"{number:099}")
    journal.close()
    assert sorted(file.name for file in tmp_path.iterdir()) == ["journal.txt", "journal.txt.1"]
    assert [len(file.read_text().splitlines()) for file in sorted(tmp_path.iterdir())] == [10, 10]
    assert path.read_text().endswith(f"{99:099}\n")


def test_entries_dropped_by_a_slow_disk_are_counted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(journal_file, "MAX_WAITING", 2)
    path, begun, mounted = tmp_path / "journal.txt", threading.Event(), threading.Event()
    file = JournalFile(path)

    def open_slowly(*args: Any, **options: Any) -> Any:
        begun.set()
        assert mounted.wait(60.0)
        return open(*args, **options)

    monkeypatch.setattr(journal_file, "open", open_slowly, raising=False)
    file.write("0")
    assert begun.wait(60.0)
    for number in range(1, 6):
        file.write(str(number))
    mounted.set()
    file.close()
    assert path.read_text().splitlines() == ["0", "(3 entries dropped)", "1", "2"]


def test_links_pipes_and_folders_are_refused(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "fifo")
    (tmp_path / "link").symlink_to(tmp_path / "elsewhere")
    for path in (tmp_path / "fifo", tmp_path / "link", tmp_path, Path("/dev/full")):
        with pytest.raises(Error, match=r"Cannot write the journal|is not a file of this user"):
            JournalFile(path)
    assert not (tmp_path / "elsewhere").exists()


def test_a_missing_entry_is_logged(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    path = tmp_path / "folder" / "journal.txt"
    path.parent.mkdir()
    journal_file = JournalFile(path)
    path.unlink()
    path.parent.rmdir()
    journal_file.write("lost")
    journal_file.close()
    assert "An entry is missing in the journal" in caplog.text
