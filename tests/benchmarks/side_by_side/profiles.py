"""Where webviz's processor time goes, scene by scene, with one client.

    python -m side_by_side.profiles [--scenes B C] [--functions 12]

py-spy looks 250 times a second at who holds the interpreter; what is left of the process's time is
native: DDS, and numpy, zstd, PNG and sockets where they let go of the interpreter.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from heapq import nlargest
from operator import itemgetter
from pathlib import Path

from side_by_side.case import SETTLE_S, Case, CaseFailed
from side_by_side.scenes import SCENES
from side_by_side.systems.registry import SYSTEMS

RATE = 250
AREAS = {
    "transforms in": "TransformListener.take",
    "messages in": "Runner.take",
    "transforms of the turn": "Frames.prepare|Frames.all|poses_in",
    "displays": "Runner.draw",
    "scene": "ViserScene.flush",
    "panel": "FrameLoop._show_state|Parts.keep_up",
    "frame loop, the rest": "FrameLoop.run",
    "packing": "Packer.frame",
    "event loop, the rest": "_background_worker",
    "ROS thread": "RosSource._run",
}
"""Owner of a stack: the first of these that it contains."""


def profile(scene: str, seconds: float, folder: Path, functions: int) -> None:
    """Print one scene's areas and functions in percent of a core."""
    with Case(SYSTEMS["webviz"], SCENES[scene], folder) as case:
        watcher = case.watch()
        try:
            case.wait_until_steady()
            time.sleep(2 * SETTLE_S)
            cpu, file = case.cpu(), folder / "stacks.txt"
            spy = str(Path(sys.executable).with_name("py-spy"))
            command = [spy, "record", "--gil", "--format", "raw", "--output", str(file)]
            command += ["--pid", str(case.process.pid), "--rate", str(RATE)]
            command += ["--duration", f"{seconds:g}"]
            done = subprocess.run(command, capture_output=True, text=True)
            if done.returncode:
                raise CaseFailed(done.stderr)
            total = 100 * (case.cpu() - cpu) / seconds
        finally:
            watcher.close()
    areas: defaultdict[str, float] = defaultdict(float)
    innermost: defaultdict[str, float] = defaultdict(float)
    for line in file.read_text().splitlines():
        stack, _, count = line.rpartition(" ")
        share = 100 * int(count) / RATE / seconds
        found = (name for name, pattern in AREAS.items() if re.search(pattern, stack))
        areas[next(found, "other")] += share
        innermost[re.sub(r":\d+\)", ")", stack.rpartition(";")[2])] += share
    areas["native"] = max(0.0, total - sum(areas.values()))
    print(f"\n{scene}: {total:.1f} % of a core")
    for name, share in nlargest(len(areas), areas.items(), key=itemgetter(1)):
        print(f"  {share:5.1f}  {name}")
    for name, share in nlargest(functions, innermost.items(), key=itemgetter(1)):
        print(f"         {share:5.2f}  {name}")
    sys.stdout.flush()


def main() -> int:
    """Print the profiles."""
    parser = argparse.ArgumentParser(prog="side_by_side.profiles", description=__doc__)
    parser.add_argument("--scenes", nargs="+", default=list(SCENES), choices=list(SCENES))
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--functions", type=int, default=8, help="of each scene (default: 8)")
    options = parser.parse_args()
    for scene in options.scenes:
        with tempfile.TemporaryDirectory() as folder:
            profile(scene, options.seconds, Path(folder), options.functions)
    return 0


if __name__ == "__main__":
    sys.exit(main())
