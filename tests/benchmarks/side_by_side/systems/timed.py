"""webviz, which prints as JSON when which part of its start was done.

python -m side_by_side.systems.timed SECONDS_OF_THE_COMMAND ARGUMENT ...
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from typing import Any


def main(started_s: float, arguments: list[str]) -> int:
    """Run webviz; the times are seconds since `started_s`, or durations of the parts."""
    times: dict[str, float] = {}

    def timed(owner: Any, name: str, part: str) -> None:
        original: Callable[..., Any] = getattr(owner, name)

        def run(*args: Any, **options: Any) -> Any:
            start = time.time()
            try:
                return original(*args, **options)
            finally:
                times[part] = time.time() - start

        setattr(owner, name, run)

    from webviz.shell.cli.commands import run

    times["command line"] = time.time() - started_s
    import webviz.scene
    from webviz.shell.app import running
    from webviz.shell.cli import serving

    timed(serving, "_import_slow_parts", "more imports")
    timed(webviz.scene, "open_server", "server")
    timed(running, "ros_source", "ROS")
    announce = serving._announce

    def announced(*args: Any) -> None:
        times["URL"] = time.time() - started_s
        print(json.dumps(times), flush=True)
        announce(*args)

    serving._announce = announced
    times["imports"] = time.time() - started_s - times["command line"]
    return run(arguments)


if __name__ == "__main__":
    sys.exit(main(float(sys.argv[1]), sys.argv[2:]))
