/// Every kind of fault of the motors, on a bench: the effort of a drive that received a request.

#include "drivers/mujoco/motors/motor_faults.h"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/mujoco/constants.h"
#include "drivers/mujoco/two_wheels.h"

namespace robot_control::tests {

constexpr double kLimit = 3.5;  // N·m, as two_wheels has it

struct MotorFaultsTest : testing::Test {
  /// Runs one cycle in which each wheel is asked for `effort`, all joints at rest.
  void step(FaultKind left, FaultKind right, double effort, JointMode mode = JointMode::kEffort) {
    InjectedFaults faults{};
    set_fault(faults, {FaultComponent::kMotor, kLeftWheel, left});
    set_fault(faults, {FaultComponent::kMotor, kRightWheel, right});
    std::vector<JointCommand> commands(3);
    for (JointCommand& command : commands) command = {.mode = mode, .effort = effort};
    const auto received = faults_.receive(faults, cycle_++, commands);
    ASSERT_EQ(received.size(), commands.size());
    left_ = faults_.effort(kLeftWheel, received[kLeftWheel].mode, received[kLeftWheel].effort, 0, 0);
    right_ = faults_.effort(kRightWheel, received[kRightWheel].mode, received[kRightWheel].effort, 0, 0);
    swivel_ = received[kSwivel].effort;
  }
  void step(FaultKind left, double effort, JointMode mode = JointMode::kEffort) {
    step(left, FaultKind::kOk, effort, mode);
    EXPECT_EQ(right_, effort) << "the other side is well";
    EXPECT_EQ(swivel_, effort);
  }

  static MotorFaults both_motors() {
    MotorFaults faults;
    for (const std::uint8_t wheel : {kLeftWheel, kRightWheel}) faults.add(wheel, 0.005, kLimit, 5, kStep);
    return faults;
  }

  MotorFaults faults_ = both_motors();
  std::uint64_t cycle_ = 0;
  double left_ = 0, right_ = 0, swivel_ = 0;
};

TEST_F(MotorFaultsTest, AHealthyMotorGivesWhatIsAsked) {
  step(FaultKind::kOk, 1.5);
  EXPECT_EQ(left_, 1.5);
}

TEST_F(MotorFaultsTest, AMotorThatIsOffRunsFreeAndDoesNotBrake) {
  for (const JointMode mode : {JointMode::kEffort, JointMode::kBrake}) {
    step(FaultKind::kOff, 1.5, mode);
    EXPECT_EQ(left_, 0);
  }
}

TEST_F(MotorFaultsTest, TheRightMotorIsTheRightOne) {
  step(FaultKind::kOk, FaultKind::kOff, 1.5);
  EXPECT_EQ(left_, 1.5);
  EXPECT_EQ(right_, 0);
}

TEST_F(MotorFaultsTest, AWrongMotorTurnsTheOtherWayButBrakes) {
  step(FaultKind::kWrong, 1.5);
  EXPECT_EQ(left_, -1.5);
  step(FaultKind::kWrong, 1.5, JointMode::kBrake);
  EXPECT_EQ(left_, 1.5);
}

TEST_F(MotorFaultsTest, AGarbageMotorPushesAtRandomWithinItsLimit) {
  double square = 0;
  constexpr int kCycles = 3000;
  for (int i = 0; i < kCycles; ++i) {
    step(FaultKind::kGarbage, 0.5);
    EXPECT_LE(std::abs(left_), kLimit);
    square += left_ * left_ / kCycles;
  }
  // The relative deviation is √(0.8/n), as for garbage sensors.
  EXPECT_NEAR(square / (kLimit * kLimit / 3), 1, 5 * std::sqrt(0.8 / kCycles));
}

TEST_F(MotorFaultsTest, ADelayedMotorIsTenCyclesLateWithTheBrakeToo) {
  for (int i = 0; i < 40; ++i) {
    step(FaultKind::kDelayed, 0.01 * i);
    EXPECT_EQ(left_, i < 10 ? 0 : 0.01 * (i - 10)) << i;
  }
}

TEST_F(MotorFaultsTest, AMotorIsHealthyAgainAfterOk) {
  for (std::size_t kind = 1; kind < kFaultKinds; ++kind) {
    for (int i = 0; i < 15; ++i) step(static_cast<FaultKind>(kind), 0.5);
    step(FaultKind::kOk, 1.5);
    EXPECT_EQ(left_, 1.5);
  }
}

TEST_F(MotorFaultsTest, ABlockedRotorHoldsAFreeWheelAgainstTwiceTheMotorsTorque) {
  constexpr double kInertia = 0.005;  // kg·m², as two_wheels has it
  const double load = 2 * kLimit;
  double position = 1, velocity = 10, farthest = 0;
  for (int i = 0; i < 1000; ++i) {
    InjectedFaults faults{};
    faults[0] = {FaultComponent::kMotor, kLeftWheel, FaultKind::kStuck};
    const std::vector<JointCommand> commands(3);
    faults_.receive(faults, cycle_++, commands);
    const double effort = faults_.effort(kLeftWheel, JointMode::kBrake, 0, position, velocity);
    velocity += (effort + load) / kInertia * kStep;
    position += velocity * kStep;
    farthest = std::max(farthest, std::abs(position - 1));
  }
  EXPECT_NEAR(velocity, 0, 1e-9);
  EXPECT_NEAR(position - 1, load * 4 * kStep * kStep / kInertia, 1e-9) << "load over k = J/(4h²)";
  // The wheel comes in with 10 rad/s: a = 1/2 leaves half of it in each step, at most 10·h·(1 + 1/2 + …) = 20 mrad,
  // and the load's own share.
  EXPECT_LT(farthest, 0.02 + 2 * load * 4 * kStep * kStep / kInertia);
}

}  // namespace robot_control::tests
