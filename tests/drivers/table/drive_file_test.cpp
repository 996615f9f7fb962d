#include <filesystem>
#include <sstream>

#include "drivers/cia402/cia402_parameters.h"
#include "drivers/damiao/damiao_parameters.h"
#include "drivers/drive/can_drive_file.h"
#include "drivers/odrive/odrive_parameters.h"
#include "drivers/table/drive_machine.h"
#include "drivers/vesc/vesc_parameters.h"
#include "parameters/problem_list.h"
#include "support/matchers.h"
#include "support/message_of.h"

namespace robot_control::tests {

const std::vector<std::string> kWheels = {"left_wheel_joint", "right_wheel_joint"};

constexpr const char* kOdrive = R"(
bus: {dialect: odrive}
every_joint: {torque_constant: 0.1, torque_limit: 3, velocity_limit: 30, on_silence: coasts}
left_wheel_joint: {node: 0}
right_wheel_joint: {node: 1, direction: -1, gear: 5}
)";

constexpr const char* kCia402 = R"(
bus: {dialect: cia402}
every_joint: {torque_limit: 3, velocity_limit: 30}
left_wheel_joint: {node: 1}
right_wheel_joint: {node: 2}
)";

constexpr const char* kVesc = R"(
bus: {dialect: vesc}
every_joint: {pole_pairs: 15, torque_constant: 0.5, torque_limit: 3, velocity_limit: 30, on_silence: coasts}
left_wheel_joint: {node: 0}
right_wheel_joint: {node: 1}
)";

constexpr const char* kDamiao = R"(
bus: {dialect: damiao}
every_joint: {position_range: 12.5, velocity_range: 45, torque_range: 54, torque_limit: 40, velocity_limit: 30}
left_wheel_joint: {node: 1}
right_wheel_joint: {node: 2}
)";

constexpr const char* kCybergear = R"(
bus: {dialect: cybergear}
every_joint: {position_range: 12.5, velocity_range: 30, torque_range: 12, motor_gear: 7.75, torque_limit: 10, velocity_limit: 20}
left_wheel_joint: {node: 1}
right_wheel_joint: {node: 2}
)";

constexpr const char* kMoteus = R"(
bus: {dialect: moteus}
every_joint: {kp: 3000, kd: 30, motor_gear: 9, torque_limit: 18, velocity_limit: 30}
left_wheel_joint: {node: 1}
right_wheel_joint: {node: 2}
)";

constexpr const char* kAk = R"(
bus: {dialect: ak}
every_joint: {position_range: 12.5, velocity_range: 50, torque_range: 18, motor_gear: 9, torque_limit: 18, velocity_limit: 30, on_silence: keeps}
left_wheel_joint: {node: 1}
right_wheel_joint: {node: 2}
)";

struct DriveFileTest : ::testing::Test {
  template <class File = DriveFile>
  const File& read(const std::string& text, double rate = 500, bool takes_speeds = false,
                   std::string_view driver = "can") {
    std::ofstream(path_) << text;
    file_ = read_drive_file(path_, driver, {.joints = joints_, .rate = rate, .takes_speeds = takes_speeds});
    return dynamic_cast<const File&>(*file_);
  }
  std::string refusal(std::string text, const std::string& part, const std::string& replacement, double rate = 500) {
    text.replace(text.find(part), part.size(), replacement);
    return refusal_of(text, rate);
  }
  std::string refusal_of(const std::string& text, double rate = 500, std::string_view driver = "can") {
    return message_of<ParameterError>([&] { static_cast<void>(read(text, rate, false, driver)); });
  }
  /// Returns an example in which the defaults are no comments.
  static std::string uncommented(std::string_view name) {
    std::ifstream file(example(name));
    std::string text;
    for (std::string line; std::getline(file, line);) {
      if (!line.starts_with(" ") && !line.starts_with("#")) text += line + "\n";
      if (!line.starts_with("  ")) continue;
      std::istringstream words(line.substr(line.starts_with("  # ") ? 4 : 2));
      std::string key, value;
      if (words >> key >> value && key.ends_with(":")) text += "  " + key + " " + value + "\n";
    }
    return text;
  }
  void TearDown() override { std::filesystem::remove(path_); }

  std::string path_ = ::testing::TempDir() + "drives.yaml";
  std::vector<std::string> joints_ = kWheels;
  std::unique_ptr<DriveFile> file_;
};

TEST_F(DriveFileTest, TheExamplesAreAccepted) {
  for (const DriveRow& row : kDriveRows)
    EXPECT_NO_THROW(
        read_drive_file(example(row.name), row.driver, {.joints = joints_of(example(row.name)), .rate = 1000}))
        << row.name;
}

TEST_F(DriveFileTest, EveryJointHoldsForAllAndTheBlockOfAJointOutweighsIt) {
  const auto& joints = read<CanFileOf<odrive::OdriveParameters>>(kOdrive).joints();
  ASSERT_EQ(joints.size(), 2u);
  EXPECT_EQ(joints[0].drive.joint, "left_wheel_joint");
  EXPECT_EQ(joints[0].torque_constant, 0.1);
  EXPECT_EQ(joints[0].drive.gear, 1);
  EXPECT_EQ(joints[1].drive.gear, 5);
  EXPECT_EQ(joints[1].drive.direction, -1);
}

TEST_F(DriveFileTest, AllProblemsAreInOneMessage) {
  const std::string message = refusal(R"(
bus: {dialect: odrive, bit_rat: 1000000}
every_joint: {torque_constant: 0.1, torque_limit: -3, velocity_limit: 30}
left_wheel_joint: {node: 99, direction: 0}
third_wheel_joint: {node: 1}
)",
                                      "99", "99");
  EXPECT_THAT(message,
              AllOf(HasSubstr("6 problems"), HasSubstr("bus.bit_rat = 1000000: unknown key"),
                    HasSubstr("every_joint.torque_limit = -3: must be"), HasSubstr("third_wheel_joint: unknown block"),
                    HasSubstr("right_wheel_joint.node: missing"), HasSubstr("left_wheel_joint.node = 99: must be 0"),
                    HasSubstr("left_wheel_joint.direction = 0: must be 1 or -1")));
}

/// Each line of the examples, its commented defaults included, is spoilt in turn.
TEST_F(DriveFileTest, EverySpoiltLineOfTheExamplesIsNamed) {
  int spoilt = 0;
  for (const DriveRow& row : kDriveRows) {
    const std::string text = uncommented(row.name);
    joints_ = joints_of(example(row.name));
    ASSERT_NO_THROW(read(text, 500, false, row.driver)) << text;
    for (std::size_t at = text.find("  "); at != std::string::npos; at = text.find("\n  ", at + 1)) {
      const std::size_t key = text.find_first_not_of(" \n", at);
      const std::size_t colon = text.find(':', key);
      const std::size_t end = text.find('\n', key);
      const std::string word = text.substr(key, colon - key);
      if (word == "address" || word == "bus") continue;  // Any text is an address.
      std::string renamed = text;
      renamed.insert(colon, "_");
      EXPECT_THAT(refusal_of(renamed, 500, row.driver), HasSubstr(word + "_")) << word;
      std::string mistyped = text;
      mistyped.replace(colon, end - colon, ": [wrong]");
      EXPECT_THAT(refusal_of(mistyped, 500, row.driver), HasSubstr(word + " = [wrong]")) << word;
      spoilt += 2;
    }
  }
  EXPECT_GE(spoilt, 100);
}

TEST_F(DriveFileTest, AMissingJointAndAForeignJointAreNamed) {
  EXPECT_THAT(refusal(kOdrive, "right_wheel_joint", "rigth_wheel_joint"),
              AllOf(HasSubstr("rigth_wheel_joint: unknown block"), HasSubstr("right_wheel_joint.node: missing")));
}

TEST_F(DriveFileTest, AMissingOrUnknownDialectIsNamed) {
  EXPECT_THAT(refusal(kOdrive, "dialect: odrive", ""), HasSubstr("bus.dialect: missing"));
  EXPECT_THAT(refusal(kOdrive, "odrive", "kelly"), HasSubstr("bus.dialect = kelly: "));
}

TEST_F(DriveFileTest, TwoJointsOfOneDriveAreRefused) {
  EXPECT_THAT(refusal(kOdrive, "node: 1", "node: 0"), HasSubstr("is the drive of left_wheel_joint, too"));
  EXPECT_THAT(refusal(kCia402, "node: 2", "node: 1"), HasSubstr("is the drive of left_wheel_joint, too"));
  EXPECT_EQ(refusal(kCia402, "node: 2", "node: 1, axis: 1"), "");
}

TEST_F(DriveFileTest, AJointMayHaveABusOfItsOwn) {
  const std::string text = std::string(kOdrive).replace(std::string(kOdrive).find("node: 1"), 7, "node: 0, bus: can1");
  EXPECT_THAT(read<CanDriveFile>(text).drives().buses(), ElementsAre("can0", "can1"));
  EXPECT_THAT(refusal(kOdrive, "node: 1", "node: 0, bus: can0"), HasSubstr("is the drive of left_wheel_joint, too"));
}

/// Two ODrives on one bus would need more than 70 % of it at 1500 Hz.
TEST_F(DriveFileTest, EachBusIsLoadedByItsOwnDrives) {
  EXPECT_THAT(refusal(kOdrive, "node: 1", "node: 1", 1500), HasSubstr("load the bus with"));
  EXPECT_EQ(refusal(kOdrive, "node: 1", "node: 1, bus: can1", 1500), "");
}

TEST_F(DriveFileTest, MoreThanFourBusesAreRefused) {
  std::string text =
      "bus: {dialect: odrive}\nevery_joint: {torque_constant: 0.1, torque_limit: 3, velocity_limit: 30}\n";
  joints_.clear();
  for (const std::string number : {"0", "1", "2", "3", "4"}) {
    joints_.push_back("joint_" + number);
    text += joints_.back() + ": {node: 0, bus: can" + number + "}\n";
  }
  EXPECT_THAT(refusal_of(text), HasSubstr("bus.address = can0: the joints are on 5 buses, at most 4"));
}

TEST_F(DriveFileTest, WhatADialectCannotDoIsRefused) {
  EXPECT_THAT(refusal(kOdrive, "coasts", "holds"), HasSubstr("an ODrive releases the motor"));
  EXPECT_THAT(refusal(kOdrive, "node: 0", "node: 0, enable_watchdog_endpoint: 7"),
              HasSubstr("left_wheel_joint.watchdog_timeout_endpoint: is missing"));
  EXPECT_EQ(refusal(kOdrive, "node: 0", "node: 0, motor_velocity_limit: 45"), "");
  EXPECT_THAT(refusal(kOdrive, "node: 0", "node: 0, motor_velocity_limit: 44"),
              HasSubstr("left_wheel_joint.motor_velocity_limit = 44: must be at least 1.5 · velocity_limit · gear"));
  EXPECT_THAT(refusal(kCia402, "node: 2", "node: 127"), HasSubstr("must be 1 … 127 and not bus.host_node"));
  EXPECT_THAT(refusal(kCia402, "node: 2", "node: 128"), HasSubstr("must be 1 … 127 and not bus.host_node"));
}

TEST_F(DriveFileTest, WhatAVescCannotDoIsRefused) {
  EXPECT_EQ(refusal(kVesc, "node: 1", "node: 254"), "");
  EXPECT_THAT(refusal(kVesc, "node: 1", "node: 255"), HasSubstr("right_wheel_joint.node = 255: must be"));
  EXPECT_THAT(refusal(kVesc, "node: 1", "node: 0"), HasSubstr("is the drive of left_wheel_joint, too"));
  EXPECT_THAT(refusal(kVesc, "pole_pairs: 15", "pole_pairs: 0"), HasSubstr("every_joint.pole_pairs = 0: must be"));
  EXPECT_THAT(refusal(kVesc, "pole_pairs: 15, ", ""), HasSubstr("left_wheel_joint.pole_pairs: missing"));
  EXPECT_THAT(refusal(kVesc, "coasts", "holds"), HasSubstr("the timeout of a VESC holds nothing at rest"));
  EXPECT_THAT(refusal(kVesc, "torque_constant: 0.5, ", ""),
              HasSubstr("left_wheel_joint.torque_constant: is missing: with robot.wheel_command: torque the currents "
                        "follow from it"));
  EXPECT_THAT(refusal(kVesc, "node: 1", "node: 1, status_period: 0.001", 1000), HasSubstr("load the bus with"));
}

TEST_F(DriveFileTest, WhatADamiaoCannotDoIsRefused) {
  EXPECT_EQ(refusal(kDamiao, "node: 1", "node: 15"), "");
  for (const std::string node : {"0", "16"}) {
    EXPECT_THAT(refusal(kDamiao, "node: 1", "node: " + node),
                HasSubstr("left_wheel_joint.node = " + node + ": must be 1 … 15"))
        << node;
  }
  for (const char* answers : {"2", "5", "257"}) {
    EXPECT_THAT(refusal(kDamiao, "node: 2", std::string("node: 2, answers: ") + answers),
                HasSubstr(std::string("answers = ") + answers + ": must not be an identifier that motors obey"));
  }
  EXPECT_THAT(refusal(kDamiao, "torque_limit: 40", "torque_limit: 55"), HasSubstr("must be at most torque_range"));
  EXPECT_THAT(refusal(kDamiao, "velocity_limit: 30", "velocity_limit: 30, gear: 2"),
              HasSubstr("must be at most velocity_range / gear"));
  EXPECT_THAT(refusal(kDamiao, "node: 1", "node: 1, min_voltage: 20"), HasSubstr("does not send its voltage"));
  EXPECT_THAT(refusal(kDamiao, "node: 1", "node: 1, on_silence: coasts"), HasSubstr("must be left out"));
  EXPECT_THAT(refusal(kDamiao, "node: 1", "node: 1, timeout: 0.019"), HasSubstr("must be at least ten periods"));
}

TEST_F(DriveFileTest, WhatACybergearCannotDoIsRefused) {
  EXPECT_EQ(refusal(kCybergear, "node: 1", "node: 127"), "");
  EXPECT_EQ(refusal(kCybergear, "node: 1", "node: 1, on_silence: keeps"), "");
  EXPECT_THAT(refusal(kCybergear, "node: 1", "node: 128"), HasSubstr("left_wheel_joint.node = 128: must be 1 … 127"));
  EXPECT_THAT(refusal(kCybergear, "node: 1", "node: 1, on_silence: holds"),
              HasSubstr("on_silence = holds: must be left out, or keeps"));
  EXPECT_THAT(refusal(kCybergear, "node: 1", "node: 1, timeout: 0.019"), HasSubstr("must be at least ten periods"));
  EXPECT_THAT(refusal(kCybergear, "motor_gear: 7.75, ", ""), HasSubstr("left_wheel_joint.motor_gear: missing"));
  EXPECT_THAT(refusal(kCybergear, "torque_limit: 10", "torque_limit: 13"), HasSubstr("must be at most torque_range"));
}

TEST_F(DriveFileTest, WhatAnAkCannotDoIsRefused) {
  EXPECT_EQ(refusal(kAk, "node: 1", "node: 254"), "");
  EXPECT_THAT(refusal(kAk, "node: 1", "node: 0"), HasSubstr("left_wheel_joint.node = 0: must be 1 … 254"));
  for (const char* given : {"", ", on_silence: coasts"}) {
    EXPECT_THAT(refusal(kAk, ", on_silence: keeps", given), HasSubstr("must be keeps: an AK motor has no timeout"));
  }
  EXPECT_THAT(refusal(kAk, "velocity_limit: 30", "velocity_limit: 30, timeout: 0.1"), HasSubstr("timeout"));
}

TEST_F(DriveFileTest, WhatAMoteusCannotDoIsRefused) {
  for (const char* given : {"126", "1, on_silence: coasts", "1, min_voltage: 20", "1, timeout: 0.02"})
    EXPECT_EQ(refusal(kMoteus, "node: 1", std::string("node: ") + given), "") << given;
  for (const char* node : {"0", "127"})
    EXPECT_THAT(refusal(kMoteus, "node: 1", std::string("node: ") + node), HasSubstr("must be 1 … 126")) << node;
  for (const char* reaction : {"holds", "keeps", "unknown"})
    EXPECT_THAT(refusal(kMoteus, "node: 1", std::string("node: 1, on_silence: ") + reaction),
                HasSubstr("must be brakes or coasts, as servo.timeout_mode of the controller"));
  EXPECT_THAT(refusal(kMoteus, "node: 1", "node: 1, timeout: 0.019"), HasSubstr("must be at least ten periods"));
  EXPECT_THAT(refusal(kMoteus, "kp: 3000, ", ""), HasSubstr("left_wheel_joint.kp: missing"));
  EXPECT_THAT(refusal(kMoteus, "kp: 3000", "kp: 0"), HasSubstr("kp = 0: must be"));
}

TEST_F(DriveFileTest, ADataRateBelongsToCanFd) {
  EXPECT_EQ(read<CanDriveFile>(kMoteus).bus.data_rate, 5.0e6);
  std::string slower = kMoteus;
  slower.insert(slower.find('}'), ", data_rate: 2000000");
  EXPECT_EQ(read<CanDriveFile>(slower).bus.data_rate, 2.0e6);
  EXPECT_EQ(read<CanDriveFile>(kDamiao).bus.data_rate, 0);
  EXPECT_THAT(refusal(kDamiao, "dialect: damiao", "dialect: damiao, data_rate: 5000000"),
              HasSubstr("bus.data_rate = 5000000: unknown key"));
}

TEST_F(DriveFileTest, NoOtherDriveKeepsItsLastOrder) {
  EXPECT_THAT(refusal(kOdrive, "coasts", "keeps"), HasSubstr("must be coasts or unknown"));
  EXPECT_THAT(refusal(kVesc, "coasts", "keeps"), HasSubstr("must be coasts, brakes or unknown"));
  EXPECT_THAT(refusal(kDamiao, "node: 1", "node: 1, on_silence: keeps"), HasSubstr("must be left out"));
}

/// A command and its answer have at most 135 bits each, and 160 with identifiers of 29 bits. Those of a moteus have 160
/// and 90 µs.
TEST_F(DriveFileTest, ABusCarriesThreeMotorsInMitModeAtAKilohertzAndSixAtHalf) {
  for (const char* dialect : {kDamiao, kCybergear, kAk, kMoteus}) {
    std::string text = std::string(dialect).substr(0, std::string(dialect).find("left_wheel_joint"));
    joints_.clear();
    for (int node = 1; node <= 7; ++node) {
      joints_.push_back("joint_" + std::to_string(node));
      text += joints_.back() + ": {node: " + std::to_string(node) + "}\n";
      EXPECT_EQ(refusal_of(text, 1000).empty(), node <= 3) << text;
      EXPECT_EQ(refusal_of(text, 500).empty(), node <= 6) << text;
    }
  }
}

TEST_F(DriveFileTest, AVescThatTakesSpeedsNeedsNoTorqueConstant) {
  std::string text = kVesc;
  text.erase(text.find("torque_constant: 0.5, "), 22);
  EXPECT_TRUE(read<CanFileOf<vesc::VescParameters>>(text, 1000, true).joints()[0].drive.takes_speeds);
}

TEST_F(DriveFileTest, ATimeoutOfLessThanTenPeriodsIsRefused) {
  EXPECT_THAT(refusal(kCia402, "node: 2", "node: 2, host_timeout: 0.019"),
              HasSubstr("right_wheel_joint.host_timeout = 0.019: must be at least ten periods of the loop"));
  EXPECT_EQ(refusal(kCia402, "node: 2", "node: 2, host_timeout: 0.02"), "");
}

TEST_F(DriveFileTest, ATimeoutThatIsLeftOutHasTenPeriods) {
  for (const auto& [rate, timeout] : {std::pair{500.0, 0.1}, {50.0, 0.2}, {20.0, 0.5}}) {
    EXPECT_DOUBLE_EQ(read<CanFileOf<cia402::Cia402Parameters>>(kCia402, rate).joints()[0].host_timeout, timeout)
        << rate;
  }
}

TEST_F(DriveFileTest, AVelocityIsDerivedWhereTheBusHasRoom) {
  for (const auto& [rate, room] : {std::pair{1000.0, true}, {1200.0, false}}) {
    EXPECT_EQ(read<CanFileOf<cia402::Cia402Parameters>>(kCia402, rate).joints()[0].velocity_has_room, room) << rate;
  }
}

TEST_F(DriveFileTest, AReactionOnSilenceWithoutAnActionIsRefused) {
  EXPECT_THAT(refusal(kCia402, "node: 2", "node: 2, abort_option: 0, on_silence: holds"),
              HasSubstr("right_wheel_joint.on_silence = holds: contradicts abort_option: 0"));
  EXPECT_EQ(refusal(kCia402, "node: 2", "node: 2, abort_option: 0, accept_unknown_watchdog: true"), "");
}

TEST_F(DriveFileTest, TorquesThatTheDriveSendsByItselfCountForTheLoad) {
  EXPECT_THAT(refusal(kOdrive, "node: 0", "node: 0, effort_rate: 0"), HasSubstr("left_wheel_joint.effort_rate = 0: "));
  EXPECT_EQ(refusal(kOdrive, "node: 0", "node: 0, effort_period: 0.01"), "");
  EXPECT_EQ(refusal(kOdrive, "coasts", "coasts", 1000), "");
  EXPECT_THAT(refusal(kOdrive, "coasts", "coasts, effort_period: 0.001", 1000), HasSubstr("load the bus with"));
}

TEST_F(DriveFileTest, AnOverloadedBusIsRefusedWithTheRateThatFits) {
  EXPECT_THAT(refusal(kOdrive, "dialect: odrive", "dialect: odrive, bit_rate: 500000", 1000),
              HasSubstr("set robot.rate to at most 5"));
}

}  // namespace robot_control::tests
