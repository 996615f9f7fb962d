"""The Gymnasium environments."""

import warnings

import numpy as np
import pytest
from support.pypi_package import imported

gymnasium = imported("gymnasium", "gym")
import robot_control.loop.gym as environments  # noqa: E402
from gymnasium.utils.env_checker import check_env  # noqa: E402
from robot_control.loop.signal_names import mask_of  # noqa: E402

NAMES = ("robot_control/Drive-v0", "robot_control/Walk-v0")


def drive_to_the_goal(observation):
    """Turns to the goal and drives."""
    angle = np.arctan2(observation[1], observation[0])
    return np.clip([np.cos(angle), angle], -1, 1).astype(np.float32)


def random_steps(env, seed, steps):
    observation, _ = env.reset(seed=seed)
    env.action_space.seed(seed)
    rows = [observation]
    for _ in range(steps):
        observation, reward, *_ = env.step(env.action_space.sample())
        rows.append(np.append(observation, reward))
    return np.concatenate(rows)


@pytest.mark.parametrize("name", NAMES)
def test_the_checker_of_gymnasium_finds_nothing(name):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gymnasium.make(name).unwrapped, skip_render_check=True)


@pytest.mark.parametrize("name", NAMES)
def test_equal_seeds_give_equal_bits_and_others_do_not(name):
    first, second, other = (random_steps(gymnasium.make(name), seed, 30) for seed in (3, 3, 4))
    np.testing.assert_array_equal(first, second)
    assert not np.array_equal(first, other)
    again = gymnasium.make(name)
    random_steps(again, 8, 5)
    np.testing.assert_array_equal(random_steps(again, 3, 30), first)


def test_a_robot_that_heads_for_its_goal_reaches_it_and_is_rewarded_by_the_way():
    env = gymnasium.make(NAMES[0])
    observation, info = env.reset(seed=1)
    begin, total, terminated = info["distance"], 0.0, False
    assert environments.NEAREST <= begin <= environments.FARTHEST
    assert np.hypot(*observation[:2]) == pytest.approx(begin, abs=0.01)
    while not terminated:
        observation, reward, terminated, truncated, info = env.step(drive_to_the_goal(observation))
        assert not truncated
        total += reward
    assert info["reached"]
    assert total == pytest.approx(begin - info["distance"])
    assert (info["causes"], observation[-1]) == (0, 1)


def test_a_robot_that_does_nothing_is_truncated():
    env = gymnasium.make(NAMES[0], max_episode_steps=5)
    env.reset(seed=0)
    ends = [env.step(np.zeros(2, np.float32))[2:4] for _ in range(5)]
    assert ends == [(False, False)] * 4 + [(False, True)]


def test_a_latched_stop_ends_the_episode_and_is_named():
    env = gymnasium.make(NAMES[0])
    env.reset(seed=0)
    env.step(np.array([1, 0], np.float32))
    env.unwrapped.loop.e_stop()
    *_, terminated, _, info = env.step(np.array([1, 0], np.float32))
    assert terminated
    assert not info["reached"]
    assert info["causes"] == mask_of("StopCause", "e_stop_service")


def test_legs_stand_up_and_walk_by_twists():
    env = gymnasium.make(NAMES[1])
    env.reset(seed=2)
    for _ in range(80):  # 4 s
        observation, *_ = env.step(np.array([1, 0, 0], np.float32))
    assert observation[2] == pytest.approx(0.5, abs=0.1)  # m/s to the front
    assert observation[7] > 0.1  # m above the lying one


def test_each_of_many_is_the_single_one_with_its_seed_and_begins_again():
    many = gymnasium.make_vec(NAMES[0], num_envs=3, max_episode_steps=8)
    singles = [gymnasium.make(NAMES[0], max_episode_steps=8) for _ in range(3)]
    observations, _ = many.reset(seed=5)
    np.testing.assert_array_equal(observations, [env.reset(seed=5 + i)[0] for i, env in enumerate(singles)])
    random = np.random.default_rng(0)
    ended = np.zeros(3, bool)
    for _ in range(20):
        actions = random.uniform(-1, 1, (3, 2)).astype(np.float32)
        observations, rewards, terminated, truncated, _ = many.step(actions)
        for i, env in enumerate(singles):
            expected = (env.reset()[0], 0.0, False, False) if ended[i] else env.step(actions[i])[:4]
            np.testing.assert_array_equal(observations[i], expected[0])
            assert (rewards[i], terminated[i], truncated[i]) == expected[1:]
        ended = terminated | truncated
    assert many.single_action_space.shape == (2,)


def test_arguments_reach_the_loop():
    env = gymnasium.make(NAMES[0], params={"diff_drive_controller": {"max_linear_speed": 0.2}}, cycles=20)
    env.reset(seed=0)
    for _ in range(100):
        observation, *_ = env.step(np.array([1, 0], np.float32))
    assert observation[2] == pytest.approx(0.2, abs=0.02)
    assert env.unwrapped.loop.cycle == 101 * 20
