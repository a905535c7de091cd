"""The process whose children save: a line in for each, what became of the file out.

It has a single thread, so that it can fork, and saves nothing itself, which takes another. Children
are killed with SIGKILL, or have a limit for the size of their files, as if the disk were full.
"""

from __future__ import annotations

import os
import resource
import signal
import sys
import time
from pathlib import Path

import PIL.Image

from webviz.api.errors import Error
from webviz.data.working_folder import working_folder
from webviz.files import config as config_file
from webviz.shell.pictures import files as picture_files

LIMIT = 20_000
"""Bytes of a file in a child with a full disk; what it saves is larger."""
REFUSED = 3


def text(number: int) -> str:
    """A config whose text tells whether it is whole."""
    return f"# {number}\n" + f"# line of {number}\n" * 3000 + f"# end of {number}\n"


def save(path: Path, number: int) -> None:
    """Save one version of a file."""
    if path.suffix == ".yaml":
        config_file.write_text(text(number), path)
    else:
        # Noise, which is as large as it looks.
        noise = PIL.Image.effect_noise((200, 200), 80 + number % 7)
        picture_files.save(noise.convert("RGB"), path)


def is_whole(path: Path) -> bool:
    """Return whether a file is one of the versions that were saved."""
    if path.suffix == ".png":
        with PIL.Image.open(path) as picture:
            picture.load()
            return picture.size == (200, 200)
    result = path.read_text()
    return result == text(int(result.split("\n", 1)[0][2:]))


def started(how: str, path: Path, number: int) -> int:
    """Fork a child that saves until killed, or once, on a full disk or not; its process id."""
    if pid := os.fork():
        return pid
    status = 1
    try:
        if how == "full":
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (LIMIT, LIMIT))
        try:
            while True:
                number += 1
                save(path, number)
                if how != "kill":
                    break
        except Error:
            status = REFUSED
    finally:
        os._exit(status)


def outcome(how: str, delay_s: float, path: Path, number: int) -> str:
    """Let a child save, and look at what it leaves; "refused", "survived" or what is wrong."""
    if not path.exists():
        # Another version than the next one: the same text would not be written again.
        os.waitpid(started("first", path, number - 1), 0)
    before = path.read_bytes()
    pid = started(how, path, number)
    if how == "kill":
        time.sleep(delay_s)
        os.kill(pid, signal.SIGKILL)
    _, status = os.waitpid(pid, 0)
    backup = path.with_name(path.name + ".bak")
    for file in (path, *filter(Path.exists, [backup])):
        try:
            if not is_whole(file):
                return f"{file.name} is not whole"
        except Exception as error:
            return f"{file.name} cannot be read: {error!r}"
    remains = {each.name for each in path.parent.iterdir()} - {path.name, backup.name}
    for name in remains:
        (path.parent / name).unlink(missing_ok=True)
    if how == "kill":
        return "survived"
    if os.waitstatus_to_exitcode(status) != REFUSED:
        return "a full disk was not reported"
    if path.read_bytes() != before:
        return "a full disk changed the file"
    return "a full disk leaves a part of a file" if remains else "refused"


def left_behind(delay_s: float, place: Path) -> str:
    """Kill a child that makes working folders, and look at what the next one leaves of them."""
    place.mkdir(exist_ok=True)
    if not (pid := os.fork()):
        while True:
            with working_folder("left_", place) as folder:
                for number in range(20):
                    (folder / f"{number}").write_bytes(bytes(10_000))
    time.sleep(delay_s)
    os.kill(pid, signal.SIGKILL)
    os.waitpid(pid, 0)
    with working_folder("left_", place):
        pass
    # One that was killed before its folder had a lock leaves the empty folder.
    remains = [str(path.relative_to(place)) for path in place.rglob("*") if path.is_file()]
    return f"a killed program leaves {remains} for ever" if remains else "survived"


def main() -> None:
    """Answer lines until there are no more."""
    for number, line in enumerate(sys.stdin):
        how, what, delay, path = line.rstrip("\n").split(" ", 3)
        if what == "folder":
            print(left_behind(float(delay), Path(path).parent), flush=True)
        else:
            print(outcome(how, float(delay), Path(path), number * 100_000), flush=True)


if __name__ == "__main__":
    main()
