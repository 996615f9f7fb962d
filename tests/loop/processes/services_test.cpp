/// Pause, step, reset and faults while four processes run: in lockstep with the numbers of the closed loop, on the wall
/// clock without a jump.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "simulation/closed_loop.h"
#include "support/log_table.h"
#include "support/processes/four_nodes.h"

namespace robot_control::tests {

constexpr double kServicePatience = 120;         // s
constexpr std::int64_t kSecond = 1'000'000'000;  // ns

constexpr const char* kCurve = "cycle,linear,angular,event\n1,0.5,0.2,\n1000,0.5,0.2,\n2000,0.5,0.2,\n3000,0.5,0.2,\n";

/// Drives a curve in every run.
struct Services : ::testing::Test {
  Services() : folder_(std::filesystem::temp_directory_path() / ("services-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "script.csv") << kCurve;
    parameters_ = read_parameters(std::string(PROJECT_DIRECTORY) + "/config/robot_params.yaml",
                                  {{"robot.command_script", (folder_ / "script.csv").string(), "test"}});
    parameters_.loop.wait_for_nodes = true;
    parameters_.loop.wait_for_telemetry = true;
    parameters_.telemetry.record = RecordMode::kAlways;
    parameters_.telemetry.directory = (folder_ / "log").string();
    robot_ = read_drive_train(load_description(parameters_.urdf), parameters_.robot);
  }
  ~Services() override { std::filesystem::remove_all(folder_); }

  /// run.bag of four processes under these hands.
  void run_processes(ClockMode clock, const FourNodes::Operator& operate) {
    parameters_.loop.clock = clock;
    FourNodes(parameters_, robot_, true).run(kServicePatience, operate);
  }

  LogTable four_processes(ClockMode clock, const FourNodes::Operator& operate) {
    run_processes(clock, operate);
    return LogTable::of_bag(folder_ / "log" / "run.bag");
  }

  std::filesystem::path folder_;
  Parameters parameters_;
  DriveTrain robot_;
};

/// Pauses before cycle 0, so that every event happens in a known cycle.
void step_from_the_beginning(SimulationServices& services, std::uint64_t cycles) {
  services.set_pause(true);
  ServiceAnswer answer;
  for (int patience = 0; patience < 10 && !answer.success; ++patience) answer = services.step(1);  // 2 s each
  ASSERT_TRUE(answer.success) << answer.message;
  answer = services.step(cycles - 1);
  ASSERT_TRUE(answer.success) << answer.message;
}

TEST_F(Services, StepsAndResetsInLockstepGiveTheNumbersOfTheClosedLoop) {
  constexpr std::uint64_t kFirst = 1500;  // cycles: at 0.5 m/s
  constexpr std::uint64_t kSecondRun = 700;
  const LogTable four = four_processes(ClockMode::kLockstep, [](DriverProcess& driver) {
    SimulationServices& services = *driver.services();
    step_from_the_beginning(services, kFirst);
    EXPECT_TRUE(services.reset().success);
    EXPECT_TRUE(services.inject_fault("gyro", "stuck").success);
    EXPECT_TRUE(services.step(kSecondRun).success);
    EXPECT_TRUE(services.reset().success) << "which heals";
    EXPECT_TRUE(services.step(kFirst).success);
  });

  LogTable one(robot_, parameters_.loop.period());
  ClosedLoop loop(parameters_);
  const auto steps = [&](std::uint64_t cycles) {
    for (std::uint64_t k = 0; k < cycles; ++k) {
      loop.step();
      one.add(loop.row());
    }
  };
  steps(kFirst);
  loop.reset();
  loop.inject_fault("gyro", "stuck");
  steps(kSecondRun);
  loop.reset();
  steps(kFirst);
  EXPECT_EQ(LogTable::difference(four, one), "");
}

/// Motion begins again from rest: nothing of the first run's 0.5 m/s is left in pose, command or torque.
TEST_F(Services, AResetAtSpeedOnTheWallClockIsFollowedWithoutAJump) {
  constexpr double kEffortStep = 1;  // N·m; max_linear_acceleration takes 0.65 from one cycle to the next
  const LogTable rows = four_processes(ClockMode::kWall, [](DriverProcess& driver) {
    sleep_ns(3 * kSecond / 2);
    const ServiceAnswer answer = driver.services()->reset();
    EXPECT_TRUE(answer.success) << answer.message;
    sleep_ns(kSecond);
  });
  std::size_t second = 0;
  while (second < rows.rows() && rows.at(second, "run") == 0) ++second;
  ASSERT_LT(second + 400, rows.rows()) << "the second run was too short to judge";
  EXPECT_GT(rows.at(second - 1, "truth_linear"), 0.4);
  EXPECT_EQ(rows.at(second, "cycle"), 0);
  EXPECT_EQ(rows.at(second, "stamp_ns"), rows.at(second - 1, "stamp_ns") + 1e6) << "one period after the last stamp";
  for (std::size_t row = second; row < second + 50; ++row) {
    if (std::isnan(rows.at(row, "estimate_x")) || std::isnan(rows.at(row, "requested_linear"))) continue;
    EXPECT_LT(std::abs(rows.at(row, "estimate_x")), 0.001);
    EXPECT_LT(std::abs(rows.at(row, "truth_linear")), 0.05);
    EXPECT_LT(std::abs(rows.at(row, "left_wheel_joint_effort") - rows.at(row - 1, "left_wheel_joint_effort")),
              row == second ? 20 : kEffortStep);
  }
  EXPECT_EQ(static_cast<std::uint64_t>(rows.at(second + 20, "permit_causes")) & kCauseDriverLost, 0u);
}

/// The operator reads this frame from the sensors channel.
SensorFrame newest(DriverProcess& driver) {
  SensorFrame sensors;
  while (driver.sensors().newest(sensors) != Lookup::kFrame) sleep_ns(1'000'000);
  return sensors;
}

TEST_F(Services, APauseOnTheWallClockStopsTimeAndIsNeitherCaughtUpNorSlip) {
  constexpr std::int64_t kPause = kSecond / 2;
  constexpr std::uint64_t kPeriod = 1'000'000;   // ns
  constexpr std::int64_t kStall = kSecond / 20;  // what a busy machine may take off a thread of this test
  const LogTable rows = four_processes(ClockMode::kWall, [](DriverProcess& driver) {
    SimulationServices& services = *driver.services();
    sleep_ns(kSecond);
    EXPECT_TRUE(services.set_pause(true).success);
    const SensorFrame before = newest(driver);
    const std::int64_t before_ns = monotonic_ns();
    sleep_ns(kPause);
    const SensorFrame paused = newest(driver);
    EXPECT_EQ(paused.driver_state, DriverState::kPaused);
    EXPECT_EQ(paused.head.cycle, before.head.cycle);
    EXPECT_EQ(paused.head.stamp_ns, before.head.stamp_ns);
    EXPECT_EQ(paused.joints[0].position, before.joints[0].position);

    EXPECT_TRUE(services.step(5).success);
    EXPECT_EQ(newest(driver).head.cycle, before.head.cycle + 5);
    EXPECT_EQ(newest(driver).driver_state, DriverState::kPaused);

    services.set_pause(false);
    while (newest(driver).driver_state == DriverState::kPaused) sleep_ns(1'000'000);
    const SensorFrame after = newest(driver);
    const std::int64_t paused_ns = monotonic_ns() - before_ns;
    EXPECT_GE(after.held_ns + 2 * kPeriod, before.held_ns + kPause);
    EXPECT_LE(after.held_ns, before.held_ns + static_cast<std::uint64_t>(paused_ns));
    EXPECT_NEAR(static_cast<double>(due_ns(after)), static_cast<double>(monotonic_ns()), kStall);
    EXPECT_LT(after.slipped_ns, before.slipped_ns + static_cast<std::uint64_t>(kPause) / 2);
    EXPECT_LT(after.head.cycle, before.head.cycle + 5 + static_cast<std::uint64_t>(kStall) / kPeriod) << "no burst";
    sleep_ns(kSecond / 5);
  });
  for (std::size_t row = 1; row < rows.rows(); ++row) {
    ASSERT_EQ(rows.at(row, "cycle"), rows.at(row - 1, "cycle") + 1);
    if (std::isnan(rows.at(row, "driver_state"))) continue;  // dropped: the machine was busy
    ASSERT_EQ(rows.at(row, "driver_state"), static_cast<double>(DriverState::kRunning)) << "no row is a pause";
  }
}

TEST_F(Services, SayWhyTheyDoNot) {
  run_processes(ClockMode::kLockstep, [](DriverProcess& driver) {
    SimulationServices& services = *driver.services();
    const ServiceAnswer running = services.step(1);
    EXPECT_FALSE(running.success);
    EXPECT_NE(running.message.find("only while paused"), std::string::npos) << running.message;
    const ServiceAnswer component = services.inject_fault("left_wing", "off");
    EXPECT_FALSE(component.success);
    EXPECT_NE(component.message.find("accelerometer"), std::string::npos) << component.message;
    const ServiceAnswer kind = services.inject_fault("gyro", "broken");
    EXPECT_FALSE(kind.success);
    EXPECT_NE(kind.message.find("intermittent"), std::string::npos) << kind.message;
    for (const std::string node : {"controller", "estimator", "monitor"}) {
      const ServiceAnswer fault = services.inject_fault(node, "off");
      EXPECT_FALSE(fault.success) << node;
      EXPECT_NE(fault.message.find("kill -STOP"), std::string::npos) << fault.message;
      EXPECT_NE(fault.message.find("ClosedLoop"), std::string::npos) << fault.message;
    }
  });
}

TEST_F(Services, AStepThatIsTakenBackSaysHowFarItCame) {
  run_processes(ClockMode::kWall, [](DriverProcess& driver) {
    SimulationServices& services = *driver.services();
    step_from_the_beginning(services, 10);
    ServiceAnswer long_step;
    std::thread stepping([&] { long_step = services.step(1'000'000); });
    while (newest(driver).head.cycle < 50) sleep_ns(1'000'000);
    EXPECT_FALSE(services.reset().success) << "a step is under way";
    services.set_pause(true);
    stepping.join();
    EXPECT_FALSE(long_step.success);
    EXPECT_NE(long_step.message.find("interrupted"), std::string::npos) << long_step.message;
  });
}

}  // namespace robot_control::tests
