"""The velocity controllers of all vehicles, and the thread that publishes their commands."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Mapping
from concurrent.futures import Future, wait

from webviz.api.vehicle import STILL, Vehicle, Velocity
from webviz.data.messages import encode
from webviz.engine.driving.velocity_controller import PERIOD_S, DrivingAnswer, VelocityController
from webviz.sources import Advertisement, RestrictedGraph

log = logging.getLogger("webviz")

GAP_S = 0.02
"""Pause in seconds between two commands if a set-point changes; also between the zeros of the
end."""
ATTENDED_S = 2.0
"""A controller is attended for so long after a browser looked at it."""
ENDING_S = 0.5
"""Time `close` waits for the last commands to be published."""
UNKNOWN = "This tool has no valid topic, or no longer exists. Choose a topic in the panel Tools."
ENDED = "The viewer has ended."


class VelocityControllers:
    """Set-points in, velocity commands out.

    Neither waits for the frame loop, which may be busy: set-points come from the threads of edges,
    and a thread of this object, which begins with the first of them, publishes.

    Args:
        graph: that commands go to.
        now_ns: ROS time.
    """

    def __init__(self, graph: RestrictedGraph, now_ns: Callable[[], int]) -> None:
        self._graph = graph
        self._now_ns = now_ns
        self._lock = threading.Lock()
        self._controllers: dict[str, VelocityController] = {}
        self._leaving: list[VelocityController] = []
        """Controllers of vehicles that are gone or have another advertisement, until they have
        stopped."""
        self._looked: dict[str, float] = {}
        self._publications: dict[Advertisement, Future[int]] = {}
        self._problems: dict[Advertisement, str] = {}
        self._woken = threading.Event()
        self._has_ended = False
        self._thread: threading.Thread | None = None

    # For the frame loop

    def equip(self, vehicles: Mapping[str, tuple[Vehicle, Advertisement]]) -> None:
        """Have these vehicles, by id of their tools; all others stop at once."""
        now = time.monotonic()
        with self._lock:
            drivers = {
                tool: controller.driver(now) for tool, controller in self._controllers.items()
            }
            for tool, controller in list(self._controllers.items()):
                if tool not in vehicles or vehicles[tool][1] != controller.advertisement:
                    del self._controllers[tool]
                    if not controller.is_at_rest:
                        controller.halt()
                        self._leaving.append(controller)
                        self._woken.set()
            for tool, (vehicle, advertisement) in vehicles.items():
                controller = self._controllers.setdefault(
                    tool, VelocityController(vehicle, advertisement, drivers.get(tool))
                )
                controller.vehicle = vehicle
            advertisements = [controller.advertisement for controller in self._controllers.values()]
            problems = self._problems
            self._problems = {
                advertisement: problems[advertisement]
                for advertisement in advertisements
                if advertisement in problems
            }

    def attended(self) -> set[str]:
        """Return the tools that browsers look at or drive."""
        now = time.monotonic()
        with self._lock:
            return {tool for tool in self._controllers if self._is_attended(tool, now)}

    def advertisements(self) -> set[Advertisement]:
        """Return the topics to advertise: where the commands of attended vehicles go."""
        now = time.monotonic()
        topics = {
            advertisement.topic for advertisement in self.stopping()
        }  # a topic has one type at a time
        with self._lock:
            return {
                controller.advertisement
                for tool, controller in self._controllers.items()
                if self._is_attended(tool, now) and controller.advertisement.topic not in topics
            }

    def stopping(self) -> set[Advertisement]:
        """Return the topics of vehicles that must still stop: removed ones, or with a new topic."""
        with self._lock:
            return {controller.advertisement for controller in self._leaving}

    def drivers(self) -> dict[str, int]:
        """Return the browser that drives, by tool."""
        now = time.monotonic()
        with self._lock:
            drivers = {
                tool: controller.driver(now) for tool, controller in self._controllers.items()
            }
        return {tool: driver for tool, driver in drivers.items() if driver is not None}

    def halt(self) -> bool:
        """Stop all vehicles at once; whether any was driven."""
        with self._lock:
            driven = [
                controller for controller in self._controllers.values() if not controller.is_at_rest
            ]
            for controller in driven:
                controller.halt()
        self._woken.set()
        return bool(driven)

    def stop(self) -> None:
        """Stop all vehicles and refuse every set-point from now on; from any thread."""
        self._has_ended = True
        self._woken.set()

    def close(self) -> None:
        """Stop, and wait until the last commands are published."""
        self.stop()
        if self._thread is not None:
            self._thread.join()

    # For the edges

    def steer(
        self, tool: str, browser: int, share: Velocity, heartbeat: float | None
    ) -> DrivingAnswer:
        """Take a set-point; from any thread.

        Args:
            tool: id of the tool.
            browser: id of the browser.
            share: of the limits, each from -1 to 1.
            heartbeat: time when the newest message that the browser has was sent, in monotonic s;
                None if that is too old to drive: the browser only looks at the controller.

        Returns:
            What the browser should know.
        """
        now = time.monotonic()
        with self._lock:
            controller = self._controllers.get(tool)
            if controller is None or self._has_ended:
                return DrivingAnswer(problem=ENDED if self._has_ended else UNKNOWN)
            self._looked[tool] = now
            driver = self._driver(controller.advertisement.topic, now)
            refusal = self._graph.refusal(controller.advertisement.topic)
            may_drive = not refusal and driver in (None, browser)
            if (
                heartbeat is not None
                and may_drive
                and controller.steer(browser, share, heartbeat, now)
            ):
                self._begin()
                self._woken.set()
            problem = refusal or self._problems.get(controller.advertisement, "")
            return DrivingAnswer(controller.driver(now) if driver is None else driver, problem)

    def _driver(self, topic: str, now: float) -> int | None:
        """Return the browser that drives what listens to a topic.

        Several tools may publish there.
        """
        controllers = (
            controller
            for controller in self._controllers.values()
            if controller.advertisement.topic == topic
        )
        return next(
            (
                driver
                for controller in controllers
                if (driver := controller.driver(now)) is not None
            ),
            None,
        )

    def _is_attended(self, tool: str, now: float) -> bool:
        return now - self._looked.get(tool, -ATTENDED_S) < ATTENDED_S

    # In the thread

    def _begin(self) -> None:
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name="webviz-driving", daemon=True)
            self._thread.start()

    def _run(self) -> None:
        published = 0.0
        while (is_moving := self.is_moving()) or not self._has_ended:
            due = 0.0 if self._has_ended else self._due(published + PERIOD_S)
            rest = due - time.monotonic() if is_moving else None
            if rest is None or rest > 0.0:
                self._woken.wait(rest)
            self._woken.clear()
            time.sleep(max(0.0, published + GAP_S - time.monotonic()))
            published = time.monotonic()
            self._step(published)
        wait(self._publications.values(), ENDING_S)

    def is_moving(self) -> bool:
        """Return whether any vehicle moves, or has to stop yet."""
        with self._lock:
            return not all(
                controller.is_at_rest
                for controller in (*self._controllers.values(), *self._leaving)
            )

    def _due(self, latest: float) -> float:
        """Return when to step next: as soon as a driver is silent for too long."""
        with self._lock:
            return min(
                [latest, *(controller.deadline for controller in self._controllers.values())]
            )

    def _step(self, now: float) -> None:
        with self._lock:
            if self._has_ended:
                for controller in self._controllers.values():
                    controller.halt()
            controllers = (*self._controllers.values(), *self._leaving)
            due = [
                (controller, velocity)
                for controller in controllers
                if (velocity := controller.step(now)) is not None
            ]
            self._leaving = [
                controller for controller in self._leaving if not controller.is_at_rest
            ]
        self._publications = {
            advertisement: future
            for advertisement, future in self._publications.items()
            if not future.done()
        }
        for controller, velocity in due:
            self._publish(controller.vehicle, controller.advertisement, velocity)

    def _publish(self, vehicle: Vehicle, advertisement: Advertisement, velocity: Velocity) -> None:
        before = self._publications.get(advertisement)
        if before is not None:
            before.cancel()  # what could not be published in time is not published late
        try:
            cdr = encode(advertisement.type, vehicle.message(velocity, self._now_ns()))
            publish = self._graph.halt if velocity == STILL else self._graph.publish
            publication = publish(advertisement, cdr)
        except Exception as error:  # of a plug-in's vehicle, or of the source; keep driving
            if advertisement not in self._problems:
                log.exception("No command for %s", advertisement.topic)
            self._problems[advertisement] = f"No command could be made: {error}"
            return
        self._publications[advertisement] = publication
        publication.add_done_callback(lambda publication: self._note(advertisement, publication))

    def _note(self, advertisement: Advertisement, future: Future[int]) -> None:
        """Note what came of a command."""
        if future.cancelled():
            return
        if error := future.exception():
            self._problems[advertisement] = str(error)
            with self._lock:
                for controller in self._controllers.values():
                    if controller.advertisement == advertisement:
                        controller.begin_again()
        elif future.result() == 0:
            self._problems[advertisement] = (
                f"No subscription to {advertisement.topic} as "
                f"{advertisement.type.rpartition('/')[2]}. Start the robot's driver, or choose "
                "another topic or message type in the panel Tools."
            )
        else:
            self._problems.pop(advertisement, None)
