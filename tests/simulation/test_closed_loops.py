"""Many loops in threads, copies of loops and their pickles."""

import copy
import pickle
import sys
import threading

import numpy as np
import pytest
from robot_control import ClosedLoop, ClosedLoops, DriverError, RobotError
from robot_control.installed_files import share_file

from bench.robot_corpus import DIFFBOT, QUADBOT, urdf_of

COLUMNS = ("truth_x", "truth_yaw", "gyro_z", "estimate_x_variance", "left_wheel_joint_effort_command", "permit_action")
N, CYCLES, STEPS = 5, 20, 40
FOUR_WHEELS = "jackal"


def commands_at(step, n=N):
    """Each loop gets other speeds, some of them no message."""
    random = np.random.default_rng(step)
    commands = random.uniform((-0.5, -1.0), (0.8, 1.0), (n, 2)) * (step > 10)
    commands[random.random(n) < 0.2] = np.nan
    return commands


def one_by_one(loop, i, steps=range(STEPS), columns=COLUMNS):
    """The rows that loop i of many has to give, from a ClosedLoop."""
    rows = []
    for step in steps:
        command = commands_at(step)[i]
        if np.isfinite(command).all():
            loop.command(*command)
        log = loop.step(CYCLES, columns)
        rows.append([log[name][-1] for name in columns])
    return np.array(rows)


def together(loops, steps=range(STEPS), columns=COLUMNS):
    return np.array([loops.step(CYCLES, commands_at(step)[: len(loops)], columns) for step in steps])


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_each_loop_gives_the_bits_of_its_closed_loop(threads):
    rows = together(ClosedLoops(N, threads, seed=7))
    for i in range(N):
        np.testing.assert_array_equal(rows[:, i], one_by_one(ClosedLoop(seed=7 + i), i))


def test_seeds_differ_and_can_be_named():
    rows = together(ClosedLoops(3, seed=[4, 9, 4]))
    assert not np.array_equal(rows[:, 0], rows[:, 1])
    np.testing.assert_array_equal(rows[:, 1], one_by_one(ClosedLoop(seed=9), 1))


def test_arguments_are_those_of_closed_loop():
    arguments = {"params": {"mujoco_plant": {"slope": 0.05}}, "urdf": share_file("urdf/diffbot.urdf")}
    rows = together(ClosedLoops(2, 2, **arguments))
    np.testing.assert_array_equal(rows[:, 0], one_by_one(ClosedLoop(**arguments), 0))


def test_a_wrong_argument_is_refused_as_by_closed_loop():
    with pytest.raises(RobotError, match=r"nowhere\.urdf"):
        ClosedLoops(2, urdf="nowhere.urdf")
    for arguments, message in (((0,), "at least one loop"), ((1, 0), "at least 1"), ((2, 1, [3]), "1 seeds for 2")):
        with pytest.raises(ValueError, match=message):
            ClosedLoops(*arguments)


def test_wrong_commands_and_columns_are_refused():
    loops = ClosedLoops(2)
    for commands in (np.zeros(2), np.zeros((3, 2)), np.zeros((2, 4))):
        with pytest.raises(ValueError, match=r"shape \(2, 2\).*\(2, 3\)"):
            loops.step(1, commands)
    with pytest.raises(ValueError, match='no column "truth_lineer"; did you mean "truth_linear"'):
        loops.step(1, None, ("truth_lineer",))
    assert loops.step(1).shape == (2, 0)


def test_no_cycle_reads_the_last_one_and_sends():
    loops = ClosedLoops(1)
    columns = ("time", "requested_linear")
    assert np.isnan(loops.step(0, None, columns)[0, 1])
    last = loops.step(1000, [(0.1, 0)], columns)
    np.testing.assert_array_equal(loops.step(0, [(0.3, 0)], columns), last)
    assert loops.step(1, None, columns)[0, 1] == 0.3


def test_one_of_many_is_broken_read_and_made_anew_by_itself():
    loops = ClosedLoops(3, 2, seed=1)
    single = ClosedLoop(seed=2)
    together(loops, range(12))
    one_by_one(single, 1, range(12))
    for loop in (loops[1], single):
        loop.inject_fault("left_encoder", "stuck")
    rows = together(loops, range(12, STEPS))
    np.testing.assert_array_equal(rows[:, 1], one_by_one(single, 1, range(12, STEPS)))
    assert loops[1].cycle == STEPS * CYCLES
    assert loops[-2] is loops[1]

    loops[1].reset(seed=8)
    assert (loops.seeds, loops[1].cycle, loops[0].cycle) == ((1, 8, 3), 0, STEPS * CYCLES)
    np.testing.assert_array_equal(together(loops)[:, 1], one_by_one(ClosedLoop(seed=8), 1))
    loops.reset([5, 6, 7])
    np.testing.assert_array_equal(together(loops)[:, 2], one_by_one(ClosedLoop(seed=7), 2))
    with pytest.raises(IndexError, match="no loop 3"):
        loops[3]


def broken(loop):
    loop.inject_fault("controller", "delayed")


def tuned(loop):
    loop.set_parameters({"max_linear_speed": 0.4, "pid_kp": 0.9})


def stopped(loop):
    loop.e_stop()


def nothing(_loop):
    pass


@pytest.mark.parametrize(
    ("robot", "act"),
    [
        *((DIFFBOT, act) for act in (nothing, broken, tuned, stopped)),
        *((QUADBOT, act) for act in (nothing, broken, stopped)),
        (FOUR_WHEELS, nothing),
    ],
)
def test_a_copy_continues_as_its_original(robot, act):
    try:
        loop = ClosedLoop(seed=3, urdf=urdf_of(robot))
    except FileNotFoundError as error:
        pytest.skip(str(error))
    loop.command(0.3, 0.2)
    loop.step(700)
    act(loop)
    loop.step(3)
    clone = loop.clone()
    assert clone.cycle == loop.cycle
    second = copy.deepcopy(clone)
    first, *others = (one.run(1.5, lambda t: (0.4, 0.3 * (t > 1.5))) for one in (loop, clone, second))
    different = [name for name in first for log in others if not np.array_equal(first[name], log[name], equal_nan=True)]
    assert different == []


def test_copies_share_nothing_that_changes():
    loop = ClosedLoop(seed=3)
    loop.run(1.0, (0.3, 0.0))
    clone, other = loop.clone(), loop.clone()
    clone.set_parameters({"max_linear_speed": 0.1})
    clone.inject_fault("left_motor", "off")
    clone.run(1.0, (0.5, 0.5))
    clone.reset()
    np.testing.assert_array_equal(loop.run(1.0, (0.5, 0.5))["truth_x"], other.run(1.0, (0.5, 0.5))["truth_x"])


def test_one_loop_has_several_futures():
    loops = ClosedLoops(2, 2, seed=5)
    together(loops, range(20))
    futures = loops.clone([1, 1, 0])
    assert (len(futures), futures.seeds, futures[0].cycle) == (3, (6, 6, 5), loops[1].cycle)
    rows = futures.step(400, [(0.5, 0.5), (0.5, 0.5), (0.5, 0.5)], COLUMNS)
    np.testing.assert_array_equal(rows[0], rows[1])
    np.testing.assert_array_equal(rows[[1, 2]], loops.step(400, [(0.5, 0.5), (0.5, 0.5)], COLUMNS)[::-1])


def test_simulated_drives_are_not_copied():
    loop = ClosedLoop(drives=share_file("config/drives/cia402.yaml"))
    with pytest.raises(DriverError, match="cannot be cloned; create another one"):
        loop.clone()


def test_a_pickle_makes_the_same_loop_anew():
    loop = pickle.loads(pickle.dumps(ClosedLoop({"mujoco_plant": {"slope": 0.05}}, seed=4)))
    again = ClosedLoop({"mujoco_plant": {"slope": 0.05}}, seed=4)
    np.testing.assert_array_equal(one_by_one(loop, 0), one_by_one(again, 0))
    loops = pickle.loads(pickle.dumps(ClosedLoops(2, 2, seed=[4, 1])))
    assert (loops.seeds, loops.threads) == ((4, 1), 2)
    np.testing.assert_array_equal(together(loops)[:, 0], one_by_one(ClosedLoop(seed=4), 0))


@pytest.mark.parametrize(
    "use",
    [
        lambda loop: loop.step(),
        lambda loop: loop.command(0.1),
        lambda loop: loop.e_stop(),
        lambda loop: loop.inject_fault("left_motor", "off"),
        lambda loop: loop.set_parameters({"max_linear_speed": 0.4}),
    ],
)
def test_a_loop_that_has_run_is_not_pickled(use):
    loop = ClosedLoop()
    use(loop)
    with pytest.raises(TypeError, match=r"cannot be pickled.*reset\(seed\).*clone\(\)"):
        pickle.dumps(loop)
    loop.reset(seed=2)
    assert pickle.loads(pickle.dumps(loop)).cycle == 0
    loops = ClosedLoops(2)
    use(loops[1])
    with pytest.raises(TypeError, match=r"cannot be pickled.*reset\(seeds\)"):
        pickle.dumps(loops)
    assert isinstance(pickle.loads(pickle.dumps(loops[0])), ClosedLoop)


def test_asked_columns_are_those_of_the_whole_log():
    asked, whole = (
        loop.run(0.5, (0.3, 0.1), columns)
        for loop, columns in ((ClosedLoop(), ["truth_x", "time"]), (ClosedLoop(), None))
    )
    assert list(asked) == ["truth_x", "time"]
    np.testing.assert_array_equal(asked["truth_x"], whole["truth_x"])


@pytest.fixture
def other_thread():
    """Two events: the second is set by another thread after the first, as soon as the interpreter is released to it."""
    interval = sys.getswitchinterval()
    begin, ran = threading.Event(), threading.Event()
    thread = threading.Thread(target=lambda: (begin.wait(), ran.set()))
    thread.start()
    sys.setswitchinterval(1000)  # s; nothing takes the interpreter away
    yield begin, ran
    sys.setswitchinterval(interval)
    begin.set()
    thread.join()


@pytest.mark.parametrize("command", [None, (0.3, 0.1), [0.3, 0.0, 0.1]])
def test_other_threads_run_during_a_run(other_thread, command):
    begin, ran = other_thread
    loop = ClosedLoop()
    begin.set()
    for _ in range(100):  # a busy machine may be slow to wake the thread
        loop.run(0.5, command)
        if ran.is_set():
            return
    pytest.fail("the run has kept the interpreter")


def test_a_command_function_keeps_the_interpreter(other_thread):
    begin, ran = other_thread
    loop = ClosedLoop()
    begin.set()
    loop.run(1.0, lambda _time: (0.3, 0.1))
    assert not ran.is_set()
