"""Certificates and keys that a server can use, and the reason why not."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path

import pytest
from certificates import certificate
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from webviz.server.access.tls import CertificateError, doubts, server_context

WEEK_S = 7 * 86400


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Certificates and keys, good ones and others."""
    folder = tmp_path_factory.mktemp("tls")
    good = certificate(folder)
    key = good.with_suffix(".key").read_bytes()
    certificate(folder, "other")
    (folder / "both.pem").write_bytes(key + good.read_bytes())
    (folder / "damaged.pem").write_bytes(good.read_bytes()[:300] + b"\n-----END CERTIFICATE-----\n")
    private = serialization.load_pem_private_key(key, None)
    for name, format_ in (
        ("encrypted", serialization.PrivateFormat.PKCS8),
        ("encrypted_traditional", serialization.PrivateFormat.TraditionalOpenSSL),
    ):
        secret = serialization.BestAvailableEncryption(b"secret")
        data = private.private_bytes(serialization.Encoding.PEM, format_, secret)
        (folder / f"{name}.key").write_bytes(data)
    return folder


def test_a_certificate_with_its_key_is_used_without_doubts(folder: Path) -> None:
    for file, key in ((folder / "robot.pem", folder / "robot.key"), (folder / "both.pem", None)):
        assert doubts(server_context(file, key), file) == []


@pytest.mark.parametrize(
    ("file", "key", "expected"),
    [
        ("robot.pem", "other.key", "The key in other.key does not belong to the certificate in "),
        ("none.pem", "robot.key", "Cannot read none.pem: No such file or directory."),
        ("robot.pem", "", "Cannot read .: Is a directory."),
        ("robot.pem", None, "robot.pem contains no private key in PEM format."),
        ("robot.key", None, "robot.key contains no certificate in PEM format."),
        ("damaged.pem", "robot.key", "The certificate in damaged.pem or the key in robot.key is "),
        ("robot.pem", "encrypted.key", "The key in encrypted.key is encrypted. Decrypt it with `"),
        ("robot.pem", "encrypted_traditional.key", "The key in encrypted_traditional.key is encr"),
    ],
)
def test_unusable_certificates_are_refused_with_the_reason(
    folder: Path, file: str, key: str | None, expected: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    with pytest.raises(CertificateError) as error:
        server_context(Path(file), None if key is None else Path(key))
    assert str(error.value).startswith(expected)
    assert str(error.value).endswith(".")


def test_a_certificate_out_of_its_time_is_doubted(folder: Path) -> None:
    file = certificate(folder, "short", ends=datetime(2031, 5, 20, 12))
    context = server_context(file, file.with_suffix(".key"))

    def at(day: datetime) -> list[str]:
        return doubts(context, file, day.timestamp())

    assert at(datetime(2031, 5, 1)) == []
    assert at(datetime(2031, 5, 18)) == [
        f"The certificate in {file} expires on 2031-05-20. Renew it."
    ]
    assert at(datetime(2031, 5, 22)) == [
        f"The certificate in {file} expired on 2031-05-20. Renew it."
    ]
    assert "is not valid before" in at(datetime(1990, 1, 1))[0]


def test_a_certificate_is_valid_from_its_first_to_its_last_second(folder: Path) -> None:
    file = certificate(folder, "exact", ends=datetime(2031, 5, 20, 12))
    x509_certificate = x509.load_pem_x509_certificate(file.read_bytes())
    starts, ends = (
        int(each.timestamp())
        for each in (x509_certificate.not_valid_before_utc, x509_certificate.not_valid_after_utc)
    )
    context = server_context(file, file.with_suffix(".key"))
    warnings = {
        at: " ".join(doubts(context, file, at)) for at in (starts - 1, starts, ends, ends + 1)
    }
    assert "is not valid before" in warnings[starts - 1]
    assert warnings[starts] == ""
    assert "expires on" in warnings[ends]
    assert "expired on" in warnings[ends + 1]
    assert doubts(context, file, ends - WEEK_S) == []
    assert doubts(context, file, ends - WEEK_S + 1) != []


def test_a_certificate_that_is_not_for_servers_is_doubted(folder: Path) -> None:
    key = ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "robot")])
    x509_certificate = (
        x509.CertificateBuilder(name, name, key.public_key(), x509.random_serial_number())
        .not_valid_before(datetime(2020, 1, 1))
        .not_valid_after(datetime(2100, 1, 1))
        .add_extension(x509.ExtendedKeyUsage([ExtendedKeyUsageOID.CLIENT_AUTH]), critical=True)
        .sign(key, hashes.SHA256())
    )
    file = folder / "client.pem"
    private = key.private_bytes(
        serialization.Encoding.PEM,
        serialization.PrivateFormat.PKCS8,
        serialization.NoEncryption(),
    )
    file.write_bytes(private + x509_certificate.public_bytes(serialization.Encoding.PEM))
    (warning,) = doubts(server_context(file), file)
    assert warning.startswith(f"Browsers will reject the certificate in {file}: ")
    assert warning.endswith("purpose.")
