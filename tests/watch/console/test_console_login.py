"""Messages, users, sessions and origins: what a hostile page or a stranger can send, without a server."""

import contextlib
import json
import random
import stat
from dataclasses import dataclass

import pytest
from robot_control.settings.addresses import PUBLISHED, AddressError, interface_of, origins_of, require_protection
from robot_control.watch.console.authority import Role
from robot_control.watch.console.calls import check_call
from robot_control.watch.console.messages import BURST, MAX_SIZE, RATE, MessageError, Rate, parse
from robot_control.watch.console.room import gives_way
from robot_control.watch.console.sessions import LIFE, MAX_SESSIONS, PERIOD, TRIES_OF_USER, Sessions, Tries
from robot_control.watch.console.users import LINK_LIFE, Users, UsersError

DRIVE = {"type": "drive", "number": 1, "sent": 2.5, "held": True, "linear": 1.0, "angular": -0.5, "lateral": 0.5}


def test_a_message_of_the_schema_is_read():
    assert parse(json.dumps(DRIVE)) == DRIVE


@pytest.mark.parametrize(
    "change",
    [
        {"type": "rosservice"},
        {"type": None},
        {"linear": 1.01},
        {"linear": "1"},
        {"linear": True},
        {"angular": None},
        {"number": -1},
        {"number": 1.5},
        {"held": 1},
        {"sent": -1},
        {"topic": "/cmd_vel"},
        {"sent": 10**400},
        {"type": "pong", "name": "\ud800"},
    ],
)
def test_what_the_schema_does_not_name_is_refused(change):
    with pytest.raises(MessageError):
        parse(json.dumps({**DRIVE, **change}))


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        "1",
        "null",
        '"drive"',
        "[" * MAX_SIZE,
        '{"a":' * 10_000,
        json.dumps(DRIVE).replace("2.5", "NaN"),
        json.dumps(DRIVE).replace("2.5", "1e999"),
        json.dumps(DRIVE).replace("2.5", "9" * 5000),
    ],
)
def test_what_is_no_message_is_refused(text):
    with pytest.raises(MessageError):
        parse(text)


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("__class__", {}),
        ("step", {}),
        ("step", {"cycles": 1, "more": 2}),
        ("step", {"cycles": True}),
        ("path_points", {"speed": 1, "points": [[0, 0], [0, 1e400]]}),
        ("path_points", {"speed": 1, "points": [[0, 0]]}),
    ],
)
def test_a_call_that_is_none_is_refused(name, arguments):
    with pytest.raises(MessageError):
        check_call(name, arguments)


def test_random_bytes_raise_nothing_else():
    numbers = random.Random(3)
    whole = json.dumps(DRIVE)
    for _ in range(5000):
        cut = numbers.randrange(len(whole))
        text = whole[:cut] + chr(numbers.randrange(1, 0x2FF)) + whole[cut + numbers.randrange(3) :]
        with contextlib.suppress(MessageError):
            assert parse(text)["type"] == "drive", text


def test_a_flood_is_bounded_and_the_usual_pace_is_not():
    rate = Rate(0.0)
    assert sum(rate.admits(0.001 * step) for step in range(10_000)) <= BURST + 10 * RATE
    rate = Rate(0.0)
    assert all(rate.admits(0.02 * step) for step in range(10_000))


@pytest.fixture
def users(tmp_path):
    return Users(tmp_path / "new" / "users.json")


def refused(users, name, password):
    with pytest.raises(UsersError, match="name or password is wrong"):
        users.check(name, password)
    return True


def test_a_user_sets_a_password_with_a_link_that_is_good_once(users):
    link = users.add("anna", Role.OPERATE, now=0.0)
    assert link not in users.path.read_text()
    assert refused(users, "anna", "")
    assert users.set_password(link, "long enough", 1.0).name == "anna"
    assert users.check("anna", "long enough").role is Role.OPERATE
    assert refused(users, "anna", "long enougH")
    assert refused(users, "berta", "long enough")
    with pytest.raises(UsersError, match="wrong, used"):
        users.set_password(link, "another password", 2.0)


def test_an_expired_link_and_a_wrong_one_set_nothing(users):
    link = users.add("anna", Role.OPERATE, now=0.0)
    for text, now in ((link, LINK_LIFE), (link + "x", 1.0), ("", 1.0)):
        with pytest.raises(UsersError, match="older than a day"):
            users.set_password(text, "long enough", now)
    with pytest.raises(UsersError, match="10 to 256"):
        users.set_password(link, "short", 1.0)


def test_only_this_account_reads_the_file(users):
    users.add("anna", Role.WATCH, 0.0)
    assert stat.S_IMODE(users.path.stat().st_mode) == 0o600
    users.path.chmod(0o640)
    with pytest.raises(UsersError, match="chmod 600"):
        users.all()


@pytest.mark.parametrize("name", ["", "a b", "<script>", "../x", "a" * 33, "a\n", ".x"])
def test_names_are_plain(users, name):
    with pytest.raises(UsersError, match="letters"):
        users.add(name, Role.WATCH, 0.0)


@pytest.mark.parametrize("text", ["", "{}", '[{"name":"a"}]', '[{"name":"a","role":"root"}]', "[1]"])
def test_a_broken_file_is_refused(users, text):
    users.path.parent.mkdir()
    users.path.touch(mode=0o600)
    users.path.write_text(text)
    if text == "{}":
        assert users.all() == {}
        return
    with pytest.raises(UsersError, match=r"is not a file of console_users\.py"):
        users.all()


def test_a_session_ends_by_time_and_by_logout():
    sessions = Sessions()
    cookie = sessions.begin("anna", Role.OPERATE, 0.0)
    assert sessions.of(cookie + "x", 1.0) is None
    assert sessions.of(None, 1.0) is None
    assert sessions.of(cookie, LIFE - 1.0) is not None
    assert sessions.of(cookie, LIFE) is None
    session = sessions.of(cookie, 1.0)
    sessions.end(session)
    assert not sessions.lives(session, 1.0)


def test_two_hundred_logins_of_one_user_end_sessions_of_that_user_alone_and_never_the_one_that_drives():
    sessions = Sessions()
    other, driving = (sessions.begin(name, Role.OPERATE, 0.0) for name in ("berta", "anna"))
    kept = sessions.of(driving, 1.0)
    cookies = [sessions.begin(name, Role.WATCH, 1.0, kept) for name in ("anna", "wanda") for _ in range(200)]
    assert sessions.of(other, 1.0)
    assert sessions.lives(kept, 1.0)
    assert sum(sessions.of(cookie, 1.0) is not None for cookie in cookies) == 2 * MAX_SESSIONS
    assert sessions.of(cookies[-1], 1.0)


def test_a_changed_role_ends_the_session():
    sessions = Sessions()
    anna, berta = (sessions.begin(name, Role.MAINTAIN, 0.0) for name in ("anna", "berta"))
    sessions.check_roles({"anna": Role.MAINTAIN, "berta": Role.WATCH})
    assert sessions.of(anna, 1.0)
    assert sessions.of(berta, 1.0) is None


def test_failed_logins_are_limited_per_user_and_per_address():
    tries = Tries()
    for at in range(TRIES_OF_USER):
        assert tries.admit("anna", f"10.0.0.{at}", float(at)) == 0.0
    assert tries.admit("anna", "10.0.0.99", 10.0) == pytest.approx(PERIOD - 10.0)
    assert tries.admit("berta", "10.0.0.99", 10.0) == 0.0
    assert tries.admit("anna", "10.0.0.99", PERIOD + 5.0) == 0.0
    for number in range(20):
        tries.admit(f"user {number}", "10.0.0.7", 1000.0)
    assert tries.admit("carla", "10.0.0.7", 1001.0) > 0.0


def test_of_ninety_guesses_at_once_no_more_are_admitted_than_one_after_another():
    tries = Tries()
    assert sum(tries.admit("anna", "10.0.0.7", 0.0) == 0.0 for _ in range(90)) == TRIES_OF_USER


def test_logins_that_succeed_are_never_limited():
    tries = Tries()
    for at in range(100):
        assert tries.admit("anna", "10.0.0.7", float(at)) == 0.0
        tries.succeed("anna", "10.0.0.7", float(at))
    assert not any(tries._times.values())


@dataclass
class Place:
    user: str
    role: Role


def test_twenty_pages_of_one_watcher_keep_nobody_out_and_cost_that_watcher_alone():
    anna, *wandas = [Place("anna", Role.MAINTAIN), *(Place("wanda", Role.WATCH) for _ in range(19))]
    for newcomer in (("wanda", Role.WATCH), ("berta", Role.WATCH), ("carla", Role.MAINTAIN), ("dora", Role.OPERATE)):
        assert gives_way([anna, *wandas], *newcomer) is wandas[0]
    assert gives_way([anna], "wanda", Role.WATCH) is None
    assert gives_way([anna], "carla", Role.MAINTAIN) is None


def test_only_own_names_and_origins_count():
    origins = origins_of("127.0.0.1", 8080, [], tls=False, further=["https://console.example"])
    assert origins.host_is_own("localhost:8080")
    assert origins.host_is_own("console.example")
    assert origins.origin_is_own("http://127.0.0.1:8080", "127.0.0.1:8080")
    for host in (None, "", "evil.example:8080", "127.0.0.1", "127.0.0.1:80", "127.0.0.1:8080.evil.example"):
        assert not origins.host_is_own(host)
    for origin in (None, "null", "", "https://127.0.0.1:8080", "http://evil.example", "http://localhost:8080"):
        assert not origins.origin_is_own(origin, "127.0.0.1:8080")


@pytest.mark.parametrize("address", ["0.0.0.0", "192.0.2.1", "::", "robot.local"])
def test_an_address_that_others_reach_needs_users_and_tls(address):
    with pytest.raises(AddressError, match=r"users .* and TLS"):
        require_protection(address, users=False, tls=False)
    with pytest.raises(AddressError, match="needs TLS"):
        require_protection(address, users=True, tls=False)
    require_protection(address, users=True, tls=True)
    require_protection("127.0.0.5", users=False, tls=False)


def test_only_the_image_listens_beyond_the_loopback_and_to_no_further_name():
    for environment in ({}, {PUBLISHED: ""}, {PUBLISHED: "0"}, {PUBLISHED: "true"}):
        assert interface_of("127.0.0.1", environment) == "127.0.0.1"
    assert interface_of("127.0.0.1", {PUBLISHED: "1"}) == "0.0.0.0"
    assert interface_of("192.0.2.1", {PUBLISHED: "1"}) == "192.0.2.1"
