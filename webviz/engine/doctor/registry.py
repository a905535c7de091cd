"""The registry of checks: every class in the packages that entry points name."""

from __future__ import annotations

import functools
import importlib
import importlib.metadata
import logging
import pkgutil
from collections.abc import Iterator, Sequence
from types import ModuleType

from webviz.api.check import Check
from webviz.api.finding import CauseLevel

GROUP = "webviz.checks"

log = logging.getLogger("webviz")


@functools.cache
def installed_checks() -> Sequence[type[Check]]:
    """All checks in the order of causes: by level, then by number.

    A package that does not load is logged and left out, as are checks without a valid id and those
    whose id is taken.
    """
    found: dict[str, type[Check]] = {}
    points = importlib.metadata.entry_points(group=GROUP)
    for point in sorted(points, key=lambda point: point.name):
        try:
            classes = list(_classes_of(point.load()))
        except Exception as error:  # plug-ins may raise anything
            log.warning("The checks of %s do not load: %s.", point.value, error)
            continue
        for check in classes:
            try:
                CauseLevel.of(check.id)
            except ValueError:
                log.warning("The check %s has no valid id: %r.", check.__name__, check.id)
                continue
            if found.setdefault(check.id, check) is not check:
                log.warning("Two checks have the id %s; %s is left out.", check.id, check)
    return sorted(found.values(), key=lambda check: (CauseLevel.of(check.id).place, check.id))


def _classes_of(module: ModuleType) -> Iterator[type[Check]]:
    """The checks that a module, or the modules of a package, define."""
    modules = [module]
    if hasattr(module, "__path__"):
        names = pkgutil.walk_packages(module.__path__, f"{module.__name__}.")
        modules += [importlib.import_module(each.name) for each in names]
    for each in modules:
        for value in vars(each).values():
            is_check = isinstance(value, type) and issubclass(value, Check)
            if is_check and value.__module__ == each.__name__ and value.id:
                yield value
