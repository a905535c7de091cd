"""Tokens: what they are made of, where they are kept, and until when they count."""

from __future__ import annotations

import os
import threading
import time
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from websockets.datastructures import Headers

from webviz.api.roles import Role
from webviz.server.access import login, token_file
from webviz.server.access.access import EVERYBODY, Access
from webviz.server.access.starting import access_to, is_local, link, make_missing
from webviz.server.access.tokens import MAX_TOKENS, Token, TokenError, make

NOW = datetime(2030, 1, 1, tzinfo=UTC)
SECRET = "A" * 32


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "webviz" / "tokens.json"


def token(name: str = "Ada", role: Role = Role.OPERATOR, days: float | None = None) -> Token:
    return make(name, role, NOW, days)


def access(*tokens: Token, now: datetime = NOW) -> Access:
    return Access(True, others=tokens, now=lambda: now)


def test_secrets_are_random_and_long() -> None:
    secrets = {token().secret for _ in range(100)}
    assert len(secrets) == 100
    assert {len(secret) for secret in secrets} == {32}


def test_a_secret_is_not_shown_by_accident() -> None:
    new_token = token()
    assert new_token.secret not in f"{new_token!r} {new_token} {[new_token]}"
    assert new_token.cookie not in f"{new_token!r}"


def test_a_cookie_is_not_the_secret_of_the_link() -> None:
    new_token = token()
    assert new_token.secret not in new_token.cookie
    assert access(new_token).by_secret(new_token.cookie, Role.OPERATOR) is None
    assert access(new_token).by_cookie(new_token.secret) is None


def test_a_name_has_forty_characters_at_most() -> None:
    assert token(40 * "a").name == 40 * "a"


@pytest.mark.parametrize(
    "name",
    ["", " ", "a\nb", "a\x1b[2J", "a" * 41, "../a", "a'", "a ", "a\u202eb", "\ud800", "a\n", "-x"],
)
def test_a_name_that_could_deceive_in_a_log_is_refused(name: str) -> None:
    with pytest.raises(TokenError, match=r" is not a valid name\. Use 1 to 40 letters"):
        token(name)


@pytest.mark.parametrize("days", [0.0, -1.0, float("nan"), 1e308, 1e-12])
def test_a_time_that_makes_no_sense_is_refused(days: float) -> None:
    with pytest.raises(TokenError, match="is not a valid number of days"):
        token(days=days)


def test_a_link_gives_the_role_that_it_names_and_no_other() -> None:
    new_token = token()
    access_rights = access(new_token)
    for role in Role:
        assert (access_rights.by_secret(new_token.secret, role) is not None) == (
            role is Role.OPERATOR
        )
    assert link("http://robot:8080", new_token) == f"http://robot:8080/?operate={new_token.secret}"


@pytest.mark.parametrize(
    "secret", ["", "é" * 32, "\ud800", "A" * (1 << 20), SECRET[:-1], SECRET + "A"]
)
def test_a_wrong_secret_or_cookie_gives_nothing(secret: str) -> None:
    access_rights = access(Token("a", "owner", SECRET, NOW))
    assert access_rights.by_secret(secret, Role.OWNER) is None
    assert access_rights.by_cookie(secret) is None


def test_an_expired_token_counts_no_more() -> None:
    new_token = token(days=1.0)
    grant = access(new_token).by_secret(new_token.secret, Role.OPERATOR)
    assert grant is not None
    for hours, is_valid in ((23, True), (24, False), (25, False)):
        later = access(new_token, now=NOW + timedelta(hours=hours))
        assert (later.by_secret(new_token.secret, Role.OPERATOR) is not None) == is_valid
        assert (later.by_cookie(new_token.cookie) is not None) == later.holds(grant) == is_valid


def test_without_tokens_everybody_is_an_owner() -> None:
    assert Access().by_cookie("") is EVERYBODY
    assert EVERYBODY.role is Role.OWNER


def test_the_program_itself_is_an_unlisted_watcher() -> None:
    access_rights = access()
    grant = access_rights.by_cookie(access_rights.own.cookie)
    assert grant is not None
    assert grant.role is Role.WATCHER
    assert access_rights.tokens == ()


def test_the_file_is_private_and_comes_back(path: Path) -> None:
    tokens = [token("a"), token("b", days=3.0)]
    old = os.umask(0)
    try:
        token_file.modify(path, lambda _: tokens)
    finally:
        os.umask(old)
    assert path.stat().st_mode & 0o777 == 0o600
    assert path.parent.stat().st_mode & 0o777 == 0o700
    assert token_file.read(path) == tuple(tokens)
    assert [each.name for each in path.parent.iterdir()] == ["tokens.json"]


def test_a_missing_file_has_no_tokens(path: Path) -> None:
    assert token_file.read(path) == ()


@pytest.mark.parametrize("mode", [0o640, 0o604, 0o620, 0o660, 0o644, 0o601])
def test_a_file_that_others_may_read_is_refused_with_the_remedy(path: Path, mode: int) -> None:
    token_file.modify(path, lambda _: [token()])
    path.chmod(mode)
    with pytest.raises(TokenError, match=rf"mode {mode:04o}.*Run `chmod 600 {path}`"):
        token_file.read(path)
    with pytest.raises(TokenError, match="chmod 600"):
        access_to("127.0.0.1", True, path, {})


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        "[" * 100_000,
        '{"tokens": [{"name": "a", "role": "king", "secret": "SECRET", "made": "2030-01-01T00:00Z"}'
        "]}",
        '{"tokens": [{"name": "a", "role": "owner", "secret": "SECRET"}]}',
        '{"tokens": [{"name": "a", "role": "owner", "secret": "a", "made": "2030-01-01T00:00:00Z"}'
        "]}",
        '{"tokens": [], "more": "SECRET"}',
        "\x00",
    ],
)
def test_an_invalid_file_is_an_error_that_quotes_no_secret(path: Path, text: str) -> None:
    path.parent.mkdir()
    path.write_text(text.replace("SECRET", SECRET))
    path.chmod(0o600)
    with pytest.raises(TokenError, match="is not a valid file of tokens") as excinfo:
        token_file.read(path)
    assert SECRET not in str(excinfo.value)
    assert excinfo.value.__cause__ is None


def test_a_file_above_a_megabyte_is_not_read(path: Path) -> None:
    token_file.modify(path, lambda _: [token()])
    text = path.read_text().rstrip()

    def grow(size: int) -> None:
        path.write_text(text[:-1] + (size - len(text)) * " " + "}")

    grow(1 << 20)
    assert len(token_file.read(path)) == 1
    grow((1 << 20) + 2)
    with pytest.raises(TokenError, match="is not a valid file of tokens"):
        token_file.read(path)


def test_a_file_that_cannot_be_written_is_an_error_with_the_reason(path: Path) -> None:
    path.parent.write_text("")
    with pytest.raises(TokenError) as excinfo:
        token_file.modify(path, lambda _: [token()])
    assert str(excinfo.value) == f"Cannot write {path}: File exists."
    path.parent.unlink()
    path.mkdir(parents=True)
    with pytest.raises(TokenError, match=f"Cannot (read|write) {path}: Is a directory"):
        token_file.modify(path, lambda _: [token()])


def test_a_pipe_in_place_of_the_file_is_an_error_at_once(path: Path) -> None:
    path.parent.mkdir()
    os.mkfifo(path, 0o600)
    with pytest.raises(TokenError, match="is not a file"):
        token_file.read(path)


def test_a_file_of_root_is_read(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if os.geteuid():
        pytest.skip("only root can make it")
    token_file.modify(path, lambda _: [token()])
    monkeypatch.setattr(os, "geteuid", lambda: 4321)
    assert len(token_file.read(path)) == 1


def test_a_file_of_another_user_is_refused(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    token_file.modify(path, lambda _: [token()])
    if os.geteuid() == 0:
        os.chown(path, 4321, 4321)
    else:
        monkeypatch.setattr(os, "geteuid", lambda: 4321)
    with pytest.raises(TokenError, match="belongs to another user"):
        token_file.read(path)


def test_two_tokens_of_one_name_are_refused(path: Path) -> None:
    token_file.modify(path, lambda _: [token("a"), token("a")])
    with pytest.raises(TokenError, match="two tokens of one name"):
        token_file.read(path)


def test_there_are_not_too_many_tokens(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tokens = [token(str(n)) for n in range(MAX_TOKENS + 2)]
    with pytest.raises(TokenError, match=f"There are {MAX_TOKENS} tokens, which is the limit"):
        token_file.modify(path, lambda _: tokens)
    assert not path.exists()
    token_file.modify(path, lambda _: tokens[:MAX_TOKENS])
    assert len(token_file.read(path)) == MAX_TOKENS
    with monkeypatch.context() as patch:
        patch.setattr(token_file, "MAX_TOKENS", len(tokens))
        token_file.modify(path, lambda _: tokens)
    with pytest.raises(TokenError, match=f"or more than {MAX_TOKENS}"):
        token_file.read(path)


def test_programs_that_change_the_file_at_once_lose_nothing(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.files.config.atomic.LOCK_S", 60.0)  # the disk may be busy

    def add(number: int) -> None:
        token_file.modify(path, lambda tokens: [*tokens, token(str(number))])

    threads = [threading.Thread(target=add, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert {each.name for each in token_file.read(path)} == {str(number) for number in range(8)}


def test_a_file_is_read_again_only_if_changed_and_tokens_are_required(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    token_file.modify(path, lambda _: [token()])
    asking, free = Access(True, path), Access(False, path)
    monkeypatch.setattr(token_file, "read", lambda path: pytest.fail("was read"))
    asking.refresh()
    os.utime(path, ns=(1, 1))
    free.refresh()


def test_a_token_that_is_revoked_in_the_file_counts_no_more(path: Path) -> None:
    valid, revoked = token("kept"), token("revoked")
    token_file.modify(path, lambda _: [valid, revoked])
    access_rights = Access(True, path, now=lambda: NOW)
    grant = access_rights.by_cookie(revoked.cookie)
    assert grant is not None
    token_file.modify(path, lambda tokens: [t for t in tokens if t.name != "revoked"])
    access_rights.refresh()
    assert not access_rights.holds(grant)
    assert access_rights.by_cookie(revoked.cookie) is None
    assert access_rights.by_cookie(valid.cookie) is not None


def test_no_token_of_a_file_counts_that_others_may_read_meanwhile(
    path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    new_token = token()
    token_file.modify(path, lambda _: [new_token])
    access_rights = Access(True, path, now=lambda: NOW)
    path.chmod(0o644)
    access_rights.refresh()
    assert access_rights.by_cookie(new_token.cookie) is None
    assert "chmod 600" in caplog.text
    path.chmod(0o600)
    access_rights.refresh()
    assert access_rights.by_cookie(new_token.cookie) is not None


def test_tokens_are_removed_from_the_environment() -> None:
    environment = {"WEBVIZ_TOKEN_OPERATE": SECRET, "HOME": "/"}
    access_rights = access_to("127.0.0.1", environment=environment)
    assert access_rights.asks
    assert access_rights.by_secret(SECRET, Role.OPERATOR) is not None
    assert environment == {"HOME": "/"}


@pytest.mark.parametrize("secret", ["short", "a b" * 20, "ü" * 30, "x" * 201, "a" * 30 + "\n"])
def test_a_weak_token_of_the_environment_is_refused_and_not_quoted(secret: str) -> None:
    with pytest.raises(TokenError, match=r"^WEBVIZ_TOKEN_OWN must have 22 to 200") as excinfo:
        access_to("127.0.0.1", environment={"WEBVIZ_TOKEN_OWN": secret})
    assert secret not in str(excinfo.value)


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "::1", "127.3.2.1"])
def test_a_viewer_on_this_machine_only_needs_no_token_by_default(host: str, path: Path) -> None:
    assert is_local(host)
    assert not access_to(host, path=path, environment={}).asks
    assert access_to(host, True, path, {}).asks


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "", "192.0.2.1", "2001:db8::1"])
def test_others_need_a_token(host: str, path: Path) -> None:
    assert not is_local(host)
    access_rights = access_to(host, path=path, environment={})
    assert access_rights.asks
    assert access_rights.by_cookie("") is None
    assert not path.exists()
    make_missing(access_rights)
    assert [each.role for each in access_rights.tokens] == ["watcher", "operator", "owner"]
    before = path.read_bytes()
    make_missing(access_to(host, path=path, environment={}))
    assert path.read_bytes() == before


def test_an_address_that_cannot_be_resolved_is_not_only_of_this_machine() -> None:
    assert not is_local("a..b")


def test_a_viewer_without_tokens_makes_none(path: Path) -> None:
    make_missing(Access(False, path))
    assert not path.exists()


def test_a_disk_that_does_not_respond_is_logged_once(
    path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    rights, mounted = Access(True, path), threading.Event()
    monkeypatch.setattr(rights, "refresh", lambda: mounted.wait(60.0))
    for number in range(10):
        rights.begin_refresh(lambda: None)
        is_said = number >= 5  # the first look waits for the disk
        assert ["does not respond" in text for text in caplog.messages] == [True] * is_said
    mounted.set()


def test_a_viewer_with_a_token_of_the_environment_makes_none(path: Path) -> None:
    make_missing(access_to("0.0.0.0", path=path, environment={"WEBVIZ_TOKEN_OWN": SECRET}))
    assert not path.exists()


def test_a_viewer_without_a_valid_token_does_not_start(path: Path) -> None:
    old = Token("a", "owner", SECRET, NOW, datetime(2000, 1, 1, tzinfo=UTC))
    token_file.modify(path, lambda _: [old])
    with pytest.raises(TokenError, match=r"has expired\. Run `webviz token make`"):
        make_missing(access_to("0.0.0.0", path=path, environment={}))


def headers(*cookies: str, **more: str) -> Headers:
    return Headers([*(("Cookie", cookie) for cookie in cookies), *more.items()])


TYPED = Headers([("Sec-Fetch-Site", "none")])
"""Headers of an address that somebody has entered."""


def test_a_cookie_is_that_of_the_port() -> None:
    new_token = token()
    access_rights = access(new_token)
    assert login.grant_of(access_rights, headers(f"webviz_80={new_token.cookie}"), 80)
    assert login.grant_of(access_rights, headers(f"a=b; webviz_80 = {new_token.cookie} ;c"), 80)
    for wrong in (
        f"webviz_81={new_token.cookie}",
        f"Webviz_80={new_token.cookie}",
        f"webviz_80={new_token.cookie}x",
        f"webviz_80={new_token.cookie.upper()}",
        f"webviz_80={new_token.secret}",
        "webviz_80=",
        "webviz_80",
        "",
        ";" * 10_000 + f"webviz_80={new_token.cookie}",
    ):
        assert login.grant_of(access_rights, headers(wrong), 80) is None


def test_a_cookie_of_another_service_shadows_none() -> None:
    new_token = token()
    tossed = f"webviz_80=other; webviz_80={new_token.cookie}"
    assert login.grant_of(access(new_token), headers(tossed), 80)
    assert login.grant_of(
        access(new_token), headers("webviz_80=other", f"webviz_80={new_token.cookie}"), 80
    )


def test_the_highest_role_of_several_cookies_counts() -> None:
    tokens = [token(role.label, role) for role in (Role.OPERATOR, Role.OWNER, Role.WATCHER)]
    cookies = "; ".join(f"webviz_80={each.cookie}" for each in tokens)
    grant = login.grant_of(access(*tokens), headers(cookies), 80)
    assert grant is not None
    assert grant.role is Role.OWNER


def test_a_request_with_all_its_cookies_costs_little_beside_many_tokens() -> None:
    rights = access(*(token(str(number)) for number in range(MAX_TOKENS)))
    cookies = headers("; ".join(["webviz_80=" + "a" * 64] * login.MAX_COOKIES))
    start = time.process_time()
    for _ in range(100):
        assert login.grant_of(rights, cookies, 80) is None
    assert time.process_time() - start < 0.2  # 2 ms each; comparing with every token took 11 ms


def test_the_page_without_access_sets_commands_apart() -> None:
    assert b"<p>Run <code>a &lt;b</code> or <code>c</code>.</p>" in login.page("Run `a <b` or `c`.")


def test_a_link_leads_to_an_address_without_the_token() -> None:
    new_token = token(days=1.0)
    answer = login.welcome(
        access(new_token), f"/?fixedDpr=1&operate={new_token.secret}", TYPED, 80, is_secure=False
    )
    assert answer is not None
    assert (answer.status, answer.headers["Location"]) == (303, "./?fixedDpr=1")
    assert answer.headers["Set-Cookie"] == (
        f"webviz_80={new_token.cookie}; Max-Age=86400; HttpOnly; SameSite=Strict"
    )
    assert new_token.secret not in str(answer)


def test_with_tls_the_cookie_is_sent_by_tls_only() -> None:
    new_token = token()
    answer = login.welcome(
        access(new_token), f"/?operate={new_token.secret}", TYPED, 80, is_secure=True
    )
    assert answer is not None
    assert answer.headers["Set-Cookie"].endswith("; SameSite=Strict; Secure")


@pytest.mark.parametrize(
    "query",
    [
        "",
        "operate=",
        "own=SECRET",
        "operate=SECRET&operate=SECRET",
        "operate=SECRET&watch=SECRET",
        "operate=%00SECRET",
        "operate=SECRET%00",
        "OPERATE=SECRET",
        "&".join(["a=b"] * 30) + "&operate=SECRET",
    ],
)
def test_a_link_that_is_not_exactly_right_is_refused(query: str) -> None:
    new_token = token()
    path = "/?" + query.replace("SECRET", new_token.secret)
    assert login.welcome(access(new_token), path, headers(), 80, is_secure=False) is None
