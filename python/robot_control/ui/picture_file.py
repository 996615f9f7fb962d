"""The file of a picture that a user names."""

from collections.abc import Sequence
from pathlib import Path

from robot_control.files.output_files import check_outputs


def check_picture(path: Path, inputs: Sequence[Path | None] = ()) -> None:
    """Checks the file before the work whose result is drawn.

    Raises:
        ValueError: no picture can be written there, or it is one of the inputs.
    """
    check_outputs([path], inputs)
    from matplotlib.backend_bases import FigureCanvasBase  # noqa: PLC0415 (matplotlib takes a second)

    formats = sorted(FigureCanvasBase.get_supported_filetypes())
    if path.suffix.removeprefix(".").lower() not in formats:
        raise ValueError(f"{path} is not a picture: its suffix must be one of {', '.join(formats)}")
