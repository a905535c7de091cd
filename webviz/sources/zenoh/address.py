"""Addresses of Zenoh routers and robots, as users give them."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from webviz.api.errors import Error
from webviz.sources.inbox import MAX_TOTAL
from webviz.sources.zenoh.engine import engine
from webviz.sources.zenoh.tokens import MAX_DOMAIN

USER, PASSWORD = "WEBVIZ_ZENOH_USER", "WEBVIZ_ZENOH_PASSWORD"
"""Environment variables with the credentials for a router that asks for them."""
DOMAIN = "ROS_DOMAIN_ID"
MAX_CONFIG = 1 << 20
"""Bytes of a file with the config of a session."""
MAX_ENDPOINTS = 100
_ENDPOINT = re.compile(
    r"(?P<protocol>tcp|tls|quic|udp|ws)/(?P<host>\[[0-9A-Fa-f:.%]+\]|[A-Za-z0-9._-]+):"
    r"(?P<port>[0-9]{1,5})(?:[?#][\x21-\x7e]*)?",
    re.ASCII,
)
_CONFIG = (".json5", ".json")
EXAMPLE = (
    "Write PROTOCOL/HOST:PORT, such as tcp/robot:7447, tls/… or quic/…, several with commas, or "
    "the path of a session config such as zenoh.json5."
)


@dataclass(frozen=True)
class ZenohAddress:
    """The way to a robot over Zenoh.

    Args:
        endpoints: of routers or robots, such as "tcp/robot:7447"; all are connected.
        config: file with the config of the session, None for the default.
        domain: number of the ROS domain.
        user: for a router that asks for one, "" for none.
        password: of the user.
        key_prefix: before all keys, "" for none; the engine adds and removes it.
    """

    endpoints: tuple[str, ...]
    config: Path | None = None
    domain: int = 0
    user: str = ""
    password: str = field(default="", repr=False)
    key_prefix: str = ""

    @property
    def name(self) -> str:
        """The address without credentials, for sentences."""
        return ", ".join(self.endpoints) or str(self.config)


def is_zenoh(address: str) -> bool:
    """Return whether an address is one of Zenoh rather than of a bridge."""
    is_endpoint = re.match(r"[a-z]+/(?!/)", address) is not None
    return is_endpoint or address.endswith(_CONFIG)


def zenoh_address(
    text: str, environment: Mapping[str, str] = os.environ, key_prefix: str = ""
) -> ZenohAddress:
    """Return the address that a user gave.

    Args:
        text: such as "tcp/robot:7447", "tls/a:7447,tls/b:7447" or "zenoh.json5".
        environment: may have the domain and credentials.
        key_prefix: before all keys, "" for that of the config, or none.

    Raises:
        Error: the address, the file or the domain is invalid, or the engine is not installed.
    """
    domain = _domain(environment.get(DOMAIN, ""))
    user, password = environment.get(USER, ""), environment.get(PASSWORD, "")
    if text.endswith(_CONFIG):
        config = _read(Path(text))
        address = ZenohAddress(_endpoints(config), Path(text), domain, user, password, key_prefix)
    else:
        endpoints = tuple(part.strip() for part in text.split(",") if part.strip())
        for endpoint in endpoints[: MAX_ENDPOINTS + 1]:
            parts = _ENDPOINT.fullmatch(endpoint)
            if parts is None or not 0 < int(parts["port"]) < 1 << 16:
                raise Error(f"{endpoint[:200]!r} is not an address of Zenoh. {EXAMPLE}")
        if not 0 < len(endpoints) <= MAX_ENDPOINTS:
            raise Error(f"{len(endpoints)} addresses of Zenoh are given. {EXAMPLE}")
        address = ZenohAddress(endpoints, None, domain, user, password, key_prefix)
    session_config(address)  # refuses what the engine does not accept
    return address


def session_config(address: ZenohAddress) -> Any:
    """Return the config of a session: a client of the named endpoints, without scouting.

    Raises:
        Error: the engine does not accept it.
    """
    config = engine().Config() if address.config is None else _read(address.config)
    if config.get_json("mode") == "null":
        config.insert_json5("mode", '"client"')
    values: dict[str, Any] = {
        "timestamping/enabled": True,  # for caches of latched messages
        "scouting/multicast/enabled": False,  # only what was named
        "transport/link/rx/max_message_size": MAX_TOTAL + (1 << 20),
    }
    if address.config is None:
        values["connect/endpoints"] = list(address.endpoints)
    if address.key_prefix:
        values["namespace"] = address.key_prefix
    if address.user:
        values["transport/auth/usrpwd/user"] = address.user
        values["transport/auth/usrpwd/password"] = address.password
    try:
        for key, value in values.items():
            config.insert_json5(key, json.dumps(value))
    except engine().ZError as error:
        raise Error(f"Zenoh does not accept {address.name}: {_reason(error)}. {EXAMPLE}") from error
    return config


def host_and_port(endpoint: str) -> tuple[str, int]:
    """Return both of an endpoint; an empty host for one that has none."""
    parts = _ENDPOINT.fullmatch(endpoint)
    return (parts["host"].strip("[]"), int(parts["port"])) if parts else ("", 0)


def _read(path: Path) -> Any:
    """Return the config in a file; raises Error."""
    try:
        if not path.is_file():  # a FIFO would block
            raise Error(f"{path} with the config of Zenoh is not a file.")
        with path.open("rb") as file:
            text = file.read(MAX_CONFIG + 1)
    except OSError as error:
        raise Error(f"{path} with the config of Zenoh cannot be read: {error.strerror}.") from error
    if len(text) > MAX_CONFIG:
        raise Error(f"{path} with the config of Zenoh is larger than {MAX_CONFIG >> 20} MB.")
    try:
        return engine().Config.from_json5(text.decode("utf-8", "replace"))
    except engine().ZError as error:
        raise Error(f"{path} is not a config of Zenoh: {_reason(error)}.") from error


def _endpoints(config: Any) -> tuple[str, ...]:
    """Return the endpoints that a config connects to."""
    configured = json.loads(config.get_json("connect/endpoints"))
    if isinstance(configured, dict):  # by mode
        configured = [each for endpoints in configured.values() for each in endpoints]
    return tuple(each for each in configured or [] if isinstance(each, str))[:MAX_ENDPOINTS]


def _domain(text: str) -> int:
    if not text:
        return 0
    if not (text.isascii() and text.isdigit() and len(text) <= 3 and int(text) <= MAX_DOMAIN):
        raise Error(f"{DOMAIN} is {text[:40]!r}. Set it to a number from 0 to {MAX_DOMAIN}.")
    return int(text)


def _reason(error: Exception) -> str:
    """Return what the engine says, without the place in its source."""
    return str(error).partition(" at /")[0].strip().rstrip(".!")[:300]
