"""Vehicles that people drive: set-points of pages, and speeds of robots."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import msgspec

from webviz.api.declared import Topic
from webviz.api.vehicle import Vehicle, Velocity
from webviz.data.messages import MessageError, decode
from webviz.data.words import joined
from webviz.engine.driving import DrivingAnswer
from webviz.engine.feature import store
from webviz.engine.forms import sendable
from webviz.engine.parts.advertisements import advertisement_of
from webviz.engine.parts.part import Batches, PartContext
from webviz.engine.store import PageStore
from webviz.features.driving.messages import DrivingMessages
from webviz.page.dispatcher import Dispatcher, PageFeature
from webviz.sources import Advertisement, Raw, Subscriber, Subscription

ODOMETRY = "nav_msgs/msg/Odometry"
FRESH_S = 1.0
"""Validity of a speed."""
DIGITS = 2
"""Number of digits of speeds, so that nothing is sent while nothing changes."""
REMEDY = "Choose another topic of odometry in the panel Tools."


DEPTH = 1
"""Depth of the queue of velocity commands: only the newest counts."""


class Driving(msgspec.Struct, frozen=True):
    """A vehicle that browsers attend to.

    Args:
        driver: id of the browser that drives, None if none does.
        speed: of the robot in m/s, negative while it backs; None if it is unknown.
        turn_rate: of the robot in rad/s, counter-clockwise; None if it is unknown.
        problem: why they are unknown, with a remedy; "" if they are not.
    """

    driver: int | None = None
    speed: float | None = None
    turn_rate: float | None = None
    problem: str = ""


class DrivingStore(PageStore, frozen=True):
    """A vehicle, see `Driving`."""

    speed: float | None
    turn_rate: float | None
    problem: str


class DrivingFeature(PageFeature):
    """Lets pages drive the vehicles of tools, and shows their speeds, from their odometry."""

    name = "Driving"
    module = "teleop.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._newest: dict[str, tuple[Raw, float]] = {}
        self._subscriber = Subscriber()

    def attach(self, dispatcher: Dispatcher) -> None:
        """Take the heartbeats of pages that drive."""
        DrivingMessages(dispatcher.channel, self.steer, dispatcher.note)

    def steer(
        self, tool: str, browser: int, share: Velocity, heartbeat: float | None
    ) -> DrivingAnswer:
        """Take a set-point of a page, from any thread; see `VelocityControllers.steer`."""
        return self.context.controllers.steer(tool, browser, share, heartbeat)

    def keep_up(self, commanded: bool) -> None:
        """Have a controller for each vehicle."""
        vehicles: dict[str, tuple[Vehicle, Advertisement]] = {}
        for id, vehicle in self._vehicles().items():
            advertisement = advertisement_of(self.context, vehicle.type, vehicle.topic, DEPTH)
            if advertisement:
                vehicles[id] = vehicle, advertisement
        self.context.controllers.equip(vehicles)

    def subscriptions(self) -> Mapping[str, Subscription]:
        """Return the odometry of attended vehicles; none while no page drives."""
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
                self._newest[name] = raw, self.context.clock()

    def reset(self) -> None:
        """Forget what was received."""
        self._newest.clear()
        self._subscriber.ask()

    def is_attended(self) -> bool:
        """Return whether a browser attends to a vehicle."""
        return bool(self.context.controllers.attended())

    def state(self) -> Mapping[str, Any]:
        """Return the state of attended vehicles."""
        return {"driving": self.vehicles()}

    @store()
    def driving(self, tool: str) -> DrivingStore | None:
        """Return the state of the vehicle of a tool; None if no browser drives it."""
        vehicle = self.vehicles().get(tool)
        return vehicle and DrivingStore(
            vehicle.speed, vehicle.turn_rate, str(sendable(vehicle.problem))
        )

    def vehicles(self) -> dict[str, Driving]:
        """Return the vehicles that browsers attend to, by id of their tools."""
        controllers, topics = self.context.controllers, self._topics()
        drivers = controllers.drivers()
        return {
            tool: self._driving(drivers.get(tool), *topics[tool])
            for tool in controllers.attended() & topics.keys()
        }

    def _vehicles(self) -> dict[str, Vehicle]:
        """Return the vehicle of each tool that has one, by its id."""
        vehicles = {id: tool.vehicle for id, tool in self.context.tools.usable().items()}
        return {id: vehicle for id, vehicle in vehicles.items() if vehicle}

    def _topics(self) -> dict[str, tuple[str, Topic]]:
        """Full name and QoS of the odometry of attended vehicles, by tool."""
        attended = self.context.controllers.attended()
        topics = {}
        for tool, vehicle in self._vehicles().items() if attended else ():
            topic = vehicle.odometry
            if tool in attended and topic.name:
                try:
                    topics[tool] = self.context.player.resolve(topic.name), topic
                except ValueError:
                    continue
        return topics

    def _driving(self, driver: int | None, name: str, topic: Topic) -> Driving:
        raw, at = self._newest.get(name, (None, -math.inf))
        if raw is None or self.context.clock() - at > FRESH_S:
            offer = self.context.offers.get(name)
            if offer is None or not offer.publishers:
                return Driving(driver, problem=f"No publisher on {name}. {REMEDY}")
            return Driving(driver, problem=f"No message on {name}. {REMEDY}")
        try:
            twist = decode(ODOMETRY, raw.cdr, raw.types).twist.twist
        except MessageError as error:
            return Driving(driver, problem=joined(f"{name} cannot be read: {error}", REMEDY))
        x, y, turn = float(twist.linear.x), float(twist.linear.y), float(twist.angular.z)
        speed = math.copysign(math.hypot(x, y), x) if abs(x) >= abs(y) else math.hypot(x, y)
        if not (math.isfinite(speed) and math.isfinite(turn)):
            cause = f"{name} has velocities that are not finite."
            return Driving(driver, problem=joined(cause, "Correct its publisher."))
        return Driving(driver, round(speed, DIGITS) + 0.0, round(turn, DIGITS) + 0.0)
