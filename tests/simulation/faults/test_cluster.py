"""A campaign with the workers of a Dask cluster, over TLS on the loopback, has the outcomes of one on this machine."""

import contextlib
import os
import shutil
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import pytest

from bench.faults.campaign import run_seed
from bench.robot_corpus import robot_names
from bench.runs.address import check_address
from bench.runs.identity import UNKNOWN, Identity, identity
from bench.runs.runner import Processes

ROOT = Path(__file__).parents[3]
SEEDS = range(12)
LIMIT = 120.0
"""s for the scheduler and its workers to start; 5 s on an idle machine"""


def program(folder, module, *arguments, **environment):
    """A process of the cluster, ended with the test."""
    path = os.pathsep.join([str(ROOT), *filter(None, sys.path)])
    tls = ["--tls-ca-file", "ca.pem", "--tls-cert", "cert.pem", "--tls-key", "key.pem"]
    command = [sys.executable, "-m", f"distributed.cli.{module}", *tls, "--no-dashboard", *arguments]
    log = (folder / f"{module}.log").open("a")
    return subprocess.Popen(
        command, cwd=folder, env={**os.environ, "PYTHONPATH": path, **environment}, stdout=log, stderr=log
    )


def worker(folder, name, **environment):
    arguments = ["--scheduler-file", "scheduler.json", "--name", name, "--nthreads", "1", "--no-nanny"]
    return program(folder, "dask_worker", "--protocol", "tls", "--host", "127.0.0.1", *arguments, **environment)


def certificate(folder):
    """One self-signed certificate for all processes."""
    made = ["-keyout", "key.pem", "-out", "cert.pem", "-days", "1", "-subj", "/CN=robot_control test"]
    command = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", *made]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    shutil.copy(folder / "cert.pem", folder / "ca.pem")


def other_robots(folder):
    """A folder of robots that this machine does not have."""
    (folder / "robots" / "own").mkdir(parents=True)
    (folder / "robots" / "TRUTH.json").write_text('{"own": {}}')
    (folder / "robots" / "own" / "robot.urdf").write_text("<robot/>")
    return str(folder / "robots")


@pytest.fixture
def cluster(tmp_path):
    """Starts a scheduler, two workers, and a worker with other robots."""
    pytest.importorskip("distributed", reason="python3-distributed is not installed: scripts/setup --cluster")
    if shutil.which("openssl") is None:
        pytest.skip("no openssl to make a certificate with")
    if identity().commit == UNKNOWN:
        pytest.skip("no git checkout, so workers cannot be compared with it")
    certificate(tmp_path)
    address = ["--protocol", "tls", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", "scheduler.json"]
    processes = [program(tmp_path, "dask_scheduler", *address)]
    try:
        end = time.monotonic() + LIMIT
        while not (tmp_path / "scheduler.json").exists():
            assert time.monotonic() < end, (tmp_path / "dask_scheduler.log").read_text()
            time.sleep(0.1)
        processes += [worker(tmp_path, "one"), worker(tmp_path, "two")]
        processes.append(worker(tmp_path, "different", ROBOT_CORPUS=other_robots(tmp_path)))
        yield tmp_path, processes
    finally:
        for process in processes:
            process.kill()
            process.wait()


def test_a_campaign_on_a_cluster_that_loses_a_worker_has_the_same_outcomes_as_alone(cluster):
    from distributed import Client

    from bench.runs.cluster import Cluster, _security

    folder, processes = cluster
    address = next(line for line in (folder / "scheduler.json").read_text().split('"') if line.startswith("tls://"))
    with contextlib.closing(Client(address, security=_security(address, folder))) as client:
        client.wait_for_workers(3, timeout=LIMIT)
        names = {info["name"]: at for at, info in client.scheduler_info()["workers"].items()}
    one = partial(run_seed, robots=robot_names())
    outcomes, lines = [], []
    with Cluster(address, tls=folder) as runner:
        for outcome in runner.outcomes(one, SEEDS, lines.append):
            if not outcomes:
                processes[1].kill()  # the worker "one"
            outcomes.append(outcome)
    assert outcomes == list(Processes().outcomes(one, SEEDS, print))
    said = "\n".join(lines)
    assert f"worker {names['one']} is lost: its 1 are repeated" in said
    assert f"worker {names['different']} is refused: its robot descriptions have the checksum" in said
    assert names["two"] not in said


HERE = Identity("0" * 40, "a" * 64, "b" * 64)


@pytest.mark.parametrize(
    ("other", "difference"),
    [
        (Identity("1" * 40, HERE.robots, HERE.reference), f"its commit is {'1' * 40}, here it is {'0' * 40}"),
        (Identity(HERE.commit + "-dirty", HERE.robots, HERE.reference), "its commit is"),
        (Identity(HERE.commit, "c" * 64, HERE.reference), "robot descriptions have the checksum cccccccccccc, those"),
        (Identity(HERE.commit, HERE.robots, "c" * 64), "reference run has the checksum cccccccccccc, the one here bbb"),
    ],
)
def test_a_process_with_another_identity_is_different(other, difference):
    assert difference in HERE.difference(other)
    assert HERE.difference(HERE) == ""


@pytest.mark.parametrize(
    "address", ["tls://far.example:8786", "tcp://127.0.0.1:8786", "tcp://[::1]:1", "tcp://localhost:1"]
)
def test_an_encrypted_or_local_scheduler_is_accepted(address):
    check_address(address, insecure=False)


def test_plain_text_beyond_the_loopback_needs_consent():
    with pytest.raises(ValueError, match="--insecure"):
        check_address("tcp://192.168.1.5:8786", insecure=False)
    check_address("tcp://192.168.1.5:8786", insecure=True)


@pytest.mark.parametrize("address", ["far.example:8786", "http://far.example", "tls://", ""])
def test_what_is_no_address_of_a_scheduler_is_refused(address):
    with pytest.raises(ValueError, match="no address of a scheduler"):
        check_address(address, insecure=True)
