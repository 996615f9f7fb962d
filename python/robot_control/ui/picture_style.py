"""How the project's pictures look: a style sheet of matplotlib."""

from pathlib import Path

STYLE = Path(__file__).with_name("picture.mplstyle")
