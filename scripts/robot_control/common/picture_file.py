"""The file of a picture that a user names."""

from __future__ import annotations

from pathlib import Path


def check_picture(path: Path) -> None:
    """Before the work that is drawn.

    Raises:
        ValueError: no picture can be written there.
    """
    if not path.parent.is_dir():
        raise ValueError(f"{path} cannot be written: there is no folder {path.parent}")
    if path.is_dir():
        raise ValueError(f"{path} cannot be written: it is a folder")
    from matplotlib.backend_bases import FigureCanvasBase  # noqa: PLC0415 (matplotlib takes a second)

    formats = sorted(FigureCanvasBase.get_supported_filetypes())
    if path.suffix and path.suffix.removeprefix(".").lower() not in formats:
        raise ValueError(f"{path} is no picture: its suffix is none of {', '.join(formats)}")
