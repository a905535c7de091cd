"""Whole .rviz files."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

import msgspec

from webviz.api.declared import Color, make, to_values
from webviz.api.panel import Panel
from webviz.api.registry import plugin_types
from webviz.files.config import (
    Config,
    ConfigError,
    Location,
    PanelItem,
    Settings,
    YamlDocument,
    all_panels,
)
from webviz.files.config.reading import refuse_too_many
from webviz.files.rviz import values, views
from webviz.files.rviz.classes import counterpart
from webviz.files.rviz.displays import UnsupportedParts, is_writable, read_items, write_items
from webviz.files.rviz.properties import keys
from webviz.files.rviz.report import Report
from webviz.files.rviz.rest import note_rest
from webviz.files.rviz.structs import Reading, struct_tree
from webviz.files.rviz.toolbar import NEW_TOOLS, read_tools, write_tools
from webviz.files.rviz.tree import MANAGER, Tree, child, difference, parse, restored
from webviz.files.rviz.tree import write as write_tree
from webviz.files.rviz.values import Unfit

BASE_LINK, RVIZ_FRAME_RATE = "base_link", 30
"""RViz's defaults for missing keys."""

NOT_WRITTEN = ("layout", "layouts", "publish", "robots")
"""Settings that .rviz files do not have."""

NEW_FILE: Tree = {
    "Panels": [
        {"Class": f"rviz_common/{name}", "Name": name}
        for name in ("Displays", "Selection", "Tool Properties", "Views", "Time")
    ],
    MANAGER: {
        "Tools": NEW_TOOLS,
        "Transformation": {"Current": {"Class": "rviz_default_plugins/TF"}},
    },
}
"""Parts RViz needs besides displays in a new file, to have panels and tools."""


def read(text: str, where: str) -> tuple[Config, Report]:
    """Return a config from the text of a .rviz file, as RViz would open it.

    Unsupported parts are kept in the settings and listed in the report.

    Args:
        text: of the file.
        where: names it in errors.

    Raises:
        ConfigError: it is not a .rviz file, or has too many displays.
    """
    source = YamlDocument(text, where)
    document = parse(source)
    if not isinstance(document, dict) or not isinstance(document.get(MANAGER), dict):
        raise ConfigError(f"{where} is not an RViz config: it has no `{MANAGER}`.")
    report, unsupported = Report(), UnsupportedParts()
    for kind in ("displays", "properties", "views", "tools", "panels"):
        report.count(kind, 0, 0)
    manager = dict(document[MANAGER])
    settings = _settings(manager, report)
    settings.views = views.read_saved(child(manager, "Views").get("Saved"), report)
    entries = manager.pop("Displays", None) or []
    if not isinstance(entries, list):
        report.note(MANAGER, "Displays", "not a list; ignored")
        entries = []
    refuse_too_many(entries, "Displays", where)
    items = read_items(entries, report, unsupported, Location((MANAGER, "Displays"), source))
    place = Location((MANAGER, "Tools"), source)
    tools = read_tools(manager.get("Tools"), document.get("Panels"), report, place)
    note_rest(document, report)
    basis = _bare(settings)
    if views.kind_of(child(manager, "Views", "Current")) is None:
        del basis[MANAGER]["Views"]["Current"]  # it is kept whole
    else:
        del basis[MANAGER]["Views"]["Current"]["Class"]  # the other keys are kept for this class
    rest = difference({**document, MANAGER: manager}, basis)
    if displays := _worth_keeping(unsupported.entries):
        rest[MANAGER] = {**rest.get(MANAGER, {}), "Displays": displays}
    settings.rviz = rest
    panels = read_panels(document.get("Panels"), manager.get("Tools"), report)
    return Config(settings, items, tools, panels, report=report.sentences()), report


def write(config: Config) -> tuple[str, Report]:
    """Return the text of a .rviz file, and a report of what RViz does not support."""
    report = Report()
    rest = config.settings.rviz
    manager = child(rest, MANAGER)
    entries = manager.pop("Displays", None)
    entries = entries if isinstance(entries, list) else []
    unsupported = UnsupportedParts([dict(entry) for entry in entries if isinstance(entry, Mapping)])
    kept_views = child(manager, "Views")
    current, view = child(kept_views, "Current"), config.settings.view
    tree = _bare(config.settings)
    if current and views.kind_of(current) is not type(view):
        del kept_views["Current"]
        if views.kind_of(current) is None and views.read_current(current, Report()) == view:
            tree[MANAGER]["Views"]["Current"] = current
    saved = views.write_saved(config.settings.views, kept_views.pop("Saved", None))
    tree[MANAGER]["Views"]["Saved"] = saved
    if saved or isinstance(manager.get("Views"), Mapping):
        manager["Views"] = kept_views
    rest = {**rest, MANAGER: manager} if rest else NEW_FILE
    no_settings = Settings()
    for key in NOT_WRITTEN:
        if getattr(config.settings, key) != getattr(no_settings, key):
            report.note("Settings", key, "not in RViz's format, so it is left out")
    own = msgspec.structs.replace(
        config.settings,
        rviz={},
        views={},
        **{key: getattr(no_settings, key) for key in NOT_WRITTEN},
    )
    tree = restored(tree, rest, own, lambda tree: _settings(tree[MANAGER], Report()))
    tree[MANAGER]["Displays"] = write_items(config.displays, report, unsupported)
    kept_tools = child(rest, MANAGER).get("Tools")
    tree["Panels"] = panels = write_panels(config.panels, tree.get("Panels"), kept_tools, report)
    tools = write_tools(config.tools, kept_tools, panels, report)
    if tools is not None:
        tree[MANAGER]["Tools"] = tools
    return write_tree(tree), report


def _settings(manager: Mapping[str, Any], report: Report) -> Settings:
    options = child(manager, "Global Options")
    default = Settings()
    frame = _option(options, "Fixed Frame", str, BASE_LINK, report)
    rate = _option(options, "Frame Rate", float, float(RVIZ_FRAME_RATE), report)
    return Settings(
        fixed_frame=frame.removeprefix("/"),
        background=_option(options, "Background Color", Color, default.background, report),
        frame_rate=min(max(rate, 1.0), 240.0),
        view=views.read_current(child(manager, "Views").get("Current"), report),
    )


def _option(options: Tree, key: str, kind: Any, default: Any, report: Report) -> Any:
    if key not in options:
        return default
    try:
        value = values.read(options[key], kind)
        report.count("properties", 1, 1)
        return value
    except Unfit as error:
        report.count("properties", 0, 1)
        report.note("Global Options", key, f"{error}; using {default}")
        return default


def _bare(settings: Settings) -> Tree:
    """Return the tree of a file with these settings, without displays and kept parts."""
    return {
        MANAGER: {
            "Class": "",
            "Name": "root",
            "Enabled": True,
            "Value": True,
            "Global Options": {
                "Fixed Frame": settings.fixed_frame,
                **(
                    {}
                    if settings.background is None
                    else {"Background Color": values.write(settings.background, Color)}
                ),
                "Frame Rate": values.write(settings.frame_rate, float),
            },
            "Views": {"Current": views.write(settings.view)},
        }
    }


def _worth_keeping(entries: list[Tree]) -> list[Tree]:
    """Entries that are not empty, and those that distinguish displays of one name."""
    alike = Counter((entry["Class"], entry["Name"]) for entry in entries)
    return [e for e in entries if len(e) > 2 or alike[e["Class"], e["Name"]] > 1]


def read_panels(entries: Any, tools: Any, report: Report) -> list[PanelItem]:
    """Return the panels that every config has, and those in RViz's list that are plug-ins here.

    Args:
        entries: RViz's list.
        tools: of the same file; those that do what a panel does open it.
        report: receives invalid values.
    """
    panel_items: list[PanelItem] = all_panels()
    for entry in entries if isinstance(entries, list) else []:
        cls = _counterpart(entry)
        if cls is None or cls.opens == "at start" or any(type(each) is cls for each in panel_items):
            continue
        reading = Reading()
        panel_items.append(make(cls, reading.struct(cls, entry)))
        for path, reason in reading.faults:
            report.count("properties", 0, 1)
            report.note(values.text(entry.get("Name", "?")), "/".join(path), reason)
    for cls in _of_tools(tools):
        if not any(type(each) is cls for each in panel_items):
            panel_items.append(make(cls, {}))
    return panel_items


def _of_tools(tools: Any) -> list[type[Panel]]:
    """Return the panels that do what tools of RViz's list do."""
    entries = tools if isinstance(tools, list) else []
    names = {values.text(each.get("Class")) for each in entries if isinstance(each, Mapping)}
    return [cls for cls in plugin_types(Panel).values() if cls.rviz_tool in names]


def write_panels(
    panels: list[PanelItem], originals: Any, tools: Any, report: Report
) -> list[Any] | None:
    """Panels as RViz's list, None if it is empty.

    Args:
        panels: of a config; those that every config has are not written.
        originals: the list of the file that they come from.
        tools: of that file; panels that it has as tools are not written, unless they were changed.
        report: receives those that RViz does not have.
    """
    everywhere = {type(each) for each in all_panels()}
    waiting = [
        panel for panel in panels if type(panel) not in everywhere and is_writable(panel, report)
    ]
    by_class = {type(panel): panel for panel in waiting}
    written: list[Any] = []
    for entry in originals if isinstance(originals, list) else []:
        cls = _counterpart(entry)
        if cls is None or cls.opens == "at start":
            written.append(entry)
        elif panel := by_class.get(cls):
            written.append({k: v for k, v in entry.items() if k not in keys(cls)} | _changed(panel))
            waiting = [each for each in waiting if each is not panel]
    as_tools = _of_tools(tools)
    for panel in waiting:
        if type(panel) in as_tools and not _changed(panel):
            continue
        written.append({"Class": type(panel).rviz, "Name": panel.name} | _changed(panel))
    return written or None


def _counterpart(entry: Any) -> type[Panel] | None:
    cls = entry.get("Class") if isinstance(entry, Mapping) else None
    return counterpart(Panel, values.text(cls))


def _changed(panel: Panel) -> Tree:
    """Return the properties of a panel, if some are not at their defaults."""
    return struct_tree(panel) if to_values(panel).keys() - {"name"} else {}
