"""A GIF of pictures in files, for docs: ffmpeg."""

import subprocess
from collections.abc import Sequence
from pathlib import Path


def write_gif(path: Path, parts: Sequence[tuple[Path, int]], rate: int, size: tuple[int, int], colours: int) -> None:
    """One part after the other, at `rate` pictures per second, `size` px, with that many colours.

    `parts`: files of PNGs with the number as %03d, and their pictures per second.

    Raises:
        subprocess.CalledProcessError: ffmpeg refused them.
    """
    inputs = [text for pattern, of in parts for text in ("-framerate", str(of), "-i", str(pattern))]
    scaled = f"fps={rate},scale={size[0]}:{size[1]}:flags=lanczos,setsar=1"
    each = "".join(f"[{number}]{scaled}[part{number}];" for number in range(len(parts)))
    joined = "".join(f"[part{number}]" for number in range(len(parts))) + f"concat=n={len(parts)},split[c][d]"
    palette = f"[c]palettegen=max_colors={colours}[p];[d][p]paletteuse=dither=none:diff_mode=rectangle"
    command = ["ffmpeg", "-y", "-loglevel", "error", *inputs]
    subprocess.run([*command, "-filter_complex", f"{each}{joined};{palette}", str(path)], check=True)
