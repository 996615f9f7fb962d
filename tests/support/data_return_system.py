"""Logs, a queue and a remote in memory for the tests of data return, in virtual time."""

import os

from robot_control.data.data_return.parts import MANIFEST, put_together
from robot_control.data.data_return.queue_file import QueueFile
from robot_control.data.data_return.sender import Sender
from robot_control.data.data_return.settings import Settings

from bench.data_return.virtual_remote import VirtualRemote

DAY = 2e9  # s; all files are older
PART = 1000  # bytes, in place of 4 MiB
OPEN_BAG = b"#ROSBAG V2.0\n" + b"index_pos=" + bytes(8) + b"rows"
WHOLE_BAG = b"#ROSBAG V2.0\n" + b"index_pos=" + b"\x01" + bytes(7) + b"rows"


def use_small_parts(monkeypatch):
    for module in ("plan", "parts"):
        monkeypatch.setattr(f"robot_control.data.data_return.{module}.PART_BYTES", PART)


def write(path, content, at=1e9):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)
    os.utime(path, (at, at))


class System:
    """Logs, a queue and a far side; the program can end at any moment and begins again."""

    def __init__(self, tmp_path, files, far=None, **values):
        self.folder, self.sources = tmp_path, files
        for number, (name, content) in enumerate(files.items()):
            write(tmp_path / "logs" / name, content, 1e9 + number)
        self.settings = Settings(folder=str(tmp_path / "logs"), queue_folder=str(tmp_path / "queue"), **values)
        self.far = far or VirtualRemote()
        self.said = []
        self.now = 0.0
        self.begin()

    def begin(self):
        self.settings.queue.mkdir(exist_ok=True)
        self.queue = QueueFile(self.settings.queue)
        self.sender = Sender(self.settings, self.queue, self.far, self.said.append)

    def step(self, reason_to_wait=""):
        self.now += 1.0
        return self.sender.step(self.now, DAY, reason_to_wait)

    @property
    def done(self):
        return bool(self.queue.entries) and all(each.returned for each in self.queue.entries.values())

    def finish(self, steps=2000):
        for _ in range(steps):
            self.step()
            if self.done:
                return
        raise AssertionError(self.sender.progress)

    def written(self, folder):
        for name, data in self.far.content.items():
            write(folder / name, data)
        return folder

    def verify_far_side(self):
        out = {}
        for name in [name for name in self.far.content if name.endswith(MANIFEST)]:
            begin = name.removesuffix(MANIFEST)
            path = self.folder / "one"
            with path.open("wb") as file:
                content = put_together(lambda wanted, begin=begin: self.far.content[begin + wanted], file)
            out[content["name"]] = path.read_bytes()
        assert out == self.sources


def check_nothing_is_lost(system):
    """Each file that is no more on the robot is whole on the far side."""
    for name, content in system.sources.items():
        path = system.folder / "logs" / name
        if path.exists():
            assert path.read_bytes() == content
            continue
        (begin,) = {key.rpartition("/")[0] for key in system.far.content if key.split("Z-")[1].startswith(path.name)}
        assert put_together(lambda wanted, begin=begin: system.far.content[f"{begin}/{wanted}"], None)["name"] == name
