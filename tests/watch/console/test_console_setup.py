"""How console.py and console_users.py start, and what they refuse: one message, exit code 2."""

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPTS = Path(__file__).parents[3] / "scripts/console"
AIOHTTP = pytest.mark.skipif(importlib.util.find_spec("aiohttp") is None, reason="no aiohttp: scripts/setup --console")


def run(script, *arguments, home):
    environment = {**os.environ, "ROS_HOME": str(home), "ROS_MASTER_URI": "http://127.0.0.1:1"}
    command = [sys.executable, str(SCRIPTS / script), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=60, env=environment)


def refusal(*arguments, home):
    done = run("console.py", *arguments, home=home)
    assert done.returncode == 2, done.stderr
    assert done.stderr.count("\n") == 1
    assert "Traceback" not in done.stderr
    return done.stderr


@AIOHTTP
def test_an_address_that_others_reach_is_refused_without_users_or_tls(tmp_path):
    assert "users (console_users.py add) and TLS (--tls)" in refusal("--address", "0.0.0.0", home=tmp_path)
    assert "needs users" in refusal("--address", "0.0.0.0", "--tls", home=tmp_path)
    run("console_users.py", "add", "anna", home=tmp_path)
    assert "needs TLS" in refusal("--address", "0.0.0.0", home=tmp_path)


@AIOHTTP
def test_wrong_files_are_refused_with_their_name(tmp_path):
    config, users = tmp_path / "own.yaml", tmp_path / "robot_control/console_users.json"
    config.write_text("distance: -1")
    assert f"{config}: distance = -1: must be a number from 0.001 to 1000" in refusal("--config", config, home=tmp_path)
    assert "--cert" in refusal("--cert", tmp_path / "none.pem", home=tmp_path)
    assert "--origin console.example" in refusal("--origin", "console.example", home=tmp_path)
    users.parent.mkdir(exist_ok=True)
    users.touch(mode=0o644)
    assert f"chmod 600 {users}" in refusal(home=tmp_path)


@AIOHTTP
def test_a_certificate_is_made_once_and_its_key_is_for_this_account_alone(tmp_path):
    from robot_control.watch.console.tls import context_of, fingerprint, self_made

    certificate, key = self_made(tmp_path, ["localhost", "127.0.0.1", "::1"])
    assert key.stat().st_mode & 0o077 == 0
    assert self_made(tmp_path, ["localhost"]) == (certificate, key)
    assert len(fingerprint(certificate).split(":")) == 32
    context_of(certificate, key)


def test_users_are_added_listed_and_removed(tmp_path):
    added = run("console_users.py", "add", "anna", "--role", "operate", home=tmp_path)
    assert "/login#" in added.stdout
    assert run("console_users.py", "list", home=tmp_path).stdout == "anna\toperate\thas set no password yet\n"
    assert run("console_users.py", "remove", "anna", home=tmp_path).returncode == 0
    again = run("console_users.py", "remove", "anna", home=tmp_path)
    assert (again.returncode, again.stderr.count("\n")) == (2, 1)
    bad = run("console_users.py", "add", "<b>", home=tmp_path)
    assert (bad.returncode, "letters" in bad.stderr) == (2, True)


@AIOHTTP
def test_without_a_master_it_ends_with_a_message(tmp_path):
    done = run("console.py", home=tmp_path)
    assert done.returncode == 1
    assert "no ROS master at http://127.0.0.1:1" in done.stderr


def test_every_library_of_the_page_is_one_of_the_list():
    """A page imports its own files and those of the list; nothing comes from elsewhere."""
    import re

    files = pytest.importorskip("aiohttp") and importlib.import_module("robot_control.watch.console.files")
    own = {f"/{name}" for name in files.FILES}
    for path in files.OWN.glob("*.*"):
        text = path.read_text()
        for target in re.findall(r'(?:from|import|import\(|src=|href=)\s*"([^"]+)"', text):
            assert target in own, (path, target)
        assert not re.search(r"innerHTML|outerHTML|insertAdjacent|document\.write|\beval\(|style=|onclick=", text), path
    missing = [name for name, path in files.FILES.items() if not path.is_file()]
    assert not missing or pytest.skip("scripts/setup --console")
