"""Addresses of Zenoh: endpoints, session configs and credentials."""

from __future__ import annotations

import builtins
from pathlib import Path
from typing import Any

import pytest

from webviz.api.errors import Error
from webviz.shell.live_source import bridge_source
from webviz.sources.zenoh.address import PASSWORD, USER, is_zenoh, session_config, zenoh_address


def test_several_endpoints_and_no_scouting() -> None:
    result = zenoh_address("tcp/robot:7447, tls/cloud.example:7447", {"ROS_DOMAIN_ID": "12"})
    assert result.endpoints == ("tcp/robot:7447", "tls/cloud.example:7447")
    assert result.domain == 12
    config = session_config(result)
    assert config.get_json("scouting/multicast/enabled") == "false"
    assert config.get_json("mode") == '"client"'
    assert config.get_json("connect/endpoints") == '["tcp/robot:7447","tls/cloud.example:7447"]'


def test_credentials_come_from_the_environment_and_are_not_shown() -> None:
    result = zenoh_address("quic/robot:7447", {USER: "ann", PASSWORD: "secret"})
    assert session_config(result).get_json("transport/auth/usrpwd/user") == '"ann"'
    assert "secret" not in repr(result)
    assert "secret" not in result.name


def test_a_session_config(tmp_path: Path) -> None:
    path = tmp_path / "zenoh.json5"
    path.write_text("{mode: 'peer', connect: {endpoints: ['tcp/[::1]:7447']}} // of mine")
    result = zenoh_address(str(path), {})
    assert result.endpoints == ("tcp/[::1]:7447",)
    config = session_config(result)
    assert config.get_json("mode") == '"peer"'
    assert config.get_json("scouting/multicast/enabled") == "false"
    path.write_text("{connect: {endpoints: {client: ['tcp/a:1'], peer: ['tcp/b:2']}}}")
    assert set(zenoh_address(str(path), {}).endpoints) == {"tcp/a:1", "tcp/b:2"}
    assert session_config(zenoh_address(str(path), {})).get_json("mode") == '"client"'


@pytest.mark.parametrize(
    ("address", "sentence"),
    [
        ("tcp/robot", "'tcp/robot' is not an address of Zenoh. Write PROTOCOL/HOST:PORT"),
        ("tcp/robot:99999", "is not an address of Zenoh"),
        ("tcp/robot:0", "is not an address of Zenoh"),
        ("serial/dev/ttyUSB0:7447", "is not an address of Zenoh"),
        ("tcp/a:1," * 200, "200 addresses of Zenoh are given"),
        ("missing.json5", "missing.json5 with the config of Zenoh is not a file."),
    ],
)
def test_refuses_with_a_sentence(address: str, sentence: str) -> None:
    with pytest.raises(Error, match=sentence.replace("(", r"\(")):
        zenoh_address(address, {})


def test_refuses_invalid_configs_and_domains(tmp_path: Path) -> None:
    path = tmp_path / "bad.json5"
    path.write_text("{mode: 'robot'}")
    with pytest.raises(Error, match=r"bad\.json5 is not a config of Zenoh: "):
        zenoh_address(str(path), {})
    path.write_bytes(b"/" * (2 << 20))
    with pytest.raises(Error, match="is larger than 1 MB"):
        zenoh_address(str(path), {})
    with pytest.raises(Error, match=r"ROS_DOMAIN_ID is '300'\. Set it to a number from 0 to 232"):
        zenoh_address("tcp/a:1", {"ROS_DOMAIN_ID": "300"})


def test_tells_bridges_apart() -> None:
    assert not is_zenoh("ws://robot:8765")
    assert is_zenoh("ws/robot:7447")
    assert is_zenoh("config/zenoh.json5")
    assert is_zenoh("tcp/robot:7447")
    with pytest.raises(Error, match="Zenoh has no headers"):
        bridge_source("tcp/robot:7447", "headers.txt")


def test_one_sentence_without_the_package(monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def without(name: str, *rest: Any, **named: Any) -> Any:
        if name.startswith("zenoh"):
            raise ImportError(name)
        return real(name, *rest, **named)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(Error, match=r"not installed\. Run `pip install 'ros-webviz\[zenoh\]'`"):
        zenoh_address("tcp/robot:7447", {})
