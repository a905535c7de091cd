"""Servers of the middleware that variables name, and whether they answer."""

from __future__ import annotations

import re
import socket
from collections.abc import Mapping

WAIT_S = 0.3
ZENOH, ZENOH_PORT = "rmw_zenoh_cpp", 7447
DISCOVERY_PORT = 11811
_ENDPOINTS = re.compile(r"connect/endpoints\s*=\s*\[([^\]]*)\]")
_TCP = re.compile(r"tcp/(?:\[([^\]]+)\]|([^:/\"]+)):(\d+)")


def zenoh_routers(variables: Mapping[str, str]) -> Mapping[str, str]:
    """Return the problem of each Zenoh router that this machine uses, "" for one that listens.

    None without Zenoh, or if a file of the session names the routers.
    """
    if variables.get("RMW_IMPLEMENTATION") != ZENOH:
        return {}
    given = _ENDPOINTS.search(variables.get("ZENOH_CONFIG_OVERRIDE", ""))
    if given is None and variables.get("ZENOH_SESSION_CONFIG_URI"):
        return {}
    text = given[1] if given else f"tcp/localhost:{ZENOH_PORT}"
    places = {found[0]: (found[1] or found[2], int(found[3])) for found in _TCP.finditer(text)}
    return {name: _tcp_problem(*place) for name, place in places.items()}


def discovery_servers(variables: Mapping[str, str]) -> Mapping[str, str]:
    """Return the problem of each discovery server of Fast DDS, "" for one that is not refused.

    UDP has no connections: only the machine of the server can say that nothing listens there.
    """
    found: dict[str, str] = {}
    for entry in variables.get("ROS_DISCOVERY_SERVER", "").split(";"):
        name = entry.strip()
        if not name or name.startswith(("TCP", "[")) or name.count(":") > 1:
            continue
        host, _, port = name.partition(":")
        try:
            found[name] = _udp_problem(host, int(port or DISCOVERY_PORT))
        except ValueError:
            found[name] = "its port is not a number"
    return found


def _tcp_problem(host: str, port: int) -> str:
    try:
        with socket.create_connection((host, port), WAIT_S):
            return ""
    except OSError as error:
        return error.strerror or "no answer"


def _udp_problem(host: str, port: int) -> str:
    try:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.settimeout(WAIT_S)
            probe.connect((host, port))
            probe.send(b"")
            probe.recv(1)
    except TimeoutError:
        return ""
    except (OSError, OverflowError) as error:
        return getattr(error, "strerror", None) or str(error)
    return ""
