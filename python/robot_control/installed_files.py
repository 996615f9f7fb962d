"""Finds the package's files in the source tree or in the installation."""

from pathlib import Path


def share_file(name: str) -> str:
    """Absolute path of a shared file, such as `config/robot_params.yaml`.

    Raises:
        FileNotFoundError: neither beside the sources nor installed.
    """
    here = Path(__file__).resolve()
    candidates = [here.parents[2] / name]  # python/robot_control/ in the source tree
    candidates += [parent / "share" / "robot_control" / name for parent in here.parents]
    for path in candidates:
        if path.is_file():
            return str(path)
    raise FileNotFoundError(f"{name}: not found in {candidates[0].parents[1]} nor in any share/robot_control above")
