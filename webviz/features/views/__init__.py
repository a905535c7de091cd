"""The saved views, which all browsers share, and the panel "Views"."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import msgspec

from webviz.api.roles import Role
from webviz.api.views import View, type_of
from webviz.data.names import problem_of
from webviz.engine.commands import Sender
from webviz.engine.feature import Feature, command, store
from webviz.engine.forms import sendable
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.parts.views import ViewsPart, saved_view
from webviz.engine.store import PageStore
from webviz.files.config import ConfigError


class SavedView(msgspec.Struct, frozen=True):
    """A saved view: its name and type, and whether browsers begin with it."""

    name: str
    type: str
    is_start: bool


class ViewsStore(PageStore, frozen=True):
    """The saved views."""

    saved: Sequence[SavedView]


class ViewsFeature(Feature):
    """The saved views."""

    name = "Saved views"
    module = "views.js"

    @store(of=lambda part: part.context.get(SettingsPart).settings)
    def views(self, argument: str) -> ViewsStore:
        """Return the saved views."""
        settings = self.context.get(SettingsPart).settings
        return ViewsStore(
            [
                SavedView(str(sendable(name)), type_of(view), view == settings.view)
                for name, view in settings.views.items()
            ]
        )

    @command(Role.OPERATOR)
    def save_view(
        self, sender: Sender, name: str, browser: int | None = None, view: View | None = None
    ) -> None:
        """Save the current view under a name.

        Args:
            name: of the view; replaces a saved view of that name.
            browser: on which it acts; by default the one that sends this, or for a program the one
                that connected last.
            view: instead of the current view.
        """
        _check_name(name)
        view = view or self.context.get(ViewsPart).one(browser, sender)
        self._keep({**self._saved, name: view})

    @command(Role.OPERATOR)
    def rename_view(self, name: str, new_name: str) -> None:
        """Rename a saved view."""
        saved = self._saved
        view = saved_view(name, saved)
        _check_name(new_name)
        if new_name != name and new_name in saved:
            raise ConfigError(f"A view named {new_name} exists already. Choose another name.")
        names = {key: new_name if key == name else key for key in saved}
        self._keep({names[key]: saved[key] for key in saved} | {new_name: view})

    @command(Role.OPERATOR)
    def remove_view(self, name: str) -> None:
        """Remove a saved view."""
        saved = self._saved
        saved_view(name, saved)
        self._keep({key: view for key, view in saved.items() if key != name})

    @property
    def _saved(self) -> Mapping[str, View]:
        return self.context.get(SettingsPart).settings.views

    def _keep(self, views: Mapping[str, View]) -> None:
        self.context.get(SettingsPart).set("views", views)


def _check_name(name: str) -> None:
    if problem := problem_of(name):
        raise ConfigError(problem)
