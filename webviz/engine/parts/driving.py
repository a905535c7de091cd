"""Reports of robots that people drive."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from webviz.api.declared import Topic
from webviz.data.messages import MessageError, decode
from webviz.data.words import joined
from webviz.engine.driving import VelocityControllers
from webviz.engine.parts.part import Batches, Core, Part
from webviz.engine.state import Driving
from webviz.sources import Raw, Subscriber, Subscription

ODOMETRY = "nav_msgs/msg/Odometry"
FRESH_S = 1.0
"""Validity of a speed."""
DIGITS = 2
"""Of speeds, so that nothing is sent while nothing changes."""
REMEDY = "Choose another topic of odometry in the panel Tools."


class DrivingPart(Part):
    """Speed and turn rate of the vehicles that browsers attend to, from their odometry.

    Args:
        core: shared by all parts.
        controllers: of the vehicles.
        odometry: the topic of each vehicle's odometry, by id of its tool.
    """

    name = "Driving"

    def __init__(
        self,
        core: Core,
        controllers: VelocityControllers,
        odometry: Callable[[], Mapping[str, Topic]],
    ) -> None:
        super().__init__(core)
        self._controllers = controllers
        self._odometry = odometry
        self._newest: dict[str, tuple[Raw, float]] = {}
        self._subscriber = Subscriber()

    def subscriptions(self) -> Mapping[str, Subscription]:
        """Return the odometry of attended vehicles; none while nobody drives."""
        topics = self._topics().values()
        return self._subscriber.subscribe(
            {name: Subscription(ODOMETRY, topic) for name, topic in topics}
        )

    def take(self, batches: Batches) -> None:
        """Keep the newest odometry."""
        names = {name for name, _ in self._topics().values()}
        self._newest = {name: each for name, each in self._newest.items() if name in names}
        for name in names & batches.keys():
            for raw in batches[name]:
                self._newest[name] = raw, self.core.clock()

    def reset(self) -> None:
        """Forget what was received."""
        self._newest.clear()
        self._subscriber.ask()

    def state(self) -> Mapping[str, Any]:
        """Return the state of attended vehicles."""
        drivers, topics = self._controllers.drivers(), self._topics()
        return {
            "driving": {
                tool: self._driving(drivers.get(tool), *topics[tool])
                for tool in self._controllers.attended() & topics.keys()
            }
        }

    def _topics(self) -> dict[str, tuple[str, Topic]]:
        """Full name and QoS of the odometry of attended vehicles, by tool."""
        attended = self._controllers.attended()
        found = {}
        for tool, topic in self._odometry().items() if attended else ():
            if tool in attended and topic.name:
                try:
                    found[tool] = self.core.player.resolve(topic.name), topic
                except ValueError:
                    continue
        return found

    def _driving(self, driver: int | None, name: str, topic: Topic) -> Driving:
        raw, at = self._newest.get(name, (None, -math.inf))
        if raw is None or self.core.clock() - at > FRESH_S:
            offer = self.core.offers.get(name)
            if offer is None or not offer.publishers:
                return Driving(driver, problem=f"No publisher on {name}. {REMEDY}")
            return Driving(driver, problem=f"No message on {name}. {REMEDY}")
        try:
            twist = decode(ODOMETRY, raw.cdr).twist.twist
        except MessageError as error:
            return Driving(driver, problem=joined(f"{name} cannot be read: {error}", REMEDY))
        x, y, turn = float(twist.linear.x), float(twist.linear.y), float(twist.angular.z)
        speed = math.copysign(math.hypot(x, y), x) if abs(x) >= abs(y) else math.hypot(x, y)
        if not (math.isfinite(speed) and math.isfinite(turn)):
            cause = f"{name} has velocities that are not finite."
            return Driving(driver, problem=joined(cause, "Correct its publisher."))
        return Driving(driver, round(speed, DIGITS) + 0.0, round(turn, DIGITS) + 0.0)
