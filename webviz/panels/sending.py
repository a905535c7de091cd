"""The base of panels that send a message: a form from its definition, YAML, history and presets."""

from __future__ import annotations

import itertools
import threading
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, ClassVar

import msgspec

from webviz.api.declared import Prop
from webviz.api.errors import Error
from webviz.api.panel import Panel, Send, Ui
from webviz.api.status import Level, Status
from webviz.commands import SetPanelProperty
from webviz.data.messages import MessageError, encode, message_class, typestore
from webviz.data.messages.classes import attribute
from webviz.data.names import readable
from webviz.engine.state import PanelTab
from webviz.panels.reading import id_of
from webviz.panels.yaml_text import inline, read_yaml, write_yaml

MAX_DEPTH = 8
"""Messages within messages that are written out."""
MAX_FIELDS = 200
"""Fields of the form."""
MAX_FIXED = 100
"""Elements of an array of fixed length that are written out."""
HISTORY = 20
MAX_PRESETS = 50
DEFAULTS: Mapping[str, Any] = {
    "bool": False,
    "float32": 0.0,
    "float64": 0.0,
    "string": "",
    "wstring": "",
}
"""Elements of arrays of primitives; those of all others are 0."""


class SendingPanel(Panel):
    """A panel with values of a message type, as a form and as YAML, which a button sends."""

    opens = "side"
    module = "sending.js"
    target: ClassVar[str] = ""
    """The property that names where it is sent."""

    presets: Annotated[dict[str, str], Prop(help="Values as YAML, by the name of each preset.")] = (
        msgspec.field(default_factory=dict)
    )

    def __post_init__(self) -> None:
        """Begin without values."""
        self.lock = threading.Lock()
        self.id = ""
        self.text = ""
        self.type_shown = ""
        self.fields: list[dict[str, str]] = []
        self.history: deque[str] = deque(maxlen=HISTORY)
        self.problem = ""
        self.outcome = Status(Level.OK, "")

    @property
    def uses(self) -> tuple[str, ...]:
        """The name of the target, also while its type is unknown."""
        name = getattr(self, self.target)
        return (name,) if name.startswith("/") else ()

    def build_form(self, ui: Ui, send: Send) -> None:
        """Add the form."""
        self.send = send
        self.form = ui.widget("form", {}, self.use)

    def show_form(self, panels: Sequence[PanelTab], type_: str, extra: Mapping[str, Any]) -> None:
        """Show the form of a message type.

        Args:
            panels: all of them.
            type_: of the message, "" if it is unknown.
            extra: what else pages need: `verb` of the button, `name`, `label` and `use` of the
                target, other `names` to choose from, and `about`, its type or why it has no form.
        """
        if not extra["name"]:
            extra = {**extra, "about": f"Enter the name of the {self.target}."}
        self.id = id_of(self, panels)
        with self.lock:
            if type_ != self.type_shown:
                self.type_shown = type_
                self._use_defaults()
            values = {
                "yaml": self.text,
                "fields": self.fields,
                "history": list(self.history),
                "presets": dict(list(self.presets.items())[:MAX_PRESETS]),
                "problem": self.problem,
                "outcome": self.outcome.text,
                "failed": self.outcome.level is Level.ERROR,
                **extra,
            }
        self.form.show(values)

    def use(self, value: Any, browser: int | None) -> None:
        """Do what a page asks: another text or field, a preset, or sending."""
        if "yaml" in value:
            self.edit(str(value["yaml"]))
        elif "field" in value:
            path, text = value["field"]
            self.edit_field(str(path), str(text))
        elif "preset" in value:
            self.edit(self.presets.get(str(value["preset"]), self.text))
        elif "keep" in value:
            name = readable(str(value["keep"]))[:60].strip()
            if not name:
                raise Error("The preset has no name. Enter one.")
            presets = {**self.presets, name: self.text}
            if len(presets) > MAX_PRESETS:
                raise Error(f"There are {MAX_PRESETS} presets. Remove one in Properties first.")
            self.send(SetPanelProperty(self.id, "presets", presets), browser)
        elif "name" in value:
            self.report(Status(Level.OK, ""))
            self.send(SetPanelProperty(self.id, self.target, str(value["name"])[:300]), browser)
        elif "reset" in value:
            with self.lock:
                self._use_defaults()
        else:
            self.act(value, browser)

    def act(self, value: Any, browser: int | None) -> None:
        """Send; `value` says how."""
        raise NotImplementedError

    def edit(self, text: str) -> None:
        """Take another text; one that does not fit is kept, with the reason."""
        with self.lock:
            self.text = text
            self.problem = ""
            self.outcome = Status(Level.OK, "")
            try:
                self.fields = fields_of(self._values())
            except Error as error:
                self.problem = str(error)

    def edit_field(self, path: str, text: str) -> None:
        """Change one field of the form."""
        with self.lock:
            values = self._entered()  # another field may not fit yet
            defaults = template(self.type_shown) if self.type_shown else {}
        self.edit(write_yaml(_assigned(values, defaults, path, text)))

    def values(self) -> Mapping[str, Any]:
        """Return the values, checked.

        Raises:
            Error: no target is named, or the text is not YAML or does not fit the type.
        """
        if not getattr(self, self.target):
            raise Error(f"No {self.target} is chosen. Enter its name.")
        with self.lock:
            values = self._values()
            if self.text in self.history:
                self.history.remove(self.text)
            self.history.append(self.text)
        return values

    def report(self, outcome: Status) -> None:
        """Show what became of what was sent; from any thread."""
        with self.lock:
            self.outcome = outcome

    def _entered(self) -> Mapping[str, Any]:
        """Return the values of the text, which may not fit the type."""
        values = read_yaml(self.text)
        values = {} if values is None else values
        if not isinstance(values, Mapping):
            raise Error("Expected fields with values, such as `data: 5`.")
        return values

    def _values(self) -> Mapping[str, Any]:
        values = self._entered()
        if not self.type_shown:
            raise Error("The message type is unknown. Choose another name, or enter the type.")
        try:
            encode(self.type_shown, values)
        except MessageError as error:
            raise Error(str(error)) from None
        return values

    def _use_defaults(self) -> None:
        self.problem = ""
        self.text, self.fields = "", []
        if not self.type_shown:
            return
        try:
            values = template(self.type_shown)
        except MessageError as error:
            self.problem = str(error)
        else:
            self.text, self.fields = write_yaml(values), fields_of(values)


def template(type_name: str) -> dict[str, Any]:
    """Return the default values of a message type by field; sequences are empty.

    Fields that are left out have their defaults, too: arrays of messages, and what is beyond
    `MAX_DEPTH` and `MAX_FIELDS`.

    Raises:
        UnknownTypeError: no definition is known.
    """
    return _template(type_name, MAX_DEPTH, itertools.count())


def _template(type_name: str, depth: int, counter: Iterator[int]) -> dict[str, Any]:
    tree: dict[str, Any] = {}
    defaults = message_class(type_name)()
    for field in typestore.fields(type_name):
        if next(counter) >= MAX_FIELDS:
            break
        if field.name == typestore.PLACEHOLDER[0]:
            continue
        if field.is_message:
            if field.size is None and depth > 0:
                tree[field.name] = _template(field.base, depth - 1, counter)
            elif field.size == 0:
                tree[field.name] = []
            continue
        if field.size is None:
            tree[field.name] = getattr(defaults, attribute(field.name))
        elif field.size <= MAX_FIXED:
            tree[field.name] = [DEFAULTS.get(field.base, 0)] * field.size
    return tree


def fields_of(values: Mapping[str, Any]) -> list[dict[str, str]]:
    """Return the first fields of values as the form has them: paths and texts."""
    return [
        {"path": path, "text": text}
        for (path, text), _ in zip(_leaves(values, ""), range(MAX_FIELDS), strict=False)
    ]


def _leaves(values: Mapping[str, Any], before: str) -> Iterator[tuple[str, str]]:
    for key, value in values.items():
        path = f"{before}{key}"
        if isinstance(value, Mapping) and value:
            yield from _leaves(value, f"{path}.")
        else:
            yield path, value if isinstance(value, str) else inline(value)


def _assigned(
    values: Mapping[str, Any], defaults: Mapping[str, Any], path: str, text: str
) -> dict[str, Any]:
    """Values with another one at a path; what is a text by default is one."""
    key, _, rest = path.partition(".")
    if key not in values:
        raise Error(f"`{path[:80]}` is no longer a field.")
    before, default = values[key], defaults.get(key, values[key])
    if rest and isinstance(before, Mapping):
        inner = default if isinstance(default, Mapping) else {}
        return {**values, key: _assigned(before, inner, rest, text)}
    return {**values, key: text if isinstance(default, str) else read_yaml(text)}
