"""Interactive markers in a bag, which has the updates of their server but not its service."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from bags import Bag

from webviz.files.config import Config, dump
from webviz.shell.testing import check_seeks
from webviz_displays.interactive_markers import InteractiveMarkers

UPDATE = "visualization_msgs/msg/InteractiveMarkerUpdate"


def test_a_seek_among_updates_of_interactive_markers(tmp_path: Path) -> None:
    bag = Bag()
    bag.add("/arm/update", UPDATE)
    for number in range(40):
        marker: dict[str, Any] = {"header": {"frame_id": "map"}, "name": f"m{number % 3}"}
        values = {"server_id": "arm", "seq_num": number, "type": number % 2, "markers": [marker]}
        bag.put(0.25 * number, "/arm/update", values)
    config = Config(displays=[InteractiveMarkers(interactive_markers_namespace="/arm")])
    config.set_fixed_frame("map")
    check_seeks(bag.write_file(tmp_path / "run.mcap"), dump(config), count=6, seed=1)
