#include <cmath>
#include <numbers>

#include "drivers/drive/device_rig.h"
#include "support/matchers.h"

namespace robot_control::cia402::tests {

std::string words_after(
    const Cia402Pair& pair, const std::function<void(Cia402Device&)>& change = [](auto&) {}) {
  DeviceRig rig;
  Cia402Device& device = add(rig, pair);
  change(device);
  rig.command_all({.enabled = true});
  rig.run(3);
  return rig.drive().words();
}

auto without(const canopen::ObjectAddress& object) {
  return [=](Cia402Device& device) { device.objects().remove(object); };
}
auto with(const canopen::ObjectAddress& object, std::uint32_t value) {
  return [=](Cia402Device& device) { device.objects().set(object, value); };
}

TEST(Cia402Drive, PrefersTheCyclicTorqueModeAndTakesTheProfileMode) {
  for (const auto& [modes, mode] : {std::pair{0x208U, Mode::kCyclicTorque}, {0x8U, Mode::kTorque}}) {
    Cia402Pair pair = cia402_pair(5);
    pair.device.supported_modes = modes;
    DeviceRig rig;
    add(rig, pair);
    ASSERT_TRUE(rig.runs());
    EXPECT_EQ(dynamic_cast<Cia402Drive&>(rig.drive()).mode(), mode);
  }
}

TEST(Cia402Drive, RefusesADriveWithoutATorqueModeByItsName) {
  Cia402Pair pair = cia402_pair(5);
  pair.device.supported_modes = 0x85;
  EXPECT_THAT(words_after(pair), HasSubstr("lacks torque mode in its supported modes (6502)"));
}

TEST(Cia402Drive, AModeOfTheFileOutweighsAnEmpty6502) {
  Cia402Pair pair = cia402_pair(5);
  pair.device.supported_modes = 0;
  pair.drive.mode = ModeChoice::kProfileTorque;
  EXPECT_THAT(words_after(pair), HasSubstr("running"));
}

TEST(Cia402Drive, ComparesWhatItReadsWithTheFile) {
  Cia402Pair pair = cia402_pair(5);
  pair.drive.vendor = 7;
  EXPECT_THAT(words_after(pair), HasSubstr("differs from the drive file: vendor (1018:1), 421 instead of 7"));
  pair = cia402_pair(5);
  pair.drive.rated_torque = 3;
  EXPECT_THAT(words_after(pair), HasSubstr("rated torque (6076), 2 instead of 3"));
  pair = cia402_pair(5);
  EXPECT_THAT(words_after(pair, with(kMaxTorque, 500)), HasSubstr("maximum torque (6072), 1 instead of 1.6"));
}

TEST(Cia402Drive, SaysWhatIsMissingAndWhatWasRefusedWithTheAbortInWords) {
  const Cia402Pair pair = cia402_pair(5);
  EXPECT_THAT(words_after(pair, without(kRatedTorque)), HasSubstr("lacks rated torque (6076); set rated_torque"));
  EXPECT_THAT(words_after(pair, without({0x6077, 0})),
              HasSubstr("refused to set TPDO of statusword, position and torque (0x6040041: object cannot be mapped"));
  Cia402Pair fixed = pair;
  fixed.device.fixed_mapping = true;
  EXPECT_THAT(words_after(fixed), HasSubstr("attempt to write a read-only object"));
}

TEST(Cia402Drive, TakesAFixedMappingThatHoldsWhatItNeeds) {
  Cia402Pair pair = cia402_pair(5);
  pair.device.fixed_mapping = true;
  pair.drive.pdos = PdoSource::kFixed;
  EXPECT_THAT(words_after(pair), HasSubstr("running"));
  const auto with_mode = [](Cia402Device& device) {
    device.objects().set({0x1600, 0}, 3);
    device.objects().set({0x1600, 3}, 0x60600008);
  };
  EXPECT_THAT(words_after(pair, with_mode), HasSubstr("running"));
  const auto with_position = [](Cia402Device& device) {
    device.objects().set({0x1600, 0}, 3);
    device.objects().set({0x1600, 3}, 0x607A0020);
  };
  EXPECT_THAT(words_after(pair, with_position), HasSubstr("its RPDO, which holds another object: 0x607A0020"));
  const auto without_position = with({0x1A00, 0}, 1);
  EXPECT_THAT(words_after(pair, without_position), HasSubstr("lacks an entry of its PDO: (0x60640020"));
}

/// Returns the words of a drive that runs with these objects, after its motor has turned by about 5 rad. Writes by how
/// much the angle of the drive differs from the motor's, rad of the motor.
std::string words_after_turning(const Cia402Pair& pair, const std::function<void(Cia402Device&)>& change,
                                double& difference) {
  DeviceRig rig;
  Cia402Device& device = add(rig, pair);
  change(device);
  rig.command_all({.enabled = true});
  rig.run(3);
  rig.motor().velocity = 10;
  rig.run(0.5);
  difference = rig.drive().sample().joint.position * -2.5 - rig.motor().position;  // direction and gear of node 5
  return rig.drive().words();
}

TEST(Cia402Drive, ReadsItsCountsPerTurnOfTheMotor) {
  struct Case {
    std::uint32_t motor_turns, feed;
    double counts;  // per turn of the motor, those of the device
  };
  for (const Case& each : {Case{.motor_turns = 5, .feed = 5000, .counts = 1000},
                           {.motor_turns = 1, .feed = 3600, .counts = 3600},
                           {.motor_turns = 1, .feed = 1, .counts = 4096}}) {
    Cia402Pair pair = cia402_pair(5);
    pair.device.counts_per_turn = each.counts;
    double difference = 0;
    const std::string words = words_after_turning(
        pair,
        [&](Cia402Device& device) {
          device.objects().set({0x608F, 1}, 4096);
          device.objects().add({0x6091, 1}, each.motor_turns, 4, false);
          device.objects().add({0x6091, 2}, 1, 4, false);
          device.objects().add({0x6092, 1}, each.feed, 4, false);
          device.objects().add({0x6092, 2}, 1, 4, false);
        },
        difference);
    EXPECT_THAT(words, HasSubstr("running")) << each.feed;
    EXPECT_NEAR(difference, 0, 0.05) << each.feed;  // The sample is up to two cycles of 2 ms old.
  }
}

TEST(Cia402Drive, RefusesAGearWithoutAFeedConstant) {
  Cia402Pair pair = cia402_pair(5);
  const auto with_gear = [](Cia402Device& device) {
    device.objects().add({0x6091, 1}, 5, 4, false);
    device.objects().add({0x6091, 2}, 1, 4, false);
  };
  EXPECT_THAT(words_after(pair, with_gear),
              HasSubstr("lacks feed constant (6092) beside its gear (6091); set counts_per_turn"));
  pair.drive.counts_per_turn = 4096;
  EXPECT_THAT(words_after(pair, with_gear), HasSubstr("running"));
}

TEST(Cia402Drive, TakesAVelocityAtAnyPlaceOfAFixedPdo) {
  Cia402Pair pair = cia402_pair(5);
  pair.device.fixed_mapping = true;
  pair.drive.pdos = PdoSource::kFixed;
  pair.drive.velocity_pdo = VelocityPdo::kTrue;
  EXPECT_THAT(words_after(pair), HasSubstr("running"));
  EXPECT_THAT(words_after(pair, with({0x1A01, 0}, 0)), HasSubstr("lacks an entry of its PDO: (0x606C0020"));
  DeviceRig rig;
  Cia402Device& device = add(rig, pair);
  device.objects().set({0x1A01, 0}, 2);
  device.objects().set({0x1A01, 1}, kStatuswordEntry.mapped());
  device.objects().set({0x1A01, 2}, kVelocityEntry.mapped());
  ASSERT_TRUE(rig.runs());
  rig.motor().velocity = 10;
  rig.run(0.05);
  EXPECT_NEAR(rig.drive().sample().joint.velocity * -2.5, 10, 0.06);  // half a unit of 1 rpm
}

VelocitySource velocity_of(const Cia402Pair& pair, const std::function<void(Cia402Device&)>& change = {}) {
  DeviceRig rig;
  Cia402Device& device = add(rig, pair);
  if (change) change(device);
  EXPECT_TRUE(rig.runs()) << rig.drive().words();
  rig.motor().velocity = 10;
  rig.run(0.05);
  EXPECT_NEAR(rig.drive().sample().joint.velocity * -2.5, 10, 0.3) << "a count of the position per 8 ms";
  return rig.drive().full_status().velocity;
}

TEST(Cia402Drive, MapsTheVelocityWhereItCan) {
  const Cia402Pair pair = cia402_pair(5);
  EXPECT_EQ(velocity_of(pair), VelocitySource::kDrive);
  EXPECT_EQ(velocity_of(pair, without({0x606C, 0})), VelocitySource::kNotMapped);
  EXPECT_EQ(velocity_of(pair, without({0x1801, 1})), VelocitySource::kNotMapped);
  EXPECT_EQ(velocity_of(pair, without({0x1A01, 2})), VelocitySource::kDrive) << "one entry is enough";
}

TEST(Cia402Drive, DrivesOnWithoutADerivedVelocityThatIsNotSent) {
  DeviceRig rig;
  Cia402Device& device = add(rig, cia402_pair(5));
  ASSERT_TRUE(rig.runs());
  device.objects().set({0x1801, 1}, canopen::kPdoDisabled);
  rig.motor().velocity = 10;
  rig.run(0.1);
  EXPECT_EQ(rig.drive().status().state, DrivePhase::kRunning);
  EXPECT_NEAR(rig.drive().sample().joint.velocity * -2.5, 10, 0.3);
}

// A wrong unit would move the joint by a multiple of its way.
TEST(Cia402Drive, MapsNoVelocityWithoutItsUnit) {
  Cia402Pair pair = cia402_pair(5);
  EXPECT_EQ(velocity_of(pair, without(kVelocityUnit)), VelocitySource::kNoUnit);
  EXPECT_EQ(velocity_of(pair, with(kVelocityUnit, 0x00B5'0300)), VelocitySource::kNoUnit) << "increments per second";
  pair.drive.velocity_unit = pair.device.velocity_unit = 0.01 * kRpm;
  EXPECT_EQ(velocity_of(pair, without(kVelocityUnit)), VelocitySource::kDrive) << "it is stated";
}

TEST(Cia402Drive, MapsNoVelocityThatIsNotWantedOrHasNoRoom) {
  Cia402Pair pair = cia402_pair(5);
  pair.drive.velocity_has_room = false;
  EXPECT_EQ(velocity_of(pair), VelocitySource::kNoRoom);
  pair.drive.velocity_pdo = VelocityPdo::kOff;
  EXPECT_EQ(velocity_of(pair), VelocitySource::kNotRequested);
}

TEST(Cia402Drive, UsesTheVelocityOfAFixedPdoThatComesWithSync) {
  Cia402Pair pair = cia402_pair(5);
  pair.device.fixed_mapping = true;
  pair.drive.pdos = PdoSource::kFixed;
  EXPECT_EQ(velocity_of(pair), VelocitySource::kDrive);
  EXPECT_EQ(velocity_of(pair, with({0x1801, 2}, canopen::kOnEvent)), VelocitySource::kNotMapped);
  EXPECT_EQ(velocity_of(pair, with({0x1A01, 0}, 0)), VelocitySource::kNotMapped);
}

TEST(Cia402Drive, AVelocityThatIsNotSentAnyMoreIsNamed) {
  Cia402Pair pair = cia402_pair(5);
  pair.drive.velocity_pdo = VelocityPdo::kTrue;
  DeviceRig rig;
  Cia402Device& device = add(rig, pair);
  ASSERT_TRUE(rig.runs());
  device.objects().set({0x1801, 1}, canopen::kPdoDisabled);
  rig.run(0.1);
  EXPECT_THAT(rig.drive().words(), HasSubstr("is silent: no velocity"));
}

TEST(Cia402Drive, StepsThroughThePowerStates) {
  DeviceRig rig;
  add(rig, cia402_pair(5));
  std::vector<unsigned> controlwords;
  rig.bus().join([&](const can_frame& frame, std::int64_t) {
    if (frame.can_id == 0x205 && (controlwords.empty() || controlwords.back() != frame.data[0])) {
      controlwords.push_back(frame.data[0]);
    }
  });
  ASSERT_TRUE(rig.runs());
  rig.run(0.1);
  EXPECT_THAT(controlwords, ElementsAre(0x06, 0x07, 0x0F));
}

TEST(Cia402Drive, ResetsNoFaultByItself) {
  DeviceRig rig;
  Cia402Device& device = add(rig, cia402_pair(5));
  rig.run(0.5);
  device.inject(DeviceFault::kEncoder);
  device.inject(DeviceFault::kNone);
  bool reset = false;
  rig.bus().join(
      [&](const can_frame& frame, std::int64_t) { reset |= frame.can_id == 0x205 && frame.data[0] == 0x80; });
  rig.command_all({.enabled = true});
  rig.run(5);
  EXPECT_FALSE(reset);
  EXPECT_THAT(rig.drive().words(), HasSubstr("fault; the drive reports an error: 0x7305"));
  rig.reset();
  EXPECT_TRUE(rig.runs());
  EXPECT_TRUE(reset);
}

TEST(Cia402Drive, ReadsTheCodeOfAnErrorWhoseEmergencyWasLost) {
  DeviceRig rig;
  Cia402Device& device = add(rig, cia402_pair(5));
  ASSERT_TRUE(rig.runs());
  rig.bus().lose(1);
  device.inject(DeviceFault::kEncoder);
  rig.cycle();
  rig.bus().lose(0);
  rig.run(0.5);
  EXPECT_THAT(rig.drive().words(), HasSubstr("0x7305 (incremental sensor 1 fault)"));
}

TEST(Cia402Drive, JudgesTheVoltageWhereTheDriveHasIt) {
  DeviceRig rig;
  Cia402Device& device = add(rig, cia402_pair(5));
  ASSERT_TRUE(rig.runs());
  rig.run(0.3);
  EXPECT_EQ(rig.drive().sample().voltage, 48);
  device.objects().set(kDcLinkVoltage, 12000);
  rig.run(0.3);
  EXPECT_THAT(rig.drive().words(), HasSubstr("has a low supply: voltage, 12 instead of 18"));
  EXPECT_THAT(words_after(cia402_pair(5), without(kDcLinkVoltage)), HasSubstr("running"));
}

struct ReactionCase {
  std::int64_t abort_option, quick_stop, fault_reaction;
  SilenceReaction reaction;
};

TEST(Cia402Drive, StatesWhatTheDriveDoesOnSilenceAndTheDeviceDoesIt) {
  for (const ReactionCase& each : {ReactionCase{3, 6, 2, SilenceReaction::kHolds},
                                   {3, 2, 2, SilenceReaction::kBrakes},
                                   {3, 0, 2, SilenceReaction::kCoasts},
                                   {2, 6, 2, SilenceReaction::kCoasts},
                                   {1, 6, 2, SilenceReaction::kBrakes},
                                   {1, 6, 0, SilenceReaction::kCoasts},
                                   {0, 6, 2, SilenceReaction::kUnknown}}) {
    Cia402Pair pair = cia402_pair(4);
    pair.drive.abort_option = each.abort_option;
    pair.drive.quick_stop_option = each.quick_stop;
    pair.drive.fault_reaction = each.fault_reaction;
    pair.drive.drive.accept_unknown_watchdog = true;
    DeviceRig rig;
    add(rig, pair);
    ASSERT_TRUE(rig.runs());
    EXPECT_EQ(rig.drive().on_silence().reaction, each.reaction);
    rig.command_all({.enabled = true, .torque = 1});
    rig.run(0.3);
    const double speed = rig.motor().velocity;
    ASSERT_GT(speed, 5);
    rig.host_lives = false;
    rig.run(0.15);
    rig.slope = 0.1;
    rig.run(2);
    const double at = rig.motor().position;
    rig.run(0.5);
    const double moved = std::abs(rig.motor().position - at);
    EXPECT_EQ(moved < 0.01, each.reaction == SilenceReaction::kHolds) << each.abort_option << each.quick_stop;
    const bool slowed = rig.motor().velocity < speed + 0.1 / rig.inertia * 2.6 - 5;
    EXPECT_EQ(slowed, each.reaction == SilenceReaction::kHolds || each.reaction == SilenceReaction::kBrakes);
  }
}

struct TwoAxes : ::testing::Test {
  TwoAxes() {
    Cia402Parameters parameters = cia402_pair(6).drive;
    for (const unsigned axis : {1U, 0U}) {  // The order of the joints does not matter.
      parameters.axis = axis;
      rig_.add_drive(parameters);
    }
    DeviceMotor* const second = &rig_.add_motor();
    const std::vector<DeviceMotor*> motors{&rig_.add_motor(), second};
    device_ = &rig_.add_device(std::make_unique<Cia402Device>(cia402_pair(6).device, rig_.bus(), motors));
  }

  DeviceRig rig_;
  Cia402Device* device_ = nullptr;
};

TEST_F(TwoAxes, AreDrivenApart) {
  ASSERT_TRUE(rig_.runs());
  rig_.commands = {{.enabled = true, .torque = 1}, {.enabled = true, .torque = -2}};
  rig_.cycle();
  EXPECT_NEAR(rig_.motor(0).torque, 0.4, 0.001);
  EXPECT_NEAR(rig_.motor(1).torque, -0.8, 0.001);
}

TEST_F(TwoAxes, FailTogetherAndAreResetTogether) {
  ASSERT_TRUE(rig_.runs());
  device_->inject(DeviceFault::kEncoder);
  rig_.run(0.1);
  EXPECT_TRUE(rig_.all_are(DrivePhase::kFault));
  EXPECT_THAT(rig_.drive(0).words(), HasSubstr("has another axis in fault"));
  EXPECT_THAT(rig_.drive(1).words(), HasSubstr("reports an error: 0x7305"));
  device_->inject(DeviceFault::kNone);
  rig_.reset();
  EXPECT_TRUE(rig_.runs());
  device_->inject(DeviceFault::kOff);
  rig_.run(0.5);
  device_->inject(DeviceFault::kNone);
  rig_.reset();
  EXPECT_TRUE(rig_.runs());
}

TEST_F(TwoAxes, StartAgainTogetherWhereOneFailedAndCouldStillBrake) {
  ASSERT_TRUE(rig_.runs());
  for (const unsigned axis : {0U, 1U}) {
    device_->objects().set(on_axis(kDcLinkVoltage, axis), 10'000);
    rig_.run(0.5);
    EXPECT_EQ(rig_.drive(1 - axis).status().state, DrivePhase::kFault) << axis;
    EXPECT_EQ(rig_.drive(axis).status().state, DrivePhase::kRunning) << axis;
    device_->objects().set(on_axis(kDcLinkVoltage, axis), 48'000);
    rig_.reset();
    EXPECT_TRUE(rig_.runs()) << axis;
  }
}

TEST(Cia402Drive, ContinuesItsPositionOverTheOverflowOf32Bits) {
  DeviceRig rig;
  const Cia402Pair pair = cia402_pair(2);
  add(rig, pair);
  rig.command_all({});
  rig.cycle();  // The device takes its zero.
  rig.motor().position = std::ldexp(2 * std::numbers::pi / pair.device.counts_per_turn, 31) - 0.1;
  ASSERT_TRUE(rig.runs());
  const double before = rig.drive().sample().joint.position;
  rig.motor().velocity = 10;
  rig.run(0.1);
  EXPECT_EQ(rig.drive().status().state, DrivePhase::kRunning) << rig.drive().words();
  EXPECT_NEAR(rig.drive().sample().joint.position - before, 10 * 0.1 / pair.drive.drive.gear, 0.02);
}

}  // namespace robot_control::cia402::tests
