#pragma once
/// A gate in its healthy case: tick 100 at 1 kHz, with a permit to drive and a command of cycle 99. Two joints stand,
/// in effort and velocity mode, within their limits; only their efforts are limited.

#include <gtest/gtest.h>

#include <cstring>

#include "gate/gate.h"

namespace robot_control {

inline constexpr std::uint64_t kRun = 42;
inline constexpr double kLimit = 5.0;
inline constexpr double kPeriod = 1e-3;
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct GateFixture : testing::Test {
  explicit GateFixture(const JointLimits& limits = {.effort = kLimit}, const GateParameters& parameters = {})
      : gate_({limits, limits}, parameters, kPeriod) {
    permit_.head.run = command_.head.run = input_.run = kRun;
    permit_.action = PermitAction::kDrive;
    command_.joint_count = sensors_.joint_count = 2;
    set_joints_valid(sensors_, kValidMotion);
    command_.joints[0] = {.mode = JointMode::kEffort, .velocity = 4.5, .effort = 1.5};
    command_.joints[1] = {.mode = JointMode::kVelocity, .velocity = 5.5, .damping = 2.0, .effort = -0.5};
    input_.permit = &permit_;
    input_.command = &command_;
    input_.sensors = &sensors_;
    input_.permit_found = input_.command_found = Lookup::kFrame;
    tick_at(100);
  }

  void permit_of(std::uint64_t cycle) {
    permit_.head.cycle = cycle;
    permit_.expiry = cycle + kPermitLife;
  }
  void command_of(std::uint64_t cycle) { command_.head.cycle = cycle; }

  /// The next step is tick `cycle`; its frames are those of the cycle before.
  void tick_at(std::uint64_t cycle) {
    input_.cycle = cycle;
    permit_of(cycle - 1);
    command_of(cycle - 1);
  }

  void step() { joints_ = gate_.step(input_); }
  void next() {
    step();
    tick_at(input_.cycle + 1);
  }

  bool braked() const {
    bool brake = gate_.report().verdict == GateVerdict::kBrake && joints_.size() == 2;
    const JointCommand none;
    for (const JointCommand& joint : joints_) brake = brake && std::memcmp(&joint, &none, sizeof none) == 0;
    return brake;
  }
  void expect_brake(std::uint64_t reasons) {
    step();
    EXPECT_TRUE(braked());
    EXPECT_EQ(gate_.report().reasons, reasons);
  }
  std::uint64_t reasons() const { return gate_.report().reasons; }
  GateVerdict verdict() const { return gate_.report().verdict; }

  Gate gate_;
  Permit permit_;
  CommandFrame command_;
  SensorFrame sensors_;
  GateInput input_;
  std::span<const JointCommand> joints_;
};

}  // namespace robot_control
