"""A gait that a user describes in the parameters."""

import pytest
from robot_control import ClosedLoop
from robot_control.data.replay.main import EXACT
from robot_control.data.replay.main import main as replay
from robot_control.installed_files import share_file

AMBLE = {"name": "amble", "period": 0.6, "duty": 0.75, "phases": [0.5, 0.0, 0.25, 0.75], "lift": 0.06}


def test_it_walks_and_its_log_is_computed_again_bit_for_bit(tmp_path):
    loop = ClosedLoop({"leg_controller": {"gait_1": AMBLE}}, urdf=share_file("urdf/quadbot.urdf"))
    loop.log_into(tmp_path)
    loop.set_gait("amble")
    loop.run(4.0, (0.3, 0.0))
    walk = loop.run(3.0, (0.3, 0.0))
    loop.end_log()
    with pytest.raises(SystemExit) as ended:
        replay([str(tmp_path / "run.bag")])
    assert ended.value.code == EXACT
    assert walk["truth_linear"].mean() == pytest.approx(0.3, rel=0.03)
    assert set(walk["legged_gait"]) == {4.0}
    assert not walk["permit_causes"].any()
    with pytest.raises(ValueError, match="'moonwalk'; set one of auto, trot, walking_trot, crawl, amble"):
        loop.set_gait("moonwalk")
