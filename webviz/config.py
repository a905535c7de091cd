"""The saved state of a viewer as YAML: fixed frame, background, view, and the list of displays."""

from __future__ import annotations

import difflib
import io
import os
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any

import msgspec
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError
from ruamel.yaml.nodes import MappingNode, Node, SequenceNode
from ruamel.yaml.representer import SafeRepresenter

from webviz.display import Color, Display, make, to_values
from webviz.group import Group
from webviz.registry import broken_display_types, display_types, type_name
from webviz.views import View

VERSION = 1
MAX_BYTES = 16 << 20
MAX_HINTS = 40
"""Valid words that an error lists; a tree of transforms may have a thousand frames."""
MAX_VALUES = 200_000
"""In one file; YAML's aliases can make a few lines endless."""
LINE = 88
"""Characters of mappings and lists that are written on one line."""
STANDARD = ("Grid", "TF", "RobotModel", "LaserScan", "Map", "Path", "Odometry")
"""What is shown when nobody says what to show."""


class ConfigError(Exception):
    """A file cannot be used; one sentence that names the file and the place in it."""


class Settings(msgspec.Struct, forbid_unknown_fields=True):
    """What a config file says besides its displays."""

    version: int = VERSION
    fixed_frame: str = "map"
    background: Color = (48, 48, 48)
    frame_rate: Annotated[float, msgspec.Meta(ge=1, le=240)] = 60.0
    view: View = View()
    rviz: dict[str, Any] = {}  # msgspec copies it
    """What a .rviz file says that has no counterpart here; kept for writing it again."""


@dataclass
class Unreadable:
    """A display that cannot be shown: kept as it was written, and saved again so.

    Args:
        values: the entry of the file.
        reason: a sentence with the place of the fault.
    """

    values: Any
    reason: str

    @property
    def name(self) -> str:
        """What the list of displays calls it."""
        if isinstance(self.values, Mapping):
            return str(self.values.get("name") or self.values.get("type") or "?")
        return "?"

    @property
    def is_from_rviz(self) -> bool:
        """Whether it is kept of a .rviz file, for want of a counterpart."""
        return isinstance(self.values, Mapping) and "rviz" in self.values


@dataclass
class Branch:
    """A group and what is in it, in order."""

    group: Group
    displays: list[Item]


Item = Display | Unreadable | Branch
"""What a list of displays consists of."""


@dataclass
class Config:
    """A whole config.

    Args:
        settings: all but the displays.
        displays: in order.
        report: sentences on what could not be read from RViz's config file.
    """

    settings: Settings = field(default_factory=Settings)
    displays: list[Item] = field(default_factory=list)
    report: list[str] = field(default_factory=list)


def standard() -> Config:
    """What is shown without a config file: the usual displays on their usual topics."""
    types = display_types()
    return Config(displays=[make(types[name], {}) for name in STANDARD if name in types])


def load(path: Path) -> Config:
    """Read a config file: YAML, or RViz's if its name ends with .rviz.

    Raises:
        ConfigError: the file is missing, no YAML, or not a config. A single display that does not
            fit is no error: it becomes an `Unreadable`.
    """
    text = read_text(path)
    if is_rviz(path):
        from webviz import rviz  # it stands on this module

        return rviz.read(text, str(path))[0]
    return parse(text, str(path))


def read_text(path: Path) -> str:
    """The text of a config file.

    Raises:
        ConfigError: it is missing, too large or no text.
    """
    try:
        if path.stat().st_size > MAX_BYTES:
            raise ConfigError(f"{path} is larger than {MAX_BYTES >> 20} MB and no config file.")
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise ConfigError(f"Cannot read {path}: {error.strerror or error}.") from error
    except UnicodeDecodeError as error:
        raise ConfigError(f"{path} is not UTF-8 text.") from error


def is_rviz(path: Path) -> bool:
    """Whether a file is RViz's by its name."""
    return path.suffix.lower() == ".rviz"


def parse(text: str, where: str) -> Config:
    """A config from YAML text; `where` names it in errors. See `load`."""
    try:
        document = YAML(typ="safe", pure=True).load(text)
    except YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f"{where}:{mark.line + 1}" if mark else where
        problem = getattr(error, "problem", None) or str(error).splitlines()[0]
        raise ConfigError(f"{place} is not valid YAML: {problem}.") from error
    except (ValueError, RecursionError) as error:  # such as a date that does not exist
        raise ConfigError(f"{where} is not valid YAML: {error}.") from error
    if _is_endless(document):
        raise ConfigError(f"{where} holds more than {MAX_VALUES} values, aliases counted.")
    if not isinstance(document, Mapping):
        raise ConfigError(f"{where} holds no settings such as `fixed_frame: map`.")
    version = document.get("version", VERSION)
    if isinstance(version, int) and version > VERSION:
        raise ConfigError(
            f"{where} has version {version}, this webviz reads up to {VERSION}: update webviz."
        )
    rest = {str(key): value for key, value in document.items() if key != "displays"}
    _refuse_unknown(rest, [*Settings.__struct_fields__, "displays"], where)
    try:
        settings = msgspec.convert(rest, Settings)
    except msgspec.ValidationError as error:
        raise ConfigError(f"{where}: {describe(error)}.") from error
    entries = document.get("displays") or []
    if not isinstance(entries, list):
        raise ConfigError(f"{where}: displays: expected a list, each entry with a `type`.")
    return Config(settings, [read_display(e, f"displays[{i}]") for i, e in enumerate(entries)])


def read_display(entry: Any, place: str) -> Item:
    """A display or group from an entry of a list in a config file, which is at `place`."""
    if not isinstance(entry, Mapping) or not isinstance(entry.get("type"), str):
        return Unreadable(entry, f"{place}: a display needs a `type`, such as `type: Grid`.")
    if "rviz" in entry:
        return Unreadable(
            entry, f"{place}: RViz's {entry['type']} has no counterpart here yet; it is kept."
        )
    types = display_types()
    cls = types.get(entry["type"])
    if cls is Group:
        return _read_group(entry, place)
    if entry["type"] in broken_display_types():
        return Unreadable(entry, f"{place}: {broken_display_types()[entry['type']]}")
    if cls is None:
        hint = nearest(entry["type"], types)
        return Unreadable(entry, f"{place}: no display type `{entry['type']}` here, {hint}")
    values = {key: value for key, value in entry.items() if key != "type"}
    try:
        _refuse_unknown(values, cls.__struct_fields__, place)
        return make(cls, values)
    except ConfigError as error:
        return Unreadable(entry, str(error))
    except msgspec.ValidationError as error:
        return Unreadable(entry, f"{place}.{describe(error)}")


def _read_group(entry: Mapping[str, Any], place: str) -> Branch | Unreadable:
    inner = entry.get("displays") or []
    if not isinstance(inner, list):
        return Unreadable(entry, f"{place}.displays: expected a list, each entry with a `type`.")
    values = {key: value for key, value in entry.items() if key not in ("type", "displays")}
    try:
        _refuse_unknown(values, [*Group.__struct_fields__, "displays"], place)
        group = make(Group, values)
    except ConfigError as error:
        return Unreadable(entry, str(error))
    except msgspec.ValidationError as error:
        return Unreadable(entry, f"{place}.{describe(error)}")
    return Branch(group, [read_display(e, f"{place}.displays[{i}]") for i, e in enumerate(inner)])


def _is_endless(document: Any) -> bool:
    """Whether a document has too many values, such as an alias for what it stands in."""
    waiting, count = [document], 0
    while waiting:
        value = waiting.pop()
        count += 1
        if count > MAX_VALUES:
            return True
        if isinstance(value, Mapping):
            waiting.extend(value.values())
        elif isinstance(value, list):
            waiting.extend(value)
    return False


def document(config: Config) -> dict[str, Any]:
    """A config as the values of its file; defaults are left out."""
    settings = msgspec.to_builtins(config.settings)
    basis = msgspec.to_builtins(Settings())
    values: dict[str, Any] = {"version": VERSION}
    values |= {key: value for key, value in settings.items() if value != basis[key]}
    kept = values.pop("rviz", None)
    values["displays"] = [_entry(display) for display in config.displays]
    if kept:
        values["rviz"] = kept  # last, as nobody wants to read it
    return values


def dump(config: Config) -> str:
    """A config as YAML text; see `document`."""
    yaml = YAML(typ="safe", pure=True)
    yaml.Representer = _Representer
    yaml.default_flow_style = None  # short lists such as colours stay on one line
    yaml.width = 1 << 20  # a key of two words that is broken cannot be read again
    yaml.sort_base_mapping_type_on_output = False  # pyright: ignore[reportAttributeAccessIssue]
    stream = io.StringIO()
    yaml.dump(document(config), stream)
    return stream.getvalue()


class _Representer(SafeRepresenter):
    """Gives each value a line of its own where they are too many for one."""

    def represent_mapping(self, tag: Any, mapping: Any, flow_style: Any = None) -> MappingNode:
        node = super().represent_mapping(tag, mapping, flow_style)
        node.flow_style &= _fits([part for pair in node.value for part in pair])
        return node

    def represent_sequence(self, tag: Any, sequence: Any, flow_style: Any = None) -> SequenceNode:
        node = super().represent_sequence(tag, sequence, flow_style)
        node.flow_style &= _fits(node.value)
        return node


def _fits(nodes: Sequence[Node]) -> bool:
    # ruamel does not quote what is plain in lines and a mark within braces: {:0: ?1}.
    is_short = sum(len(node.value) + len(", ") for node in nodes) <= LINE
    return is_short and not any(mark in node.value for node in nodes for mark in ":?")


def save(config: Config, path: Path) -> None:
    """Write a config file; a name that ends with .rviz makes it RViz's.

    Raises:
        ConfigError: it cannot be written.
    """
    if is_rviz(path):
        from webviz import rviz  # it stands on this module

        write_text(rviz.write(config)[0], path)
    else:
        write_text(dump(config), path)


def write_text(text: str, path: Path) -> None:
    """Write a file in one step: after a failure the old file is still there.

    Raises:
        ConfigError: it cannot be written.
    """
    try:
        with tempfile.NamedTemporaryFile(
            "w", encoding="utf-8", dir=path.parent, prefix=path.name, delete=False
        ) as file:
            temporary = Path(file.name)
            try:
                file.write(text)
                file.flush()
                os.fsync(file.fileno())
                temporary.replace(path)
            except BaseException:
                temporary.unlink(missing_ok=True)
                raise
    except OSError as error:
        raise ConfigError(f"Cannot write {path}: {error.strerror or error}.") from error


def describe(error: msgspec.ValidationError) -> str:
    """A validation error with its place first: ``displays[2].size: expected `float` > 0.0``."""
    text, _, path = str(error).partition(" - at `")
    place = path.removesuffix("`").lstrip("$").lstrip(".")
    text = text[:1].lower() + text[1:]
    return f"{place}: {text}" if place else text


def nearest(word: str, valid: Iterable[str]) -> str:
    """A hint at the valid word somebody may have meant, or the list of all."""
    valid = sorted(valid)
    close = difflib.get_close_matches(word, valid, n=1)
    if close:
        return f"did you mean `{close[0]}`?"
    more = f" and {len(valid) - MAX_HINTS} more" if len(valid) > MAX_HINTS else ""
    return f"known are: {', '.join(valid[:MAX_HINTS])}{more}"


def _refuse_unknown(values: Mapping[str, Any], valid: Iterable[str], where: str) -> None:
    for key in values:
        if key not in valid:
            raise ConfigError(f"{where}: unknown key `{key}`, {nearest(key, valid)}")


def _entry(display: Item) -> Any:
    if isinstance(display, Unreadable):
        return display.values
    if isinstance(display, Branch):
        inner = [_entry(each) for each in display.displays]
        return _entry(display.group) | ({"displays": inner} if inner else {})
    return {"type": type_name(type(display)), **to_values(display)}
