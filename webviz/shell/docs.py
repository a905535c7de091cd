"""Documentation that is generated from declarations: `make docs`.

That is: the pages on displays and tools; those on commands, keys and the Python API; the schema of
config files; the types that Python shares with the page's modules; and, for .rviz files given as
arguments, the page on their support. Explanations of statuses and differences from RViz2 are in
`notes.yaml` next to the pages; the pictures are those of `tests/pictures`.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import msgspec
import msgspec.inspect as inspect
from PIL import Image

from webviz.api.declared import Color, Declared, P, Topic
from webviz.api.display import Display, inputs_of
from webviz.api.ports import ANY, Input
from webviz.api.properties import FIRST, Property, properties_of, value_at
from webviz.api.registry import plugin_types
from webviz.api.tool import Tool, outputs_of
from webviz.data import plain_yaml
from webviz.files.rviz import docs as rviz
from webviz.files.rviz.docs import table
from webviz.shell import check_docs, reference, typings
from webviz.shell.cli import schema

ROOT = Path(__file__).parents[2]
PAGES = ROOT / "displays/docs"
PICTURES = ROOT / "tests/pictures"
SMALL_PICTURES = ROOT / "displays/webviz_displays/pictures"
SMALL = (128, 96)
"""Size in pixels of the pictures in the dialog that adds displays."""
COMMAND = "make docs"
BUILT_IN = ("webviz_displays", "webviz")

COLOR = msgspec.inspect.type_info(Color)
WORDS = {
    inspect.BoolType: "true, false",
    inspect.StrType: "text",
    inspect.IntType: "whole number",
    inspect.FloatType: "number",
}


class Notes(msgspec.Struct, forbid_unknown_fields=True):
    """Notes on one display.

    Args:
        statuses: explanation of each status.
        differs: differences from RViz2 with their reasons.
    """

    statuses: dict[str, str] = {}
    differs: list[str] = []


def pages() -> dict[str, str]:
    """Return the text of each page by file name."""
    notes = read_notes()
    types = built_in(Display)
    texts = {
        page_name(name): page(name, cls, notes.get(name, Notes())) for name, cls in types.items()
    }
    return texts | {
        "README.md": index(types, notes["every display"]),
        "tools.md": tools_page(built_in(Tool)),
        "reference.md": reference.reference_page(),
        "api.md": reference.api_page(),
    }


def groups(types: Mapping[str, type[Display]]) -> dict[str, list[str]]:
    """Return the names of the displays by what they are for; those in no group come last.

    Raises:
        ValueError: a group names a display that does not exist, or that another one has.
    """
    text = (PAGES / "groups.yaml").read_text(encoding="utf-8")
    by_group = msgspec.convert(plain_yaml.read_plain(text), dict[str, list[str]])
    listed = [name for names in by_group.values() for name in names]
    if wrong := {name for name in listed if listed.count(name) > 1 or name not in types}:
        raise ValueError(f"groups.yaml is wrong about {', '.join(sorted(wrong))}.")
    others = [name for name in types if name not in listed]
    return by_group | ({"Others": others} if others else {})


def built_in(base: type[P]) -> dict[str, type[P]]:
    """Return the displays or tools that come with webviz, by name."""
    types = plugin_types(base)
    return {n: c for n, c in types.items() if c.__module__.split(".")[0] in BUILT_IN}


def read_notes() -> Mapping[str, Notes]:
    """Return the notes by display."""
    text = (PAGES / "notes.yaml").read_text(encoding="utf-8")
    return msgspec.convert(plain_yaml.read_plain(text), dict[str, Notes])


def page_name(name: str) -> str:
    """Return the file name of a display's page: `laser_scan.md` for `LaserScan`."""
    return f"{snake_case(name)}.md"


def snake_case(name: str) -> str:
    """`LaserScan` as `laser_scan`, `TF` as `tf`."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower()


def page(name: str, cls: type[Display], notes: Notes) -> str:
    """Return the page of a display."""
    images = pictures(snake_case(name))
    lines = [f"# {name}", "", *paragraphs(cls), ""]
    lines += [f"![{name}]({images.pop('default')})", ""] if "default" in images else []
    origin = f"RViz2's `{cls.rviz}`." if cls.rviz else "RViz2 has no such display."
    lines += [f"{origin} In a config file: `- type: {name}`.", ""]
    lines += inputs_table(cls)
    lines += ["## Properties", "", *properties_table(cls), ""]
    if notes.statuses:
        lines += ["## Statuses", "", "Besides [those of every display](README.md#statuses):", ""]
        lines += table(("status", "says"), [(f"**{k}**", v) for k, v in notes.statuses.items()])
        lines += [""]
    if notes.differs:
        lines += ["## Differs from RViz2, because", ""]
        lines += [f"- {sentence}" for sentence in notes.differs] + [""]
    if images:
        lines += ["## Pictures", "", *gallery(images), ""]
    return "\n".join([*lines, f"Written by `{COMMAND}`.", ""])


def tools_page(types: Mapping[str, type[Tool]]) -> str:
    """Return the page of the tools."""
    lines = ["# The tools", "", "The toolbar of the page has a button for each.", ""]
    for name, cls in types.items():
        lines += [f"## {cls.title or name}", "", *paragraphs(cls), ""]
        origin = f"RViz2's `{cls.rviz}`." if cls.rviz else "RViz2 has no such tool."
        lines += [f"{origin} In a config file: `- type: {name}` of `tools`."]
        lines += [f"Key: `{cls.shortcut}`." if cls.shortcut else "", ""]
        rows = [(f"`{key}`", f"`{out.type}`") for key, out in outputs_of(cls).items()]
        lines += [*table(("output", "message"), rows), ""] if rows else []
        lines += [*properties_table(cls), ""]
    return "\n".join([*lines, f"Written by `{COMMAND}`.", ""])


def index(types: Mapping[str, type[Display]], notes: Notes) -> str:
    """Return the overview, with links to the other pages."""
    lines = ["# The displays", ""]
    for title, names in groups(types).items():
        rows = [(f"[{n}]({page_name(n)})", next(iter(paragraphs(types[n])))) for n in names]
        lines += [f"## {title}", "", *table(("display", "shows"), rows), ""]
    lines += ["## More", "", "- [The tools](tools.md)"]
    lines += ["- [The doctor: why something is not shown](doctor/README.md)"]
    lines += ["- [Displays, tools and panels of your own](examples/README.md)"]
    lines += ["- [Commands, keys of the config, environment variables](reference.md)"]
    lines += ["- [The Python API](api.md)"]
    lines += ["", "Where something looks wrong on a robot:", ""]
    for path in sorted((PAGES / "stories").glob("*.md")):
        title = path.read_text(encoding="utf-8").partition("\n")[0].removeprefix("# ")
        lines.append(f"- [{title}](stories/{path.name})")
    lines += ["", "## Statuses", "", "Every display says, as far as it applies:", ""]
    lines += table(("status", "says"), [(f"**{k}**", v) for k, v in notes.statuses.items()])
    lines += ["", "## Topics", "", "Each topic has, besides its name:", ""]
    rows = [(f"`{f.name}`", values(f), default_of(f.default)) for f in topic_fields()]
    lines += table(("key", "values", "default"), rows)
    lines += [
        "",
        "A `depth` of 0 suits the message type; `filter_size` is how many messages may "
        "wait for their transform.",
    ]
    lines += ["", "## Differs from RViz2, because", ""]
    lines += [f"- {sentence}" for sentence in notes.differs]
    return "\n".join([*lines, "", f"Written by `{COMMAND}`.", ""])


def paragraphs(cls: type[Declared]) -> list[str]:
    """Return the docstring of a class, one line per paragraph."""
    text = "\n".join(line.strip() for line in (cls.__doc__ or "").splitlines()).strip()
    return [" ".join(part.split()) for part in text.split("\n\n")]


def pictures(folder: str) -> dict[str, str]:
    """Links to the pictures of a display by caption."""
    images = sorted((PICTURES / folder).rglob("*.png"))
    return {
        path.stem.replace("_", " "): f"../../{path.relative_to(ROOT).as_posix()}" for path in images
    }


def gallery(pictures: Mapping[str, str]) -> list[str]:
    """Pictures with captions, two per row."""
    cells = [f"![{what}]({link})<br>{what}" for what, link in pictures.items()]
    rows = [(*cells[i : i + 2], "")[:2] for i in range(0, len(cells), 2)]
    return table(("", ""), rows)


def inputs_table(cls: type[Display]) -> list[str]:
    """Return a table of the subscriptions of a display."""
    rows = []
    for name, declared in inputs_of(cls).items():
        topic = value_at(cls(), name).name or _default_topic(declared)
        qos = "transient local, always" if declared.latched else "as its publishers offer"
        rows.append((f"`{name}`", _types(declared), topic, qos))
    return [*table(("input", "message", "default topic", "QoS"), rows), ""] if rows else []


def _types(declared: Input) -> str:
    """Return the message types of an input."""
    if declared.type == ANY:
        return "any"
    return ", ".join(f"`{type_}`" for type_ in declared.types)


def _default_topic(declared: Input) -> str:
    """Return the default subscription of an input without a topic of its own."""
    if declared.beside:
        return f"`{declared.beside}` beside the first topic"
    return f"the first topic + `{declared.suffix}`" if declared.suffix else "none"


def properties_table(cls: type[Declared]) -> list[str]:
    """Return a table of all properties."""
    rows = list(property_rows(properties_of(cls), cls()))
    return table(("property", "key", "values", "default", "what it does"), rows)


def property_rows(
    properties: tuple[Property, ...], declared: Declared
) -> Iterator[tuple[str, ...]]:
    """Yield a row for each property, including nested ones."""
    for each in properties:
        if each.path in FIRST:
            continue
        if each.children and not is_topic(each):
            yield from property_rows(each.children, declared)
            continue
        when = ", ".join(
            f"`{path}` is {' or '.join(map(default_of, values))}" for path, values in each.when
        )
        note = f" Where {when}." if when else ""
        default = each.of(declared)
        default = default_of(default.name if isinstance(default, Topic) else default)
        yield each.label, f"`{each.path}`", values(each), default, f"{each.help}{note}"


def values(each: Property | inspect.Field) -> str:
    """Return the valid values of a property, in words."""
    if isinstance(each, Property):
        if is_topic(each):
            return "topic"
        if each.widget == "frame" and isinstance(each.type, inspect.StrType):
            return "frame"
        if each.choices:
            return ", ".join(f"`{choice}`" for choice in each.choices)
    return type_words(each.type)


def is_topic(each: Property) -> bool:
    """Return whether a property is a topic, whose keys have their own table."""
    return isinstance(each.type, inspect.StructType) and each.type.cls is Topic


def type_words(type_: inspect.Type) -> str:
    """Return a type in words, with its bounds."""
    if isinstance(type_, inspect.Metadata):
        return type_words(type_.type)
    if type_ == COLOR:
        return "red, green, blue, 0 to 255 each"
    match type_:
        case inspect.LiteralType(values=choices):
            return ", ".join(f"`{choice}`" for choice in choices)
        case inspect.TupleType(item_types=items):
            return f"{len(items)} times {type_words(items[0])}"
        case inspect.ListType(item_type=item):
            return f"list of {type_words(item)}"
        case inspect.DictType(value_type=inspect.StructType(fields=fields)):
            inner = "; ".join(f"`{f.name}`: {type_words(f.type)}" for f in fields)
            return f"by name: {inner}"
        case inspect.DictType(value_type=item):
            return f"by name: {type_words(item)}"
    return f"{WORDS[type(type_)]}{bounds(type_)}"


def bounds(type_: Any) -> str:
    """`, 0 to 1` or ` > 0`."""
    low, high = getattr(type_, "ge", None), getattr(type_, "le", None)
    if low is not None and high is not None:
        return f", {low:g} to {high:g}"
    signs = {"gt": ">", "ge": "≥", "lt": "<", "le": "≤"}
    limits = ((sign, getattr(type_, name, None)) for name, sign in signs.items())
    return "".join(f" {sign} {limit:g}" for sign, limit in limits if limit is not None)


def default_of(value: Any) -> str:
    """Return a value as a config file has it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple | list):
        return f"[{', '.join(default_of(item) for item in value)}]"
    if isinstance(value, int | float):
        return f"{value:g}"
    return f"`{value}`" if value else ""


def topic_fields() -> list[inspect.Field]:
    """Return the keys of a topic besides its name."""
    info = inspect.type_info(Topic)
    assert isinstance(info, inspect.StructType)
    return [field for field in info.fields if field.name != "name"]


def write_small_pictures() -> None:
    """Write the pictures of the types for the dialog that adds displays."""
    for name in built_in(Display):
        picture = PICTURES / snake_case(name) / "default.png"
        if picture.exists():
            with Image.open(picture) as image:
                small = image.convert("RGB").resize(SMALL, Image.Resampling.LANCZOS)
            small.save(SMALL_PICTURES / f"{name}.webp", quality=75, method=6)


def main() -> None:
    """Write everything."""
    for path, text in typings.files().items():
        path.write_text(text, encoding="utf-8")
    for name, text in pages().items():
        (PAGES / name).write_text(text, encoding="utf-8")
    for name, text in check_docs.pages().items():
        (PAGES / check_docs.FOLDER / name).write_text(text, encoding="utf-8")
    write_small_pictures()
    schema.SHIPPED.write_text(schema.text(), encoding="utf-8")
    if files := [Path(name) for name in sys.argv[1:]]:
        rviz.PAGE.write_text(rviz.page(files), encoding="utf-8")


if __name__ == "__main__":
    main()
