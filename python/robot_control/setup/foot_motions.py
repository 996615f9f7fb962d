"""The motion of a foot when one joint of its leg turns, in words."""

from collections.abc import Sequence

import numpy as np

from robot_control import _robot_control
from robot_control.settings.parameter_layers import layered

WAYS = (("forward", "backward"), ("to the left", "to the right"), ("up", "down"))


def foot_motions(urdf: str, angles: Sequence[float], names: Sequence[str], turns: Sequence[float] = ()) -> list[str]:
    """The motion when each joint turns from `angles`, rad, in its positive direction, or in that of `turns`."""
    turns = turns or [1.0] * len(names)
    try:
        slopes = np.asarray(_robot_control.legs(*layered(None, urdf)).jacobian(np.asarray(angles)))
    except Exception:
        return [f"towards {'greater' if turn > 0 else 'smaller'} angles (about its axis in the URDF)" for turn in turns]
    words = []
    for index, turn in enumerate(turns):
        slope = np.sign(turn) * slopes[index // 3, :, index % 3]
        axis = int(abs(slope).argmax())
        words.append(f"so that its foot goes {WAYS[axis][int(slope[axis] < 0)]}")
    return words
