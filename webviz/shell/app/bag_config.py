"""The config of a bag without one: displays for its topics, a fixed frame, a view of the robot."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence

import msgspec

from webviz.api.declared import make
from webviz.api.display import Display
from webviz.api.offer import Offer
from webviz.api.ports import TRANSPORTS
from webviz.api.registry import display_types
from webviz.api.views import Orbit
from webviz.data.recordings.latched import TF
from webviz.data.transforms.tree import root_of
from webviz.engine.parts.by_topic import Pick, picks
from webviz.files.config import STANDARD, Config, Item
from webviz.sources.bag.comparison import BASES, ROOT
from webviz.sources.bag.history import BagHistory

PREFERRED = ("RobotModel", "Image", "OccupancyGrid", "PlanningScene", "Trajectory", "NavSatFix")
"""Types of displays that are preferred if several fit a topic."""
ON_REQUEST = {"CameraInfo", "Effort", "Text"}
"""Displays that repeat what others show, or that fit everything."""
JOINTS = "RobotModel", "joint_states_topic"
"""Only moves the links of a model, which comes from the description."""
MAX_ENABLED = 4
"""Largest number of displays of a type; further ones are in the list, switched off."""
MAX_DISPLAYS = 100
FRAMES = ("map", "odom", "world")
"""Fixed frames by preference; without them, the root of the largest tree."""


def config_of(bag: BagHistory) -> Config:
    """Return the displays that fit the topics of a bag, in a frame that it has.

    The view follows the robot, which may be far from where the fixed frame is.
    """
    offers = {
        topic: offer
        for topic, offer in bag.offers({}).items()
        if bag.has(topic) and not (bag.comparison and topic.startswith(f"{ROOT}/"))
    }
    config, drawn_topics = displays_of(offers)
    links = bag.links() or [(frame, frame) for frame in bag.frames(drawn_topics)]
    if frame := fixed_frame_of(links):
        config.set_fixed_frame(frame)
    if robot := robot_frame_of(links, frame):
        config.settings = msgspec.structs.replace(config.settings, view=Orbit(target_frame=robot))
    return config


def displays_of(offers: Mapping[str, Offer]) -> tuple[Config, set[str]]:
    """Return the displays that fit published topics, and the topics that they show."""
    types = display_types()
    topics = {
        topic: tuple(dict.fromkeys(publisher.type for publisher in offer.publishers))
        for topic, offer in offers.items()
    }
    chosen_picks = sorted(_chosen(picks(topics, types)), key=_place)[:MAX_DISPLAYS]
    names = ["Grid"]
    if any(TF in messages for messages in topics.values()):
        names.append("TF")
    config = Config(displays=[make(types[name], {}) for name in names if name in types])
    config.displays += _displays(chosen_picks, types)
    return config, {pick.topic for pick in chosen_picks}


def _chosen(fits: Iterable[Pick]) -> Iterable[Pick]:
    """One display for each topic, and for one of the transports of an image."""
    by_topic: dict[str, list[Pick]] = defaultdict(list)
    for pick in fits:
        if pick.display not in ON_REQUEST and (pick.display, pick.input) != JOINTS:
            by_topic[pick.topic].append(pick)
    bases = set[str]()
    for topic, several in sorted(by_topic.items()):
        folder, _, last = topic.rpartition("/")
        base = folder if last in TRANSPORTS else topic
        if base not in bases:
            bases.add(base)
            yield min(several, key=_rank)


def _rank(pick: Pick) -> int:
    return PREFERRED.index(pick.display) if pick.display in PREFERRED else len(PREFERRED)


def _place(pick: Pick) -> tuple[int, str, str]:
    """Return the usual displays come first."""
    place = STANDARD.index(pick.display) if pick.display in STANDARD else len(STANDARD)
    return place, pick.display, pick.topic


def _displays(picks: Sequence[Pick], types: Mapping[str, type[Display]]) -> Iterable[Item]:
    counts = Counter(pick.display for pick in picks)
    totals = Counter[str]()
    for pick in picks:
        totals[pick.display] += 1
        values = {**pick.values, "enabled": totals[pick.display] <= MAX_ENABLED}
        if counts[pick.display] > 1:
            values["name"] = pick.topic
        yield make(types[pick.display], values)


def fixed_frame_of(links: Sequence[tuple[str, str]]) -> str:
    """Return the frame in which most can be drawn, "" without any.

    Args:
        links: parents and children.
    """
    parents = {child: parent for parent, child in links}
    frames = {frame for link in links for frame in link}
    for name in FRAMES:
        if name in frames:
            return name
    sizes = Counter(root_of(frame, parents) for frame in frames)
    return min(sizes, key=lambda root: (-sizes[root], root), default="")


def robot_frame_of(links: Sequence[tuple[str, str]], fixed_frame: str) -> str:
    """Return the frame of a robot that moves in the fixed frame, "" without any.

    Args:
        links: parents and children.
    """
    parents = {child: parent for parent, child in links}
    robots = [
        (BASES.index(name), frame)
        for frame in parents
        if (name := frame.rpartition("/")[2]) in BASES
        and frame != fixed_frame
        and root_of(frame, parents) == root_of(fixed_frame, parents)
    ]
    return min(robots, default=(0, ""))[1]
