"""The panel Parameters: the parameters of a node, edited, saved and loaded."""

from __future__ import annotations

import functools
import threading
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any

import msgspec

from webviz.api.declared import Prop
from webviz.api.errors import Error
from webviz.api.offer import Offer
from webviz.api.panel import Panel, Send, Ui
from webviz.commands import CallService
from webviz.data.names import readable
from webviz.data.parameters import KINDS, Value, plain
from webviz.data.words import counted, joined, listed
from webviz.panels.parameter_values import fitting, flat, of_node, parse, to_yaml
from webviz.panels.yaml_text import inline, read_yaml

EVENTS = "/parameter_events"
"""Every node with parameters publishes here."""
MAX_PARAMETERS = 1000
MAX_TEXT = 300
"""Characters of a value or description; longer values cannot be edited."""
MAX_CHARACTERS = 200_000
"""Largest number of characters of all that is shown."""
MAX_STEPS = 100
"""Changes that can be undone."""
TIMEOUT_S = 5.0
NOTHING = ""


class Parameters(Panel):
    """The parameters of a node, with types, ranges and descriptions."""

    opens = "side"
    icon = "gear"
    module = "parameters.js"

    node: Annotated[str, Prop(help="Full name of the node, such as /controller_server.")] = ""
    editable: Annotated[
        list[str],
        Prop(
            help="Nodes whose parameters may be changed, as far as the config with which webviz "
            "was started names them."
        ),
    ] = msgspec.field(default_factory=list)

    def __post_init__(self) -> None:
        """Begin without parameters."""
        self.lock = threading.Lock()
        self.chosen = self.requested_node = self.node
        self.rows: dict[str, dict[str, Any]] = {}
        self.steps: list[tuple[str, dict[str, tuple[int, Value]]]] = []
        self.problem = self.outcome = ""
        self.refused: dict[str, str] = {}
        self.changes: list[int] = []

    def build(self, ui: Ui, send: Send) -> None:
        """Show the node and its parameters."""
        self.send = send
        self.nodes = ui.choice("Node", self.node, self.choose, "Node with parameters.")
        self.list = ui.widget("parameters", {}, self.use)
        self.requested_node = NOTHING

    @property
    def uses(self) -> tuple[str, ...]:
        """The services that change parameters."""
        nodes = dict.fromkeys([*self.editable])
        return tuple(f"{node}/set_parameters" for node in nodes if node.startswith("/"))

    def show(self, offers: Mapping[str, Offer], bridges: Sequence[Any] = ()) -> None:
        """Show the parameters, and ask for them if another node was chosen."""
        offer = offers.get(EVENTS)
        nodes = {each.node for each in offer.publishers if each.node} if offer else set[str]()
        nodes.update(node for bridge in bridges for node in bridge.parameters.nodes)
        self.nodes.offer([NOTHING, *sorted(nodes)], self.chosen)
        changes = [bridge.parameters.changes for bridge in bridges]
        if self.requested_node != self.chosen or changes != self.changes:
            self.changes = changes
            self.refresh(None)
        with self.lock:
            self.list.show(self._rows())

    def choose(self, node: str, browser: int | None) -> None:
        """Show another node."""
        with self.lock:
            self.chosen = node
            self.rows, self.refused = {}, {}
            self.problem = self.outcome = ""

    def use(self, value: Any, browser: int | None) -> None:
        """Do what a page asks: refresh, set one, undo, or load a file."""
        if "set" in value:
            name, text = value["set"]
            with self.lock:
                row = self.rows.get(name)
            if row is None:
                raise Error(f"{str(name)[:100]} is no longer a parameter of this node.")
            self.change({name: (row["kind"], parse(text, row["kind"]))}, browser)
        elif "load" in value:
            self.load(str(value["load"]), browser)
        elif "undo" in value:
            self.undo(browser)
        else:
            self.refresh(browser)

    def refresh(self, browser: int | None) -> None:
        """Ask the node for its parameters."""
        self.requested_node = node = self.chosen
        if not node:
            return
        self._call(
            "list_parameters", "ListParameters", {"depth": 0}, self._take_names, browser, node
        )

    def load(self, text: str, browser: int | None) -> None:
        """Change what a YAML text says of this node, as `ros2 param load` does."""
        loaded = flat(of_node(read_yaml(text), self.chosen))
        with self.lock:
            kinds = {name: row["kind"] for name, row in self.rows.items()}
        changes = {
            name: (kinds[name], fitting(value, kinds[name]))
            for name, value in loaded.items()
            if name in kinds
        }
        if not changes:
            raise Error("The file has no parameter of this node. Choose another file or node.")
        unknown = [readable(name)[:60] for name in loaded if name not in kinds]
        left_out = f"The node does not have {listed(unknown, 5)}." if unknown else ""
        self.change(changes, browser, note=left_out)

    def change(
        self,
        changes: Mapping[str, tuple[int, Value]],
        browser: int | None,
        *,
        is_undo: bool = False,
        note: str = "",
    ) -> None:
        """Set parameters; what the node accepts can be undone.

        Args:
            changes: types and values by name.
            browser: that asks for it.
            is_undo: whether it takes back others.
            note: what else to say of the outcome, a sentence or "".
        """
        node = self.chosen
        with self.lock:
            before = {
                name: (self.rows[name]["kind"], self.rows[name]["value"])
                for name in changes
                if name in self.rows and self.rows[name]["value"] is not None
            }
        parameters = [
            {"name": name, "value": {"type": kind, KINDS[kind][1]: value}}
            for name, (kind, value) in changes.items()
        ]

        def on_response(response: Any) -> None:
            results = dict(zip(changes, response.results, strict=False))
            refused = {
                name: readable(result.reason[:MAX_TEXT]) or "The node gave no reason."
                for name, result in results.items()
                if not result.successful
            }
            accepted = {name: before[name] for name in results.keys() & before.keys() - refused}
            with self.lock:
                self.refused = refused
                if accepted and not is_undo:
                    self.steps = [*self.steps, (node, accepted)][-MAX_STEPS:]
                self.outcome = joined(*_outcome(len(results) - len(refused), refused), note)
            self.refresh(browser)

        self._call(
            "set_parameters",
            "SetParameters",
            {"parameters": parameters},
            on_response,
            browser,
            node,
        )

    def undo(self, browser: int | None) -> None:
        """Take back the newest change."""
        with self.lock:
            if not self.steps:
                raise Error("There is nothing to undo.")
            node, before = self.steps[-1]
            if node != self.chosen:
                raise Error(f"The newest change is of {node}. Choose that node first.")
            self.steps = self.steps[:-1]
        self.change(before, browser, is_undo=True)

    def _rows(self) -> dict[str, Any]:
        rows: list[dict[str, Any]] = []
        size = 0
        for name, row in self.rows.items():
            value = row["value"]
            text = value if isinstance(value, str) else "" if value is None else inline(value)
            cells = {
                "name": name,
                "kind": KINDS.get(row["kind"], ("not set", ""))[0],
                "text": text[:MAX_TEXT],
                "range": row["range"],
                "about": row["about"],
                "locked": row["locked"] or value is None or len(text) > MAX_TEXT,
                "refused": self.refused.get(name, ""),
            }
            size += sum(len(str(each)) for each in cells.values())
            if size > MAX_CHARACTERS:
                break
            rows.append(cells)
        rest = len(self.rows) - len(rows)
        note = f"{counted(rest, 'parameter')} more." if rest else ""
        yaml = to_yaml(self.chosen, self.rows) if rows else ""
        return {
            "node": self.chosen,
            "rows": rows,
            "note": note,
            "problem": self.problem or ("" if self.chosen else "Choose a node."),
            "outcome": self.outcome,
            "undo": len(self.steps),
            "yaml": yaml if len(yaml) < MAX_CHARACTERS else "",
        }

    def _take_names(self, response: Any) -> None:
        node = self.requested_node
        names = sorted(response.result.names)[:MAX_PARAMETERS]
        with self.lock:
            self.problem = "" if names else "This node has no parameters."
        described = functools.partial(self._take_descriptions, node, names)
        self._call(
            "describe_parameters", "DescribeParameters", {"names": names}, described, None, node
        )

    def _take_descriptions(self, node: str, names: Sequence[str], response: Any) -> None:
        about = dict(zip(names, response.descriptors, strict=False))
        on_values = functools.partial(self._take_values, node, names, about)
        self._call("get_parameters", "GetParameters", {"names": list(names)}, on_values, None, node)

    def _take_values(
        self, node: str, names: Sequence[str], about: Mapping[str, Any], response: Any
    ) -> None:
        rows = {}
        for name, value in zip(names, response.values, strict=False):
            descriptor = about.get(name)
            kind = int(value.type)
            rows[readable(name)] = {
                "kind": kind,
                "value": plain(value, kind),
                "range": _range(descriptor),
                "about": _about(descriptor),
                "locked": bool(descriptor is not None and descriptor.read_only),
            }
        with self.lock:
            if node == self.chosen:
                self.rows = rows

    def _call(
        self,
        service: str,
        type_: str,
        request: Mapping[str, Any],
        answered: Any,
        browser: int | None,
        node: str,
    ) -> None:
        def failed(reason: str) -> None:
            with self.lock:
                self.problem = reason

        self.send(
            CallService(
                f"{node}/{service}",
                f"rcl_interfaces/srv/{type_}",
                request,
                answered=answered,
                failed=failed,
                timeout_s=TIMEOUT_S,
            ),
            browser,
        )


def _outcome(count: int, refused: Mapping[str, str]) -> Iterator[str]:
    """Say how many parameters were set, and why the first of the others was not."""
    if count or not refused:
        yield f"{counted(count, 'parameter')} set."
    if refused:
        yield f"The node refused {listed([*refused], 1)}: {next(iter(refused.values()))}"


def _range(descriptor: Any) -> str:
    if descriptor is None:
        return ""
    for each in [*descriptor.floating_point_range, *descriptor.integer_range]:
        step = f", step {each.step:g}" if each.step else ""
        return f"{each.from_value:g} to {each.to_value:g}{step}"
    return ""


def _about(descriptor: Any) -> str:
    if descriptor is None:
        return ""
    texts = (descriptor.description, descriptor.additional_constraints)
    return readable(" ".join(filter(None, texts))[:MAX_TEXT])
