"""webviz behind a bridge: foxglove-sdk passes raw messages on, and webviz draws them.

    python -m side_by_side.systems.bridged CONFIG TOPIC=TYPE...

Both are children of this process, and so is what they take.
"""

from __future__ import annotations

import subprocess
import sys


def main(config: str, *topics: str) -> None:
    """Run until it is ended."""
    python = [sys.executable, "-m"]
    bridge = subprocess.Popen(
        [*python, "side_by_side.systems.foxglove", *topics], stdout=subprocess.PIPE, text=True
    )
    assert bridge.stdout is not None
    url = bridge.stdout.readline().strip()
    options = ["--port", "0", "--no-autosave", "--set", "memory.seconds=0", "--connect", url]
    viewer = subprocess.Popen([*python, "webviz", "-d", config, *options])
    try:
        viewer.wait()
    except KeyboardInterrupt:
        pass
    finally:
        for child in (viewer, bridge):
            child.terminate()
            child.wait()


if __name__ == "__main__":
    main(*sys.argv[1:])
