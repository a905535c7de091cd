"""Topics and their QoS.

RViz writes Reliable, Volatile and a depth of 5 into every file, chosen or not.
Taken literally they would lose the laser scans of a best-effort publisher. RViz's defaults
therefore become `auto`, and all other values are explicit choices. Where `auto` is written, RViz
gets what hears the usual publishers, and a mark says that it was not chosen. A robot's description
is always subscribed with transient local, as in RViz.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from webviz.api.declared import Topic
from webviz.api.ports import Input, Output
from webviz.files.rviz import values
from webviz.files.rviz.properties import RvizProperty
from webviz.files.rviz.tree import Path, Tree, child
from webviz.files.rviz.values import Unfit

DEPTH = 5
ROS_1_QUEUE_SIZE = 10
RELIABILITY = {"reliable": "Reliable", "best_effort": "Best Effort"}
DURABILITY = {"volatile": "Volatile", "transient_local": "Transient Local"}
RELIABLE, DURABLE = "Reliability Policy", "Durability Policy"
POLICIES = ("Depth", "Filter size", "History Policy", RELIABLE, DURABLE)
AUTOMATIC = "Automatic QoS"
"""Key of webviz alone: the policy that suits the type of a topic stands for `auto`. RViz ignores
it."""
TOPIC = "Topic"
OLD_KEYS = ("Image Topic", "Marker Topic", "Octomap Topic")
"""ROS 1's keys for `TOPIC`."""
OF_DEPTH_CLOUD = {
    "Depth Map Topic": "Depth Map Transport Hint",
    "Color Image Topic": "Color Transport Hint",
}
"""The topics of a DepthCloud, which has one policy for all, and the keys of their transports."""
HINTS = {**dict.fromkeys(OLD_KEYS, "Transport Hint"), **OF_DEPTH_CLOUD}
"""Keys for the transport of images, by the key of the topic beside them."""
RAW = "raw"


def read(tree: Tree, place: RvizProperty, faults: list[tuple[Path, str]]) -> tuple[dict, set[Path]]:
    """Return a topic of a display as plain values, and the paths they come from.

    Args:
        tree: of the display.
        place: the property.
        faults: receives invalid values, with the reason.
    """
    assert place.port is not None
    (*above, key) = place.path
    tree = child(tree, *above)
    if key == TOPIC:
        key = next((k for k in (key, *OLD_KEYS) if k in tree), key)
    raw = tree.get(key)
    result: dict[str, Any] = {"name": ""}
    used: set[Path] = set()
    name = values.own_value(raw)
    if raw is None and isinstance(place.missing, str):
        result["name"] = place.missing
    elif raw is None and isinstance(place.port, Input) and place.port.is_plain:
        result["name"] = place.default.name  # RViz has one, too
    elif not isinstance(name, Mapping | list) and name is not None:
        result["name"] = values.text(name)
        used.add((*above, key, "Value") if isinstance(raw, Mapping) else (*above, key))
        if (hint := HINTS.get(key)) and hint in tree:
            result["name"] = _with_transport(result["name"], tree[hint])
            used.add((*above, hint))
    for field, path, value in _policies(tree, (*above, key), raw):
        used.add(path)
        try:
            result |= _policy(field, value, place.port)
        except Unfit as error:
            faults.append((path, str(error)))
    if isinstance(raw, Mapping) and raw.get(AUTOMATIC) is True and isinstance(place.port, Input):
        used.add((*above, key, AUTOMATIC))
        for policy in _suited(place.port):
            result.pop(policy, None)
    return result, used


def _suited(input: Input) -> dict[str, str]:
    """Return the policies that hear the usual publishers of a type where RViz's defaults do not."""
    if input.type.startswith("sensor_msgs/"):
        return {"reliability": "Best Effort"}  # which hears all publishers
    is_map = input.type == "nav_msgs/msg/OccupancyGrid" and not input.latched
    return {"durability": "Transient Local"} if is_map else {}


def _with_transport(name: str, hint: Any) -> str:
    """Return the topic of images of a transport, which is below that of raw ones."""
    transport = values.text(hint)
    is_said = transport in ("", RAW) or name.endswith(f"/{transport}") or not name
    return name if is_said else f"{name}/{transport}"


def complete(display: dict[str, Any], topics: list[RvizProperty]) -> None:
    """Remove names that follow from the name of a display's first topic, in place."""
    first = display.get(topics[0].name, {}).get("name") if topics else ""
    for each in topics:
        topic = display.get(each.name, {})
        suffix = each.port.suffix if isinstance(each.port, Input) else ""
        if suffix and topic.get("name") == f"{first}{suffix}":
            topic["name"] = ""


def without_idle_marks(tree: Tree, places: Iterable[RvizProperty]) -> Tree:
    """Return a display's tree without `AUTOMATIC` where that is RViz's default.

    Args:
        tree: of the display, not changed.
        places: the properties of the display.
    """
    for place in places:
        own = child(tree, *place.path)
        is_chosen = (own.get(RELIABLE), own.get(DURABLE)) != ("Reliable", "Volatile")
        if AUTOMATIC in own and not is_chosen:
            (key,) = place.path
            tree = {**tree, key: {k: value for k, value in own.items() if k != AUTOMATIC}}
    return tree


def write(topic: Topic, port: Input | Output, first: Topic) -> Tree | str:
    """Return a topic as RViz has it; `first` is the first topic of the display."""
    if isinstance(port, Input) and port.is_plain:
        return topic.name
    if isinstance(port, Output):
        return _written(topic, "Reliable", "Volatile")
    return _write_input(topic, port, first)


def _write_input(topic: Topic, input: Input, first: Topic) -> Tree:
    # A topic that is not named has no publishers.
    suited = _suited(input) if topic.name else {}
    tree = _written(
        topic,
        suited.get("reliability", "Reliable"),
        suited.get("durability", "Volatile"),
    )
    if any(getattr(topic, policy) == "auto" for policy in suited):
        tree[AUTOMATIC] = True
    if input.latched:
        tree[DURABLE] = "Transient Local"
    if not topic.name and input.suffix and first.name:
        tree["Value"] = first.name + input.suffix
    if not input.latched and not input.suffix:
        tree["Filter size"] = topic.filter_size
    return tree


def _written(topic: Topic, reliability: str, durability: str) -> Tree:
    """Return a topic as RViz has it, with what `auto` stands for."""
    return {
        "Value": topic.name,
        "Depth": topic.depth or DEPTH,
        "History Policy": "Keep Last",
        RELIABLE: RELIABILITY.get(topic.reliability, reliability),
        DURABLE: DURABILITY.get(topic.durability, durability),
    }


def _policies(tree: Tree, path: Path, raw: Any) -> Iterator[tuple[str, Path, Any]]:
    """Yield the QoS in a file: ROS 2's under the topic, ROS 1's next to it."""
    inner = raw if isinstance(raw, Mapping) else {}
    for word in POLICIES:
        if word in inner:
            yield word, (*path, word), inner[word]
    if raw is None:
        return
    if "Queue Size" in tree and "Depth" not in inner:
        yield "Queue Size", (*path[:-1], "Queue Size"), tree["Queue Size"]
    if path[-1] in OF_DEPTH_CLOUD and "Reliability Policy" in tree and not inner:
        yield "own policy", (*path[:-1], "Reliability Policy"), tree["Reliability Policy"]
    if "Unreliable" in tree and "Reliability Policy" not in inner:
        yield "Unreliable", (*path[:-1], "Unreliable"), tree["Unreliable"]


def _policy(word: str, raw: Any, port: Input | Output) -> dict[str, Any]:
    match word:
        case "Depth":
            depth = max(values.read(raw, int), 1)
            return {"depth": 0 if depth == DEPTH else depth}
        case "Queue Size":  # which rviz1_to_rviz2.py makes the depth
            size = max(values.read(raw, int), 1)
            return {"depth": 0 if size == ROS_1_QUEUE_SIZE else size}
        case "Filter size":
            return {"filter_size": max(values.read(raw, int), 1)}
        case "Unreliable":
            return {"reliability": "best_effort"} if values.read(raw, bool) else {}
        case "Reliability Policy":
            label = _label(raw, ("Reliable", "Best Effort", "System Default"))
            return {"reliability": "best_effort"} if label == "Best Effort" else {}
        case "own policy":  # of best-effort, its default, RViz hears the same as of auto
            label = _label(raw, ("Reliable", "Best effort", "System Default"))
            return {"reliability": "reliable"} if label == "Reliable" else {}
        case "Durability Policy":
            label = _label(raw, ("Volatile", "Transient Local", "System Default"))
            is_latched = isinstance(port, Input) and port.latched
            is_chosen = label == "Transient Local" and not is_latched
            return {"durability": "transient_local"} if is_chosen else {}
        case _:
            _label(raw, ("Keep Last", "Keep All", "System Default"))
            return {}


def _label(raw: Any, labels: tuple[str, ...]) -> str:
    label = values.text(values.own_value(raw))
    if label not in labels:
        raise Unfit(f"expected {', '.join(labels)}, got `{label[:80]}`")
    return label
