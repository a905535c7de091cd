"""Plants small faults with cosmic-ray, and lists those that the nearest tests do not find.

It works on a copy of the checkout. Run it with files or folders: `webviz/engine/driving`.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from cosmic_ray.work_db import WorkDB, use_db
from cosmic_ray.work_item import TestOutcome, WorkerOutcome, WorkItem, WorkResult

UNION = "core/ReplaceBinaryOperator_BitOr_"
"""Nearly all `|` are in type hints, which nothing evaluates."""
SAME = {
    f"core/ReplaceComparisonOperator_{pair}"
    for pair in ("Eq_Is", "NotEq_IsNot", "Is_Eq", "IsNot_NotEq")
}
"""Both hold for None, members of enums, and small numbers."""


def main() -> None:
    """Plant faults, and print how many were found and a patch for each that was not."""
    parser = argparse.ArgumentParser(prog="make mutants")
    parser.add_argument("rooms", nargs="+", help="folders or files")
    parser.add_argument("--sample", type=int, default=60, help="faults per room; 0 for all")
    parser.add_argument("--seed", type=int, default=0, help="of the samples")
    parser.add_argument("--tests", default="", help="instead of the nearest ones")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="webviz-mutants-") as folder:
        copy = Path(folder) / "checkout"
        copy_of_checkout(copy)
        for room in options.rooms:
            name = room.rstrip("/")
            attempt(copy, name, options.tests or nearest_tests(name), options)


def nearest_tests(room: str) -> str:
    """Return the folder of `tests/` that mirrors a room, or the one that it is in.

    The tests of a module, `tests/sources/test_inbox.py` of `webviz/sources/inbox.py`, come first.
    """
    path = Path(room.removeprefix("webviz/"))
    module = Path("tests", path.with_name(f"test_{path.name}"))
    folder = next(each for each in (path, *path.parents) if Path("tests", each).is_dir())
    first = [str(module)] if module.is_file() else []
    return shlex.join([*first, str(Path("tests", folder))])


def copy_of_checkout(copy: Path) -> None:
    """Copy all files that git knows or would add."""
    listed = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(listed, capture_output=True, text=True, check=True).stdout
    for name in filter(os.path.isfile, names.split("\0")):
        target = copy / name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(name, target)


def attempt(copy: Path, room: str, tests: str, options: argparse.Namespace) -> None:
    """Plant faults in a room of a copy, and print what came of it."""
    run = [sys.executable, "-m", "pytest", "-x", "-q", "-n", "0", "-p", "no:cacheprovider"]
    run += shlex.split(tests)
    folders = [copy / name for name in (".", "displays", "urdf", "sim")]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(map(str, folders))}
    start = time.monotonic()
    subprocess.run(run, cwd=copy, env=environment, check=True)  # also compiles all once
    seconds = time.monotonic() - start
    config, session = copy.parent / "config.toml", copy.parent / f"{room.replace('/', '.')}.sqlite"
    settings = {
        "module-path": room,
        "timeout": 10.0 + 2.0 * seconds,
        "test-command": shlex.join(run),
    }
    # A text or number of JSON is one of TOML, too.
    lines = [f"{key} = {json.dumps(value)}" for key, value in settings.items()]
    config.write_text("\n".join(["[cosmic-ray]", *lines, 'distributor = {name = "local"}', ""]))

    def cosmic_ray(*arguments: object) -> None:
        command = [sys.executable, "-m", "cosmic_ray.cli", *map(str, arguments)]
        subprocess.run(command, cwd=copy, env=environment, check=True)

    cosmic_ray("init", config, session)
    with use_db(session, WorkDB.Mode.open) as plan:
        keep_sample(plan, copy, options.sample, options.seed)
    cosmic_ray("exec", config, session)
    with use_db(session, WorkDB.Mode.open) as database:
        report(database, room)


def keep_sample(plan: WorkDB, copy: Path, count: int, seed: int) -> None:
    """Leave `count` faults of a plan to be planted, or all that count if it is 0."""
    items = list(plan.work_items)
    usable = [item for item in items if not is_pointless(item, copy)]
    if count and count < len(usable):
        usable = random.Random(seed).sample(usable, count)
    remaining = {item.job_id for item in usable}
    skipped = [item.job_id for item in items if item.job_id not in remaining]
    if skipped:
        plan.set_multiple_results(skipped, WorkResult(WorkerOutcome.SKIPPED))


def is_pointless(item: WorkItem, copy: Path) -> bool:
    """Return whether a fault probably changes nothing that a program does."""
    (mutation,) = item.mutations
    line = (copy / mutation.module_path).read_text().splitlines()[mutation.start_pos[0] - 1]
    is_frozen = line.startswith("@dataclass(") or "(msgspec.Struct," in line
    name = mutation.operator_name
    return is_frozen or name in SAME or name.startswith(UNION)


def report(database: WorkDB, room: str) -> None:
    """Print the share of faults that were found, and the others."""
    results = [result for _, result in database.results if result.test_outcome is not None]
    survivors = [result for result in results if result.test_outcome is TestOutcome.SURVIVED]
    for result in survivors:
        print(result.diff)
    killed = len(results) - len(survivors)
    hung = sum(result.output == "timeout" for result in results)
    share = f"{killed / max(1, len(results)):.0%}"
    print(f"{room}: {killed} of {len(results)} found, {share}; {hung} of them hung the tests")


if __name__ == "__main__":
    main()
