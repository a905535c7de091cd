"""The panel Selector: chooses the plug-ins that Nav2 uses for its next goals."""

from __future__ import annotations

import functools
import time
from collections.abc import Mapping, Sequence
from typing import Annotated, Any

from webviz.api.declared import Prop
from webviz.api.panel import Choice, Panel, Send, Ui
from webviz.api.status import Level, Status
from webviz.commands import CallService, Publish
from webviz.data.words import listed

ASK_S = 5.0
"""Interval between requests to servers that have not answered."""
DEFAULT = "Default"
"""The choice of Nav2 itself, before a user chooses."""
STRING = "std_msgs/msg/String"
STRING_ARRAY = 9
"""Constant of rcl_interfaces/msg/ParameterType."""
KINDS = (
    ("Controller", "controller_selector", "controller_server", "controller_plugins"),
    ("Planner", "planner_selector", "planner_server", "planner_plugins"),
    ("Goal Checker", "goal_checker_selector", "controller_server", "goal_checker_plugins"),
    ("Smoother", "smoother_selector", "smoother_server", "smoother_plugins"),
    (
        "Progress Checker",
        "progress_checker_selector",
        "controller_server",
        "progress_checker_plugins",
    ),
)
"""Label, topic of the choice, and the node and the parameter with the names to choose from."""
PARAMETERS: Mapping[str, Sequence[str]] = {
    node: [parameter for _, _, other, parameter in KINDS if other == node]
    for _, _, node, _ in KINDS
}
"""Parameters by node."""


class Selector(Panel):
    """Choices of the controller, planner, checkers and smoother of Nav2.

    Its behavior tree needs the selectors that read the topics, such as PlannerSelector.
    """

    title = "Selector"
    rviz = "nav2_rviz_plugins/Selector"
    opens = "side"
    icon = "list"

    namespace: Annotated[str, Prop(help="Namespace of Nav2's nodes; empty for none.")] = ""

    def build(self, ui: Ui, send: Send) -> None:
        """One list for each kind of plug-in."""
        self.send = send
        self.asked_s = 0.0
        self.missing: dict[str, str] = {}
        self.names: dict[str, list[str]] = {}
        self.chosen: dict[str, str] = {}
        self.outcome = Status(Level.OK, "")
        self.choices: dict[str, Choice] = {}
        for label, topic, node, _ in KINDS:
            edit = functools.partial(self._choose, topic)
            self.choices[topic] = ui.choice(label, DEFAULT, edit, f"Plug-ins of {node}.")
        self.result = ui.area()

    @property
    def uses(self) -> tuple[str, ...]:
        """Its topics, and the services of the parameters."""
        topics = (self._full(topic) for _, topic, _, _ in KINDS)
        return (*topics, *(self._service(node) for node in PARAMETERS))

    def show(self) -> None:
        """Ask the servers that have not answered, and offer what is known."""
        if time.monotonic() - self.asked_s > ASK_S:
            self.asked_s = time.monotonic()
            for node, parameters in PARAMETERS.items():
                if any(parameter not in self.names for parameter in parameters):
                    self._ask(node, parameters)
        for _, topic, _, parameter in KINDS:
            chosen = self.chosen.get(topic, DEFAULT)
            first = [] if topic in self.chosen else [DEFAULT]
            self.choices[topic].offer([*first, *self.names.get(parameter, ())], chosen)
        self.result.text(self._sentence())

    def _sentence(self) -> str:
        if self.outcome.level is Level.ERROR:
            return self.outcome.text
        if missing := dict(self.missing):  # which other threads change
            return f"No names of {listed(list(missing), len(missing))}. {min(missing.values())}"
        return ""

    def _ask(self, node: str, parameters: Sequence[str]) -> None:
        def answered(response: Any) -> None:
            self.missing.pop(node, None)
            for name, value in zip(parameters, response.values, strict=False):
                is_known = value.type == STRING_ARRAY
                self.names[name] = list(value.string_array_value) if is_known else []

        def failed(reason: str) -> None:
            self.missing[node] = reason

        self.send(
            CallService(
                self._service(node),
                "rcl_interfaces/srv/GetParameters",
                {"names": list(parameters)},
                answered=answered,
                failed=failed,
                timeout_s=2.0,
            )
        )

    def _choose(self, topic: str, name: str, browser: int | None) -> None:
        if name == DEFAULT:
            return
        self.chosen[topic] = name
        message = {"data": name}
        # Behavior trees read it when their goal begins.
        self.send(
            Publish(self._full(topic), STRING, message, report=self._report, latched=True), browser
        )

    def _report(self, outcome: Status) -> None:
        self.outcome = outcome

    def _full(self, name: str) -> str:
        return "/".join(["", *filter(None, [self.namespace.strip("/")]), name])

    def _service(self, node: str) -> str:
        return f"{self._full(node)}/get_parameters"
