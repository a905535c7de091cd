"""An action server of any type, also of one whose package is missing.

rclpy's own needs the Python classes of the package. This one decodes and encodes what its services
and topics carry, and has no threads: goals advance when the node calls their methods.
"""

from collections import deque
from collections.abc import Callable, Mapping
from typing import Any

from action_msgs.msg import GoalInfo, GoalStatus, GoalStatusArray
from action_msgs.srv import CancelGoal
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

from webviz.data.messages import decode, encode, interfaces
from webviz.ros.types import from_cdr, message_class, service_class, to_cdr

MAX_ENDED = 20
"""Goals that have ended, whose results clients may still request."""
MAX_WAITING = 100
"""Requests for results that wait; of more, the oldest get none."""

_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class ServerGoal:
    """A goal that was accepted.

    Args:
        server: that accepted it.
        info: its id, and when it was accepted.
        request: its values.
    """

    def __init__(self, server: "ActionServer", info: GoalInfo, request: Any) -> None:
        self._server = server
        self.info = info
        self.request = request
        self.status = GoalStatus.STATUS_EXECUTING
        self.result: Mapping[str, Any] = {}

    @property
    def is_active(self) -> bool:
        """Return whether it has not ended."""
        return self.status in (GoalStatus.STATUS_EXECUTING, GoalStatus.STATUS_CANCELING)

    @property
    def is_canceling(self) -> bool:
        """Return whether a client wants it to end."""
        return self.status == GoalStatus.STATUS_CANCELING

    def report(self, feedback: Mapping[str, Any]) -> None:
        """Publish feedback by field."""
        self._server.publish(self, feedback)

    def succeed(self, result: Mapping[str, Any]) -> None:
        """End it with a result by field."""
        self._server.end(self, GoalStatus.STATUS_SUCCEEDED, result)

    def abort(self, result: Mapping[str, Any]) -> None:
        """End it as failed, with a result by field."""
        self._server.end(self, GoalStatus.STATUS_ABORTED, result)

    def cancel(self, result: Mapping[str, Any]) -> None:
        """End it as cancelled, with a result by field."""
        self._server.end(self, GoalStatus.STATUS_CANCELED, result)


class ActionServer:
    """Serves an action to any client.

    Args:
        node: whose executor handles its services.
        name: of the action, such as "navigate_to_pose".
        type: such as "nav2_msgs/action/NavigateToPose".
        accept: whether to accept a goal with these values.
        begin: called with each accepted goal.
    """

    def __init__(
        self,
        node: Node,
        name: str,
        type: str,
        accept: Callable[[Any], bool],
        begin: Callable[[ServerGoal], None],
    ) -> None:
        self._node = node
        self._parts = interfaces.action(type)
        self._accept, self._begin = accept, begin
        self._goals: dict[bytes, ServerGoal] = {}
        self._waiting: deque[tuple[bytes, Any]] = deque(maxlen=MAX_WAITING)
        """Requests for results of active goals: the id, and the header to respond to."""
        send_goal, get_result = map(service_class, (self._parts.send_goal, self._parts.get_result))
        prefix = f"{name}/_action"
        node.create_service(send_goal, f"{prefix}/send_goal", self._take_goal)
        node.create_service(CancelGoal, f"{prefix}/cancel_goal", self._cancel)
        results: Any = node.create_service(get_result, f"{prefix}/get_result", _as_sent)
        # rclpy responds as soon as the callback returns; a result comes later.
        self._respond, results.send_response = results.send_response, self._take_request
        self._result_class = get_result.Response
        feedback = message_class(self._parts.feedback)
        self._feedback = node.create_publisher(feedback, f"{prefix}/feedback", 10)
        self._status = node.create_publisher(GoalStatusArray, f"{prefix}/status", _LATCHED)

    def publish(self, goal: ServerGoal, feedback: Mapping[str, Any]) -> None:
        """Publish feedback; see `ServerGoal.report`."""
        values = {"goal_id": goal.info.goal_id, "feedback": feedback}
        self._feedback.publish(encode(self._parts.feedback, values))

    def end(self, goal: ServerGoal, status: int, result: Mapping[str, Any]) -> None:
        """End a goal; see `ServerGoal.succeed`."""
        goal.status, goal.result = status, result
        id = bytes(goal.info.goal_id.uuid)
        for _ in range(len(self._waiting)):
            goal_id, header = self._waiting.popleft()
            if goal_id == id:
                self._send_result(goal, header)
            else:
                self._waiting.append((goal_id, header))
        ended = [id for id, each in self._goals.items() if not each.is_active]
        for old in ended[:-MAX_ENDED]:
            del self._goals[old]
        self._publish_status()

    def _take_goal(self, request: Any, response: Any) -> Any:
        goal_request = decode(f"{self._parts.send_goal}_Request", to_cdr(request))
        id = bytes(goal_request.goal_id.uuid)
        is_accepted = id not in self._goals and self._accept(goal_request.goal)
        info = GoalInfo(stamp=self._node.get_clock().now().to_msg())
        info.goal_id.uuid = list(id)
        if is_accepted:
            goal = self._goals[id] = ServerGoal(self, info, goal_request.goal)
            self._publish_status()
            self._begin(goal)
        values = {"accepted": is_accepted, "stamp": info.stamp}
        return response_of(f"{self._parts.send_goal}_Response", values, type(response))

    def _cancel(self, request: CancelGoal.Request, response: CancelGoal.Response) -> Any:
        id = bytes(request.goal_info.goal_id.uuid)
        goals = [self._goals[id]] if id in self._goals else []
        if not any(id):  # of all goals
            goals = list(self._goals.values())
        elif not goals:
            response.return_code = CancelGoal.Response.ERROR_UNKNOWN_GOAL_ID
        elif not goals[0].is_active:
            response.return_code = CancelGoal.Response.ERROR_GOAL_TERMINATED
        goals = [goal for goal in goals if goal.is_active]
        for goal in goals:
            goal.status = GoalStatus.STATUS_CANCELING
        response.goals_canceling = [goal.info for goal in goals]
        self._publish_status()
        return response

    def _take_request(self, request: Any, header: Any) -> None:
        result_request = decode(f"{self._parts.get_result}_Request", to_cdr(request))
        id = bytes(result_request.goal_id.uuid)
        goal = self._goals.get(id)
        if goal is not None and goal.is_active:
            self._waiting.append((id, header))
        else:
            self._send_result(goal, header)

    def _send_result(self, goal: ServerGoal | None, header: Any) -> None:
        status = goal.status if goal else GoalStatus.STATUS_UNKNOWN
        values = {"status": status, "result": goal.result if goal else {}}
        name = f"{self._parts.get_result}_Response"
        self._respond(response_of(name, values, self._result_class), header)

    def _publish_status(self) -> None:
        statuses = [GoalStatus(goal_info=g.info, status=g.status) for g in self._goals.values()]
        self._status.publish(GoalStatusArray(status_list=statuses))


def _as_sent(request: Any, response: Any) -> Any:
    """Pass a request on to where its response would be sent."""
    return request


def response_of(name: str, values: Mapping[str, Any], cls: Any) -> Any:
    """Return a response for rclpy, also of a type that was composed, from values by field."""
    return from_cdr(encode(name, values), cls)
