// Tests every condition under every reaction: the right permit in the right cycle, and the brake behind it.
//
// At `onset` a robot that drives at 5 rad/s (0.5 m/s) breaks one thing, and goes on. After at most `seen` cycles the
// fact is beyond its limit. A window of wheel speeds is 20 cycles long, so a speed that jumps takes 20 cycles; other
// facts are immediate. From then on its persistence counts.

#include <cmath>

#include "safety/latch/fixed_reactions.h"
#include "safety/monitor_fixture.h"
#include "signals/names.h"
#include "support/measured_contacts.h"

namespace robot_control::tests {

constexpr std::uint64_t kWindow = 20;

/// The values that a row may change in each cycle.
struct Robot {
  SensorFrame& sensors;
  CommandFrame& command;
  std::array<double, 2>& speed;
  bool& noisy;
  double t = 0;  ///< s since the onset
};

struct Row {
  StopCause cause;
  Condition SafetyParameters::*condition;
  double limit;
  double persistence;
  std::uint64_t seen;
  std::function<void(Robot&)> onset;
  bool commanded_to_stand = false;
};

const std::vector<Row>& rows() {
  using P = SafetyParameters;
  static const std::vector<Row> kRows{
      {kCauseWheelSpeed, &P::wheel_speed, 18, 0.03, kWindow, [](Robot& r) { r.speed[0] = 25; }},
      // (100 − 5)/20 ms = 4750 rad/s² at the most; half of it is reached after a half of the window, and kept as long.
      {kCauseWheelAcceleration, &P::wheel_acceleration, 2300, 0.01, kWindow, [](Robot& r) { r.speed[0] = 100; }},
      {kCauseWheelEffort, &P::wheel_effort, 1.05, 0.02, 0, [](Robot& r) { r.sensors.joints[1].effort = -3.3; }},
      {kCausePower, &P::power, 60, 0.1, 0,  // 15 N·m · 5 rad/s = 75 W
       [](Robot& r) { r.sensors.joints[1].effort = 15; }},
      // It is slower than a fifth of the target after a window, then 0.3 rad at 5 rad/s, and a count.
      {kCauseStall, &P::stall, 0.3, 0, kWindow + 62, [](Robot& r) { r.speed[0] = 0; }},
      {kCauseRunaway, &P::runaway, 4, 0.05, kWindow, [](Robot& r) { r.speed[1] = 12; }},
      {kCauseWrongDirection, &P::wrong_direction, 1.5, 0.05, kWindow, [](Robot& r) { r.speed[1] = -5; }},
      {kCauseNotStopping, &P::not_stopping, 1.0, 0, 1001, [](Robot&) {}, true},
      // A ripple of 0.9 of the limit, the mean of 0.5 s: 0.3 after −0.5 s·ln(1 − (0.3/0.9)²) = 59 ms, and a swing.
      {kCauseTorqueOscillation, &P::torque_oscillation, 0.3, 0, 80,
       [](Robot& r) {
         r.command.joints[1].effort = std::lround(r.t * 1000) / 8 % 2 == 0 ? 3 : -3;
         r.sensors.joints[1].effort = r.command.joints[1].effort;
       }},
      {kCauseYawRate, &P::yaw_rate, 1.0, 0.2, 0, [](Robot& r) { r.sensors.imu.angular_velocity[2] = -1.2; }},
      // It rolls at 1 rad/s up to 0.6 rad, and the accelerometer with it.
      {kCauseTilt, &P::tilt, 0.35, 0.05, 400,
       [](Robot& r) {
         const double roll = std::min(r.t, 0.6);
         r.sensors.imu.angular_velocity[0] = roll < 0.6 ? 1 : 0;
         r.sensors.imu.linear_acceleration = {0, 9.81 * std::sin(roll), 9.81 * std::cos(roll)};
         r.noisy = false;
       }},
      // At 2 rad/s, from half of the tilt limit (0.35 rad by default; here what `parameters` says) on.
      {kCauseTipOver, &P::tip_over, 1.5, 0.02, 250,
       [](Robot& r) {
         const double roll = std::min(2 * r.t, 1.5);
         r.sensors.imu.angular_velocity[0] = roll < 1.5 ? 2 : 0;
         r.sensors.imu.linear_acceleration = {0, 9.81 * std::sin(roll), 9.81 * std::cos(roll)};
         r.noisy = false;
       }},
      {kCauseFreeFall, &P::free_fall, 3, 0.05, 0,
       [](Robot& r) {
         r.sensors.imu.linear_acceleration = {0, 0, 0};
         r.noisy = false;
       }},
      {kCauseLift, &P::lift, 0.2, 0.1, 0,
       [](Robot& r) {
         for (ContactSample& contact : r.sensors.contacts) contact.force = {};
       }},
      // An impact may have a window of its own.
      {kCauseImpact, &P::impact, 60, 0, kWindow,
       [](Robot& r) {
         r.sensors.imu.linear_acceleration[0] = -200;
         r.noisy = false;
       }},
      {kCauseEncodersLost, &P::encoders_lost, 0, 0.01, 0, [](Robot& r) { set_joints_valid(r.sensors, 0); }},
      {kCauseImuLost, &P::imu_lost, 0, 0.1, 0, [](Robot& r) { r.sensors.valid &= ~kValidGyro; }},
      // The median of nine changes, of which the fifth is the first.
      {kCauseImuJump, &P::imu_jump, 5, 0, 5,
       [](Robot& r) { r.sensors.imu.angular_velocity[1] = std::lround(r.t * 1000) % 2 == 0 ? 6 : 0; }},
      {kCauseImuStuck, &P::imu_stuck, 0, 0.25, 1, [](Robot& r) { r.noisy = false; }},
      // 51 come at once, then 100 a second.
      {kCauseOverruns, &P::overruns, 50, 1, 0,
       [](Robot& r) { r.sensors.overruns += r.t < 1e-9 ? 51 : (std::lround(r.t * 1000) % 10 == 0 ? 1 : 0); }},
      {kCauseBatteryLow, &P::battery_low, 22, 1, 0, [](Robot& r) { r.sensors.battery_voltage = 21.9; }},
      {kCauseBatteryEmpty, &P::battery_empty, 20, 1, 0, [](Robot& r) { r.sensors.battery_voltage = 19.9; }},
  };
  return kRows;
}

/// These are in legged_conditions_test.cpp.
constexpr std::uint64_t kOfLegs = kCauseJointSpeed | kCauseJointEffort | kCauseJointRange | kCauseFootSlip |
                                  kCauseFootLoad | kCauseJointFollowing | kCauseEncoderJump | kCauseEncoderStuck |
                                  kCauseSinking | kCauseBodyTurn | kCauseImuReversed | kCauseWrongState;

/// All conditions but one are off, so that nothing else stops the robot.
SafetyParameters only(const SafetyParameters& given, const Row& row, Reaction reaction) {
  SafetyParameters parameters = given;
  for (const Row& other : rows()) (parameters.*other.condition).reaction = Reaction::kOff;
  parameters.tilt.limit = 0.35;
  parameters.heartbeat_timeout = 0;
  parameters.*row.condition = {row.limit, row.persistence, reaction};
  return parameters;
}

struct Conditions : MonitorTest, testing::WithParamInterface<std::tuple<std::size_t, Reaction>> {
  Conditions() : row_(rows()[std::get<0>(GetParam())]), reaction_(std::get<1>(GetParam())) {
    const SafetyParameters chosen = only(parameters(), row_, reaction_);
    persistence_ = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::lround(row_.persistence / kPeriod)));
    sensors_.valid |= kValidBattery;
    measure_contacts(sensors_);
    sensors_.battery_voltage = 24;
    sensors_.contacts[0].force[2] = sensors_.contacts[1].force[2] = 6 * 9.81;
    drive_with(chosen, robot());
  }

  /// Cycles from the onset to the first in which `reported` is true; at most `patience`.
  template <class Reported>
  std::uint64_t break_until(std::uint64_t patience, Reported reported) {
    Robot robot{sensors_, command_, speed_, noisy_gyro_};
    for (JointCommand& joint : command_.joints) joint.velocity *= row_.commanded_to_stand ? 0 : 1;
    for (std::uint64_t k = 0; k < patience; ++k) {
      robot.t = static_cast<double>(k) * kPeriod;
      row_.onset(robot);
      step();
      if (reported()) return k;
    }
    return patience;
  }

  std::uint64_t latest() const { return row_.seen + persistence_ - 1; }

  const Row& row_;
  Reaction reaction_;
  std::uint64_t persistence_;
};

TEST_P(Conditions, ReactAsConfiguredInTheirCycle) {
  ASSERT_EQ(permit_.action, PermitAction::kDrive);
  ASSERT_EQ(permit_.causes | permit_.warnings, 0u);
  const std::uint64_t patience = latest() + 200;
  const auto reported = [&] { return ((permit_.causes | permit_.warnings) & row_.cause) != 0; };
  const std::uint64_t k = break_until(patience, reported);
  if (reaction_ == Reaction::kOff) {
    EXPECT_EQ(k, patience);
    EXPECT_EQ(permit_.action, PermitAction::kDrive);
    return;
  }
  ASSERT_LE(k, latest());
  ASSERT_GE(k + 1, persistence_) << "before it had persisted";
  EXPECT_EQ(permit_.evidence[0].cause, std::uint64_t{row_.cause});
  EXPECT_EQ(permit_.evidence[0].cycle, cycle());

  const bool latches = reaction_ == Reaction::kRamp || reaction_ == Reaction::kBrake;
  EXPECT_EQ(permit_.causes, latches ? std::uint64_t{row_.cause} : 0u);
  EXPECT_EQ(permit_.warnings, latches ? 0u : std::uint64_t{row_.cause});
  EXPECT_EQ(permit_.speed_limit, reaction_ == Reaction::kSlow ? parameters().slow_speed : kNoSpeedLimit);
  EXPECT_EQ(permit_.action, reaction_ == Reaction::kBrake  ? PermitAction::kBrake
                            : reaction_ == Reaction::kRamp ? PermitAction::kRamp
                                                           : PermitAction::kDrive);
}

TEST_P(Conditions, ReachTheMotorsWithinThreeCyclesAndBrakeAtTheRampsDeadline) {
  if (reaction_ != Reaction::kBrake && reaction_ != Reaction::kRamp) return;
  break_until(latest() + 1, [&] { return permit_.causes != 0; });
  ASSERT_EQ(permit_.causes, std::uint64_t{row_.cause});
  const std::uint64_t latched = cycle();
  const std::uint64_t deadline = permit_.ramp_until;
  EXPECT_EQ(deadline, reaction_ == Reaction::kRamp ? latched + kRamp : 0);
  ASSERT_FALSE(braked()) << "in the tick of this cycle the permit before it counts";
  const bool ramp = reaction_ == Reaction::kRamp;
  const auto acts = [&] { return ramp ? ramps() : braked(); };
  break_until(kToMotors, acts);
  EXPECT_TRUE(acts());
  EXPECT_LE(cycle(), latched + kToMotors);
  break_until(kRamp + kToMotors, [&] { return braked(); });
  EXPECT_TRUE(braked());
  if (ramp) {
    EXPECT_EQ(cycle(), deadline + 1);
  }
}

std::string name_of_row(const testing::TestParamInfo<Conditions::ParamType>& info) {
  constexpr std::array<const char*, 5> kNames{"off", "warn", "slow", "ramp", "brake"};
  const Row& row = rows()[std::get<0>(info.param)];
  return std::string(row_of(kStopCauseNames, row.cause)->name) + "_" +
         kNames[static_cast<std::size_t>(std::get<1>(info.param))];
}

INSTANTIATE_TEST_SUITE_P(Every, Conditions,
                         testing::Combine(testing::Range<std::size_t>(0, rows().size()),
                                          testing::Values(Reaction::kOff, Reaction::kWarn, Reaction::kSlow,
                                                          Reaction::kRamp, Reaction::kBrake)),
                         name_of_row);

/// Drives that take speeds and measure no torque (robot.wheel_command: velocity).
struct ConditionsWithoutTorque : Conditions {
  /// docs/safety.md names them.
  static constexpr std::uint64_t kBlind = kCauseWheelEffort | kCausePower | kCauseTorqueOscillation;

  ConditionsWithoutTorque() {
    SafetyParameters chosen = only(parameters(), row_, reaction_);
    chosen.joint_numbers = kValidKinematics;
    measure_no_torque();
    drive_with(chosen, robot());
  }

  void measure_no_torque() {
    for (JointSample& joint : sensors_.joints) {
      joint.effort = std::numeric_limits<double>::quiet_NaN();
      joint.valid &= ~std::uint32_t{kValidEffort};
    }
  }
};

TEST_P(ConditionsWithoutTorque, ReactInTheSameTimeOrAreNamedAsBlind) {
  ASSERT_EQ(permit_.action, PermitAction::kDrive);
  ASSERT_EQ(permit_.causes, 0u);
  const std::uint64_t patience = latest() + 200;
  Robot broken{sensors_, command_, speed_, noisy_gyro_};
  for (JointCommand& joint : command_.joints) joint.velocity *= row_.commanded_to_stand ? 0 : 1;
  std::uint64_t k = 0;
  for (; k < patience && permit_.causes == 0; ++k) {
    broken.t = static_cast<double>(k) * kPeriod;
    row_.onset(broken);
    measure_no_torque();
    step();
  }
  EXPECT_EQ(permit_.causes, (row_.cause & kBlind) != 0 ? 0u : std::uint64_t{row_.cause});
  if (permit_.causes != 0) {
    EXPECT_LE(k, latest() + 1);
  }
}

INSTANTIATE_TEST_SUITE_P(Every, ConditionsWithoutTorque,
                         testing::Combine(testing::Range<std::size_t>(0, rows().size()),
                                          testing::Values(Reaction::kBrake)),
                         name_of_row);

// The reaction decides whether a reset is needed; the messages add it.
TEST(CauseNames, RemediesDoNotSpeakOfTheReset) {
  for (const BitName& row : kStopCauseNames) EXPECT_EQ(row.remedy.find("e_stop_reset"), row.remedy.npos) << row.name;
}

// The table has every cause of a robot on wheels that is not fixed, so its rows are all that can be set.
TEST(ConditionTable, HasEveryCauseThatIsNotFixed) {
  std::uint64_t all = kAllCauses & ~kOfLegs;
  for (const FixedCause& rule : kFixedCauses) all &= ~std::uint64_t{rule.cause};
  for (const Row& row : rows()) all &= ~std::uint64_t{row.cause};
  EXPECT_EQ(all, 0u) << names_of(kStopCauseNames, all);
}

}  // namespace robot_control::tests
