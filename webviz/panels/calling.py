"""The panels Service call and Action goal: requests and goals as a form and as YAML."""

from __future__ import annotations

from typing import Annotated, Any

from webviz.api.declared import Prop
from webviz.api.errors import Error
from webviz.api.goal import goal_request
from webviz.api.panel import Send, Ui
from webviz.api.status import Status
from webviz.data.messages import MessageError, interfaces, to_tree
from webviz.engine.commands import CallService, SendGoal
from webviz.panels.sending import SendingPanel

TIMEOUT_S = 30.0
Definition = Annotated[str, Prop(help="Text of the definition, for types unknown to webviz.")]


class ServiceCall(SendingPanel):
    """A service that is called with a request."""

    title = "Service call"
    on_request = True
    module = "sending.js"
    target = "service"

    service: Annotated[str, Prop(help="Full name of the service.")] = ""
    service_type: Annotated[str, Prop(help="Type, such as std_srvs/srv/SetBool.")] = ""
    definition: Definition = ""

    def build(self, ui: Ui, send: Send) -> None:
        """Show the form."""
        self.build_form(ui, send)
        self.response: Any = None

    @property
    def uses(self) -> tuple[str, ...]:
        """The service."""
        return (self.service,) if self.service.startswith("/") else ()

    def show(self, state: Any) -> None:
        """Show the form and the response."""
        try:
            request = (
                interfaces.service(self.service_type, self.definition).request
                if self.service_type
                else ""
            )
        except MessageError as error:
            request = ""
            self.say(str(error))
        form = {"verb": "Call", "name": self.service, "label": "Service", "names": []}
        self.show_form(state, request, {**form, "response": self.response})

    def act(self, value: Any, browser: int | None) -> None:
        """Call the service."""
        values = self.values()
        if not self.service:
            raise Error("No service is chosen. Enter its name.")
        self.response = None
        self.say("Waiting ...")
        call = CallService(
            self.service,
            self.service_type,
            values,
            self.definition,
            answered=self._take,
            failed=self.say,
            timeout_s=TIMEOUT_S,
        )
        self.send(call, browser)

    def _take(self, response: Any) -> None:
        self.response = to_tree(response)
        self.say("Answered.")


class ActionGoal(SendingPanel):
    """A goal that is sent to an action; all pages show its progress and can cancel it."""

    title = "Action goal"
    on_request = True
    module = "sending.js"
    target = "action"

    action: Annotated[str, Prop(help="Full name of the action.")] = ""
    action_type: Annotated[str, Prop(help="Type, such as nav2_msgs/action/Spin.")] = ""
    definition: Definition = ""

    def build(self, ui: Ui, send: Send) -> None:
        """Show the form."""
        self.build_form(ui, send)

    @property
    def uses(self) -> tuple[str, ...]:
        """The action."""
        return (self.action,) if self.action.startswith("/") else ()

    def show(self, state: Any) -> None:
        """Show the form."""
        try:
            goal = (
                interfaces.action(self.action_type, self.definition).goal
                if self.action_type
                else ""
            )
        except MessageError as error:
            goal = ""
            self.say(str(error))
        form = {"verb": "Send goal", "name": self.action, "label": "Action", "names": []}
        self.show_form(state, goal, form)

    def act(self, value: Any, browser: int | None) -> None:
        """Send the goal."""
        values = self.values()
        if not self.action:
            raise Error("No action is chosen. Enter its name.")
        request = goal_request(self.action, self.action_type, values, definition=self.definition)
        self.send(SendGoal(request, f"panel {self.id}", self.name, self._report), browser)

    def _report(self, outcome: Status) -> None:
        self.say(outcome.text)
