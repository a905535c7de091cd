"""Config files on the disk: what was saved is never lost."""

from __future__ import annotations

import contextlib
import fcntl
import os
import socket
import stat
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from webviz.data import disk
from webviz.data.disk import MAX_THREADS, DiskThreads, in_thread, within
from webviz.files.config import Config, ConfigError, write_text
from webviz.files.opening import load, parse, save


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "lab.yaml"


def test_a_config_comes_back_from_its_file_exactly(path: Path) -> None:
    save(parse("fixed_frame: odom\ndisplays: [{type: LaserScan, size: 0.05}]", "x"), path)
    first = path.read_text()
    assert first == ("version: 1\nfixed_frame: odom\ndisplays:\n- {type: LaserScan, size: 0.05}\n")
    save(load(path), path)
    assert path.read_text() == first


def test_a_missing_file_is_an_error_that_names_it(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"Cannot read .*none\.yaml: No such file"):
        load(tmp_path / "none.yaml")
    with pytest.raises(ConfigError, match=r"Cannot read .*: Is a directory"):
        load(tmp_path)


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (b"\x89PNG\r\n\x1a\n\x00\xff", "is not UTF-8 text: not a config file."),
        (
            b"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 9\n",
            "is a Git LFS pointer: run `git lfs pull`.",
        ),
        ("version: 1".encode("utf-16"), "is not UTF-8 text: it is UTF-16, save it as UTF-8."),
        (b"version: 1\x00", "is not valid YAML"),
        (b"# " * (2 << 20), "is not a config file: it is larger than 2 MB."),
    ],
)
def test_bytes_that_are_not_a_config_are_an_error(path: Path, data: bytes, sentence: str) -> None:
    path.write_bytes(data)
    with pytest.raises(ConfigError) as excinfo:
        load(path)
    assert sentence in str(excinfo.value)
    assert "\n" not in str(excinfo.value)


@pytest.mark.parametrize("kind", ["fifo", "socket", "device"])
def test_only_regular_files_are_read(path: Path, kind: str) -> None:
    if kind == "fifo":
        os.mkfifo(path)  # which to open waits for a writer
    elif kind == "socket":
        with socket.socket(socket.AF_UNIX) as server:
            server.bind(str(path))
    else:
        path.symlink_to("/dev/zero")
    with pytest.raises(ConfigError, match=rf"^Cannot read {path}: (it is not a regular file|No )"):
        load(path)


def test_a_pipe_is_written() -> None:
    reading, writing = os.pipe()
    with open(reading) as reader:
        write_text("one", Path(f"/dev/fd/{writing}"))
        os.close(writing)
        assert reader.read() == "one"


def test_a_fifo_without_a_reader_is_not_written(path: Path) -> None:
    os.mkfifo(path)
    with pytest.raises(ConfigError, match=r"Cannot write .*No such device"):
        write_text("one", path)


def test_a_disk_that_does_not_respond_is_given_up() -> None:
    mounted = threading.Event()
    try:
        with pytest.raises(OSError, match=r"no response within 0\.05 s"):
            within(0.05, mounted.wait)
        waiting = [in_thread(mounted.wait) for _ in range(MAX_THREADS - 1)]
        with pytest.raises(OSError, match="too many files do not respond"):
            in_thread(mounted.wait)
    finally:
        mounted.set()
    assert all(each.result(60.0) for each in waiting)
    assert within(10.0, lambda: "mounted again") == "mounted again"


def test_a_thread_that_cannot_start_leaves_its_place(monkeypatch: pytest.MonkeyPatch) -> None:
    threads = DiskThreads(1)
    with monkeypatch.context() as system:
        system.setattr(threading.Thread, "start", lambda _: _fail())
        with pytest.raises(OSError, match="no thread is left"):
            threads.start(lambda: None)
    assert threads.within(60.0, lambda: "started") == "started"


def test_a_thread_is_reused_and_ends_when_idle(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    threads = DiskThreads(2)
    first = threads.within(60.0, threading.current_thread)
    assert any(threads.within(60.0, threading.current_thread) is first for _ in range(1000))
    both = threading.Barrier(2)
    waiting = [threads.start(lambda: both.wait(60.0)) for _ in range(2)]
    assert sorted(each.result(60.0) for each in waiting) == [0, 1]
    monkeypatch.setattr(disk, "KEPT_S", 0.01)
    last = (brief := DiskThreads(1)).within(60.0, threading.current_thread)
    last.join(60.0)
    assert not last.is_alive()
    assert brief.within(60.0, threading.current_thread) is not last


def _fail() -> None:
    raise RuntimeError("can't start new thread")


def test_the_version_before_is_kept(path: Path) -> None:
    backup = path.with_name("lab.yaml.bak")
    write_text("one", path)
    assert not backup.exists()
    write_text("two", path)
    assert (path.read_text(), backup.read_text()) == ("two", "one")
    write_text("three", path)
    assert (path.read_text(), backup.read_text()) == ("three", "two")
    # Saving what is there already does not make both the same.
    write_text("three", path)
    assert (path.read_text(), backup.read_text()) == ("three", "two")
    assert sorted(each.name for each in path.parent.iterdir()) == ["lab.yaml", "lab.yaml.bak"]


def test_mode_and_links_stay(path: Path, tmp_path: Path) -> None:
    (tmp_path / "store").mkdir()
    real = tmp_path / "store" / "lab-2.yaml"
    real.write_text("one")
    real.chmod(0o640)
    path.symlink_to(Path("store") / "lab-2.yaml")
    write_text("two", path)
    assert path.is_symlink()
    assert real.read_text() == "two"
    assert stat.S_IMODE(real.stat().st_mode) == 0o640
    assert (tmp_path / "store" / "lab-2.yaml.bak").read_text() == "one"


def test_a_new_file_has_the_permissions_of_the_umask(path: Path) -> None:
    before = os.umask(0o027)
    try:
        write_text("one", path)
    finally:
        os.umask(before)
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_a_link_that_leads_nowhere_makes_the_file(path: Path, tmp_path: Path) -> None:
    path.symlink_to(tmp_path / "new.yaml")
    write_text("one", path)
    assert (tmp_path / "new.yaml").read_text() == "one"


def test_a_failed_save_leaves_the_old_file(path: Path, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"Cannot write .*; save it under another name"):
        save(Config(), tmp_path / "no such folder" / "x.yaml")
    (tmp_path / "folder").mkdir()
    with pytest.raises(ConfigError, match="Is a directory"):
        save(Config(), tmp_path / "folder")
    write_text("one", path)
    (tmp_path / "lab.yaml.bak").mkdir()
    with pytest.raises(ConfigError, match=r"lab\.yaml\.bak cannot be replaced"):
        write_text("two", path)
    assert path.read_text() == "one"
    names = ["folder", "lab.yaml", "lab.yaml.bak"]
    assert sorted(each.name for each in tmp_path.iterdir()) == names


def test_a_backup_interrupted_by_a_crash_is_completed(path: Path) -> None:
    write_text("one", path)
    os.link(path, path.with_name("lab.yaml.bak"))  # it had the backup's name, and then no power
    write_text("two", path)
    assert (path.read_text(), path.with_name("lab.yaml.bak").read_text()) == ("two", "one")
    assert len(list(path.parent.iterdir())) == 2


def test_a_full_disk_is_reported() -> None:
    with pytest.raises(ConfigError, match="Cannot write /dev/full: No space left on device"):
        write_text("one", Path("/dev/full"))


def test_a_disk_that_fills_up_keeps_the_old_file(path: Path) -> None:
    """The limit of a file's size stands for a full disk: writing fails halfway."""
    write_text("one\n", path)
    code = (
        "import resource, signal, sys\n"
        "from pathlib import Path\n"
        "from webviz.files.config import ConfigError, write_text\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))\n"
        "try:\n"
        "    write_text('x' * 10000, Path(sys.argv[1]))\n"
        "except ConfigError as error:\n"
        "    print(error)\n"
    )
    completed = subprocess.run(
        [sys.executable, "-c", code, str(path)], capture_output=True, text=True, timeout=60
    )
    assert completed.stdout == f"Cannot write {path}: File too large; save it under another name.\n"
    assert path.read_text() == "one\n"
    assert list(path.parent.iterdir()) == [path]


@contextlib.contextmanager
def without_roots_rights() -> Iterator[None]:
    """Run as nobody if the tests run as root, who may write everywhere."""
    if os.geteuid() != 0:
        yield
        return
    os.seteuid(65534)
    try:
        yield
    finally:
        os.seteuid(0)


def test_a_read_only_folder_is_reported() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "lab.yaml").write_text("one")
        (folder / "lab.yaml").chmod(0o666)
        folder.chmod(0o555)
        with without_roots_rights(), pytest.raises(ConfigError, match="Permission denied"):
            write_text("two", folder / "lab.yaml")
        assert (folder / "lab.yaml").read_text() == "one"
        folder.chmod(0o777)
        (folder / "lab.yaml").chmod(0o444)
        with without_roots_rights(), pytest.raises(ConfigError, match="it is write-protected"):
            write_text("two", folder / "lab.yaml")
        assert (folder / "lab.yaml").read_text() == "one"
        folder.chmod(0o700)


def test_two_programs_that_save_at_once_leave_whole_files(path: Path) -> None:
    code = (
        "import sys\n"
        "from pathlib import Path\n"
        "from webviz.files.config import write_text\n"
        "for i in range(40):\n"
        "    write_text(sys.argv[2] * 5000 + str(i), Path(sys.argv[1]))\n"
    )
    writers = [subprocess.Popen([sys.executable, "-c", code, str(path), who]) for who in "ab"]
    assert [writer.wait(timeout=120) for writer in writers] == [0, 0]
    last, before = path.read_text(), path.with_name("lab.yaml.bak").read_text()
    for text in (last, before):
        assert text[:5000] in ("a" * 5000, "b" * 5000)
    assert last.endswith("39")
    assert last != before
    assert len(list(path.parent.iterdir())) == 2


def test_a_locked_folder_is_reported(path: Path) -> None:
    write_text("one", path)
    descriptor = os.open(path.parent, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        with pytest.raises(
            ConfigError, match="another program is saving in this folder; try again"
        ):
            write_text("two", path)
    finally:
        os.close(descriptor)
    assert path.read_text() == "one"
    assert list(path.parent.iterdir()) == [path]
