"""Recorded drives by chance, and displays of all they publish."""

from __future__ import annotations

import random

from bags import START_NS, Bag, ns

from webviz.shell.testing import header

CONFIG = """\
fixed_frame: map
displays:
- {type: LaserScan, decay_time: 1.2}
- {type: Odometry, keep: 7, position_tolerance: 0.25}
- {type: Map}
- {type: TF}
- {type: Axes, reference_frame: late}
- {type: Path, buffer_length: 3}
- {type: MarkerArray, topic: /markers}
"""
CELLS = 4


def grid(value: int) -> dict:
    info = {"resolution": 1.0, "width": CELLS, "height": CELLS, "origin": {"orientation": {"w": 1}}}
    return {"header": header("map", START_NS), "info": info, "data": [value] * CELLS * CELLS}


def markers(at_s: float, step: int) -> dict:
    common = {"header": header("map", START_NS + ns(at_s)), "ns": "box", "type": 1}
    if step % 20 == 19:
        return {"markers": [{**common, "action": 3}]}
    marker = {
        **common,
        "id": step % 7,
        "action": 2 if step % 5 == 4 else 0,
        "pose": {"position": {"x": at_s}, "orientation": {"w": 1.0}},
        "scale": {"x": 1.0, "y": 1.0, "z": 1.0},
        "color": {"r": 1.0, "a": 1.0},
        "lifetime": {"sec": step % 3},
    }
    return {"markers": [marker]}


def recorded(seed: int = 7, duration_s: float = 6.0, step_s: float = 0.1) -> Bag:
    """A robot that drives; what it publishes when varies by chance."""
    chance = random.Random(seed)
    bag = Bag()
    bag.add("/scan", "sensor_msgs/msg/LaserScan", best_effort=True)
    bag.add("/odom", "nav_msgs/msg/Odometry")
    bag.add("/map", "nav_msgs/msg/OccupancyGrid", latched=True)
    bag.add("/map_updates", "map_msgs/msg/OccupancyGridUpdate")
    bag.add("/path", "nav_msgs/msg/Path", latched=True, depth=2)
    bag.add("/markers", "visualization_msgs/msg/MarkerArray")
    bag.transform(0, "map", "odom", static=True)
    bag.transform(chance.uniform(0, duration_s), "base", "late", static=True)
    bag.put(0, "/map", grid(0))
    bag.put(chance.uniform(0, duration_s), "/map", grid(50))
    silent_s = chance.uniform(0, duration_s)
    for step in range(round(duration_s / step_s)):
        at_s = step * step_s
        stamp_ns = START_NS + ns(at_s)
        # The transform comes after the data that needs it, as it does on robots.
        ranges = {"angle_increment": 0.1, "range_max": 9.0, "ranges": [1.0 + at_s % 5, 2.0, 3.0]}
        if not silent_s < at_s < silent_s + duration_s / 4:
            bag.put(at_s, "/scan", {"header": header("base", stamp_ns), **ranges})
        pose = {"pose": {"position": {"x": at_s}, "orientation": {"w": 1.0}}}
        bag.put(at_s + 0.01, "/odom", {"header": header("odom", stamp_ns), "pose": pose})
        bag.transform(at_s + 0.03, "odom", "base", x=at_s)
        if chance.random() < 0.8:
            bag.put(at_s + 0.05, "/markers", markers(at_s, step))
        if chance.random() < 0.2:
            x = chance.randrange(CELLS)
            update = {"x": x, "y": 1, "width": 1, "height": 1, "data": [chance.randrange(100)]}
            bag.put(at_s, "/map_updates", {"header": header("map", stamp_ns), **update})
            place = {"header": header("map", stamp_ns), **pose}
            bag.put(at_s, "/path", {"header": header("map", stamp_ns), "poses": [place, place]})
    return bag
