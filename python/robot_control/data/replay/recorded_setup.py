"""The robot and the parameters of a log, as files from which laws can be made."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from robot_control._robot_control import read_run_header
from robot_control.data.run_log import LogError, is_bag
from robot_control.files.files import utf8

Layers = tuple[str, list[tuple[str, str]]]
"""path of a parameter file, and what is laid over it"""


@dataclass(frozen=True)
class RecordedSetup:
    """Robot and parameters in the header of a log."""

    path: Path
    robot: str
    parameters: Path
    urdf: Path

    def layers(self) -> Layers:
        """The parameters of the log."""
        return str(self.parameters), [("robot.urdf", str(self.urdf))]

    def varied(self, params: Path | None, values: Sequence[tuple[str, str]]) -> Layers:
        """Layers of another file and `values` that are laid over the parameters of the log."""
        path, over = self.layers()
        return (path if params is None else str(params)), [*over, *values]


def recorded_setup(log: Path, folder: Path) -> RecordedSetup:
    """Writes the texts in the header of `log` into `folder`.

    Raises:
        InputFileError, OSError: it is no file to read.
        LogError: it is no bag.
        RuntimeError: it is no log, or a damaged one.
    """
    if not is_bag(log):
        raise LogError(f"{log} is not a ROS bag")
    header = read_run_header(utf8(log))
    parameters, urdf = folder / "parameters.yaml", folder / "robot.urdf"
    parameters.write_text(header["parameters"])
    urdf.write_text(header["urdf"])
    return RecordedSetup(log, header["robot"], parameters, urdf)
