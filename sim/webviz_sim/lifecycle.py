"""The services of Nav2's lifecycle manager: start-up, pause and the like of the navigation."""

from collections.abc import Callable
from typing import Any

from rclpy.node import Node
from std_srvs.srv import Trigger

from webviz.data.messages import decode, interfaces
from webviz.ros.types import service_class, to_cdr
from webviz_sim.action_server import response_of

MANAGE = "nav2_msgs/srv/ManageLifecycleNodes"
MANAGER = "lifecycle_manager_navigation"
STARTUP, PAUSE, RESUME, RESET, SHUTDOWN, CONFIGURE, CLEANUP = range(7)
"""Commands of `MANAGE`."""
_STEPS = {
    ("unconfigured", STARTUP): "active",
    ("unconfigured", CONFIGURE): "inactive",
    ("inactive", STARTUP): "active",
    ("inactive", RESUME): "active",
    ("inactive", CLEANUP): "unconfigured",
    ("inactive", RESET): "unconfigured",
    ("active", PAUSE): "inactive",
    ("active", RESET): "unconfigured",
}


class Lifecycle:
    """Lifecycle of the navigation, as clients decide; it starts active.

    Args:
        node: The node that offers the services.
        left: Called when it stops being active.
    """

    def __init__(self, node: Node, left: Callable[[], None]):
        self._state = "active"
        self._left = left
        manage = service_class(MANAGE)
        node.create_service(Trigger, f"{MANAGER}/is_active", self._answer)
        node.create_service(manage, f"{MANAGER}/manage_nodes", self._manage)

    @property
    def is_active(self) -> bool:
        """Return whether goals are accepted."""
        return self._state == "active"

    def _answer(self, request: Any, response: Any) -> Any:
        response.success = self.is_active
        return response

    def _manage(self, request: Any, response: Any) -> Any:
        parts = interfaces.service(MANAGE)
        is_done = self._step(decode(parts.request, to_cdr(request)).command)
        return response_of(parts.response, {"success": is_done}, type(response))

    def _step(self, command: int) -> bool:
        """Carry out a command, if the state allows it."""
        step = _STEPS.get((self._state, command))
        if command == SHUTDOWN and self._state != "finalized":
            step = "finalized"
        if step is None:
            return False
        was_active, self._state = self.is_active, step
        if was_active:
            self._left()
        return True
