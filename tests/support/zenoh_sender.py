"""A robot over Zenoh in a process of its own: `python zenoh_sender.py ENDPOINT`.

It publishes a latched /words, and for each line of its standard input another: as many bytes as the
line says, or the line itself. With 0 for the endpoint it is its own router, whose endpoint it
prints.
"""

from __future__ import annotations

import sys
from typing import Any

from zenoh_robot import ZenohRobot, ZenohRouter


def main() -> None:
    """Publish until the standard input ends."""
    endpoint = sys.argv[1]
    alone: Any = {
        "transport__shared_memory__enabled": False,
        # Zenoh ends a connection that takes nothing for five seconds, as a busy machine may.
        "transport__link__tx__queue__congestion_control__block__wait_before_close": 60_000_000,
    }
    router = ZenohRouter(**alone) if endpoint == "0" else None
    robot = ZenohRobot(router.endpoint if router else endpoint, **alone)
    type = "std_msgs/msg/String"
    publish = robot.publisher("/words", type, is_latched=router is None, is_blocking=True)
    publish({"data": "cached"})
    print(router.endpoint if router else endpoint, flush=True)
    for line in sys.stdin:
        text = line.strip()
        publish(bytes(int(text)) if text.isdigit() else {"data": text})
    robot.close()


if __name__ == "__main__":
    main()
