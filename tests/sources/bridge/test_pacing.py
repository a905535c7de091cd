"""The pacing of large topics, on a link and a bridge that are computed."""

from __future__ import annotations

import random
import struct
from collections import deque
from dataclasses import dataclass

import pytest

from webviz.api.declared import Topic
from webviz.api.lookback import Lookback
from webviz.sources import Subscription
from webviz.sources.bridge.pacing import FIRST_STAY_S, LARGE, MIN_RATE, RateController, is_thinnable

TICK_S = 0.01
CHUNK = 1448
SCAN, CLOUD = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2"
IMAGE, MAP = "sensor_msgs/msg/CompressedImage", "nav_msgs/msg/OccupancyGrid"
POSE_TYPE = "geometry_msgs/msg/PoseStamped"
VIDEO = "foxglove_msgs/msg/CompressedVideo"
TF, MARKERS = "tf2_msgs/msg/TFMessage", "visualization_msgs/msg/MarkerArray"


@dataclass
class Published:
    """A topic of the robot, in bytes and Hz."""

    type: str
    size: int
    hz: float


@dataclass
class Arrivals:
    """The arrivals of a topic: delays in s, and moments."""

    delays: list[float]
    moments: list[float]


class SimulatedLink:
    """A link with a rate and a delay, behind a bridge with two connections.

    Small messages wait in the queue of the link behind what is on its way already. Large ones wait
    at the bridge; of them only what the receive buffer allows is on its way.

    Args:
        rate: bytes per second.
        topics: of the robot.
        delay_s: of the link.
    """

    def __init__(self, rate: float, topics: dict[str, Published], delay_s: float = 0.1) -> None:
        self.rate, self.delay_s, self.topics = rate, delay_s, topics
        self.rate_controller = RateController()
        self.now = 100.0
        self.outcomes = {topic: Arrivals([], []) for topic in topics}
        self._chance = random.Random(2)
        self._link: deque[tuple[str, int, float, bool]] = deque()
        """Topic, bytes, moment of publication, and whether it ends its message."""
        self._free_s = self.now
        self._arriving: deque[tuple[float, str, int, float, bool]] = deque()
        self._at_bridge: deque[tuple[str, int, float]] = deque()
        self._begun = 0
        self._subscribed: deque[tuple[float, set[str]]] = deque([(0.0, set())])
        self._due = {t: self.now + self._chance.random() / p.hz for t, p in topics.items()}
        self._update_large()

    def _update_large(self) -> None:
        subscriptions = {t: Subscription(p.type, Topic(t)) for t, p in self.topics.items()}
        self.large = set(self.rate_controller.large(subscriptions))

    def run(self, seconds: float) -> None:
        until = self.now + seconds
        while self.now < until:
            self.now += TICK_S
            self._publish()
            self._send_large()
            self._arrive()
            if self.rate_controller.step(self.now):
                self._update_large()
            self._subscribed.append(
                (self.now + self.delay_s / 10, set(self.rate_controller.subscribed()))
            )
            while len(self._subscribed) > 1 and self._subscribed[1][0] <= self.now:
                self._subscribed.popleft()

    def _publish(self) -> None:
        for topic, published in self.topics.items():
            if self._due[topic] > self.now:
                continue
            self._due[topic] += 1 / published.hz
            if topic not in self.large:
                self._queue(topic, published.size, self.now, True)
            elif topic in self._subscribed[0][1]:
                self._at_bridge.append((topic, published.size, self.now))

    def _queue(self, topic: str, size: int, at_s: float, is_last: bool) -> None:
        self._free_s = max(self.now, self._free_s) + size / self.rate
        self._arriving.append((self._free_s + self.delay_s, topic, size, at_s, is_last))

    def _send_large(self) -> None:
        """Put on the link what the reader's rate and buffer allow."""
        window = self.rate_controller.rate * (self.rate_controller.trip_s + 0.05)
        flying = sum(size for _, topic, size, _, _ in self._arriving if topic in self.large)
        room = min(window - flying, self.rate_controller.rate * TICK_S + CHUNK)
        while self._at_bridge and room > 0:
            topic, size, at_s = self._at_bridge[0]
            part = min(CHUNK, size - self._begun)
            self._begun += part
            room -= part
            is_last = self._begun >= size
            self._queue(topic, part, at_s, is_last)
            if is_last:
                self._at_bridge.popleft()
                self._begun = 0

    def _arrive(self) -> None:
        while self._arriving and self._arriving[0][0] <= self.now:
            _, topic, size, at_s, is_last = self._arriving.popleft()
            late_s = self.now - at_s - self.delay_s
            if topic in self.large:
                self.rate_controller.note_bytes(size, self.now)
            if not is_last:
                continue
            self.outcomes[topic].delays.append(self.now - at_s)
            self.outcomes[topic].moments.append(self.now)
            published = self.topics[topic]
            if topic in self.large:
                cdr = self._chance.randbytes(8) + bytes(published.size - 8)
                self.rate_controller.note_large(topic, cdr, late_s, self.now)
            elif self.rate_controller.note_small(
                topic, published.type, published.size, late_s, self.now
            ):
                self._update_large()
            if topic == "/tf":
                self.rate_controller.note_trip(self.delay_s + late_s, self.delay_s, self.now)

    def median_delay(self, topic: str, since: float) -> float:
        outcome = self.outcomes[topic]
        pairs = zip(outcome.delays, outcome.moments, strict=True)
        delays = sorted(delay for delay, at_s in pairs if at_s > since)
        return delays[len(delays) // 2]


POSE, LASER = Published(TF, 120, 50), Published(SCAN, 4400, 10)
ROBOT = {
    "/tf": POSE,
    "/scan": LASER,
    "/points": Published(CLOUD, 200_000, 10),
    "/image": Published(IMAGE, 60_000, 15),
}


@pytest.mark.parametrize("mbit", [1.0, 2.0, 5.0])
def test_small_messages_are_in_time_and_large_ones_share_the_rest(mbit: float) -> None:
    link = SimulatedLink(mbit * 125e3, ROBOT)
    link.run(20)
    since = link.now
    link.run(40)
    assert link.median_delay("/tf", since) < 0.25
    assert link.median_delay("/scan", since) < 0.3
    sizes = {"/points": 200_000, "/image": 60_000}
    duration = sum(
        size * sum(at_s > since for at_s in link.outcomes[topic].moments) / 40
        for topic, size in sizes.items()
    )
    remaining = mbit * 125e3 - 50_000
    assert duration > 0.5 * remaining
    assert set(link.rate_controller.thinned(link.now)) == {"/points", "/image"}
    for hz in link.rate_controller.thinned(link.now).values():
        assert hz < 15


def test_a_fast_link_carries_everything_without_a_remark() -> None:
    link = SimulatedLink(50e6, ROBOT, delay_s=0.005)
    link.run(5)
    assert not link.rate_controller.is_in_turns
    since = link.now
    link.run(5)
    assert sum(at_s > since for at_s in link.outcomes["/points"].moments) == pytest.approx(
        50, abs=2
    )
    assert link.rate_controller.thinned(link.now) == {}


def test_a_link_that_becomes_slow_and_fast_again_is_followed() -> None:
    link = SimulatedLink(20e6, ROBOT, delay_s=0.02)
    link.run(5)
    assert not link.rate_controller.is_in_turns
    link.rate = 150e3
    link.run(30)
    since = link.now
    link.run(20)
    assert link.rate_controller.is_in_turns
    assert link.median_delay("/tf", since) < 0.25
    link.rate = 20e6
    link.run(30)
    assert not link.rate_controller.is_in_turns


def test_a_scan_that_does_not_fit_takes_turns_too() -> None:
    link = SimulatedLink(0.3 * 125e3, ROBOT)
    link.run(30)
    assert "/scan" in link.large
    assert "/tf" not in link.large
    since = link.now
    link.run(60)
    assert link.median_delay("/tf", since) < 0.4
    assert link.outcomes["/scan"].moments[-1] > since


def test_a_scan_is_small_again_as_soon_as_all_fit() -> None:
    """However long it would take turns otherwise, after it did several times."""
    link = SimulatedLink(
        0.3 * 125e3, {"/tf": POSE, "/scan": LASER, "/image": Published(IMAGE, 60_000, 0.5)}
    )
    moved_s = link.now
    for _ in range(3):
        link.rate = 0.3 * 125e3
        while "/scan" not in link.large:
            link.run(0.1)
        moved_s, link.rate = link.now, 20e6
        while "/scan" in link.large:
            link.run(0.1)
    assert not link.rate_controller.is_in_turns
    assert link.now - moved_s < 4 * FIRST_STAY_S - 5.0


def test_a_fast_link_carries_all_within_seconds() -> None:
    """Also if the first messages take longer than the rate takes to grow."""
    link = SimulatedLink(
        1e8, {"/tf": POSE, "/points": Published(CLOUD, 1_600_000, 10)}, delay_s=0.001
    )
    link.run(4)
    since = link.now
    link.run(2)
    recent = [at_s for at_s in link.outcomes["/points"].moments if at_s > since]
    assert len(recent) >= 19
    assert not link.rate_controller.is_in_turns
    assert link.median_delay("/points", since) < 0.1


def test_a_message_that_is_large_moves_its_topic() -> None:
    link = SimulatedLink(1e6, {"/tf": POSE, "/clusters": Published(MARKERS, LARGE, 1)})
    assert link.large == set()
    link.run(3)
    assert link.large == {"/clusters"}


def test_a_latched_message_is_not_taken_again_and_again() -> None:
    rate_controller = RateController()
    rate_controller.large({"/cloud": Subscription(CLOUD, Topic("/cloud"))})
    now, subscriptions, was_open, is_open = 0.0, 0, False, False
    for _ in range(400):
        now += 0.05
        rate_controller.note_trip(0.05, 0.05, now)
        rate_controller.step(now)
        is_open = "/cloud" in rate_controller.subscribed()
        if is_open and not was_open:
            subscriptions += 1
            rate_controller.note_large("/cloud", b"the same" * 10_000, 0.0, now)
        was_open = is_open
    assert subscriptions <= 3
    assert is_open


def test_a_topic_that_is_silent_stays_subscribed_to_longer_and_keeps_no_other_out() -> None:
    link = SimulatedLink(
        2e5, {"/tf": POSE, "/rare": Published(CLOUD, 50_000, 0.2), "/image": ROBOT["/image"]}
    )
    link.run(60)
    assert len(link.outcomes["/rare"].moments) >= 3
    assert len(link.outcomes["/image"].moments) > 20


@pytest.mark.parametrize(
    ("type", "lookbacks", "is_thin"),
    [
        (CLOUD, (Lookback(count=1),), True),
        (SCAN, (Lookback(seconds=2.0), Lookback(count=1)), True),
        (MARKERS, (Lookback(),), False),
        (IMAGE, (Lookback(starts_over=lambda message, type: True),), True),
        (VIDEO, (Lookback(starts_over=lambda message, type: True),), False),
        (MAP, (Lookback(count=1),), False),
        (TF, (Lookback(seconds=15.0),), False),
    ],
)
def test_only_messages_that_are_shown_alone_are_left_out(
    type: str, lookbacks: tuple[Lookback, ...], is_thin: bool
) -> None:
    assert is_thinnable(Subscription(type, Topic("/t"), lookbacks=lookbacks)) is is_thin


def test_the_rate_never_falls_below_the_least() -> None:
    rate_controller = RateController()
    rate_controller.large({"/points": Subscription(CLOUD, Topic("/points"))})
    for i in range(1000):
        rate_controller.note_small("/pose", "geometry_msgs/msg/PoseStamped", 100, 5.0, i / 20)
        rate_controller.note_bytes(5000, i / 20)
        rate_controller.step(i / 20)
    assert rate_controller.rate == MIN_RATE


@pytest.mark.parametrize(("type", "is_large"), [(SCAN, True), (MARKERS, True), (TF, False)])
def test_a_large_message_makes_its_topic_large_unless_it_has_transforms(
    type: str, is_large: bool
) -> None:
    rate_controller = RateController()
    assert not rate_controller.note_small("/t", type, LARGE - 1, 0.0, 1.0)
    assert rate_controller.note_small("/t", type, LARGE, 0.0, 1.1) is is_large
    subscriptions = {"/t": Subscription(type, Topic("/t"))}
    assert ("/t" in rate_controller.large(subscriptions)) is is_large


@pytest.mark.parametrize(("bytes_per_s", "is_moved"), [(7000, True), (9000, False)])
def test_small_topics_move_if_they_are_late_although_large_ones_bring_little(
    bytes_per_s: int, is_moved: bool
) -> None:
    types = {"/pose": "geometry_msgs/msg/PoseStamped", "/points": CLOUD}
    subscriptions = {topic: Subscription(type, Topic(topic)) for topic, type in types.items()}
    rate_controller = RateController()
    rate_controller.large(subscriptions)
    for i in range(60):
        rate_controller.note_small("/pose", types["/pose"], 100, 5.0, i / 20)
        rate_controller.note_bytes(bytes_per_s // 20, i / 20)
        rate_controller.step(i / 20)
    assert ("/pose" in rate_controller.large(subscriptions)) is is_moved


class LatePose:
    """Poses that come late at first, since something else than large messages fills the link.

    Args:
        size: of each pose, in bytes.
    """

    def __init__(self, size: int = 100) -> None:
        types = {"/pose": POSE_TYPE, "/points": CLOUD}
        self.subscriptions = {
            topic: Subscription(type, Topic(topic)) for topic, type in types.items()
        }
        self.rate_controller, self.size, self.now = RateController(), size, 0.0

    @property
    def is_moved(self) -> bool:
        """Return whether they take turns with large messages."""
        return "/pose" in self.rate_controller.large(self.subscriptions)

    def run(self, seconds: float, late_s: float) -> float:
        """Let them come late for so long, or until they take turns or no longer do; how long."""
        before, begun = self.is_moved, self.now
        while self.now < begun + seconds and self.is_moved == before:
            self.now += 0.05
            if not before:
                self.rate_controller.note_small("/pose", POSE_TYPE, self.size, late_s, self.now)
            elif "/pose" in self.rate_controller.subscribed():
                self.rate_controller.note_bytes(self.size, self.now)
                cdr = struct.pack("<d", self.now) + bytes(self.size - 8)
                self.rate_controller.note_large("/pose", cdr, late_s, self.now)
            self.rate_controller.note_trip(late_s, 0.0, self.now)
            self.rate_controller.step(self.now)
        return self.now - begun


def test_a_topic_in_turns_becomes_small_again_after_a_delay_that_doubles() -> None:
    poses = LatePose()
    stays: list[float] = []
    for _ in range(7):
        assert poses.run(5.0, late_s=5.0) < 5.0
        assert poses.is_moved
        stays.append(poses.run(400.0, late_s=0.0))
        assert not poses.is_moved
    assert stays == pytest.approx([10, 20, 40, 80, 160, 300, 300], abs=0.3)


def test_a_topic_that_is_late_occasionally_takes_no_turns() -> None:
    poses = LatePose()
    for _ in range(5):
        poses.run(1.2, late_s=5.0)
        poses.run(1.0, late_s=0.0)
    assert not poses.is_moved


@pytest.mark.parametrize(("size", "late_s"), [(100, 0.05), (LARGE, 0.0)])
def test_a_topic_stays_in_turns_while_late_or_large(size: int, late_s: float) -> None:
    poses = LatePose(size)
    poses.run(5.0, late_s=5.0)
    assert poses.is_moved
    assert poses.run(60.0, late_s) > 59.0
    assert poses.is_moved


@pytest.mark.parametrize("part", [1500, 6000, 50_000])
def test_large_messages_are_read_half_as_fast_again_as_the_link_brought_the_last(part: int) -> None:
    """The link itself may be slow without any queue in it."""
    rate_controller = RateController()
    rate_controller.large({"/points": Subscription(CLOUD, Topic("/points"))})
    size, seconds = 100_000, 2.0
    for at in range(0, size, part):
        rate_controller.note_bytes(min(part, size - at), seconds * at / size)
    rate_controller.note_large("/points", bytes(size), 0.0, seconds)
    assert rate_controller.rate == pytest.approx(1.5 * size / seconds, rel=0.01)
    rate_controller.note_bytes(size, 3.0)
    rate_controller.note_large(
        "/points", bytes(size), 0.0, 3.0
    )  # at once: as fast as the rate allows
    assert rate_controller.rate == pytest.approx(1.5 * size / seconds, rel=0.01)


def test_the_estimated_rate_of_a_link_does_not_rise_without_evidence() -> None:
    rate_controller = RateController()
    rate_controller.large({"/points": Subscription(CLOUD, Topic("/points"))})
    rate_controller.note_bytes(LARGE, 1.0)
    rate_controller.note_bytes(LARGE, 2.0)
    rate_controller.note_large("/points", bytes(2 * LARGE), 0.0, 2.0)  # slower than the first rate
    rate = rate_controller.rate
    for i in range(200):
        rate_controller.note_small("/pose", POSE_TYPE, 100, 0.0, 3.0 + i / 20)
        rate_controller.note_bytes(100, 3.0 + i / 20)
        rate_controller.step(3.0 + i / 20)
    assert rate_controller.rate == rate
    for i in range(60):
        rate_controller.note_small("/pose", POSE_TYPE, 100, 0.0, 13.0 + i / 20)
        rate_controller.note_bytes(round(0.6 * rate_controller.rate / 20), 13.0 + i / 20)
        rate_controller.step(13.0 + i / 20)
    assert rate_controller.rate > 1.5 * rate


class Turns:
    """Two topics with clouds that take turns, and the moments at which each is asked for.

    Args:
        trip_s: round trip of the link.
        sizes: of the message of each that has come before, 0 for none.
    """

    def __init__(self, trip_s: float, sizes: tuple[int, int] = (0, 0)) -> None:
        self.rate_controller = RateController()
        self.rate_controller.large({t: Subscription(CLOUD, Topic(t)) for t in ("/a", "/b")})
        self.trip_s, self.now = trip_s, 0.0
        for topic, size in zip(("/a", "/b"), sizes, strict=True):
            if size:
                self.rate_controller.note_large(topic, topic.encode() * (size // 2), 0.0, 0.0)

    def until_asked(self, topic: str, bytes_per_s: float = 0.0) -> float:
        """Wait until a topic is asked for, while bytes come; the time that takes."""
        begun = self.now
        while topic not in self.rate_controller.subscribed():
            self.now += 0.02
            self.rate_controller.note_trip(self.trip_s, self.trip_s, self.now)
            if bytes_per_s:
                self.rate_controller.note_bytes(round(bytes_per_s * 0.02), self.now)
            self.rate_controller.step(self.now)
            assert self.now < begun + 20.0
        return self.now - begun


@pytest.mark.parametrize("trip_s", [0.0, 0.3, 1.0, 2.0])
def test_a_topic_that_brings_nothing_in_a_round_trip_and_a_half_second_is_over(
    trip_s: float,
) -> None:
    turns = Turns(trip_s)
    turns.until_asked("/a")
    assert turns.until_asked("/b") == pytest.approx(0.1 + trip_s + 0.5, abs=0.08)
    assert turns.until_asked("/a") == pytest.approx(0.1 + trip_s + 0.5, abs=0.08)
    assert turns.until_asked("/b") == pytest.approx(0.15 + trip_s + 0.5, abs=0.08), "it is longer"


@pytest.mark.parametrize("trip_s", [0.1, 0.3])
def test_the_next_topic_is_requested_shortly_before_the_current_message_ends(trip_s: float) -> None:
    """So that the link has no rest; no earlier, as both would be on their way then."""
    size, bytes_per_s = 60_000, 100_000
    turns = Turns(trip_s, (size, size))
    turns.until_asked("/a")
    left_s = size / bytes_per_s - turns.until_asked("/b", bytes_per_s)
    assert left_s == pytest.approx(trip_s + 0.1, abs=0.06)


def test_the_rate_of_the_link_is_that_of_the_last_seconds() -> None:
    rate_controller = RateController()
    for at_s in range(1, 21):
        rate_controller.note_small("/pose", POSE_TYPE, 1000, 0.0, float(at_s))
        rate_controller.note_bytes(9000, float(at_s))
        rate_controller.step(float(at_s))
    assert rate_controller.carried() == pytest.approx(10_000, rel=0.25)
    rate_controller.step(30.0)
    assert rate_controller.carried() == 0.0


def test_the_rates_of_thinned_topics_are_those_of_their_last_messages() -> None:
    link = SimulatedLink(2 * 125e3, ROBOT)
    link.run(60)
    result = link.rate_controller.thinned(link.now)
    assert result.keys() == {"/points", "/image"}
    for topic, hz in result.items():
        last = link.outcomes[topic].moments[-10:]
        assert hz == pytest.approx(9 / (link.now - last[0]), rel=0.02)
    later = link.rate_controller.thinned(link.now + 100.0)
    assert all(0.0 < hz < 0.1 for hz in later.values()), "none came since"


def test_only_thinned_topics_are_reported() -> None:
    """Neither a map, nor a latched cloud, nor what has not come yet."""
    link = SimulatedLink(
        2e5,
        {
            "/tf": POSE,
            "/map": Published(MAP, 50_000, 0.2),
            "/rare": Published(CLOUD, 50_000, 0.1),
            "/silent": Published(CLOUD, 50_000, 0.001),
            "/image": ROBOT["/image"],
        },
    )
    link.run(5)
    assert link.outcomes["/image"].moments
    assert link.rate_controller.thinned(link.now).keys() <= {"/image", "/rare"}
    link.run(60)
    assert link.outcomes["/map"].moments
    assert link.outcomes["/rare"].moments
    assert link.rate_controller.thinned(link.now).keys() == {"/image"}


@pytest.mark.parametrize(("delay_s", "is_in_turns"), [(0.9, False), (1.5, True)])
def test_large_topics_take_turns_once_their_own_messages_are_a_second_late(
    delay_s: float, is_in_turns: bool
) -> None:
    link = SimulatedLink(50e6, ROBOT, delay_s=0.005)
    link.run(5)
    assert not link.rate_controller.is_in_turns
    link.rate_controller.note_large("/points", bytes(LARGE), delay_s, link.now)
    assert link.rate_controller.is_in_turns is is_in_turns


def test_a_topic_that_has_come_once_has_the_rate_of_one_message_since() -> None:
    turns = Turns(0.1)
    turns.until_asked("/a")
    turns.rate_controller.note_large("/a", bytes(LARGE), 0.0, turns.now)
    assert turns.rate_controller.thinned(turns.now + 10.0) == {"/a": pytest.approx(0.1)}
