/// The driver on simulated devices, through a real file descriptor; every_drive_test.cpp holds it to the contract.

#include "drivers/drive/can_driver.h"

#include <sys/socket.h>
#include <unistd.h>

#include "drivers/drive/device_rig.h"
#include "support/allocation_guard.h"
#include "support/matchers.h"

namespace robot_control::tests {

enum class TestedDialect { kOdrive, kCia402, kVesc, kDamiao, kAk };
constexpr const char* kNames[] = {"odrive", "cia402", "vesc"};

/// Two drives on devices in virtual time. A datagram socket stands between the driver and the bus.
class CanMachine final : public Driver {
 public:
  static constexpr double kPeriod = 0.001;

  explicit CanMachine(TestedDialect dialect, std::size_t joints = 2) : rig_(1 / kPeriod) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0, ends) != 0) throw DriverError("no socket");
    wire_ = ends[1];
    party_ = rig_.bus().join([this](const can_frame& frame, std::int64_t) {
      if (write_frame(frame) != kFrameBytes) ADD_FAILURE() << "the wire is full";
    });
    rig_.host_lives = false;
    const std::uint8_t first =
        dialect == TestedDialect::kOdrive || dialect == TestedDialect::kVesc ? 0 : 1;  // elsewhere 0 is no node
    add(dialect, first);
    add(dialect, first + 1);
    // At the joint 0.0625 kg·m²: d h/J = 0.16.
    const Brake brake{.effort = 3, .hold_effort = 3, .damping = 10, .stiffness = 400, .hold_speed = 0.3};
    driver_.emplace(CanBusParameters{}, rig_.made_drives(), std::vector{brake, brake}, joints, kPeriod,
                    sockets(ends[0]), [this] { return CanTime{.time_ns = rig_.now_ns(), .utc_ns = rig_.now_ns()}; });
  }
  ~CanMachine() override { close(wire_); }
  CanMachine(const CanMachine&) = delete;
  CanMachine& operator=(const CanMachine&) = delete;

  /// The contract begins with a machine that is ready.
  void start() override {
    driver_->start();
    SensorFrame frame;
    for (int i = 0; i < 5000 && frame.driver_state != DriverState::kRunning; ++i) {
      read(frame);
      write(std::vector<JointCommand>(2));
    }
  }
  void read(SensorFrame& sensors) noexcept override { driver_->read(sensors); }
  void write(std::span<const JointCommand> commands) noexcept override {
    driver_->write(commands);
    run_bus(1);
  }
  void stop() noexcept override { driver_->stop(); }

  /// Carries the frames of the driver and runs the devices.
  void run_bus(int cycles) {
    can_frame frame{};
    while (recv(wire_, &frame, kFrameBytes, 0) == kFrameBytes) rig_.bus().send(party_, frame);
    for (int i = 0; i < cycles; ++i) rig_.cycle();
  }

  DeviceRig& rig() { return rig_; }
  CanDriver& driver() { return *driver_; }

 private:
  static CanSockets sockets(int descriptor) {
    CanSockets one;
    one.emplace_back(descriptor);
    return one;
  }
  ssize_t write_frame(const can_frame& frame) const { return ::send(wire_, &frame, kFrameBytes, 0); }
  void add(TestedDialect dialect, std::uint8_t node) {
    if (dialect == TestedDialect::kOdrive) robot_control::add(rig_, odrive_pair(node));
    if (dialect == TestedDialect::kCia402) robot_control::add(rig_, cia402_pair(node));
    if (dialect == TestedDialect::kDamiao) robot_control::add(rig_, damiao_pair(node));
    if (dialect == TestedDialect::kAk) robot_control::add(rig_, ak_pair(node));
    if (dialect != TestedDialect::kVesc) return;
    VescPair pair = vesc_pair(node);
    pair.drive.drive.max_silence = 10;  // of 2 ms
    robot_control::add(rig_, pair);
  }

  DeviceRig rig_;
  int wire_ = -1;
  std::size_t party_ = 0;
  std::optional<CanDriver> driver_;
};

struct CanDriverOn : ::testing::TestWithParam<TestedDialect> {
  SensorFrame cycle(const JointCommand& command = {}) {
    SensorFrame frame;
    machine_.read(frame);
    machine_.write(std::vector<JointCommand>(2, command));
    return frame;
  }
  SensorFrame cycles(int count, const JointCommand& command = {}) {
    SensorFrame frame;
    for (int i = 0; i < count; ++i) frame = cycle(command);
    return frame;
  }

  double joint_speed(std::size_t joint) { return std::abs(machine_.rig().motor(joint).velocity) / 2.5; }

  CanMachine machine_{GetParam()};
  const JointCommand drive_{.mode = JointMode::kVelocity, .velocity = 5, .damping = 2};
};

TEST_P(CanDriverOn, StartReturnsAtOnceAndReadReportsStarting) {
  machine_.rig().device(0).inject(DeviceFault::kOff);
  machine_.driver().start();
  const SensorFrame frame = cycles(10'000, drive_);
  EXPECT_EQ(frame.driver_state, DriverState::kStarting);
  EXPECT_EQ(frame.faults, 0u);
  EXPECT_FALSE(has(frame.joints[0], kValidPosition));
  EXPECT_THAT(machine_.driver().drives()[0].words(), HasSubstr("starting; the drive waits for the first frame"));
  EXPECT_THAT(machine_.driver().drives()[1].words(), HasSubstr("ready; the drive waits to be enabled"));
  EXPECT_EQ(machine_.rig().motor(1).velocity, 0);
  machine_.rig().device(0).inject(DeviceFault::kNone);
  EXPECT_EQ(cycles(5000).driver_state, DriverState::kRunning);
}

TEST_P(CanDriverOn, TheOtherJointBrakesWhenADriveIsLost) {
  machine_.start();
  cycles(500, drive_);
  machine_.rig().device(0).inject(DeviceFault::kOff);
  int seen = 0;
  while (cycle(drive_).driver_state != DriverState::kFault && seen < 100) ++seen;
  EXPECT_LE(seen, 22);
  const double speed = std::abs(machine_.rig().motor(1).velocity);
  cycles(5, drive_);
  EXPECT_LT(std::abs(machine_.rig().motor(1).velocity), speed - 0.5);
  const SensorFrame frame = cycles(1000, drive_);
  EXPECT_EQ(frame.faults, std::uint64_t{kFaultLink});
  EXPECT_LT(joint_speed(1), 0.05);
}

TEST_P(CanDriverOn, TheMotorsHaveNoTorqueAfterAStopWithoutAWrite) {
  cycles(3000, drive_);
  machine_.driver().stop();
  machine_.run_bus(2);
  EXPECT_EQ(machine_.rig().motor(0).torque, 0);
  EXPECT_EQ(machine_.rig().motor(1).torque, 0);
}

TEST_P(CanDriverOn, AJointWithoutADriveHasNoSampleAndHindersNothing) {
  CanMachine machine(GetParam(), 4);
  machine.start();
  SensorFrame frame;
  for (int i = 0; i < 3000; ++i) {
    machine.read(frame);
    machine.write(std::vector<JointCommand>(4, drive_));
  }
  EXPECT_EQ(frame.joint_count, 4u);
  EXPECT_EQ(frame.joints[2].valid, 0u);
  EXPECT_NEAR(std::abs(machine.rig().motor(0).velocity) / 2.5, 5, 0.5);
}

TEST_P(CanDriverOn, SaysWhatEachJointDoesOnSilence) {
  cycles(3000);
  const std::string text = machine_.driver().description();
  EXPECT_THAT(text, HasSubstr("load at most"));
  EXPECT_THAT(text, HasSubstr(GetParam() == TestedDialect::kCia402 ? "holds (read from the drive)"
                                                                   : "coasts (stated in the drive file)"));
}

TEST_P(CanDriverOn, SaysThatTheBusIsSilent) {
  machine_.start();
  EXPECT_EQ(cycle().links[0].state, LinkState::kUp);
  EXPECT_EQ(machine_.driver().warning(), "");
  machine_.rig().bus().lose(1);
  EXPECT_EQ(cycles(1600).links[0].state, LinkState::kDown);
  EXPECT_THAT(machine_.driver().warning(), HasSubstr("the bus: no frame was received"));
  machine_.rig().bus().lose(0);
  EXPECT_EQ(cycles(200).links[0].state, LinkState::kUp);
}

TEST_P(CanDriverOn, ASampleThatIsMissingMovesOnWithItsVelocity) {
  cycles(3000, drive_);
  const JointSample last = cycle(drive_).joints[0];
  machine_.rig().bus().lose(1);
  cycle(drive_);
  const JointSample missing = cycle(drive_).joints[0];
  EXPECT_EQ(missing.age_ns, 1'000'000);
  EXPECT_NEAR(missing.position, last.position + 0.002 * last.velocity, 1.0e-4);
}

TEST_P(CanDriverOn, NothingMovesAfterAFaultUntilTheNextStart) {
  machine_.start();
  machine_.rig().device(0).inject(DeviceFault::kReset);
  cycles(3000, drive_);
  EXPECT_EQ(cycle(drive_).driver_state, DriverState::kFault);
  EXPECT_LT(joint_speed(1), 0.05);
  machine_.start();
  EXPECT_EQ(cycle().driver_state, DriverState::kRunning);
  EXPECT_GT(cycles(500, drive_).joints[0].velocity, 4);
}

TEST_P(CanDriverOn, ReadAndWriteDoNotAllocate) {
  machine_.start();
  const std::vector<JointCommand> commands(2, drive_);
  SensorFrame frame;
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    machine_.read(frame);
    machine_.write(commands);
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST_P(CanDriverOn, BrakesAndHoldsOnASlope) {
  machine_.start();
  cycles(500, drive_);
  machine_.rig().slope = 0.3;
  cycles(1000);
  const double held = cycle().joints[0].position;
  EXPECT_NEAR(cycles(1000).joints[0].position, held, 0.01);
}

/// Drives that close an impedance by themselves.
struct CanDriverOfImpedances : ::testing::Test {
  explicit CanDriverOfImpedances(TestedDialect dialect = TestedDialect::kDamiao) : machine_(dialect) {}
  void SetUp() override { machine_.start(); }
  SensorFrame cycles(int count, const JointCommand& command) {
    SensorFrame frame;
    for (int i = 0; i < count; ++i) {
      machine_.read(frame);
      machine_.write(std::vector<JointCommand>(2, command));
    }
    return frame;
  }
  /// N·m, of joint 0: the gear is 2.5.
  double torque() { return 2.5 * std::abs(machine_.rig().motor(0).torque); }

  CanMachine machine_;
};

/// Drives that keep their last order for ever.
struct CanDriverOfKeepers : CanDriverOfImpedances {
  CanDriverOfKeepers() : CanDriverOfImpedances(TestedDialect::kAk) {}
};

TEST_F(CanDriverOfKeepers, AMotorThatLosesItsLineStandsStillWithItsLastOrder) {
  const DeviceMotor& motor = machine_.rig().motor(0);
  const double begin = motor.position;
  cycles(1, {.mode = JointMode::kImpedance, .damping = 0.5, .effort = 2});
  machine_.rig().run(3);  // The driver is silent.
  EXPECT_NEAR(motor.velocity, 0, 0.01);
  EXPECT_NEAR(std::abs(motor.position - begin) / 2.5, 0.2 * 2 / 4, 0.02);  // the limit of 4 N·m within 0.2 rad
}

/// The torque is that of the order at the angle that the motor has in the cycle, also in motion.
TEST_F(CanDriverOfKeepers, TheirStiffnessDoesNotChangeTheMotion) {
  SensorFrame frame = cycles(1, {});
  const double begin = frame.joints[0].position;
  for (int i = 0; i < 800; ++i) frame = cycles(1, {.mode = JointMode::kImpedance, .damping = 0.5, .effort = 2});
  EXPECT_NEAR(frame.joints[0].velocity, 2 / 0.5, 0.1);
  EXPECT_GT(frame.joints[0].position - begin, 2);
}

TEST_F(CanDriverOfImpedances, TheSumOfImpedanceAndTorqueIsWithinTheLimit) {
  constexpr double kLimit = 4, kStep = 2.5 * 2 * 54 / 4095;  // N·m, of drive_parameters; of the protocol
  const double position = cycles(1, {}).joints[0].position;
  const JointCommand far{.mode = JointMode::kImpedance, .position = position + 10, .stiffness = 50, .effort = -2};
  for (int i = 0; i < 20; ++i) {
    cycles(1, far);
    EXPECT_LE(torque(), kLimit + kStep);
  }
  EXPECT_GT(torque(), kLimit - kStep);
}

/// The motor computes its torque from its own motion, so the damping acts in the cycle of a push.
TEST_F(CanDriverOfImpedances, TheDriveReactsWithoutTheDriver) {
  const double position = cycles(1000, {}).joints[0].position;
  const JointCommand held{.mode = JointMode::kImpedance, .position = position, .stiffness = 20, .damping = 1};
  cycles(1000, held);
  machine_.rig().motor(0).velocity = 2.5;  // rad/s; of the joint 1
  machine_.rig().cycle();
  EXPECT_NEAR(torque(), 1, 0.15);  // the push slows down by a tenth within the cycle
}

TEST_F(CanDriverOfImpedances, ReadAndWriteDoNotAllocate) {
  const std::vector<JointCommand> commands(
      2, {.mode = JointMode::kImpedance, .position = 0.1, .stiffness = 20, .damping = 1});
  SensorFrame frame;
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    machine_.read(frame);
    machine_.write(commands);
  }
  EXPECT_EQ(guard.count(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Dialects, CanDriverOn,
                         ::testing::Values(TestedDialect::kOdrive, TestedDialect::kCia402, TestedDialect::kVesc),
                         [](const auto& each) { return std::string(kNames[static_cast<std::size_t>(each.param)]); });

}  // namespace robot_control::tests
