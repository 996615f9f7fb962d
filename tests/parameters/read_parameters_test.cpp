#include <yaml-cpp/yaml.h>

#include <span>

#include "configuration/parameters.h"
#include "parameters/parameter_file.h"
#include "parameters/problem_list.h"
#include "parameters/schema.h"
#include "parameters/suggestion.h"
#include "support/matchers.h"

namespace robot_control::tests {

/// The healthy case is a copy of the shipped file. Each test spoils one thing.
struct ReadParameters : ::testing::Test {
  std::string at(const std::string& start, int nth = 1) const {
    return "[" + file.path() + ":" + std::to_string(file.line_of(start, nth)) + "]";
  }

  ParameterFile file;
};

TEST_F(ReadParameters, AcceptsTheShippedFile) {
  EXPECT_EQ(file.refusal(), "");
}

// If the file differed from the structs, tests and nodes would disagree.
TEST_F(ReadParameters, ShippedValuesAreTheDefaultsOfTheStructs) {
  const Parameters shipped = read_parameters(shipped_path());
  Parameters defaults;
  defaults.urdf = shipped.urdf;  // files have no default
  defaults.plant.scene = shipped.plant.scene;
  EXPECT_EQ(parameters_text(shipped), parameters_text(defaults));
}

TEST_F(ReadParameters, PathsCountFromTheFileAndComeOutAbsolute) {
  file.set("command_script", "  command_script: scripts/square.csv");
  const Parameters parameters = read_parameters(file.path());
  EXPECT_EQ(parameters.urdf, file.folder().parent_path() / "urdf/diffbot.urdf");
  EXPECT_EQ(parameters.plant.scene, file.folder().parent_path() / "urdf/scenes/flat.xml");
  EXPECT_EQ(parameters.loop.command_script, file.folder() / "scripts/square.csv");
}

TEST_F(ReadParameters, PathsOfOverlaysCountFromTheCurrentFolder) {
  const Parameters parameters = read_parameters(file.path(), {{"robot.urdf", "other.urdf", "/robot/urdf"}});
  EXPECT_EQ(parameters.urdf, std::filesystem::current_path() / "other.urdf");
}

TEST_F(ReadParameters, AbsolutePathsStay) {
  const Parameters parameters = read_parameters(file.path(), {{"robot.urdf", "/opt/other.urdf", "/robot/urdf"}});
  EXPECT_EQ(parameters.urdf, "/opt/other.urdf");
}

// This sweeps bad input: one start shows everything that is wrong.
TEST_F(ReadParameters, ReportsEveryProblemAtOnce) {
  file.set("rate", "  rate: fast");
  file.set("core", "");
  file.set("clock", "  clock: sundial");
  file.set("seed", "  seed: -1");
  file.set("gyro_noise", "  gyro_noise: .nan");
  file.set("odom_frame", "  odom_frame:");
  file.set("publish_tf", "  publish_tf: 3");
  file.set("max_linear_speed", "  max_linear_speed: .inf");
  file.set("max_angular_speed", "  max_angular_speed: -2");
  file.set("pid_kd", "  pid_kd: [2.0]");
  file.set("ramp_time", "  ramp_time: 2.0\n  rampe_time: 2.0");
  file.set("loss_cycles", "  loss_cycles: 20.5");
  file.append("mujoco_plnat:\n  seed: 0\n");
  const std::string message = file.refusal({{"robot.bogus", "1", "/robot/bogus"}});

  EXPECT_THAT(message, HasSubstr("robot.rate = fast: must be a number of 20 … 2000 Hz " + at("  rate:")));
  EXPECT_THAT(message, HasSubstr("robot.core: missing [" + file.path() + "]; add it: a whole number of -1 … 1023"));
  EXPECT_THAT(message, HasSubstr("robot.clock = sundial: must be one of wall, lockstep " + at("  clock:")));
  EXPECT_THAT(message, HasSubstr("mujoco_plant.seed = -1: must be a whole number of 0 …"));
  EXPECT_THAT(message, HasSubstr("mujoco_plant.gyro_noise = .nan: must be finite, a number of"));
  EXPECT_THAT(message, HasSubstr("state_estimator.odom_frame = (nothing): must be a text, not empty"));
  EXPECT_THAT(message, HasSubstr("state_estimator.publish_tf = 3: must be true or false"));
  EXPECT_THAT(message, HasSubstr("diff_drive_controller.max_linear_speed = .inf: must be finite"));
  EXPECT_THAT(message, HasSubstr("diff_drive_controller.max_angular_speed = -2: must be a number of 0.001 … 50 rad/s"));
  EXPECT_THAT(message, HasSubstr("diff_drive_controller.pid_kd = [2.0]: must be a number"));
  EXPECT_THAT(message, HasSubstr("safety_monitor.rampe_time = 2.0: unknown key " + at("  rampe_time:") +
                                 "; did you mean ramp_time?"));
  EXPECT_THAT(message, HasSubstr("safety_monitor.loss_cycles = 20.5: must be a whole number of 5 … 10000 cycles"));
  EXPECT_THAT(message,
              HasSubstr("mujoco_plnat: unknown block " + at("mujoco_plnat:") + "; did you mean mujoco_plant?"));
  EXPECT_THAT(message, HasSubstr("robot.bogus = 1: unknown key [/robot/bogus]"));
  EXPECT_THAT(message, HasSubstr("14 problems"));
  EXPECT_EQ(problems_in(message), 14u) << message;
}

TEST_F(ReadParameters, RefusesTheAbsenceOfAnyKeyThatIsNotOptional) {
  std::map<std::string, int> seen;  // blocks share some names
  for (const Block& block : blocks()) {
    for (const Key& key : block.keys) {
      if ((key.traits & kOptional) != 0) continue;
      ParameterFile without;
      const std::string name(key.name);
      if (key.group.empty()) {
        without.set(name, "", ++seen[name]);
      } else {
        without.set_in(std::string(key.group), name, "");
      }
      const std::string message = without.refusal();
      EXPECT_THAT(message, HasSubstr(path_of(block, key) + ": missing"));
      EXPECT_EQ(problems_in(message), 1u) << message;
    }
  }
}

TEST_F(ReadParameters, AnOverlayMayBringWhatTheFileLacks) {
  file.set("rate", "");
  EXPECT_EQ(read_parameters(file.path(), {{"robot.rate", "500", "/robot/rate"}}).loop.rate, 500);
}

TEST_F(ReadParameters, AMapOfWhatIsOptionalMayBeAbsentOrHoldAPartOfIt) {
  EXPECT_FALSE(read_parameters(file.path()).controller.feed_forward.mass);
  const auto read = [&](const std::string& path, const std::string& text) {
    return read_parameters(file.path(), {{path, text, "dict"}}).controller.feed_forward;
  };
  EXPECT_EQ(read("diff_drive_controller.feed_forward.mass", "13.5").mass, 13.5);
  const FeedForwardParameters some = read("diff_drive_controller.feed_forward", "{mass: 13.5, wheel_friction: 0.1}");
  EXPECT_EQ(some.mass, 13.5);
  EXPECT_EQ(some.wheel_friction, 0.1);
  EXPECT_FALSE(some.yaw_inertia);
}

TEST_F(ReadParameters, NamesTheRuleOfAMapThatIsNone) {
  file.set("command_rate", "  command_rate: 50\n  feed_forward: 12");
  EXPECT_THAT(file.refusal(), HasSubstr("diff_drive_controller.feed_forward = 12: must be a map of mass, yaw_inertia, "
                                        "wheel_inertia, wheel_damping, wheel_friction"));
}

TEST_F(ReadParameters, ChecksTheGaitsOfTheUser) {
  EXPECT_THAT(file.refusal({{"leg_controller.gait_1", "{name: pace}", "dict"}}),
              HasSubstr("leg_controller.gait_1.name = pace: does not describe a gait by itself [dict]"));
}

/// Adds the values of a YAML map as overlays.
void add_values(const YAML::Node& map, const std::string& prefix, std::vector<Overlay>& to) {
  for (const auto& entry : map) {
    const std::string path = prefix + entry.first.as<std::string>();
    if (entry.second.IsMap()) {
      add_values(entry.second, path + ".", to);
    } else {
      to.push_back({path, entry.second.IsScalar() ? entry.second.Scalar() : YAML::Dump(entry.second), "dict"});
    }
  }
}

TEST_F(ReadParameters, OverlaysAloneAreEnough) {
  const Parameters shipped = read_parameters(shipped_path());
  std::vector<Overlay> all;
  add_values(YAML::LoadFile(shipped_path()), "", all);
  all.push_back({"robot.urdf", shipped.urdf, "dict"});
  all.push_back({"mujoco_plant.scene", shipped.plant.scene, "dict"});
  EXPECT_EQ(parameters_text(read_parameters("", all)), parameters_text(shipped));
}

// A Python dict has True and False.
TEST_F(ReadParameters, TakesEverySpellingOfABoolean) {
  for (const auto& [text, value] :
       {std::pair{"true", true}, {"True", true}, {"yes", true}, {"false", false}, {"False", false}, {"no", false}}) {
    EXPECT_EQ(read_parameters(file.path(), {{"state_estimator.planar", text, "dict"}}).estimator.planar, value) << text;
  }
}

TEST_F(ReadParameters, TheLastOverlayWins) {
  const Parameters parameters =
      read_parameters(file.path(), {{"robot.rate", "500", "first"}, {"robot.rate", "200", "second"}});
  EXPECT_EQ(parameters.loop.rate, 200);
}

TEST_F(ReadParameters, RefusesAFileThatIsNoMapOfBlocks) {
  const auto expect = [&](const std::string& text, const std::string& message) {
    file.write(text);
    EXPECT_THAT(file.refusal(), HasSubstr(message)) << text.substr(0, 20);
    EXPECT_NE(file.refusal(), "");
  };
  expect("", "");
  expect(", " + shipped_text(), "");  // yaml-cpp 0.7 would read documents endlessly there.
  expect("- robot\n", "must consist of blocks");
  expect(shipped_text() + "---\nrobot: {}\n", "must hold one YAML document, not more");
  expect(shipped_text() + "more: 1\n", "more: must be a block of keys");
  expect(shipped_text() + "telemetry:\n  directory: elsewhere\n", "telemetry: given twice");
  expect("robot:\n  rate: 1000\n  clock: [wall\nother: 1\n", "is not YAML");
  EXPECT_THAT(file.refusal(), HasSubstr(file.path() + ":4]"));
}

TEST_F(ReadParameters, RefusesAWrongValueOfAnOverlayByItsOrigin) {
  for (const auto& [path, text, message] :
       {std::tuple{"robot.rate", "5000", "robot.rate = 5000: must be a number of 20 … 2000 Hz [origin]"},
        {"robot.rate", "[1, ", "robot.rate = [1, : is not YAML"},
        {"robot.rate", "{a: 1}", "robot.rate = (a block): must be"},
        {"robot.rate", "\"1000\"", "robot.rate = \"1000\": must be a number"},
        {"safety_monitor.heartbeat_timeout", "0.001", "must be 0 (off) or at least"}}) {
    EXPECT_THAT(file.refusal({{path, text, "origin"}}), HasSubstr(message));
  }
  EXPECT_THAT(
      file.refusal({{"robot.left_wheel_joints", "[a, b]", "origin"}, {"robot.left_wheel_joint", "a", "origin"}}),
      HasSubstr("robot.left_wheel_joint = a: is another name of robot.left_wheel_joints = [a, b]"));
}

TEST_F(ReadParameters, RefusesAFileThatIsNotThere) {
  EXPECT_THAT([] { read_parameters("/nowhere/robot_params.yaml"); },
              ThrowsMessage<ParameterError>(HasSubstr("/nowhere/robot_params.yaml: file not found")));
}

TEST_F(ReadParameters, RefusesAKeyGivenTwiceAndNamesBothLines) {
  file.set("rate", "  rate: 1000\n  rate: 500");
  EXPECT_THAT(file.refusal(),
              HasSubstr("robot.rate: given twice, first at " + at("  rate:").substr(1, at("  rate:").size() - 2)));
  EXPECT_THAT(file.refusal(), HasSubstr(at("  rate:", 2)));
}

TEST_F(ReadParameters, AcceptsEitherNameOfTheWheelBase) {
  file.set("rate", "  rate: 1000\n  wheel_separation: 0.6");
  EXPECT_EQ(read_parameters(file.path()).robot.wheel_base, 0.6);
  file.set("wheel_separation", "  wheel_base: 0.7");
  EXPECT_EQ(read_parameters(file.path()).robot.wheel_base, 0.7);
}

TEST_F(ReadParameters, RefusesTwoNamesThatDiffer) {
  file.set("rate", "  rate: 1000\n  wheel_base: 0.5\n  wheel_separation: 0.6");
  const std::string message = file.refusal();
  EXPECT_THAT(message,
              HasSubstr("robot.wheel_separation = 0.6: is another name of robot.wheel_base = 0.5 " +
                        at("  wheel_base:") + " and differs " + at("  wheel_separation:") + "; remove one of them"));
  EXPECT_EQ(problems_in(message), 1u);
}

TEST_F(ReadParameters, AcceptsTwoNamesThatAgree) {
  file.set("rate", "  rate: 1000\n  wheel_base: 0.5\n  wheel_separation: 0.50");
  EXPECT_EQ(read_parameters(file.path()).robot.wheel_base, 0.5);
}

TEST_F(ReadParameters, AnOverlayOfOneNameReplacesTheOther) {
  file.set("rate", "  rate: 1000\n  wheel_base: 0.5");
  const Parameters parameters = read_parameters(file.path(), {{"robot.wheel_separation", "0.6", "/robot"}});
  EXPECT_EQ(parameters.robot.wheel_base, 0.6);
}

TEST_F(ReadParameters, LeavesTheWheelsToTheUrdf) {
  const Parameters parameters = read_parameters(file.path());
  EXPECT_FALSE(parameters.robot.wheel_base);
  EXPECT_FALSE(parameters.robot.wheel_radius);
}

TEST_F(ReadParameters, ReadsWheelJointsAsAListOrAsOneName) {
  file.set("rate", "  rate: 1000\n  left_wheel_joints: [front, \"rear\"]\n  right_wheel_joint: other");
  const Parameters parameters = read_parameters(file.path());
  EXPECT_THAT(parameters.robot.left_wheel_joints, ElementsAre("front", "rear"));
  EXPECT_THAT(parameters.robot.right_wheel_joints, ElementsAre("other"));
  EXPECT_THAT(read_parameters(file.path(), {{"robot.left_wheel_joints", "[]", "dict"}}).robot.left_wheel_joints,
              IsEmpty());
}

TEST_F(ReadParameters, RefusesWhatIsNoListOfNames) {
  for (const char* text : {"[a, \"\"]", "[[a]]", "{a: b}", "[a, ~]", ""}) {
    EXPECT_THAT(file.refusal({{"robot.left_wheel_joints", text, "dict"}}),
                HasSubstr("must be a name or a list of names, [] = found in the URDF"))
        << text;
  }
}

TEST_F(ReadParameters, ReadsAVectorOfThreeNumbers) {
  EXPECT_FALSE(read_parameters(file.path()).robot.centre_of_gravity);
  file.set("rate", "  rate: 1000\n  centre_of_gravity: [0.1, -2e-2, 0]");
  EXPECT_THAT(read_parameters(file.path()).robot.centre_of_gravity, Optional(Vector3{0.1, -0.02, 0}));
}

TEST_F(ReadParameters, RefusesWhatIsNoVectorOfThreeNumbers) {
  EXPECT_THAT(file.refusal({{"robot.centre_of_gravity", "[1, [2], x]", "dict"}}),
              HasSubstr("robot.centre_of_gravity = [1, […], x]: must be"));
  for (const char* text :
       {"[1, 2]", "[1, 2, 3, 4]", "1", "[1, 2, x]", "[1, 2, 10.5]", "[1, [2], 3]", "[1, 2, \"3\"]"}) {
    EXPECT_THAT(file.refusal({{"robot.centre_of_gravity", text, "dict"}}),
                HasSubstr("must be a list of three numbers, each of -10 … 10 m"))
        << text;
  }
  EXPECT_THAT(file.refusal({{"robot.centre_of_gravity", "[1, .nan, 3]", "dict"}}), HasSubstr("must be finite"));
}

// A list that contains itself is valid YAML.
TEST_F(ReadParameters, RefusesAListWithinItself) {
  EXPECT_THAT(file.refusal({{"robot.left_wheel_joints", "&a [*a]", "dict"}}), HasSubstr("must be"));
}

TEST_F(ReadParameters, ReadsTheWordsOfTheTyre) {
  EXPECT_EQ(read_parameters(file.path()).plant.tyre, TyreModel::kBrush);
  EXPECT_EQ(read_parameters(file.path(), {{"mujoco_plant.tyre", "native", "dict"}}).plant.tyre, TyreModel::kNative);
  EXPECT_THAT(file.refusal({{"mujoco_plant.tyre", "square", "dict"}}), HasSubstr("must be one of brush, native"));
}

TEST_F(ReadParameters, ReadsTheLevelOfSensorErrors) {
  const auto read = [&](const char* text) {
    return read_parameters(file.path(), {{"mujoco_plant.sensor_errors", text, "dict"}});
  };
  for (const auto& [text, level] : {std::pair{"ideal", ErrorLevel::kIdeal},
                                    {"data_sheet", ErrorLevel::kDataSheet},
                                    {"field", ErrorLevel::kField}}) {
    EXPECT_EQ(read(text).plant.sensor_errors, level);
    EXPECT_TRUE(read(text).warnings.empty());
  }
  EXPECT_THAT(file.refusal({{"mujoco_plant.sensor_errors", "some", "dict"}}),
              HasSubstr("must be one of ideal, data_sheet, field"));
}

TEST_F(ReadParameters, TakesTheOldTruthValuesOfSensorErrorsWithAWarning) {
  for (const auto& [text, level, now] : {std::tuple{"true", ErrorLevel::kDataSheet, "replace it with data_sheet"},
                                         {"True", ErrorLevel::kDataSheet, "replace it with data_sheet"},
                                         {"false", ErrorLevel::kIdeal, "replace it with ideal"},
                                         {"no", ErrorLevel::kIdeal, "replace it with ideal"}}) {
    const Parameters parameters = read_parameters(file.path(), {{"mujoco_plant.sensor_errors", text, "dict"}});
    EXPECT_EQ(parameters.plant.sensor_errors, level) << text;
    ASSERT_EQ(parameters.warnings.size(), 1u) << text;
    EXPECT_THAT(parameters.warnings[0], HasSubstr(now));
  }
}

TEST_F(ReadParameters, TakesAKeyThatHasNoEffectAnyMoreWithAWarning) {
  EXPECT_TRUE(read_parameters(file.path()).warnings.empty());
  const Parameters parameters =
      read_parameters(file.path(), {{"state_estimator.standstill_acceleration", "0.4", "dict"}});
  ASSERT_EQ(parameters.warnings.size(), 1u);
  EXPECT_THAT(parameters.warnings[0], HasSubstr("standstill_acceleration has no effect any more"));
}

TEST_F(ReadParameters, LeavesGainsAndBrakesToTheRobot) {
  const Parameters parameters = read_parameters(file.path());
  EXPECT_FALSE(parameters.controller.pid_kp);
  EXPECT_FALSE(parameters.controller.pid_ki);
  EXPECT_FALSE(parameters.plant.brake_effort);
  EXPECT_EQ(read_parameters(file.path(), {{"diff_drive_controller.pid_kp", "1.5", "dict"}}).controller.pid_kp, 1.5);
}

// Two periods of 1 ms.
TEST_F(ReadParameters, RefusesATimeoutUnderTwoPeriods) {
  file.set("cmd_vel_timeout", "  cmd_vel_timeout: 0.0019");
  EXPECT_THAT(file.refusal(), HasSubstr("must be 0 (off) or at least two periods, 0.002 s at 1000 Hz"));
  file.set("cmd_vel_timeout", "  cmd_vel_timeout: 0.002");
  EXPECT_EQ(file.refusal(), "");
  file.set("cmd_vel_timeout", "  cmd_vel_timeout: 0");
  EXPECT_EQ(file.refusal(), "");
}

TEST_F(ReadParameters, RefusesEveryContradictionOfTheDrivesLimitsInOneMessage) {
  const std::map<std::string, std::string> broken{
      {"max_linear_speed", "-1"},        {"max_angular_speed", "0"},    {"max_linear_acceleration", ".nan"},
      {"max_angular_acceleration", "0"}, {"cmd_vel_timeout", "0.0019"}, {"one_sender", "2"}};
  for (const auto& [key, value] : broken) file.set(key, "  " + key + ": " + value);
  const std::map<std::string, std::string> broken_and_derived{{"max_linear_emergency_deceleration", "0"},
                                                              {"max_angular_emergency_deceleration", ".inf"},
                                                              {"max_linear_jerk", "-10"},
                                                              {"max_angular_jerk", "-1e-9"}};
  std::vector<Overlay> overlays;
  for (const auto& [key, value] : broken_and_derived)
    overlays.push_back({"diff_drive_controller." + key, value, "test"});
  const std::string refusal = file.refusal(overlays);
  EXPECT_THAT(refusal, HasSubstr("10 problems"));
  for (const auto& some : {broken, broken_and_derived}) {
    for (const auto& [key, value] : some) {
      EXPECT_THAT(refusal, HasSubstr("diff_drive_controller." + key + " = " + value)) << refusal;
    }
  }
}

// The shipped file fits every rate of the loop.
TEST_F(ReadParameters, NeedsNoOtherValueForASlowLoop) {
  for (const char* rate : {"20", "50", "99", "2000"}) {
    EXPECT_NO_THROW(read_parameters(shipped_path(), {{"robot.rate", rate, "test"}})) << rate;
  }
  file.set("rate", "  rate: 19");
  EXPECT_THAT(file.refusal(), HasSubstr("robot.rate = 19: must be a number of 20 … 2000 Hz"));
}

// The parameter server follows YAML 1.1, where a plain `off` is a boolean.
TEST_F(ReadParameters, TakesTheBooleanThatYaml11MakesOfOff) {
  for (const char* text : {"off", "false", "False"}) {
    EXPECT_EQ(read_parameters(file.path(), {{"robot.realtime", text, "/robot/realtime"}}).loop.realtime,
              RealtimePolicy::kOff)
        << text;
  }
}

TEST_F(ReadParameters, AnEmptyOverlayIsTheEmptyText) {
  file.set("bus", "  bus: mine");
  EXPECT_EQ(read_parameters(file.path(), {{"robot.bus", "", "/robot/bus"}}).loop.bus, "");
  EXPECT_THAT(file.refusal({{"robot.rate", "", "/robot/rate"}}), HasSubstr("robot.rate = \"\": must be a number"));
}

TEST_F(ReadParameters, RefusesWhatIsOnlyPartlyANumber) {
  for (const char* text : {"1000Hz", "1e999", "0x3e8", "1_000", "1,000", "+-1000", "NaN", "-inf", "~", "null"}) {
    file.set("rate", std::string("  rate: ") + text);
    EXPECT_THAT(file.refusal(), HasSubstr("robot.rate = ")) << text;
  }
}

TEST_F(ReadParameters, TakesEverySpellingOfANumber) {
  for (const char* text : {"500", "500.", "+500.0", "5e2", "5.0E+2"}) {
    file.set("rate", std::string("  rate: ") + text);
    EXPECT_EQ(read_parameters(file.path()).loop.rate, 500) << text;
  }
}

TEST_F(ReadParameters, EscapesWhatATerminalWouldInterpret) {
  file.set("rate", "  rate: \"\\e[31m\"");
  EXPECT_THAT(file.refusal(), HasSubstr("\\x1b[31m"));
  EXPECT_THAT(file.refusal(), Not(HasSubstr("\x1b")));
}

TEST(Listing, FitsThousandsOfProblemsIntoAMessageAndCountsTheRest) {
  const std::string text = listing("my.yaml", std::vector<std::string>(3000, "robot.ratee = 500: unknown key"));
  EXPECT_LT(text.size(), 2000u);
  EXPECT_THAT(text, AllOf(StartsWith("my.yaml: 3000 problems"), testing::ContainsRegex("and 29[0-9]+ more$")));
}

TEST(Schema, PathsAreUnique) {
  const std::vector<std::string> paths = parameter_paths();
  EXPECT_EQ(std::set<std::string>(paths.begin(), paths.end()).size(), paths.size());
}

/// The bytes of a field.
struct Place {
  template <class Value>
  std::span<const char> operator()(const Value* value) const {
    return {reinterpret_cast<const char*>(value), sizeof(Value)};
  }
  std::span<const char> operator()(const Choice& choice) const { return {static_cast<const char*>(choice.place), 1}; }
};

// If two keys wrote one field, the later one would win silently.
TEST(Schema, EveryKeyHasAFieldOfItsOwn) {
  std::set<const void*> fields;
  for (const Block& block : blocks()) {
    for (const Key& key : block.keys) {
      const bool fresh = fields.insert(std::visit(Place{}, key.field).data()).second;
      EXPECT_EQ(fresh, key.other_name_of.empty()) << path_of(block, key);
    }
  }
}

// A word of eight bytes that no key writes would be a member without a key.
TEST(Schema, EveryMemberOfALawsParametersHasAKey) {
  Parameters parameters;
  const auto bytes_in = [&](const auto& group) {
    const auto* begin = reinterpret_cast<const char*>(&group);
    std::set<std::size_t> words;
    for (const Block& block : schema(parameters).blocks) {
      for (const Key& key : block.keys) {
        const std::span<const char> place = std::visit(Place{}, key.field);
        if (place.data() < begin || place.data() >= begin + sizeof(group)) continue;
        const auto first = static_cast<std::size_t>(place.data() - begin);
        for (std::size_t byte = first; byte < first + place.size(); ++byte) words.insert(byte / 8);
      }
    }
    return 8 * words.size();
  };
  EXPECT_EQ(bytes_in(parameters.robot), sizeof(DriveTrainParameters));
  EXPECT_EQ(bytes_in(parameters.plant), sizeof(MujocoPlantParameters));
  EXPECT_EQ(bytes_in(parameters.estimator), sizeof(EstimatorParameters));
  EXPECT_EQ(bytes_in(parameters.controller), sizeof(DriveControllerParameters));
  constexpr std::size_t kWithoutLimit = 3;  // encoders_lost, imu_lost, imu_stuck: lost or not
  constexpr std::size_t kDerivedAlways = sizeof(SafetyParameters::count_ripple) + 8;  // and joint_numbers, padded
  EXPECT_EQ(bytes_in(parameters.safety),
            sizeof(SafetyParameters) - kWithoutLimit * sizeof(Condition::limit) - kDerivedAlways);
}

TEST(Schema, EveryNumberHasARange) {
  for (const Block& block : blocks()) {
    for (const Key& key : block.keys) {
      const Field& field = key.field;
      const bool number =
          std::holds_alternative<double*>(field) || std::holds_alternative<std::int64_t*>(field) ||
          std::holds_alternative<std::uint64_t*>(field) || std::holds_alternative<std::optional<double>*>(field) ||
          std::holds_alternative<Vector3*>(field) || std::holds_alternative<std::optional<Vector3>*>(field) ||
          std::holds_alternative<std::optional<NumberList<4>>*>(field) ||
          std::holds_alternative<std::optional<CovarianceDiagonal>*>(field);
      EXPECT_EQ(number, key.min < key.max) << path_of(block, key);
    }
  }
}

TEST(Schema, DescribesWhatIsAllowed) {
  for (const Block& block : blocks()) {
    for (const Key& key : block.keys) {
      if (path_of(block, key) != "diff_drive_controller.cmd_vel_timeout") continue;
      EXPECT_EQ(rule_of(key), "a number of 0 … 60 s (0 = off)");
    }
  }
}

Schema all() {
  static Parameters parameters;
  return schema(parameters);
}

TEST(Suggestion, CountsLettersThatDiffer) {
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("wheel_bas", "wheel_base"), 1u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

TEST(Suggestion, NamesTheNearestKey) {
  EXPECT_EQ(suggest_key(all(), "robot.wheel_bas"), "did you mean wheel_base?");
  EXPECT_EQ(suggest_key(all(), "robot.wheel_seperation"), "did you mean wheel_separation?");
}

// The article keeps wheel_base in the controller's block.
TEST(Suggestion, NamesTheBlockOfAKeyThatStandsElsewhere) {
  EXPECT_EQ(suggest_key(all(), "diff_drive_controller.wheel_base"), "did you mean robot.wheel_base?");
}

TEST(Suggestion, IsSilentWhenNothingIsNear) {
  EXPECT_EQ(suggest_key(all(), "robot.colour_of_hull"), "");
}

TEST_F(ReadParameters, RefusesAnEmergencyWeakerThanAUsualStopAndAJerkThatHoldsItUp) {
  const std::string block = "diff_drive_controller.";
  const Overlay linear{block + "max_linear_emergency_deceleration", "2.0", "test"};
  const Overlay angular{block + "max_angular_emergency_deceleration", "8.0", "test"};
  EXPECT_THAT(file.refusal({linear, {block + "max_linear_deceleration", "2.5", "test"}}),
              HasSubstr("max_linear_emergency_deceleration = 2.0: must not be below diff_drive_controller."
                        "max_linear_deceleration = 2.5 [test]"));
  EXPECT_THAT(file.refusal({angular, {block + "max_angular_acceleration", "9", "test"}}),
              HasSubstr("max_angular_emergency_deceleration = 8.0: must not be below diff_drive_controller."
                        "max_angular_acceleration = 9 [test]"));
  EXPECT_THAT(file.refusal({linear, {block + "max_linear_jerk", "1.9", "test"}}),
              HasSubstr("max_linear_jerk = 1.9: must be 0 (off) or reach diff_drive_controller."
                        "max_linear_emergency_deceleration = 2.0"));
  EXPECT_THAT(file.refusal({{block + "max_linear_jerk", "1.9", "test"}}),
              HasSubstr("max_linear_emergency_deceleration = 2 (derived) within 1 s"));
  EXPECT_NO_THROW(read_parameters(file.path(), {{block + "max_linear_jerk", "2", "test"}}));
  EXPECT_NO_THROW(read_parameters(file.path(), {{block + "max_linear_jerk", "0", "test"}}));
}

}  // namespace robot_control::tests
