// A body may slide on after its wheels have stopped.

#include "safety/measurements/slide.h"

#include "safety/monitor_fixture.h"

namespace robot_control::tests {

constexpr double kSecond = 1000;  // cycles

struct SlideTest : MonitorTest {
  SlideTest() { begin_with(without_heartbeat()); }
  /// Drives until the bound has grown to the rims' speed.
  void drive_for_long() {
    ask_for(0.5);
    turn_wheels(kSpeed);
    steps(200);
  }
  void stop_at_once() {
    ++input_.operator_input.e_stop_services;
    stand();
  }
  /// Cycles from now until a reset is accepted, requested in each of them.
  std::uint64_t cycles_until_released(std::uint64_t limit) {
    for (std::uint64_t cycles = 0; cycles < limit; ++cycles) {
      const std::uint64_t refusal = reset();
      if (refusal == 0) return cycles;
      if (refusal != kRefusalSliding) return limit;
    }
    return limit;
  }
};

// 5 rad/s · 0.1 m: 0.5 m/s, gone after 0.25 s.
TEST_F(SlideTest, AResetWaitsUntilASlideWouldHaveEnded) {
  drive_for_long();
  stop_at_once();
  const double waits = 0.5 / kStopDeceleration * kSecond - kStands;
  EXPECT_NEAR(static_cast<double>(cycles_until_released(5000)), waits, 25) << "20 cycles of speed window";
}

TEST_F(SlideTest, OneWheelIsEnoughForASlide) {
  ask_for(0.5);
  speed_ = {0, -kSpeed};
  steps(200);
  stop_at_once();
  EXPECT_EQ(reset(), std::uint64_t{kRefusalSliding});
}

TEST_F(SlideTest, ARobotThatRampedDownGentlyNeedNotWait) {
  drive_for_long();
  for (double speed = kSpeed; speed > 0; speed -= 0.9 * kStopDeceleration / 0.1 * kPeriod) {
    turn_wheels(speed);
    step();
  }
  ++input_.operator_input.e_stop_services;
  stand();
  EXPECT_EQ(reset(), 0u);
}

TEST_F(SlideTest, AJerkOfAWheelIsNoSpeedOfTheBody) {
  drive();  // 5 cycles
  stop_at_once();
  EXPECT_EQ(reset(), 0u);
}

TEST_F(SlideTest, ANewRunBeginsAtRest) {
  drive_for_long();
  ++input_.operator_input.e_stop_services;
  step();
  new_run();
  ask_for(0);
  turn_wheels(0);
  steps(kStart);
  EXPECT_EQ(reset(), 0u);
}

TEST(Slide, GrowsNoFasterThanTyresCarryAndNotBeyondTheLimit) {
  SafetyParameters parameters;
  parameters.stop_deceleration = 0.5;
  parameters.wheel_speed.limit = 20;  // 2 m/s
  DriveTrain robot;
  robot.wheels = {{.joint = 0, .radius = 0.1}};
  WheelMotion motion(1, 1e-3);
  Slide slide(parameters, robot, 1e-3);
  SensorFrame sensors;
  set_joints_valid(sensors, kValidMotion);
  sensors.joint_count = 1;
  double before = 0;
  for (int k = 0; k < 1000; ++k) {
    sensors.head.cycle = static_cast<std::uint64_t>(k);
    sensors.joints[0].position = 0.1 * k;  // 100 rad/s
    motion.step(sensors);
    slide.step(motion, false, 1);
    EXPECT_LE(slide.speed(), before + Slide::kGrip * 1e-3 + 1e-12);
    before = slide.speed();
  }
  EXPECT_DOUBLE_EQ(slide.speed(), 2.0);
  set_joints_valid(sensors, 0);
  for (int k = 1000; k < 2000; ++k) {
    sensors.head.cycle = static_cast<std::uint64_t>(k);
    motion.step(sensors);
    slide.step(motion, false, 1);
  }
  EXPECT_NEAR(slide.speed(), 2.0, 0.05) << "unknown, but for two windows";
  slide.enter_run();
  EXPECT_FALSE(slide.possible());
}

}  // namespace robot_control::tests
