import pytest

from bench import loops
from bench.rows import bounded, plain

TABLE = """\
Ir
167,929,912 (100.0%)  PROGRAM TOTALS

Ir                    file:function
113,896,451 (67.82%)  ???:robot_control::MujocoPlant::simulate(robot_control::JointCommand) [/a/bench_loops]
 75,890,511 (45.19%)  ???:mj_step1 [/usr/lib/libmujoco.so.2.2.2]
 63,971,037 (38.09%)  ???:mj_step1_of_another [/usr/lib/libmujoco.so.2.2.2]
 30,367,721 ( 9.08%)  ???:mj_step2
"""


def test_physics_is_counted_by_the_names_of_its_functions():
    assert loops.counts(TABLE) == (167_929_912, 75_890_511 + 30_367_721)
    with pytest.raises(RuntimeError, match=r"no .*mj_step2"):
        loops.counts(TABLE.replace("mj_step2", "mj_step3"))


@pytest.mark.parametrize(("share", "beside", "good"), [(0.75, 40, True), (0.74, 40, False), (0.8, 40.1, False)])
def test_each_bound_counts_and_no_other_figure(monkeypatch, share, beside, good):
    rows = [plain("a figure", 7.0, "s"), bounded("lowest share", share, "", 0.75)]
    monkeypatch.setattr(loops, "speed", lambda *_: rows)
    monkeypatch.setattr(loops, "instructions", lambda *_: [bounded("beside", beside, "million", 40.0)])
    result, met = loops.bench(["speed", "instructions"], None, None, lambda _text: None)
    assert met is good
    assert [row["name"] for row in result["rows"]] == ["a figure", "lowest share", "beside"]
