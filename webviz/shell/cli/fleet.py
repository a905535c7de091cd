"""The configs of `webviz demo`, for one robot and for several."""

import contextlib
import tempfile
from collections.abc import Iterator
from pathlib import Path

DEMO, FLEET = (Path(__file__).with_name(name) for name in ("demo.yaml", "fleet.yaml"))
_NO_ROBOTS = "robots: []"
MAX_WITH_TOOLS = 8
"""Tools of more robots would push the others out of the toolbar."""


@contextlib.contextmanager
def standard_config(robots: int) -> Iterator[Path]:
    """Provide the file of a config for so many robots, during the block."""
    if robots == 1:
        yield DEMO
        return
    names = ", ".join(f"robot{number}" for number in range(1, robots + 1))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, FLEET.name)
        shown, _, tools = FLEET.read_text().partition("tools:\n")
        if robots > MAX_WITH_TOOLS:
            some = range(1, MAX_WITH_TOOLS + 1)
            tools = "".join(tools.replace("{robot}", f"robot{number}") for number in some)
        path.write_text(shown.replace(_NO_ROBOTS, f"robots: [{names}]") + "tools:\n" + tools)
        yield path
