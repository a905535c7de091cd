"""Panels of plug-ins in a tab of the page."""

from __future__ import annotations

from typing import Any, TypeVar

from tests.page.tabs import ViewerTab
from webviz.api.panel import Panel
from webviz.files.config import Item

P = TypeVar("P", bound=Panel)


def open_panel(tab: ViewerTab, panel: P, *displays: Item, **config: Any) -> P:
    """Show a config with one panel, and open its tab.

    Args:
        tab: of the page.
        panel: of the config.
        displays: of the config.
        config: settings besides, see `PageBench.show`.

    Returns:
        The panel of the viewer.
    """
    tab.viewer.show(*displays, panels=[panel], **config)
    heads = tab.page.get_by_role("tab", name=panel.name, exact=True)
    tab.wait_for(lambda: heads.count() == 1)
    tab.catch_up()  # else its layout may come after the click, and put another panel in front
    tab.show_tab(panel.name)
    tab.wait_for(lambda: tab.page.locator(".wv-plugin-widgets > *").count() > 0)
    (panel_tab,) = tab.viewer.states[-1].panels
    assert isinstance(panel_tab.panel, type(panel))
    return panel_tab.panel
