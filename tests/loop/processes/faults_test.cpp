/// Every sensor and motor fails in every way, in four processes and in one: the same numbers, and never a standstill of
/// time.

#include <gtest/gtest.h>

#include "loop/simulation_services.h"
#include "signals/names.h"
#include "simulation/closed_loop.h"
#include "support/log_table.h"
#include "support/processes/four_nodes.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

constexpr double kTimeout = 240;  // s

// One fault after the other, each in a block of cycles: drive, fail, recover, stop, reset of the latched stop.
constexpr std::uint64_t kBlock = 1200;
constexpr std::uint64_t kFails = 400;
constexpr std::uint64_t kRecovers = 460;
constexpr std::uint64_t kStops = 500;
constexpr std::uint64_t kResets = 1190;

struct Fault {
  std::string component, kind;
};

std::vector<Fault> all_faults() {
  std::vector<Fault> faults;
  for (const char* component : {"left_encoder", "right_encoder", "left_motor", "right_motor", "gyro", "accelerometer",
                                "battery", "e_stop_button"}) {
    for (const std::string_view kind : kFaultKindNames) {
      if (kind != "ok") faults.push_back({component, std::string(kind)});
    }
  }
  return faults;
}

struct Faults : ::testing::Test {
  Faults() {
    std::ostringstream script;
    script << "cycle,linear,angular,event\n";
    for (std::uint64_t i = 0; i < faults_.size(); ++i) {
      script << i * kBlock + 1 << ",0.3,0.2,\n" << i * kBlock + kStops << ",0,0,\n";
      script << i * kBlock + kResets << ",,,e_stop_reset\n";
    }
    const std::string path = folder_.write("script.csv", script.str()).string();
    parameters_ = read_parameters(std::string(PROJECT_DIRECTORY) + "/config/robot_params.yaml",
                                  {{"robot.command_script", path, "test"}});
    parameters_.safety.stop_deceleration = 10;  // an encoder that lied leaves no slide that outlasts the block
    parameters_.loop.clock = ClockMode::kLockstep;
    parameters_.loop.wait_for_nodes = true;
    parameters_.loop.wait_for_telemetry = true;
    parameters_.telemetry.record = RecordMode::kAlways;
    parameters_.telemetry.directory = (folder_.path() / "log").string();
    robot_ = read_drive_train(load_description(parameters_.urdf), parameters_.robot);
  }

  const std::vector<Fault> faults_ = all_faults();
  TemporaryFolder folder_;
  Parameters parameters_;
  DriveTrain robot_;
};

TEST_F(Faults, GiveTheNumbersOfTheClosedLoopInFourProcesses) {
  FourNodes(parameters_, robot_, true).run(kTimeout, [&](DriverProcess& driver) {
    SimulationServices& services = *driver.services();
    services.set_pause(true);
    ServiceAnswer answer;
    for (int patience = 0; patience < 10 && !answer.success; ++patience) answer = services.step(1);  // 2 s each
    ASSERT_TRUE(answer.success) << answer.message;
    std::uint64_t done = 1;
    for (const Fault& fault : faults_) {
      ASSERT_TRUE(services.step(kFails - done).success);
      ASSERT_TRUE(services.inject_fault(fault.component, fault.kind).success);
      ASSERT_TRUE(services.step(kRecovers - kFails).success) << fault.component << ' ' << fault.kind;
      ASSERT_TRUE(services.inject_fault(fault.component, "ok").success);
      ASSERT_TRUE(services.step(kBlock - kRecovers).success);
      done = 0;
    }
  });

  LogTable one(robot_, parameters_.loop.period());
  ClosedLoop loop(parameters_);
  for (const Fault& fault : faults_) {
    bool driving = false;
    for (std::uint64_t k = 0; k < kBlock; ++k) {
      if (k == kFails) {
        driving = loop.row().monitor->permit.state == SupervisorState::kDrive;
        loop.inject_fault(fault.component, fault.kind);
      }
      if (k == kRecovers) loop.inject_fault(fault.component, "ok");
      loop.step();
      one.add(loop.row());
    }
    EXPECT_TRUE(driving) << "before " << fault.component << ' ' << fault.kind << " nothing was shown";
  }
  EXPECT_EQ(LogTable::difference(LogTable::of_bag(folder_.path() / "log" / "run.bag"), one), "");
}

}  // namespace robot_control::tests
