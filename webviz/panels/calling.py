"""The panels Service call and Action goal: requests and goals as a form and as YAML."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any

from webviz import commands
from webviz.api.declared import Prop
from webviz.api.goal import goal_request
from webviz.api.offer import Offer
from webviz.api.panel import Send, Ui
from webviz.api.status import Level, Status
from webviz.commands import CallService
from webviz.data.messages import MessageError, interfaces, to_tree
from webviz.data.words import joined
from webviz.engine.state import PanelTab
from webviz.panels.sending import SendingPanel

TIMEOUT_S = 30.0
FEEDBACK, MESSAGE = "/_action/feedback", "_FeedbackMessage"
"""Ends of the topic of an action, and of its type."""
OF_PARAMETERS = (
    "/describe_parameters",
    "/get_parameter_types",
    "/get_parameters",
    "/get_type_description",
    "/list_parameters",
    "/set_parameters",
    "/set_parameters_atomically",
)
"""Services that every node has; the panel Parameters calls them."""
REMEDY = "Enter its text as Definition in Properties."
Definition = Annotated[str, Prop(help="Text of the definition, for types unknown to webviz.")]


class ServiceCall(SendingPanel):
    """A service that is called with a request."""

    title = "Service call"
    icon = "plug"
    target = "service"

    service: Annotated[str, Prop(help="Full name of the service.")] = ""
    service_type: Annotated[
        str,
        Prop(help="Type, such as std_srvs/srv/SetBool; empty for that of the server."),
    ] = ""
    definition: Definition = ""

    def build(self, ui: Ui, send: Send) -> None:
        """Show the form."""
        self.build_form(ui, send)
        self.response: Any = None
        self.type = ""

    def show(self, services: Mapping[str, str], panels: Sequence[PanelTab]) -> None:
        """Show the form and the response."""
        self.type = self.service_type or services.get(self.service, "")
        about = self.type or "No node offers this service. Start one, or choose another."
        request = ""
        try:
            if self.type:
                request = interfaces.service(self.type, self.definition).request
        except MessageError as error:
            about = joined(str(error), REMEDY)
        names = sorted(name for name in services if not name.endswith(OF_PARAMETERS))
        form = {"verb": "Call", "use": f"call {self.service}", "name": self.service}
        extra = {"label": "Service", "names": names[:2000], "response": self.response}
        self.show_form(panels, request, {**form, **extra, "about": about})

    def act(self, value: Any, browser: int | None) -> None:
        """Call the service."""
        values = self.values()
        self.response = None
        self.report(Status(Level.OK, "Waiting ..."))
        call = CallService(
            self.service,
            self.type,
            values,
            self.definition,
            answered=self._take,
            failed=lambda reason: self.report(Status(Level.ERROR, reason)),
            timeout_s=TIMEOUT_S,
        )
        self.send(call, browser)

    def _take(self, response: Any) -> None:
        self.response = to_tree(response)
        self.report(Status(Level.OK, "Answered."))


class ActionGoal(SendingPanel):
    """A goal that is sent to an action; all pages show its progress and can cancel it."""

    title = "Action goal"
    icon = "target"
    target = "action"

    action: Annotated[str, Prop(help="Full name of the action.")] = ""
    action_type: Annotated[
        str,
        Prop(help="Type, such as nav2_msgs/action/Spin; empty for that of the server."),
    ] = ""
    definition: Definition = ""

    def build(self, ui: Ui, send: Send) -> None:
        """Show the form."""
        self.build_form(ui, send)
        self.type = ""

    def show(self, offers: Mapping[str, Offer], panels: Sequence[PanelTab]) -> None:
        """Show the form."""
        offered = actions_of(offers)
        self.type = self.action_type or offered.get(self.action, "")
        about = self.type or "No node offers this action. Start one, or choose another."
        goal = ""
        try:
            if self.type:
                goal = interfaces.action(self.type, self.definition).goal
        except MessageError as error:
            about = joined(str(error), REMEDY)
        use = f"send goals to {self.action}"
        form = {"verb": "Send goal", "use": use, "name": self.action, "label": "Action"}
        self.show_form(panels, goal, {**form, "names": sorted(offered)[:2000], "about": about})

    def act(self, value: Any, browser: int | None) -> None:
        """Send the goal."""
        values = self.values()
        request = goal_request(
            self.action, self.type, values, definition=self.definition, feedback=texts
        )
        self.send(commands.SendGoal(request, f"panel {self.id}", self.name, self.report), browser)


def texts(feedback: Any) -> dict[str, str]:
    """Return the fields of feedback that are neither sequences nor empty, by their paths."""
    by_path: dict[str, str] = {}

    def add(path: str, tree: Any) -> None:
        if isinstance(tree, str):
            by_path[path] = tree
        else:
            for name, each in tree.get("fields", {}).items():
                add(f"{path}.{name}" if path else name, each)

    add("", to_tree(feedback, is_readable=True))
    return by_path


def actions_of(offers: Mapping[str, Offer]) -> dict[str, str]:
    """Return the types of the actions that nodes offer, by name: those of their feedback."""
    feedback = {
        topic.removesuffix(FEEDBACK): offer.publishers[0].type
        for topic, offer in offers.items()
        if topic.endswith(FEEDBACK) and offer.publishers
    }
    return {name: type_.removesuffix(MESSAGE) for name, type_ in feedback.items()}
