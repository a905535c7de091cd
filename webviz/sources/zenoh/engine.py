"""The module `zenoh`, which only viewers that connect over Zenoh load."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from webviz.api.errors import Error

if TYPE_CHECKING:
    import zenoh

MISSING = (
    "Connections over Zenoh need the package eclipse-zenoh, which is not installed. Run "
    "`pip install 'ros-webviz[zenoh]'`."
)


def engine() -> Any:
    """Return the module.

    Raises:
        Error: it is not installed.
    """
    try:
        import xxhash  # noqa: F401
        import zenoh
        import zenoh.ext
    except ImportError as error:
        raise Error(MISSING) from error
    return zenoh


def directly(call: Any, done: Any = None) -> zenoh.handlers.Callback[Any]:
    """Return a handler that calls a function in the engine's thread, without a queue.

    Args:
        call: takes a sample or reply; returns soon.
        done: called after the last one.
    """
    return engine().handlers.Callback(call, done, indirect=False)
