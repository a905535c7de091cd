"""Wheel and source distribution of a commit, the same bytes wherever they are built."""

from __future__ import annotations

import gzip
import hashlib
import io
import os
import subprocess
import sys
import tarfile
from pathlib import Path

from tests.release import packing

ROOT = Path(__file__).parents[2]


def build(commit: str, folder: Path) -> list[Path]:
    """Build both archives of a commit.

    Args:
        commit: a name that git knows.
        folder: an existing folder, which then holds `source/`, the files of the commit with the
            page's modules packed, and `made/`, the archives.

    Returns:
        The wheel and the source distribution.
    """
    source, output = folder / "source", folder / "made"
    source.mkdir()
    listed = subprocess.run(
        ["git", "archive", "--format=tar", commit], cwd=ROOT, capture_output=True, check=True
    )
    with tarfile.open(fileobj=io.BytesIO(listed.stdout)) as archive:
        archive.extractall(source, filter="data")
    packing.pack(source / packing.NAME)
    epoch = subprocess.run(
        ["git", "show", "-s", "--format=%ct", commit],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    ).stdout.strip()
    subprocess.run(
        [sys.executable, "-m", "build", "--outdir", output, source],
        env=os.environ | {"SOURCE_DATE_EPOCH": epoch},
        stdout=subprocess.DEVNULL,
        check=True,
    )
    (wheel,), (tar,) = output.glob("*.whl"), output.glob("*.tar.gz")
    _without_times(tar, int(epoch))
    return [wheel, tar]


def digest(path: Path) -> str:
    """The SHA-256 of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _without_times(path: Path, epoch: int) -> None:
    """Repack a source distribution without what depends on when and by whom it was built.

    setuptools honours SOURCE_DATE_EPOCH for wheels only.
    """
    packed = io.BytesIO()
    with tarfile.open(path) as old, tarfile.open(fileobj=packed, mode="w") as new:
        for member in sorted(old.getmembers(), key=lambda each: each.name):
            member.mtime = epoch
            member.pax_headers = {}  # they may have the time, too
            member.uid = member.gid = 0
            member.uname = member.gname = ""
            member.mode = 0o755 if member.isdir() or member.mode & 0o100 else 0o644
            new.addfile(member, old.extractfile(member) if member.isfile() else None)
    path.write_bytes(gzip.compress(packed.getvalue(), mtime=epoch))
