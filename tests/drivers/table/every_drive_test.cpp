/// Claims about every drive of drive_table.def: the contract of a driver, rest when its answers fail, and no torque
/// before all drives are checked.

#include <algorithm>
#include <cmath>

#include "drivers/driver_contract.h"
#include "drivers/line/answer_faults.h"
#include "drivers/table/drive_machine.h"
#include "support/matchers.h"

namespace robot_control::tests {

struct DriveUnderTest {
  const DriveRow* row = nullptr;
  bool takes_speeds = false;
};

void PrintTo(const DriveUnderTest& drive, std::ostream* out) {
  *out << drive.row->name << (drive.takes_speeds ? " with speeds" : " with torques");
}

std::vector<DriveUnderTest> all_drives() {
  std::vector<DriveUnderTest> drives;
  for (const DriveRow& row : kDriveRows) {
    if (row.command != "velocity") drives.push_back({&row, false});
    if (row.command != "impedance") drives.push_back({&row, true});
  }
  return drives;
}

std::vector<MachineUnderTest> drives_with_torques() {
  std::vector<MachineUnderTest> machines;
  for (const DriveUnderTest& drive : all_drives()) {
    if (drive.takes_speeds) continue;
    machines.push_back({.name = std::string(drive.row->name),
                        .make = [row = drive.row] { return std::make_unique<DriveMachine>(*row, false); },
                        .joints = joints_of(example(drive.row->name)).size(),
                        .period = 1 / DriveMachine::kRate,
                        .effort_limit = DriveMachine(*drive.row, false).file().capability(0).torque,
                        .effort = 0.1,
                        .damping = 0.5,
                        .stiffness = 5,
                        .devices_allocate = true});
  }
  return machines;
}

INSTANTIATE_TEST_SUITE_P(EveryDrive, DriverContract, testing::ValuesIn(drives_with_torques()), machine_name);

struct EveryDrive : testing::TestWithParam<DriveUnderTest> {
  void SetUp() override {
    machine_.start();
    ASSERT_EQ(run(2), DriverState::kRunning) << machine_.warning();
    ASSERT_NEAR(machine_.joints[0].velocity, kSpeed, 0.5);
  }

  DriverState run(double seconds) {
    const JointCommand command = GetParam().takes_speeds
                                     ? JointCommand{.mode = JointMode::kDriveVelocity, .velocity = kSpeed}
                                     : JointCommand{.mode = JointMode::kVelocity, .velocity = kSpeed, .damping = 0.2};
    return machine_.cycles(static_cast<int>(std::lround(seconds * DriveMachine::kRate)), command).driver_state;
  }
  bool turns() const {
    return std::ranges::any_of(machine_.joints,
                               [](const JointSample& joint) { return std::abs(joint.velocity) > 0.5; });
  }

  static constexpr double kSpeed = 5;  // rad/s
  DriveMachine machine_{*GetParam().row, GetParam().takes_speeds};
};

TEST_P(EveryDrive, IsAtRestWhileItsAnswersFailAndUntilTheReset) {
  const std::string component = machine_.file().line_block() == "bus" ? "bus" : "line";
  for (const std::string_view fault : kAnswerFaults) {
    if (fault == "ok") continue;
    SCOPED_TRACE(std::string(fault));
    ASSERT_EQ(machine_.board().inject(component, fault), "");
    run(1);
    for (int i = 0; i < 20; ++i) {
      ASSERT_FALSE(turns()) << 0.1 * i;
      run(0.1);
    }
    ASSERT_EQ(machine_.board().inject(component, "ok"), "");
    EXPECT_EQ(run(2), DriverState::kFault);
    EXPECT_FALSE(turns());
    for (int i = 0; i < 20 && machine_.frame().driver_state == DriverState::kFault; ++i) {
      machine_.turn_to_start();
      machine_.reset();
      run(1);
    }
    run(3);
    ASSERT_EQ(machine_.frame().driver_state, DriverState::kRunning) << machine_.warning();
    ASSERT_TRUE(turns()) << machine_.warning();
  }
}

TEST_P(EveryDrive, StatesWhatItCanDo) {
  for (std::size_t joint = 0; joint < 2; ++joint) {
    EXPECT_EQ(machine_.file().capability(joint).velocity, 30);
    EXPECT_GE(machine_.file().capability(joint).torque, 3);
  }
}

INSTANTIATE_TEST_SUITE_P(Table, EveryDrive, testing::ValuesIn(all_drives()), [](const auto& each) {
  return std::string(each.param.row->name) + (each.param.takes_speeds ? "_with_speeds" : "_with_torques");
});

/// Drives on CAN, one or more of which are not as the drive file states.
struct EveryDriveOnCan : testing::TestWithParam<const DriveRow*> {
  EveryDriveOnCan() {
    for (JointSample& joint : machine_.joints) joint.velocity = 0.1;
  }

  /// N·m, the greatest one of any joint while the driver starts for `seconds`. The brake damps the joints' motion.
  double torque(double seconds) {
    double greatest = 0;
    for (int i = 0; i < seconds * DriveMachine::kRate; ++i) {
      machine_.cycles(1);
      for (std::size_t joint = 0; joint < machine_.joints.size(); ++joint)
        greatest = std::max(greatest, std::abs(machine_.board().torque(joint)));
    }
    return greatest;
  }

  DriveMachine machine_{*GetParam(), false};
};

TEST_P(EveryDriveOnCan, HasNoTorqueBeforeTheLastDriveIsChecked) {
  const std::string last = joints_of(example(GetParam()->name)).back();
  ASSERT_EQ(machine_.board().inject(last, "off"), "");
  EXPECT_EQ(torque(3), 0);
  EXPECT_EQ(machine_.frame().driver_state, DriverState::kStarting);
  EXPECT_THAT(machine_.warning(), AllOf(HasSubstr(last), Not(HasSubstr("enabled"))));
  ASSERT_EQ(machine_.board().inject(last, "ok"), "");
  EXPECT_GT(torque(5), 0);
  EXPECT_EQ(machine_.frame().driver_state, DriverState::kRunning) << machine_.warning();
}

TEST_P(EveryDriveOnCan, HasNoTorqueIfTheLastDriveIsRefused) {
  if (GetParam()->command != "impedance") GTEST_SKIP() << "drives of wheels have no angle at the start";
  machine_.joints.back().position += 1;
  EXPECT_EQ(torque(3), 0);
  EXPECT_EQ(machine_.frame().driver_state, DriverState::kFault);
  EXPECT_THAT(machine_.warning(), HasSubstr("differs from the drive file: start_angle"));
}

std::vector<const DriveRow*> drives_on_can() {
  std::vector<const DriveRow*> rows;
  for (const DriveRow& row : kDriveRows)
    if (row.driver == "can") rows.push_back(&row);
  return rows;
}

INSTANTIATE_TEST_SUITE_P(Table, EveryDriveOnCan, testing::ValuesIn(drives_on_can()),
                         [](const auto& each) { return std::string(each.param->name); });

}  // namespace robot_control::tests
