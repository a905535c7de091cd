"""Builds a release in dist/ and tries it as a user would: `make release`."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Callable
from pathlib import Path

from program import Program

from tests.release.archives import ROOT, build, digest

PYTHONS = ("3.11", "3.12", "3.13", "3.14")
PACKAGE = "ros-webviz"
RETRY_S = 0.5
OWN = ("PYTHONPATH", "LD_LIBRARY_PATH", "_ROS_WHEELS_BOOTSTRAP_COMPLETE")
"""Variables of this environment, by which a new one would load the libraries of this one."""


def main() -> None:
    """Build, check and try the commit that is checked out."""
    changed = subprocess.run(
        ["git", "status", "--porcelain"], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout
    if changed:
        sys.exit(
            "A release has what is committed only: commit or stash these changes first.\n" + changed
        )
    dist = ROOT / "dist"
    shutil.rmtree(dist, ignore_errors=True)
    dist.mkdir()
    with tempfile.TemporaryDirectory() as folder:
        for path in _reproducible(Path(folder)):
            shutil.copy(path, dist)
    archives = sorted(dist.iterdir())
    for tool in (["twine", "check", "--strict"], ["check_wheel_contents"]):
        files = [path for path in archives if tool[0] == "twine" or path.suffix == ".whl"]
        subprocess.run([sys.executable, "-m", *tool, *files], check=True)
    tried = [version for version in PYTHONS if _is_tried(version, archives)]
    for path in archives:
        print(f"{digest(path)}  {path.relative_to(ROOT)}")
    print(
        f"Tried with Python {', '.join(tried)}." if tried else "No Python to try it with was found."
    )


def _reproducible(folder: Path) -> list[Path]:
    """Both archives, built twice; ends with the reason if they differ."""
    first, second = folder / "first", folder / "second"
    for each in (first, second):
        each.mkdir()
    once, again = build("HEAD", first), build("HEAD", second)
    for one, other in zip(once, again, strict=True):
        if digest(one) != digest(other):
            sys.exit(f"{one.name} differs between two builds of the same commit.")
    return once


def _is_tried(version: str, archives: list[Path]) -> bool:
    """Install each archive with a Python and run the demo, or return False without that Python."""
    python = _python(version)
    if python is None:
        print(f"Python {version} was not found, so the release is not tried with it.")
        return False
    for archive in archives:
        print(f"Trying {archive.name} with Python {version} ...", flush=True)
        with tempfile.TemporaryDirectory() as folder:
            _run_demo(python, archive, Path(folder))
    return True


def _python(version: str) -> str | None:
    """A Python of that version which runs: a shim of pyenv may not."""
    for name in (f"python{version}", "python3"):
        code = "import sys; print('%d.%d' % sys.version_info[:2])"
        try:
            completed = subprocess.run(
                [name, "-c", code], capture_output=True, text=True, check=False
            )
        except FileNotFoundError:
            continue
        if completed.stdout.strip() == version:
            return name
    return None


def _run_demo(python: str, archive: Path, folder: Path) -> None:
    """Install an archive into a new environment, and see that its demo draws and ends."""
    subprocess.run([python, "-m", "venv", folder / "venv"], check=True)
    scripts = folder / "venv" / "bin"
    subprocess.run(
        [scripts / "python", "-m", "pip", "install", "-q", f"{PACKAGE}[ros] @ {archive.as_uri()}"],
        check=True,
    )
    env = {k: v for k, v in os.environ.items() if k not in OWN} | {"PYTHONUNBUFFERED": "1"}
    demo = Program(
        [str(scripts / "webviz"), "demo", "--port", "0"], env, folder / "log", cwd=folder
    )
    try:
        url = demo.url()
        page = _until(lambda: urllib.request.urlopen(url, timeout=10).read(), folder / "log")
        assert b"webviz" in page
    finally:
        status = demo.end()
    assert status == 0, demo.output()


def _until(work: Callable[[], bytes], log: Path, seconds: float = 60.0) -> bytes:
    """The result of something that the system may refuse at first."""
    deadline = time.monotonic() + seconds
    while True:
        try:
            return work()
        except OSError:
            if time.monotonic() > deadline:
                raise AssertionError(log.read_text()) from None
            time.sleep(RETRY_S)


if __name__ == "__main__":
    main()
