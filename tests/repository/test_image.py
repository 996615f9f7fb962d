"""The Dockerfile's instructions, followed in clean roots by debootstrap.

A container engine is not run: namespaces, chroot and cp stand for what it does. Needs root, and a network for packages.
"""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LARGEST = 1.6e9
"""bytes of the image"""
PORT = 8080
ENGINE = {"PATH": "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root"}
CONTAINER = """
root=$1 user=$2 folder=$3; shift 3
mount -t proc proc "$root/proc"
mount -t tmpfs -o size=64m,mode=1777 shm "$root/dev/shm"  # the size that a container engine gives
ip link set lo up 2>/dev/null
exec chroot --userspec="$user" "$root" /bin/sh -c 'cd "$0" && exec "$@"' "$folder" "$@"
"""


def instructions():
    """(word, rest) of each instruction."""
    text = re.sub(r"^#.*\n", "", (ROOT / "Dockerfile").read_text(), flags=re.MULTILINE)
    return [line.split(maxsplit=1) for line in text.replace("\\\n", "").splitlines() if line]


def left_out(folder, names):
    """Those names in a folder that .dockerignore leaves out: `**/NAME` everywhere, NAME in the first folder."""
    lines = (ROOT / ".dockerignore").read_text().split()
    everywhere = [line.removeprefix("**/") for line in lines if line.startswith("**/")]
    return {name for name in names if name in everywhere or (Path(folder) == ROOT and name in lines)}


class Stage:
    """One stage: a root and what its instructions have set."""

    def __init__(self, root):
        self.root, self.folder, self.user, self.entry = root, "/", "root", []
        self.environment = dict(ENGINE)

    def inside(self, *command, network=True):
        """The call of a command in the root, in namespaces of its own."""
        spaces = ["--mount", "--pid", "--fork", "--kill-child", *([] if network else ["--net"])]
        own = ["/bin/sh", "-ec", CONTAINER, "container", str(self.root), self.user, self.folder]
        return ["unshare", *spaces, *own, *command]

    def path(self, name):
        return self.root / (Path(self.folder) / name).relative_to("/")

    def follow(self, word, rest, stages):
        if word == "WORKDIR":
            self.folder = rest
            self.path("").mkdir(parents=True, exist_ok=True)
        elif word == "COPY":
            *source, origin, target = rest.split()
            if source:
                copy(stages[source[0].removeprefix("--from=")].root / origin.lstrip("/"), self.path(target))
            else:
                assert (origin, target) == (".", ".")
                shutil.copytree(ROOT, self.path("."), symlinks=True, dirs_exist_ok=True, ignore=left_out)
        elif word == "RUN":
            done = subprocess.run(
                self.inside("/bin/sh", "-c", rest), env=self.environment, capture_output=True, text=True, check=False
            )
            assert done.returncode == 0, f"{rest}\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}"
            print(*re.findall(r"built in \d+ s", done.stdout))  # the first contact, beyond downloading and unpacking
        elif word == "USER":
            self.user = rest
        elif word == "ENV":
            self.environment |= dict(pair.split("=", 1) for pair in rest.split())
        elif word == "ENTRYPOINT":
            self.entry = json.loads(rest)
        else:
            assert word == "EXPOSE", word


def copy(source, target):
    target.parent.mkdir(parents=True, exist_ok=True)
    subprocess.run(["cp", "--archive", "--reflink=auto", source, target], check=True)


@pytest.fixture(scope="module")
def image(tmp_path_factory):
    """The last stage, with every instruction followed."""
    if os.geteuid() != 0 or not shutil.which("debootstrap"):
        pytest.skip("needs root, and debootstrap of scripts/setup --image")
    folder = tmp_path_factory.mktemp("image")
    debian = folder / "debian"
    command = ["debootstrap", "--variant=minbase", "bookworm", str(debian)]
    made = subprocess.run(command, capture_output=True, text=True, check=False)
    if made.returncode != 0:
        pytest.skip(f"debootstrap makes no root here: {made.stdout[-300:]}{made.stderr[-300:]}")
    for name in ("resolv.conf", "hosts"):  # a container engine writes both
        shutil.copy(Path("/etc", name), debian / "etc")
    stages, stage = {}, None
    for word, rest in instructions():
        if word == "FROM":
            base, _, name = rest.partition(" AS ")
            assert base == "debian:12"
            copy(debian, folder / (name or "image"))
            stages[name] = stage = Stage(folder / (name or "image"))
        else:
            stage.follow(word, rest, stages)
    yield stage
    shutil.rmtree(folder)


ASK = """
import http.client, sys
address, host, path = sys.argv[1:]
connection = http.client.HTTPConnection(address, 8080, timeout=20)
connection.request("GET", path, headers={"Host": host})
print(connection.getresponse().status)
"""


@pytest.mark.nightly
def test_the_image_is_small_and_shows_a_robot_beyond_its_loopback(image):
    size = subprocess.run(["du", "-sx", "--block-size=1", image.root], capture_output=True, text=True, check=True)
    print("bytes of the image:", size.stdout.split()[0])
    assert int(size.stdout.split()[0]) <= LARGEST

    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    command = image.inside(*image.entry, "--scene", "room", network=False)
    with subprocess.Popen(command, env=image.environment | {"HOME": f"/home/{image.user}"}, **pipes) as container:
        line = container.stdout.readline()
        assert f"open  http://127.0.0.1:{PORT}/?token=" in line, line + container.stdout.read()
        path = "/" + line.split("/")[-1].strip()

        def answer(address, host, path=path):
            """The status of the page, in the container's network."""
            inside = ["nsenter", f"--net=/proc/{container.pid}/ns/net", sys.executable, "-c", ASK, address, host, path]
            return int(subprocess.run(inside, capture_output=True, text=True, check=True).stdout)

        # 127.0.0.2 is an address of its own: what listens on 127.0.0.1 alone does not answer there.
        for address, name in (("127.0.0.2", "127.0.0.1"), ("127.0.0.1", "localhost")):
            assert answer(address, f"{name}:{PORT}") == 303  # to the page
        assert answer("127.0.0.2", f"127.0.0.1:{PORT}", path[:-1] + "x") == 403  # that token is wrong
        assert answer("127.0.0.2", f"127.0.0.2:{PORT}") == 421  # that host is not the console's
        (first,) = Path(f"/proc/{container.pid}/task/{container.pid}/children").read_text().split()
        os.kill(int(first), signal.SIGTERM)
        rest = container.stdout.read()
        assert container.wait(60) == 0, rest
