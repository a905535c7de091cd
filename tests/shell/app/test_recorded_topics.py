"""The topics that `webviz record --shown` records of a config."""

from __future__ import annotations

from webviz.files.opening import parse
from webviz.shell.recording import topics_of

CONFIG = """\
displays:
- {type: Map}
- {type: LaserScan, topic: scan, enabled: false}
- type: Group
  name: Sensors
  displays:
  - {type: LaserScan, topic: front/scan}
- type: Group
  name: Off
  enabled: false
  displays:
  - {type: Odometry}
"""


def test_topics_are_those_of_displays_that_are_switched_on_and_transforms() -> None:
    config = parse(CONFIG, "the config")
    assert topics_of(config, lambda name: f"/{name.lstrip('/')}") == [
        "/map",
        "/map_updates",
        "/front/scan",
        "/tf",
        "/tf_static",
        "/rosout",
    ]
