#include "drivers/cia402/drive_objects.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

namespace robot_control::cia402::tests {

/// The dictionary of a drive: keys of each section, as "6071 DataType" → "0x0003".
std::map<std::string, std::string> read_eds(const std::string& name) {
  std::map<std::string, std::string> entries;
  std::ifstream file(PROJECT_DIRECTORY "/tests/fixtures/" + name);
  std::string section;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const std::size_t equals = line.find('=');
    if (line.starts_with('[')) section = line.substr(1, line.find(']') - 1);
    if (equals != std::string::npos) entries[section + " " + line.substr(0, equals)] = line.substr(equals + 1);
  }
  return entries;
}

std::string section_of(const ObjectAddress& object, bool has_subs) {
  char text[16];
  std::snprintf(text, sizeof text, has_subs ? "%04Xsub%X" : "%04X", object.index, object.sub);
  return text;
}

struct DriveObjects : ::testing::Test {
  static bool has(const std::map<std::string, std::string>& eds, const ObjectAddress& object) {
    return eds.contains(section_of(object, true) + " DataType") ||
           eds.contains(section_of(object, false) + " DataType");
  }

  std::map<std::string, std::string> torque_drive_ = read_eds("cia402_example_e35.eds");
  std::map<std::string, std::string> position_drive_ = read_eds("cia402_ros_industrial_slave.eds");
};

TEST_F(DriveObjects, ProcessDataHaveTheTypesOfARealDriveAndCanBeMapped) {
  const std::map<std::string, std::pair<unsigned, bool>> types = {
      {"0x0003", {16, true}}, {"0x0004", {32, true}}, {"0x0006", {16, false}}, {"0x0007", {32, false}}};
  for (const PdoEntry& entry :
       {kControlwordEntry, kTargetTorqueEntry, kStatuswordEntry, kPositionEntry, kTorqueEntry, kVelocityEntry}) {
    const std::string section = section_of(entry.object, false);
    ASSERT_TRUE(has(torque_drive_, entry.object)) << section;
    EXPECT_EQ(types.at(torque_drive_[section + " DataType"]), std::pair(unsigned{entry.bits}, entry.is_signed))
        << section;
    EXPECT_EQ(torque_drive_[section + " PDOMapping"], "0x1") << section;
  }
}

TEST_F(DriveObjects, AreThoseOfRealDrives) {
  for (const ObjectAddress& object :
       {kHeartbeatProducer, kVendor, kProduct, kRevision, kSerialNumber, kDeviceName, kErrorCode, kModeOfOperation,
        kModeDisplay, kSupportedModes, kMaxTorque, kRatedTorque, kDcLinkVoltage, kPeriodValue, kPeriodIndex}) {
    EXPECT_TRUE(has(torque_drive_, object)) << std::hex << object.index;
  }
  for (const ObjectAddress& object : {kHeartbeatConsumer, kErrorBehaviour, kQuickStopOption, kFaultReactionOption}) {
    EXPECT_TRUE(has(position_drive_, object)) << std::hex << object.index;
    EXPECT_FALSE(has(torque_drive_, object)) << std::hex << object.index;
  }
  EXPECT_FALSE(has(position_drive_, kTargetTorqueEntry.object));
}

TEST_F(DriveObjects, TheSecondAxisIs800Farther) {
  EXPECT_EQ(on_axis(kRatedTorque, 1), (ObjectAddress{0x6876, 0}));
  EXPECT_EQ(on_axis(kPeriodIndex, 1), (ObjectAddress{0x68C2, 2}));
  EXPECT_EQ(on_axis(kSerialNumber, 1), kSerialNumber);
}

TEST_F(DriveObjects, AModeIsSupportedByItsBit) {
  const auto modes = static_cast<std::uint32_t>(std::stoul(torque_drive_["6502 DefaultValue"], nullptr, 0));
  EXPECT_TRUE(supports(modes, Mode::kCyclicTorque));
  EXPECT_TRUE(supports(modes, Mode::kTorque));
  EXPECT_FALSE(supports(0x1EF, Mode::kCyclicTorque));
}

}  // namespace robot_control::cia402::tests
