/// Claims that hold for every dialect: the state machine of a drive against its device.

#include <cmath>
#include <numbers>
#include <random>

#include "drivers/drive/device_rig.h"
#include "drivers/odrive/odrive_messages_06.h"
#include "support/allocation_guard.h"
#include "support/matchers.h"

namespace robot_control::tests {

struct Dialect {
  std::string name;
  std::function<Device&(DeviceRig& rig, std::uint8_t node, double clock_ppm)> add;
  std::function<void(DeviceRig& rig, bool accepted)> add_unknown;  ///< unknown reaction on silence; null: never unknown
  std::vector<can_frame> foreign;                                  ///< each of another program that commands node 1
  std::function<bool(const can_frame& frame)> clears;              ///< whether it requests node 1 to clear its errors
  double torque_step = 0;                                          ///< N·m of the motor: one step of the protocol
  double count = 0;                                                ///< rad of the motor
  bool brakes_by_itself = false;
  bool clears_errors = true;  ///< on request; else an error ends with its cause
  double zero_torque = 0;     ///< N·m of the motor that an order of 0 may give
  bool damps = false;         ///< It brakes with a damping, whose torque has no bound of its own.
  bool is_absolute = false;   ///< Another zero is a fault, whenever it comes.
  bool keeps = false;         ///< It keeps its last order for ever.
};

/// Firmware 0.5.6, can_simple.cpp; ros_odrive, can_simple_messages.hpp.
std::vector<can_frame> foreign_to_odrive(odrive::Firmware firmware) {
  std::vector<can_frame> frames{encode(1, odrive::SetInputTorque{.torque = 0.1}), encode(1, odrive::SetAxisState{}),
                                word_frame(1U << 5U | 0x02U | CAN_RTR_FLAG, 0, 0)};  // Estop
  for (const canid_t command : {0x10U, 0x11U, 0x12U, 0x13U, 0x1AU})
    frames.push_back(word_frame(1U << 5U | command, 0, 8));
  const bool is_06 = firmware == odrive::Firmware::k06;
  frames.push_back(is_06 ? odrive::encode(1, odrive::v06::RxSdo{.opcode = odrive::v06::RxSdo::kWrite, .endpoint = 200})
                         : word_frame(1U << 5U | 0x06U, 2, 8));  // another node number
  return frames;
}

/// Firmware 6, datatypes.h: what moves a motor, configures one, or is forwarded to the commands of a maker's tool.
std::vector<can_frame> foreign_to_vesc() {
  std::vector<can_frame> frames;
  for (const canid_t command : {0U, 1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 10U, 11U, 12U, 13U, 19U, 21U, 26U, 29U, 30U, 31U})
    frames.push_back(word_frame(CAN_EFF_FLAG | command << 8U | 1U, 0, 4));
  return frames;
}

Dialect odrive_dialect(const std::string& name, odrive::Firmware firmware, double estimates_period) {
  return {.name = name,
          .add = [=](DeviceRig& rig, std::uint8_t node, double clock_ppm) -> Device& {
            OdrivePair pair = odrive_pair(node, firmware);
            pair.drive.estimates_period = pair.device.estimates_period = estimates_period;
            pair.device.watchdog_timeout = 0.1;
            pair.device.clock_ppm = clock_ppm;
            return add(rig, pair);
          },
          .add_unknown =
              [](DeviceRig& rig, bool accepted) {
                OdrivePair pair = odrive_pair(1);
                pair.drive.drive.on_silence = SilenceReaction::kUnknown;
                pair.drive.drive.accept_unknown_watchdog = accepted;
                add(rig, pair);
              },
          .foreign = foreign_to_odrive(firmware),
          .clears = [](const can_frame& frame) { return odrive::decode<odrive::v06::ClearErrors>(frame).has_value(); },
          .torque_step = 1.0e-6,
          .count = 2 * std::numbers::pi / 8192};
}

Dialect cia402_dialect(const std::string& name, cia402::ModeChoice mode, cia402::VelocityPdo velocity_pdo) {
  return {.name = name,
          .add = [=](DeviceRig& rig, std::uint8_t node, double clock_ppm) -> Device& {
            Cia402Pair pair = cia402_pair(node);
            pair.drive.mode = mode;
            pair.drive.velocity_pdo = velocity_pdo;
            pair.drive.torque_slope = mode == cia402::ModeChoice::kProfileTorque ? 1.0e4 : 0;
            pair.device.clock_ppm = clock_ppm;
            return add(rig, pair);
          },
          .add_unknown =
              [](DeviceRig& rig, bool accepted) {
                Cia402Pair pair = cia402_pair(1);
                pair.device.has_reactions = false;
                pair.drive.drive.accept_unknown_watchdog = accepted;
                add(rig, pair);
              },
          .foreign = {canopen::encode_nmt({.command = canopen::NmtCommand::kStart, .node = 0}), word_frame(0x201, 0, 4),
                      encode_sdo(canopen::SdoSide::kRequest, 1,
                                 canopen::expedited_download({.index = 0x6040, .sub = 0}, 0x0F, 2))},
          .clears =
              [before = false](const can_frame& frame) mutable {
                if (frame.can_id != 0x201) return false;
                return !std::exchange(before, (frame.data[0] & 0x80U) != 0) && before;
              },
          .torque_step = 0.002,
          .count = 2 * std::numbers::pi / 4096,
          .brakes_by_itself = true};
}

Dialect vesc_dialect() {
  return {.name = "Vesc",
          .add = [](DeviceRig& rig, std::uint8_t node, double clock_ppm) -> Device& {
            VescPair pair = vesc_pair(node);
            pair.device.speed_gain = 1;
            pair.device.clock_ppm = clock_ppm;
            return add(rig, pair);
          },
          .add_unknown =
              [](DeviceRig& rig, bool accepted) {
                VescPair pair = vesc_pair(1);
                pair.drive.drive.on_silence = SilenceReaction::kUnknown;
                pair.drive.drive.accept_unknown_watchdog = accepted;
                add(rig, pair);
              },
          .foreign = foreign_to_vesc(),
          .clears = [](const can_frame&) { return false; },
          .torque_step = 0.01,
          .count = 2 * std::numbers::pi / 42,
          .clears_errors = false};
}

/// PyPI damiao-motor 1.0.6: orders of all modes, requests, and what changes registers.
std::vector<can_frame> foreign_to_damiao() {
  using damiao::Operation;
  std::vector<can_frame> frames{damiao::encode(1, damiao::Request::kEnable), word_frame(0x101, 0, 8),
                                word_frame(0x201, 0, 4), word_frame(0x301, 0, 8)};
  for (const Operation operation : {Operation::kWrite, Operation::kStore})
    frames.push_back(damiao::encode(damiao::kRegisterId, damiao::RegisterAccess{.node = 1, .operation = operation}));
  return frames;
}

Dialect damiao_dialect() {
  return {.name = "Damiao",
          .add = [](DeviceRig& rig, std::uint8_t node, double) -> Device& { return add(rig, damiao_pair(node)); },
          .add_unknown = {},
          .foreign = foreign_to_damiao(),
          .clears =
              [](const can_frame& frame) {
                return frame.can_id == 1 && damiao::decode_request(frame) == damiao::Request::kClear;
              },
          .torque_step = 2 * 54.0 / 4095,
          .count = 2 * 12.5 / 65535,
          .zero_torque = 54.0 / 4095,
          .damps = true,
          .is_absolute = true};
}

/// PyPI python-cybergear 0.1.2 and robstride-dynamics 0.0.1: orders, requests, and what changes parameters.
std::vector<can_frame> foreign_to_cybergear() {
  std::vector<can_frame> frames;
  for (const unsigned type : {1U, 3U, 4U, 6U, 7U, 18U, 22U, 25U})
    frames.push_back(word_frame(CAN_EFF_FLAG | type << 24U | 0x7EU << 8U | 1U, 0, 8));
  return frames;
}

Dialect cybergear_dialect() {
  return {.name = "Cybergear",
          .add = [](DeviceRig& rig, std::uint8_t node, double) -> Device& { return add(rig, cybergear_pair(node)); },
          .add_unknown =
              [](DeviceRig& rig, bool accepted) {
                CybergearPair pair = cybergear_pair(1);
                pair.device.has_timeout = false;
                if (accepted) pair.drive.drive.on_silence = SilenceReaction::kKeeps;
                add(rig, pair);
              },
          .foreign = foreign_to_cybergear(),
          .clears =
              [](const can_frame& frame) {
                const auto id = cybergear::identifier_of(frame);
                return id && id->target == 1 && id->type == cybergear::Type::kRelease && frame.data[0] == 1;
              },
          .torque_step = 2 * 12.0 / 65535,
          .count = 2 * 12.566 / 65535,
          .zero_torque = 12.0 / 65535,
          .damps = true,
          .is_absolute = true};
}

/// Orders and requests, and packets under 29 bits of the servo mode.
std::vector<can_frame> foreign_to_ak() {
  return {encode_request(1, MitRequest::kEnable), encode_request(1, MitRequest::kSetZero), word_frame(1, 0, 8),
          word_frame(CAN_EFF_FLAG | 8U << 8U | 1U, 0, 8)};
}

Dialect ak_dialect() {
  return {.name = "Ak",
          .add = [](DeviceRig& rig, std::uint8_t node, double) -> Device& { return add(rig, ak_pair(node)); },
          .add_unknown = {},
          .foreign = foreign_to_ak(),
          .clears = [](const can_frame&) { return false; },
          .torque_step = 2 * 65.0 / 4095,
          .count = 2 * 12.5 / 65535,
          .clears_errors = false,
          .zero_torque = 65.0 / 4095,
          .damps = true,
          .is_absolute = true,
          .keeps = true};
}

/// Writes of a mode, of another register and to all controllers, and a stream of the maker's tool.
std::vector<can_frame> foreign_to_moteus() {
  const auto frame_of = [](canid_t id, std::uint64_t word, std::uint8_t bytes) {
    can_frame frame = word_frame(id, word, bytes);
    frame.flags = CANFD_FDF | CANFD_BRS;
    return frame;
  };
  return {moteus::encode(1, {}, moteus::Request{}), frame_of(0x201, 0x0A0001, 3), frame_of(0x7F, 0x000001, 3),
          word_frame(1 | CAN_EFF_FLAG, 0x02B00D, 7), frame_of(0x8001 | CAN_EFF_FLAG, 0x706F747320640540, 8)};
}

Dialect moteus_dialect() {
  return {.name = "Moteus",
          .add = [](DeviceRig& rig, std::uint8_t node, double) -> Device& { return add(rig, moteus_pair(node)); },
          .add_unknown = {},
          .foreign = foreign_to_moteus(),
          .clears = [](const can_frame&) { return false; },
          .torque_step = 1.0e-6,
          .count = 1.0e-6,
          .clears_errors = false,
          .damps = true,
          .is_absolute = true};
}

const Dialect kDialects[] = {
    vesc_dialect(),
    odrive_dialect("Odrive05", odrive::Firmware::k05, 0),
    odrive_dialect("Odrive06", odrive::Firmware::k06, 0),
    odrive_dialect("Odrive06Cyclic", odrive::Firmware::k06, 0.002),
    cia402_dialect("Cia402Cyclic", cia402::ModeChoice::kAny, cia402::VelocityPdo::kOff),
    cia402_dialect("Cia402VelocityPdo", cia402::ModeChoice::kAny, cia402::VelocityPdo::kTrue),
    cia402_dialect("Cia402Profile", cia402::ModeChoice::kProfileTorque, cia402::VelocityPdo::kDerived),
    damiao_dialect(),
    cybergear_dialect(),
    ak_dialect(),
    moteus_dialect(),
};

void PrintTo(const Dialect& dialect, std::ostream* out) {
  *out << dialect.name;
}

struct DriveAndDevice : ::testing::TestWithParam<Dialect> {
  DriveAndDevice() { device_ = &GetParam().add(rig_, 1, 0); }

  DrivePhase state() { return rig_.drive().status().state; }
  bool fails(double seconds = 2) {
    return rig_.run_until([this] { return state() == DrivePhase::kFault; }, seconds);
  }
  double motor_per_joint() { return -2.5; }  // direction and gear of node 1

  DeviceRig rig_;
  Device* device_ = nullptr;
};

TEST_P(DriveAndDevice, GetsReadyWithoutTorqueAndRunsWhenItIsEnabled) {
  ASSERT_TRUE(rig_.run_until([this] { return state() == DrivePhase::kReady; }, 5)) << rig_.drive().words();
  rig_.command_all({.torque = 2});
  rig_.run(0.5);
  EXPECT_EQ(state(), DrivePhase::kReady);
  EXPECT_EQ(rig_.motor().velocity, 0);
  EXPECT_TRUE(rig_.runs());
}

TEST_P(DriveAndDevice, SaysThatItWaitsWhileTheDeviceIsOff) {
  device_->inject(DeviceFault::kOff);
  rig_.run(2);
  EXPECT_EQ(state(), DrivePhase::kStarting);
  EXPECT_THAT(rig_.drive().words(), HasSubstr("wheel_1 (node 1): starting; the drive waits for the first frame"));
  device_->inject(DeviceFault::kNone);
  EXPECT_TRUE(rig_.runs());
}

TEST_P(DriveAndDevice, AppliesTheCommandedTorqueWithinOneStepOfTheProtocol) {
  ASSERT_TRUE(rig_.runs());
  std::mt19937_64 random(7);
  for (int i = 0; i < 300; ++i) {
    const double torque = std::uniform_real_distribution<>(-3, 3)(random);
    rig_.motor().velocity = 0;
    rig_.command_all({.enabled = true, .torque = torque});
    rig_.cycle();
    ASSERT_NEAR(rig_.motor().torque, torque / motor_per_joint(), GetParam().torque_step) << i;
  }
}

TEST_P(DriveAndDevice, LimitsTheTorqueAndTakesNanAsNone) {
  ASSERT_TRUE(rig_.runs());
  rig_.command_all({.enabled = true, .torque = 100});
  rig_.cycle();
  EXPECT_NEAR(rig_.motor().torque, 4 / motor_per_joint(), GetParam().torque_step);
  rig_.command_all({.enabled = true, .torque = std::nan("")});
  rig_.cycle();
  EXPECT_NEAR(rig_.motor().torque, 0, GetParam().zero_torque * (1 + 1.0e-9));
}

TEST_P(DriveAndDevice, ReportsTheAngleTheVelocityAndTheTorqueOfTheJoint) {
  ASSERT_TRUE(rig_.runs());
  rig_.command_all({.enabled = true, .torque = 1});
  rig_.run(0.2);
  rig_.command_all({.enabled = true, .torque = 0});
  rig_.run(0.2);
  rig_.command_all({.enabled = true, .torque = 0.5});
  rig_.run(0.05);
  const double per_joint = motor_per_joint();
  const double before = rig_.drive().sample().joint.position - rig_.motor().position / per_joint;
  rig_.run(0.5);
  const DriveSample& sample = rig_.drive().sample();
  const double true_velocity = rig_.motor().velocity / per_joint;
  ASSERT_GT(true_velocity, 5);
  // The sample is up to two periods old, the difference of positions another four.
  const double acceleration = 0.5 / (rig_.inertia * per_joint * per_joint);
  EXPECT_NEAR(sample.joint.velocity, true_velocity, 7 * rig_.period() * acceleration + 2 * GetParam().count / 0.016);
  EXPECT_NEAR(sample.joint.position - before, rig_.motor().position / per_joint,
              2 * rig_.period() * true_velocity + GetParam().count);
  EXPECT_NEAR(sample.joint.effort, 0.5, 2.5 * GetParam().torque_step);
  EXPECT_TRUE(sample.effort_valid);
}

/// Two drives with 5 % of the frames lost and clocks of ± 200 ppm.
void drive_with_losses(const Dialect& dialect, int seconds) {
  DeviceRig rig(500, 1.0e6, 11);
  dialect.add(rig, 1, 200);
  dialect.add(rig, 2, -200);
  rig.bus().lose(0.05);
  ASSERT_TRUE(rig.runs(20));
  for (int i = 0; i < 2 * seconds; ++i) {
    rig.command_all({.enabled = true, .torque = i % 2 == 0 ? 0.5 : -0.5});
    rig.run(0.5);
    ASSERT_TRUE(rig.all_are(DrivePhase::kRunning)) << i << rig.drive(0).words() << rig.drive(1).words();
  }
}

TEST_P(DriveAndDevice, LossesAndClocksStopNothing) {
  drive_with_losses(GetParam(), 30);
}

TEST_P(DriveAndDevice, NightlyLossesAndClocksStopNothingInHalfAnHour) {
  drive_with_losses(GetParam(), 1800);
}

TEST_P(DriveAndDevice, NoticesWithinItsMaximumSilenceThatTheCableIsOut) {
  ASSERT_TRUE(rig_.runs());
  rig_.bus().connect(rig_.host(), false);
  int cycles = 0;
  for (; state() == DrivePhase::kRunning && cycles < 100; ++cycles) rig_.cycle();
  EXPECT_LE(cycles, 22);
  EXPECT_THAT(rig_.drive().words(), HasSubstr("fault; the drive is silent"));
}

TEST_P(DriveAndDevice, HasNoTorqueAfterItsWatchdogWhenTheHostDies) {
  ASSERT_TRUE(rig_.runs());
  rig_.command_all({.enabled = true, .torque = 1});
  rig_.run(0.3);
  rig_.host_lives = false;
  rig_.run(0.1);
  const double speed = rig_.motor().velocity;
  ASSERT_LT(speed, -5);
  rig_.run(0.02);
  if (GetParam().keeps) {
    rig_.run(10);
    EXPECT_NEAR(rig_.motor().torque, 1 / motor_per_joint(), GetParam().torque_step);
  } else if (GetParam().brakes_by_itself) {
    rig_.slope = 0.3;
    rig_.run(1);
    const double held = rig_.motor().position;
    rig_.run(1);
    EXPECT_NEAR(rig_.motor().position, held, 1.0e-6);
  } else {
    EXPECT_EQ(rig_.motor().torque, 0);
    rig_.run(1);
    EXPECT_LT(rig_.motor().velocity, speed + 1);  // It coasts.
  }
}

TEST_P(DriveAndDevice, StaysInFaultUntilTheReset) {
  ASSERT_TRUE(rig_.runs());
  rig_.command_all({.enabled = true, .torque = 0.2});
  device_->inject(DeviceFault::kEncoder);
  ASSERT_TRUE(fails());
  device_->inject(DeviceFault::kNone);
  rig_.command_all({.enabled = true, .torque = 2});
  rig_.run(3);
  EXPECT_EQ(state(), DrivePhase::kFault);
  EXPECT_EQ(rig_.motor().torque, 0);
  rig_.reset();
  EXPECT_TRUE(rig_.runs());
}

TEST_P(DriveAndDevice, AFaultThatRemainsIsReportedAgainAfterTheReset) {
  ASSERT_TRUE(rig_.runs());
  device_->inject(DeviceFault::kUnderVoltage);
  ASSERT_TRUE(fails());
  rig_.reset();
  rig_.command_all({.enabled = true});
  EXPECT_TRUE(fails(8));
}

TEST_P(DriveAndDevice, OneResetIsOneAttempt) {
  if (!GetParam().clears_errors) GTEST_SKIP() << "an error of this drive ends by itself";
  ASSERT_TRUE(rig_.runs());
  device_->inject(DeviceFault::kEncoder);
  ASSERT_TRUE(fails());
  unsigned clears = 0;
  rig_.bus().join([&clears, is_one = GetParam().clears](const can_frame& frame, std::int64_t) {
    if (is_one(frame)) ++clears;
  });
  rig_.reset();
  rig_.command_all({.enabled = true, .torque = 2});
  rig_.run(8);
  EXPECT_EQ(state(), DrivePhase::kFault);
  EXPECT_THAT(rig_.drive().words(), HasSubstr("reports an error"));
  EXPECT_GE(clears, 1U);
  EXPECT_LE(clears, Drive::kMaxClears);
  EXPECT_EQ(rig_.motor().torque, 0);
  device_->inject(DeviceFault::kNone);
  rig_.reset();
  EXPECT_TRUE(rig_.runs());
}

TEST_P(DriveAndDevice, AForeignCommanderIsNamedAndTheJointCanStillBrake) {
  for (const can_frame& frame : GetParam().foreign) {
    SCOPED_TRACE(frame.can_id);
    DeviceRig rig;
    GetParam().add(rig, 1, 0);
    ASSERT_TRUE(rig.runs());
    rig.drive().receive(frame, rig.now_ns());
    EXPECT_EQ(rig.drive().status().state, DrivePhase::kFault);
    EXPECT_THAT(rig.drive().words(), HasSubstr("is commanded by another program"));
    rig.command_all({.enabled = true, .torque = 1});
    rig.run(0.02);
    EXPECT_NEAR(rig.motor().torque, 1 / motor_per_joint(), GetParam().torque_step);
  }
}

TEST_P(DriveAndDevice, APositionThatJumpsBeforeTheMotorHasTorqueIsAnotherZero) {
  ASSERT_TRUE(rig_.run_until([this] { return state() == DrivePhase::kReady; }, 5)) << rig_.drive().words();
  rig_.run(0.1);
  const double before = rig_.drive().sample().joint.position;
  device_->inject(DeviceFault::kOtherZero);
  rig_.run(0.1);
  if (GetParam().is_absolute) {
    EXPECT_THAT(rig_.drive().words(), HasSubstr("fault; the drive reports a jump of its position"));
    return;
  }
  ASSERT_TRUE(rig_.runs());
  rig_.run(0.1);
  EXPECT_NEAR(rig_.drive().sample().joint.position, before, 0.1 * DeviceRig::kStepNs * 1.0e-9);
}

TEST_P(DriveAndDevice, BrakesByItselfWhenItsAnswersAreLost) {
  ASSERT_TRUE(rig_.runs());
  rig_.command_all({.enabled = true, .torque = 0.5});
  rig_.run(0.2);
  rig_.command_all({.enabled = true, .torque = 0.5, .brake_torque = 0.5, .brake_damping = 1});
  rig_.answers = false;
  rig_.run(0.05);
  double speed = std::abs(rig_.motor().velocity);
  for (int i = 0; i < 1500; ++i) {
    rig_.cycle();
    ASSERT_LE(std::abs(rig_.motor().velocity), speed + 0.01) << i;
    speed = std::abs(rig_.motor().velocity);
    if (GetParam().brakes_by_itself || GetParam().damps) continue;
    ASSERT_LE(std::abs(rig_.motor().torque), std::abs(0.5 / motor_per_joint()) + GetParam().torque_step) << i;
  }
  // At this speed of the motor the damping of the brake has the torque of an order of 0.
  EXPECT_LT(speed, 0.1 + GetParam().zero_torque * 2.5 * 2.5);
}

TEST_P(DriveAndDevice, AUnknownReactionOnSilenceRefusesUnlessItIsAccepted) {
  if (!GetParam().add_unknown) GTEST_SKIP() << "its reaction is written to the drive";
  for (const bool accepted : {false, true}) {
    DeviceRig rig;
    GetParam().add_unknown(rig, accepted);
    EXPECT_EQ(static_cast<bool>(rig.runs(3)), accepted);
    if (!accepted) {
      EXPECT_THAT(rig.drive().words(), HasSubstr("unknown reaction on silence"));
    }
  }
}

TEST_P(DriveAndDevice, ReceiveAndStepDoNotAllocate) {
  ASSERT_TRUE(rig_.runs());
  FrameBatch send;
  std::mt19937_64 random(3);
  const AllocationGuard guard;
  for (std::int64_t i = 0; i < 5000; ++i) {
    can_frame frame{};
    frame.can_id = static_cast<canid_t>(random()) & (i % 8 == 0 ? ~canid_t{0} : CAN_SFF_MASK);
    frame.len = static_cast<std::uint8_t>(random() % 9);
    const std::uint64_t data = random();
    std::memcpy(frame.data, &data, sizeof data);
    send.clear();
    rig_.drive().receive(frame, rig_.now_ns() + i * 1'000'000);
    rig_.drive().step({.enabled = true, .reset = i % 100 == 0, .torque = 1}, rig_.now_ns() + i * 1'000'000, send);
  }
  EXPECT_EQ(guard.count(), 0u);
}

/// Hands random and mutated frames to a running drive. None may move the motor, and none may bring the drive into a
/// state that the reset cannot leave.
void receive_random_frames(DeviceRig& rig, int count, double zero_torque) {
  std::vector<can_frame> seen;
  rig.bus().join([&](const can_frame& frame, std::int64_t) {
    if (seen.size() < 1000) seen.push_back(frame);
  });
  ASSERT_TRUE(rig.runs());
  rig.run(0.1);
  std::mt19937_64 random(5);
  for (int i = 0; i < count; ++i) {
    can_frame frame = seen[random() % seen.size()];
    if (random() % 2 == 0) {
      frame.data[random() % std::max<unsigned>(frame.len, 8)] ^= static_cast<std::uint8_t>(1U << random() % 8);
    } else {
      const std::uint64_t data = random();
      std::memcpy(frame.data, &data, sizeof data);
    }
    if (random() % 4 == 0) frame.can_id = static_cast<canid_t>(random() & CAN_SFF_MASK);
    if (random() % 8 == 0) frame.can_id ^= canid_t{1} << random() % 16;
    if (random() % 64 == 0) frame.can_id = static_cast<canid_t>(random());
    if (random() % 16 == 0) frame.len = static_cast<std::uint8_t>(random() % 9);
    rig.drive().receive(frame, rig.now_ns());
    if (i % 10 == 0) rig.cycle();
    if (i % 1000 == 0) rig.command_all({.enabled = true, .reset = i % 2000 == 0});
  }
  EXPECT_NEAR(rig.motor().velocity, 0, zero_torque / rig.inertia * 1.0e-9 * static_cast<double>(rig.now_ns()));
  rig.command_all({.enabled = true});
  rig.cycle();
  rig.reset();
  EXPECT_TRUE(rig.runs(10));
}

TEST_P(DriveAndDevice, RunsAgainAfterRandomFrames) {
  receive_random_frames(rig_, 10'000, GetParam().zero_torque);
}

TEST_P(DriveAndDevice, NightlyRunsAgainAfterAMillionRandomFrames) {
  receive_random_frames(rig_, 1'000'000, GetParam().zero_torque);
}

INSTANTIATE_TEST_SUITE_P(Dialects, DriveAndDevice, ::testing::ValuesIn(kDialects),
                         [](const auto& each) { return each.param.name; });

struct FaultCase {
  std::string name;
  Dialect dialect;
  DeviceFault fault;
  std::string words;
};

void PrintTo(const FaultCase& fault, std::ostream* out) {
  *out << fault.name;
}

std::vector<FaultCase> fault_cases() {
  const Dialect& vesc = kDialects[0];
  const Dialect& odrive05 = kDialects[1];
  const Dialect& odrive06 = kDialects[2];
  const Dialect& cia402 = kDialects[4];
  const Dialect& damiao = kDialects[7];
  const Dialect& cybergear = kDialects[8];
  const Dialect& ak = kDialects[9];
  const Dialect& moteus = kDialects[10];
  return {
      {"OffVesc", vesc, DeviceFault::kOff, "is silent: no position"},
      {"ResetVesc", vesc, DeviceFault::kReset, "is silent: no position"},
      {"OtherZeroVesc", vesc, DeviceFault::kOtherZero, "reports a jump of its position, "},
      {"EncoderVesc", vesc, DeviceFault::kEncoder, "released the motor without an error: no current"},
      {"ReleasedVesc", vesc, DeviceFault::kReleased, "released the motor without an error: no current"},
      {"HotVesc", vesc, DeviceFault::kHot, "is too hot: temperature, 120 instead of 90"},
      {"UnderVoltageVesc", vesc, DeviceFault::kUnderVoltage, "has a low supply: voltage, 8 instead of 18"},
      {"OffDamiao", damiao, DeviceFault::kOff, "is silent: no position"},
      {"ResetDamiao", damiao, DeviceFault::kReset, "is silent: no position"},
      {"OtherZeroDamiao", damiao, DeviceFault::kOtherZero, "reports a jump of its position, "},
      {"EncoderDamiao", damiao, DeviceFault::kEncoder, "reports an error: overload"},
      {"ReleasedDamiao", damiao, DeviceFault::kReleased, "released the motor without an error: off"},
      {"HotDamiao", damiao, DeviceFault::kHot, "is too hot: temperature, 120 instead of 90"},
      {"UnderVoltageDamiao", damiao, DeviceFault::kUnderVoltage, "reports an error: under-voltage"},
      {"OffCybergear", cybergear, DeviceFault::kOff, "is silent: no position"},
      {"ResetCybergear", cybergear, DeviceFault::kReset, "is silent: no position"},
      {"OtherZeroCybergear", cybergear, DeviceFault::kOtherZero, "reports a jump of its position, "},
      {"EncoderCybergear", cybergear, DeviceFault::kEncoder, "reports an error: encoder"},
      {"ReleasedCybergear", cybergear, DeviceFault::kReleased, "released the motor without an error: mode reset"},
      {"HotCybergear", cybergear, DeviceFault::kHot, "is too hot: temperature, 120 instead of 90"},
      {"UnderVoltageCybergear", cybergear, DeviceFault::kUnderVoltage, "reports an error: under-voltage"},
      {"OffAk", ak, DeviceFault::kOff, "is silent: no position"},
      {"UnpluggedAk", ak, DeviceFault::kUnplugged, "is silent: no position"},
      {"ResetAk", ak, DeviceFault::kReset, "is silent: no position"},
      {"OtherZeroAk", ak, DeviceFault::kOtherZero, "reports a jump of its position, "},
      {"EncoderAk", ak, DeviceFault::kEncoder, "reports an error: encoder"},
      {"HotAk", ak, DeviceFault::kHot, "is too hot: temperature, 120 instead of 90"},
      {"UnderVoltageAk", ak, DeviceFault::kUnderVoltage, "reports an error: under-voltage"},
      {"OffMoteus", moteus, DeviceFault::kOff, "is silent: no position"},
      {"UnpluggedMoteus", moteus, DeviceFault::kUnplugged, "is silent: no position"},
      {"ResetMoteus", moteus, DeviceFault::kReset, "is silent: no position"},
      {"OtherZeroMoteus", moteus, DeviceFault::kOtherZero, "reports a jump of its position, "},
      {"EncoderMoteus", moteus, DeviceFault::kEncoder, "reports an error: encoder"},
      {"ReleasedMoteus", moteus, DeviceFault::kReleased, "released the motor without an error: stopped"},
      {"HotMoteus", moteus, DeviceFault::kHot, "is too hot: temperature, 120 instead of 90"},
      {"UnderVoltageMoteus", moteus, DeviceFault::kUnderVoltage, "reports an error: under-voltage"},
      {"NotFiniteMoteus", moteus, DeviceFault::kNotFinite, "sent NaN or infinity"},
      {"Off05", odrive05, DeviceFault::kOff, "is silent: no position"},
      {"Off06", odrive06, DeviceFault::kOff, "is silent: no position"},
      {"OffCia402", cia402, DeviceFault::kOff, "is silent: no position"},
      {"Reset05", odrive05, DeviceFault::kReset, "is silent: no position"},
      {"Reset06", odrive06, DeviceFault::kReset, "is silent: no position"},
      {"ResetCia402", cia402, DeviceFault::kReset, "is silent: no position"},
      {"OtherZero05", odrive05, DeviceFault::kOtherZero, "reports a jump of its position, "},
      {"OtherZero06", odrive06, DeviceFault::kOtherZero, "reports a jump of its position, "},
      {"OtherZeroCia402", cia402, DeviceFault::kOtherZero, "reports a jump of its position, "},
      {"Encoder05", odrive05, DeviceFault::kEncoder, "reports an error: ENCODER_FAILED NO_RESPONSE"},
      {"Encoder06", odrive06, DeviceFault::kEncoder,
       "reports an error: MISSING_ESTIMATE (disarmed by MISSING_ESTIMATE)"},
      {"EncoderCia402", cia402, DeviceFault::kEncoder, "reports an error: 0x7305 (incremental sensor 1 fault)"},
      {"Released05", odrive05, DeviceFault::kReleased, "released the motor without an error: axis state 1"},
      {"Released06", odrive06, DeviceFault::kReleased, "released the motor without an error: axis state 1"},
      {"ReleasedCia402", cia402, DeviceFault::kReleased, "released the motor without an error: switch on disabled"},
      {"Hot06", odrive06, DeviceFault::kHot, "is too hot: temperature, 120 instead of 90"},
      {"UnderVoltage05", odrive05, DeviceFault::kUnderVoltage, "MOTOR_FAILED UNKNOWN_VBUS_VOLTAGE"},
      {"UnderVoltage06", odrive06, DeviceFault::kUnderVoltage, "DC_BUS_UNDER_VOLTAGE"},
      {"UnderVoltageCia402", cia402, DeviceFault::kUnderVoltage, "0x3220 (DC link under-voltage)"},
      {"NotFinite05", odrive05, DeviceFault::kNotFinite, "sent NaN or infinity"},
      {"NotFinite06", odrive06, DeviceFault::kNotFinite, "sent NaN or infinity"},
  };
}

class InjectedFault : public ::testing::TestWithParam<FaultCase> {};

TEST_P(InjectedFault, IsSaidInWords) {
  DeviceRig rig;
  Device& device = GetParam().dialect.add(rig, 1, 0);
  ASSERT_TRUE(rig.runs());
  rig.command_all({.enabled = true, .torque = 0.2});
  rig.run(0.2);
  device.inject(GetParam().fault);
  rig.run(0.5);
  EXPECT_EQ(rig.drive().status().state, DrivePhase::kFault);
  EXPECT_THAT(rig.drive().words(), HasSubstr(GetParam().words));
}

INSTANTIATE_TEST_SUITE_P(Faults, InjectedFault, ::testing::ValuesIn(fault_cases()),
                         [](const auto& each) { return each.param.name; });

}  // namespace robot_control::tests
