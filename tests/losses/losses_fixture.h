#pragma once
/// A healthy robot drives at full speed as four processes in `clock: wall`, and each test removes one thing. The
/// promises stand in docs/losses.md, a row for each test.

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

#include "support/processes/driving_robot.h"

namespace robot_control {

inline constexpr const char* kParams = PROJECT_DIRECTORY "/config/robot_params.yaml";

/// Cycles of the plant from a loss to the brake: permit and command live on for 4, and the machine may stall.
inline constexpr std::uint64_t kBrakeWithin = 20;

inline std::string name_of_signal(int number) {
  return number == SIGSTOP ? "SIGSTOP" : number == SIGKILL ? "SIGKILL" : "SIGSEGV";
}

struct Losses : ::testing::Test {
  explicit Losses(const Parameters& parameters = DrivingRobot::quick(kParams)) : robot_(parameters) {
    robot_.drive_at_full_speed();
  }

  DriveLog& log() noexcept { return robot_.log(); }
  NodeProcesses& nodes() noexcept { return robot_.nodes(); }

  void expect_lives(LoopNode node) { EXPECT_TRUE(nodes().lives(node)) << name_of(node) << ":\n" << nodes().said(node); }

  /// The node died of that signal, and reported it in one line.
  void expect_crash_report(LoopNode node, int signal, const std::string& name) {
    EXPECT_EQ(nodes().process(node).ending_signal(), signal) << name_of(node) << ":\n" << nodes().said(node);
    const std::string said = nodes().said(node);
    EXPECT_TRUE(said.starts_with(std::string(name_of(node)) + ": " + name)) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
  }

  /// The robot drives at full speed as before, and nothing latched except after a stall of this machine.
  void expect_undisturbed() {
    constexpr double kFast = 0.9 * DrivingRobot::kFullSpeed;
    robot_.await_cycles(300);
    if (robot_.stalled()) robot_.drive_at_full_speed();
    EXPECT_EQ(robot_.permit().causes, 0u) << robot_.situation();
    EXPECT_GT(log().last().speed, kFast) << robot_.situation();
    expect_no_jump();
  }

  /// The number of braked cycles is unknown: a full ring takes no rows.
  void expect_drives_on(std::uint64_t cycles) {
    const std::uint64_t end = robot_.cycle() + cycles;
    EXPECT_TRUE(robot_.await([&] { return robot_.cycle() >= end; })) << robot_.situation();
    EXPECT_TRUE(robot_.permit().causes == 0 || robot_.stalled()) << robot_.situation();
    if (robot_.permit().causes == 0) {
      EXPECT_GT(robot_.speed(), 0.9 * DrivingRobot::kFullSpeed) << robot_.situation();
    }
  }

  /// The robot moved in steps: none is longer than top speed allows, and 5 % for the wheel loops.
  void expect_no_jump() {
    EXPECT_LT(log().longest_step(), 1.05 * DrivingRobot::kFullSpeed * nodes().parameters().loop.period());
  }

  /// The stop is permanent: a continuing request to drive moves nothing and makes a reset fail. After the release the
  /// robot stands until a new command, and then drives.
  void expect_latched_until_reset_and_new_command(std::uint64_t cause) {
    EXPECT_TRUE(robot_.await([&] { return (robot_.permit().causes & cause) != 0; }))
        << "wanted " << names_of(kStopCauseNames, cause) << "; " << robot_.situation();
    expect_stands(100);
    EXPECT_NE(robot_.ask_reset() & (kRefusalCommand | kRefusalGap), 0u) << robot_.situation();
    expect_stands(20);
    robot_.release();
    robot_.ask_for_nothing();
    expect_stands(100);
    robot_.drive_at_full_speed();
    expect_no_jump();
  }

  /// Expects standstill after `cycles`, however many pass before the test looks: a braked robot still rocks.
  void expect_stands(std::uint64_t cycles) {
    const std::uint64_t from = log().last().cycle;
    ASSERT_TRUE(robot_.await_cycles(cycles)) << robot_.situation();
    EXPECT_LT(log().way_since(from, from + cycles), 0.001) << robot_.situation();
  }

  DrivingRobot robot_;
};

}  // namespace robot_control
