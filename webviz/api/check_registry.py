"""The registry of checks: of packages, by their entry points, and of files at run time."""

from __future__ import annotations

import functools
import importlib
import itertools
import logging
import pkgutil
from collections.abc import Iterator, Sequence
from types import ModuleType

from webviz.api.check import Check
from webviz.api.entry_points import installed
from webviz.api.finding import CauseLevel

GROUP = "webviz.checks"

log = logging.getLogger("webviz")

_registered: dict[str, Sequence[type[Check]]] = {}
"""Classes of files by owner."""


def known_checks() -> Sequence[type[Check]]:
    """All checks in the order of causes: by level, then by number."""
    return _in_order(tuple(_registered.values()))


def register_checks(owner: str, checks: Sequence[type[Check]]) -> None:
    """Register checks, replacing all previous ones of the same owner.

    Raises:
        ValueError: an id is invalid or taken by another check; nothing was changed.
    """
    owners = {check.id: "an installed package" for check in _installed()}
    owners |= {
        check.id: other for other, of in _registered.items() if other != owner for check in of
    }
    for check in checks:
        if not is_id(check.id):
            raise ValueError(f"the check {check.__name__} has no valid id: {check.id!r}")
        if check.id in owners:
            raise ValueError(f"{owners[check.id]} has a check with the id {check.id}, too")
        owners[check.id] = "the file"
    _registered[owner] = tuple(checks)


def registered_checks(owner: str) -> Sequence[type[Check]]:
    """Return the registered checks of an owner."""
    return _registered.get(owner, ())


def is_id(text: str) -> bool:
    """Return whether a text is a level of causes and a number."""
    try:
        return CauseLevel.of(text).value != text
    except ValueError:
        return False


def checks_of(module: ModuleType) -> Iterator[type[Check]]:
    """Yield the checks that a module defines; names that start with an underscore are left out."""
    for value in vars(module).values():
        is_check = isinstance(value, type) and issubclass(value, Check)
        if is_check and value.__module__ == module.__name__ and not value.__name__.startswith("_"):
            yield value


@functools.lru_cache(maxsize=1)
def _in_order(registered: tuple[Sequence[type[Check]], ...]) -> Sequence[type[Check]]:
    """Return the checks of packages and those of files, in the order of causes."""
    checks = itertools.chain(_installed(), *registered)
    return tuple(sorted(checks, key=lambda check: (CauseLevel.of(check.id).place, check.id)))


@functools.cache
def _installed() -> Sequence[type[Check]]:
    """Return the checks of packages.

    A package that does not load is logged and left out, as are checks without a valid id and those
    whose id is taken.
    """
    checks: dict[str, type[Check]] = {}
    # webviz's own come first, so that no other package takes their ids.
    for point in sorted(installed(GROUP), key=lambda point: (point.value != GROUP, point.name)):
        try:
            classes = [check for module in _modules(point.load()) for check in checks_of(module)]
        except Exception as error:  # plug-ins may raise anything
            log.warning("The checks of %s do not load: %s.", point.value, error)
            continue
        for check in classes:
            if not check.id:
                continue  # the base of several
            if not is_id(check.id):
                log.warning("The check %s has no valid id: %r.", check.__name__, check.id)
            elif checks.setdefault(check.id, check) is not check:
                log.warning(
                    "The id %s is taken; the check %s is left out.", check.id, check.__name__
                )
    return tuple(checks.values())


def _modules(module: ModuleType) -> Sequence[ModuleType]:
    """Return a module, or all modules of a package."""
    if not hasattr(module, "__path__"):
        return [module]
    names = pkgutil.walk_packages(module.__path__, f"{module.__name__}.")
    return [module, *(importlib.import_module(each.name) for each in names)]
