"""Settings of other programs and files that must agree with those of this one."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path

import psutil

PROC = "/proc"
DAEMON = "ros2-daemon"
"""Name by which the daemon of the command line calls itself in its arguments."""
SETTINGS = (
    "ROS_DOMAIN_ID",
    "RMW_IMPLEMENTATION",
    "ROS_AUTOMATIC_DISCOVERY_RANGE",
    "ROS_STATIC_PEERS",
    "ROS_LOCALHOST_ONLY",
    "ROS_DISCOVERY_SERVER",
)
DOMAIN = "--ros-domain-id"


def daemon_differences(variables: Mapping[str, str]) -> Mapping[str, str]:
    """Return the settings in which the daemon of this domain differs, with its values.

    There is one daemon for each domain and middleware, so one of another domain is not asked.
    """
    for process, words in _daemons():
        if DOMAIN not in words[:-1]:
            continue
        if words[words.index(DOMAIN) + 1] != (variables.get("ROS_DOMAIN_ID") or "0"):
            continue
        try:
            own = psutil.Process(process).environ()
        except (psutil.Error, OSError):
            continue
        return {
            name: own.get(name, "")
            for name in SETTINGS[1:]
            if own.get(name, "") != variables.get(name, "")
        }
    return {}


def _daemons() -> Iterator[tuple[int, list[str]]]:
    """Yield the id and arguments of daemons; psutil takes six times as long to look for them."""
    for name in filter(str.isdigit, os.listdir(PROC)):
        try:
            with open(f"{PROC}/{name}/cmdline", "rb", buffering=0) as file:
                words = os.fsdecode(file.readall()).split("\0")
        except OSError:  # it has ended
            continue
        if DAEMON in words:
            yield int(name), words


def security_problem(variables: Mapping[str, str]) -> str:
    """Return the reason why security has no files, a clause; "" if it has, or is off."""
    if variables.get("ROS_SECURITY_ENABLE", "").lower() != "true":
        return ""
    keystore = variables.get("ROS_SECURITY_KEYSTORE", "")
    if not keystore:
        return "ROS_SECURITY_KEYSTORE is not set"
    if not Path(keystore, "enclaves").is_dir():
        return f"{keystore} is not a keystore"
    enclave = variables.get("ROS_SECURITY_ENCLAVE_OVERRIDE", "")
    if enclave and not Path(keystore, "enclaves", enclave.lstrip("/")).is_dir():
        return f"the keystore has no enclave {enclave}"
    return ""
