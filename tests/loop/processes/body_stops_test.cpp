/// The body of the simulated robot moves, and the monitor reacts, in virtual time. The healthy case is diffbot on the
/// flat with exact sensors, 12 kg, its centre of gravity 0.06 m behind the axle. A push acts at the middle of the axle.

#include <gtest/gtest.h>

#include <cmath>

#include "machine/gravity.h"
#include "simulation/closed_loop.h"

namespace robot_control::tests {

constexpr std::uint64_t kPushStart = 1000;  // cycle
constexpr std::uint64_t kNever = ~std::uint64_t{0};

struct BodyStops : testing::Test {
  BodyStops() : parameters_(read_parameters(PROJECT_DIRECTORY "/config/robot_params.yaml")) {
    parameters_.plant.sensor_errors = ErrorLevel::kIdeal;
  }

  void in(const std::string& scene) { parameters_.plant.scene = PROJECT_DIRECTORY "/urdf/scenes/" + scene; }
  /// Upwards, N and cycles.
  void push_up(double force, std::uint64_t cycles) {
    parameters_.plant.push_z = force;
    parameters_.plant.push_start = static_cast<double>(kPushStart) * parameters_.loop.period();
    parameters_.plant.push_duration = static_cast<double>(cycles) * parameters_.loop.period();
  }

  using Look = std::function<void(ClosedLoop&)>;

  /// Requests `linear` all the time; calls `look` before each step.
  void run(std::uint64_t cycles, double linear, const Look& look = {}) {
    ClosedLoop loop(parameters_);
    caused_ = warned_ = 0;
    while (loop.cycle() < cycles) {
      if (loop.cycle() % 100 == 1) loop.command({.linear = {linear, 0, 0}, .angular = {}});
      if (look) look(loop);
      loop.step();
      record(loop.row());
    }
    truth_ = loop.row().driver->truth;
    permit_ = loop.row().monitor->permit;
  }

  /// Cycle in which a cause was first latched; kNever if it was not.
  std::uint64_t latched(StopCause cause) const { return cycle_of(cause, latched_); }

  static double tilt_of(const TruthFrame& truth) {
    const Quaternion& q = truth.pose_world.orientation;
    return std::acos(std::clamp(1 - 2 * (q[0] * q[0] + q[1] * q[1]), -1.0, 1.0));
  }
  std::uint64_t cycles(const Condition& condition) const {
    return static_cast<std::uint64_t>(std::lround(condition.persistence * parameters_.loop.rate));
  }

  Parameters parameters_;
  std::uint64_t caused_ = 0, warned_ = 0;  ///< in any cycle
  TruthFrame truth_;                       ///< in the end
  Permit permit_;                          ///< in the end

 private:
  void record(const JoinedRow& row) {
    const Permit& permit = row.monitor->permit;
    for (std::size_t bit = 0; bit < kStopCauses; ++bit) {
      const std::uint64_t cause = std::uint64_t{1} << bit;
      if ((permit.causes & ~caused_ & cause) != 0) latched_[bit] = row.cycle;
    }
    caused_ |= permit.causes;
    warned_ |= permit.warnings;
  }
  std::uint64_t cycle_of(StopCause cause, const std::array<std::uint64_t, kStopCauses>& cycles) const {
    return (caused_ & cause) != 0 ? cycles[static_cast<std::size_t>(std::countr_zero<std::uint64_t>(cause))] : kNever;
  }

  std::array<std::uint64_t, kStopCauses> latched_{};
};

TEST_F(BodyStops, AHealthyRobotIsLeftAlone) {
  run(10000, 1.0);
  EXPECT_EQ(caused_, 0u);
  EXPECT_EQ(warned_, 0u);
  EXPECT_GT(truth_.pose_world.position[0], 8);
}

// 10°, and 1 m/s² uphill, which the accelerometer takes for 0.05 rad more.
TEST_F(BodyStops, ASteepRampIsDriven) {
  parameters_.plant.slope = 0.1745;
  run(5000, 1.0);
  EXPECT_EQ(caused_, 0u);
  EXPECT_GT(truth_.pose_world.position[0], 3);
}

TEST_F(BodyStops, ARampSteeperThanTheLimitKeepsItFromStarting) {
  parameters_.plant.slope = 0.15;
  parameters_.safety.tilt.limit = 0.14;
  run(500, 0);
  // The first cycle of the persistence is cycle 0, of the first sample.
  EXPECT_EQ(latched(kCauseTilt), cycles(parameters_.safety.tilt) - 1);
  EXPECT_NEAR(permit_.evidence[0].value, 0.15, 1e-3) << "the robot sinks in by micrometres, along 0.25 m";
  EXPECT_NEAR(truth_.pose_world.position[0], 0, 1e-4);
}

// A push up at the axle by twice its weight turns it over backwards about its centre of gravity.
TEST_F(BodyStops, ARobotThatTurnsOverIsStopped) {
  push_up(2 * 12 * kGravity, 100);
  std::uint64_t tips = kNever, tilted = kNever;
  double before = 0;
  run(1500, 0, [&](ClosedLoop& loop) {
    if (loop.cycle() == 0) return;
    const double tilt = tilt_of(loop.row().driver->truth);
    const double rate = (tilt - before) / parameters_.loop.period();
    before = tilt;
    const double limit = parameters_.safety.tilt.limit.value();
    if (tips == kNever && tilt > limit / 2 && rate > 1.5) tips = loop.cycle() - 1;
    if (tilted == kNever && tilt > limit) tilted = loop.cycle() - 1;
  });
  ASSERT_NE(tips, kNever);
  ASSERT_NE(tilted, kNever);
  // The filter takes the push for gravity if its size is in the band: 0.01 rad at 5 rad/s are 2 cycles.
  EXPECT_NEAR(static_cast<double>(latched(kCauseTipOver)),
              static_cast<double>(tips + cycles(parameters_.safety.tip_over) - 1), 5);
  EXPECT_NEAR(static_cast<double>(latched(kCauseTilt)),
              static_cast<double>(tilted + cycles(parameters_.safety.tilt) - 1), 5);
  EXPECT_EQ(permit_.action, PermitAction::kBrake);
}

// A payload moves the centre of gravity to 5 mm behind the push: the robot rises without turning over.
TEST_F(BodyStops, AFallIsFelt) {
  parameters_.plant.payload = 3.6;
  parameters_.plant.payload_x = 0.18;
  constexpr std::uint64_t kPush = 200;
  push_up(3 * 15.6 * kGravity, kPush);
  run(kPushStart + kPush + 300, 0);
  // The last pushed sample is of cycle kPushStart + kPush; the next one is the first that is weightless.
  EXPECT_EQ(latched(kCauseFreeFall), kPushStart + kPush + cycles(parameters_.safety.free_fall));
  EXPECT_GT(truth_.pose_world.position[2], 0.3) << "still in the air";
}

TEST_F(BodyStops, AHopIsNotFelt) {
  parameters_.plant.payload = 3.6;
  parameters_.plant.payload_x = 0.18;
  push_up(3 * 15.6 * kGravity, 20);  // 0.4 m/s upwards: 80 ms in the air
  run(3000, 0);
  EXPECT_EQ(caused_ & (kCauseFreeFall | kCauseTilt | kCauseTipOver | kCauseImpact), 0u);
}

// The robot stops from 1 m/s within a few milliseconds.
TEST_F(BodyStops, AWallAtFullSpeedIsAnImpact) {
  in("walls.xml");
  std::uint64_t hit = kNever;
  run(4000, 1.0, [&](ClosedLoop& loop) {
    if (loop.cycle() < 2000 || hit != kNever) return;
    if (loop.row().driver->truth.twist_base.linear[0] < 0.9) hit = loop.cycle() - 1;
  });
  ASSERT_NE(hit, kNever);
  EXPECT_GE(latched(kCauseImpact), hit);
  EXPECT_LE(latched(kCauseImpact), hit + 10) << "the window";
  EXPECT_EQ(permit_.first_cause, kCauseImpact);
  EXPECT_EQ(permit_.evidence[0].limit, parameters_.safety.impact.limit);
  EXPECT_GT(permit_.evidence[0].value, 80);
}

TEST_F(BodyStops, BumpsAreNoImpactAtAnySpeed) {
  in("bumps.xml");
  for (const double speed : {0.3, 1.0}) {
    run(5000, speed);
    EXPECT_EQ(caused_, 0u) << speed;
    EXPECT_GT(truth_.pose_world.position[0], 1.2) << speed;
  }
}

// The wheels carry 0.76 of the weight; a push upwards by 0.7 leaves 0.06, the caster stays on the ground.
TEST_F(BodyStops, LiftIsFeltByContactSensors) {
  parameters_.plant.contact_sensors = true;
  push_up(0.7 * 12 * kGravity, 2000);
  run(kPushStart + 1500, 0);
  const std::uint64_t felt = latched(kCauseLift);
  // Sample kPushStart + 1 is the first pushed one; the ground lets go within a time constant of its contacts, 4 ms.
  EXPECT_GE(felt, kPushStart + cycles(parameters_.safety.lift));
  EXPECT_LE(felt, kPushStart + cycles(parameters_.safety.lift) + 10);
  parameters_.plant.contact_sensors = false;
  run(kPushStart + 1500, 0);
  EXPECT_EQ(latched(kCauseLift), kNever);
}

class StuckImu : public BodyStops, public testing::WithParamInterface<const char*> {};

TEST_P(StuckImu, LimitsTheSpeed) {
  constexpr std::uint64_t kOnset = 3000;
  std::uint64_t slowed = kNever;
  run(5000, 1.0, [&](ClosedLoop& loop) {
    if (loop.cycle() == kOnset) loop.inject_fault(GetParam(), "stuck");
    if (loop.cycle() == 0 || slowed != kNever) return;
    if (loop.row().monitor->permit.speed_limit == parameters_.safety.slow_speed) slowed = loop.cycle() - 1;
  });
  // The sample of kOnset is held; the next one is the first that repeats it.
  EXPECT_EQ(slowed, kOnset + cycles(parameters_.safety.imu_stuck));
  EXPECT_EQ(warned_, kCauseImuStuck);
  EXPECT_EQ(caused_, 0u);
}

INSTANTIATE_TEST_SUITE_P(Devices, StuckImu, testing::Values("gyro", "accelerometer"),
                         [](const auto& device) { return std::string(device.param); });

}  // namespace robot_control::tests
