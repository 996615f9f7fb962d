#include "configuration/wheeled/calibration_file.h"

#include <unistd.h>

#include <fstream>

#include "configuration/parameters.h"
#include "support/matchers.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

/// The healthy case is the calibration of a robot after an hour. Each test spoils one thing.
struct CalibrationFile : ::testing::Test {
  CalibrationFile() {
    robot_.name = "diff\"bot\\";
    robot_.wheels.resize(2);
    robot_.wheels[0].radius = robot_.wheels[1].radius = 0.1;
    robot_.wheel_base = 0.5;
    robot_.wheel_base_multiplier = 1.1;
  }

  std::string path() const { return folder_.path() / "learned.yaml"; }
  void write() const { write_calibration(path(), learned_, robot_, parameters_); }
  std::optional<LearnedCalibration> read() const { return read_calibration(path(), robot_, parameters_); }

  std::string refusal() const {
    return message_of<ParameterError>([&] { read(); }, "accepted");
  }

  std::string text() const {
    std::ostringstream text;
    text << std::ifstream(path()).rdbuf();
    return text.str();
  }

  void replace(const std::string& old, const std::string& by) const {
    std::string changed = text();
    const std::size_t at = changed.find(old);
    ASSERT_NE(at, std::string::npos) << old << " in\n" << changed;
    std::ofstream(path()) << changed.replace(at, old.size(), by);
  }

  TemporaryFolder folder_;
  DriveTrain robot_;
  EstimatorParameters parameters_;
  LearnedCalibration learned_{.wheels = {.radius_ratio = 1.00612345678901,
                                         .wheel_base_factor = 0.987,
                                         .radius_ratio_deviation = 0.0002,
                                         .wheel_base_deviation = 0.001},
                              .gyro_bias = {0.001, -0.002, 1.0 / 3},
                              .gyro_bias_deviation = {1e-5, 2e-5, 3e-5}};
};

TEST_F(CalibrationFile, ComesBackToTheLastBit) {
  write();
  const LearnedCalibration back = read().value();
  EXPECT_EQ(back.wheels.radius_ratio, learned_.wheels.radius_ratio);
  EXPECT_EQ(back.wheels.radius_ratio_deviation, learned_.wheels.radius_ratio_deviation);
  EXPECT_EQ(back.wheels.wheel_base_factor, learned_.wheels.wheel_base_factor);
  EXPECT_EQ(back.wheels.wheel_base_deviation, learned_.wheels.wheel_base_deviation);
  EXPECT_EQ(back.gyro_bias, learned_.gyro_bias);
  EXPECT_EQ(back.gyro_bias_deviation, learned_.gyro_bias_deviation);
}

TEST_F(CalibrationFile, IsNoneIfItIsNotThereYet) {
  EXPECT_FALSE(read());
}

// A robot keeps it on another partition.
TEST_F(CalibrationFile, IsKeptWhereALinkLeadsTo) {
  std::filesystem::create_symlink("elsewhere.yaml", path());
  EXPECT_FALSE(read());
  write();
  EXPECT_TRUE(std::filesystem::is_symlink(path()));
  EXPECT_TRUE(std::filesystem::is_regular_file(folder_.path() / "elsewhere.yaml"));
  EXPECT_TRUE(read());
}

TEST_F(CalibrationFile, IsRefusedIfItIsNoRegularFile) {
  std::filesystem::create_symlink("/dev/zero", path());
  EXPECT_THAT(refusal(), AllOf(HasSubstr("1 problem"), HasSubstr("is a device; only a regular file is read")));
}

TEST_F(CalibrationFile, LeavesNothingBesideItself) {
  write();
  learned_.wheels.wheel_base_factor = 1.01;
  write();
  EXPECT_EQ(read()->wheels.wheel_base_factor, 1.01);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
}

TEST_F(CalibrationFile, IsRefusedWithAllThatDiffersOfAnotherRobot) {
  write();
  robot_.name = "other";
  robot_.wheels[1].radius = 0.12;
  robot_.wheel_base = 0.6;
  EXPECT_THAT(refusal(),
              AllOf(HasSubstr("3 problems"), HasSubstr("calibration.robot = diff\"bot\\: was learned of another robot"),
                    HasSubstr("other holds here"), HasSubstr("calibration.wheel_radius = 0.1:"),
                    HasSubstr("0.11 holds here"), HasSubstr("calibration.wheel_base = 0.55"), HasSubstr(path()),
                    HasSubstr("delete it to restart the calibration")));
}

// A radius_ratio that was measured and set again is intended: an old file must not override it silently.
TEST_F(CalibrationFile, IsRefusedWithOtherInitialValues) {
  write();
  parameters_.calibration.radius_ratio = 1.004;
  EXPECT_THAT(refusal(), AllOf(HasSubstr("calibration.initial_radius_ratio = 1:"), HasSubstr("1.004 holds here")));
}

TEST_F(CalibrationFile, IsRefusedBeyondTheBounds) {
  const auto with = [&](const std::string& old, const std::string& by) {
    write();
    replace(old, by);
    return refusal();
  };
  EXPECT_THAT(with("  radius_ratio: 1.00612345678901", "  radius_ratio: 1.06"),
              HasSubstr("calibration.radius_ratio = 1.06: must be a number of 0.95 … 1.05"));
  EXPECT_THAT(with("  wheel_base_factor: 0.987", "  wheel_base_factor: 0.69"),
              HasSubstr("calibration.wheel_base_factor = 0.69: must be a number of 0.7 … 1.3"));
  EXPECT_THAT(with("  radius_ratio_deviation: 2e-04", "  radius_ratio_deviation: -1"), HasSubstr("0 … 1"));
  EXPECT_THAT(with("gyro_bias: [0.001,", "gyro_bias: [.nan,"), HasSubstr("calibration.gyro_bias"));
  EXPECT_THAT(with("gyro_bias: [0.001,", "gyro_bias: [1.1,"), HasSubstr("each of -1 … 1 rad/s"));
}

TEST_F(CalibrationFile, IsRefusedWhereItIsBroken) {
  const auto with = [&](const std::string& old, const std::string& by) {
    write();
    replace(old, by);
    return refusal();
  };
  EXPECT_THAT(with("  gyro_bias:", "  gyro_bais:"),
              AllOf(HasSubstr("calibration.gyro_bais"), HasSubstr("unknown key"),
                    HasSubstr("calibration.gyro_bias: missing"), HasSubstr(path() + ":12")));
  EXPECT_THAT(with("calibration:", "calibration: ["), HasSubstr("is not YAML"));
  EXPECT_THAT(with("calibration:", "robot:"), HasSubstr("robot: unknown block"));
  for (const std::string& content : {std::string(), std::string("7\n"), std::string(3, '\0'), std::string("a: b\n")}) {
    std::ofstream(path()) << content;
    EXPECT_THAT(refusal(), HasSubstr(path())) << content;
  }
}

// A power cut in the middle of a write leaves the old file: an incomplete one only ever has the other name.
TEST_F(CalibrationFile, CutAnywhereIsRefusedOrWhole) {
  write();
  const std::string whole = text();
  for (std::size_t length = 0; length + 1 < whole.size(); ++length) {
    std::ofstream(path()) << whole.substr(0, length);
    const std::string verdict = refusal();
    if (whole.find_first_not_of(" #rad/s\n", length) == std::string::npos) continue;  // the comment alone is cut
    EXPECT_NE(verdict, "accepted") << length;
  }
}

TEST_F(CalibrationFile, IsRefusedAtStartInAFolderThatIsNotThere) {
  const std::string nowhere = folder_.path() / "none" / "learned.yaml";
  EXPECT_THROW(read_calibration(nowhere, robot_, parameters_), ParameterError);
  EXPECT_THROW(write_calibration(nowhere, learned_, robot_, parameters_), std::system_error);
  parameters_.self_calibration = false;  // nothing will be written
  EXPECT_FALSE(read_calibration(nowhere, robot_, parameters_));
}

TEST_F(CalibrationFile, IsContinuedWithWhatANightAdds) {
  const EstimatorParameters after = continued(parameters_, learned_);
  EXPECT_EQ(after.calibration.radius_ratio, learned_.wheels.radius_ratio);
  EXPECT_EQ(after.calibration.radius_ratio_deviation, std::hypot(0.0002, 0.0005));
  EXPECT_EQ(after.calibration.wheel_base_factor, 0.987);
  EXPECT_EQ(after.calibration.wheel_base_deviation, std::hypot(0.001, 0.003));
  EXPECT_EQ(after.gyro_bias, learned_.gyro_bias);
  EXPECT_EQ(after.gyro_bias_initial, std::hypot(3e-5, 0.0052));
}

TEST_F(CalibrationFile, NeverKnowsLessThanTheParameters) {
  learned_.wheels.radius_ratio_deviation = 0.05;
  learned_.wheels.wheel_base_deviation = 0.2;
  learned_.gyro_bias_deviation = {1, 1, 1};
  const EstimatorParameters after = continued(parameters_, learned_);
  EXPECT_EQ(after.calibration.radius_ratio_deviation, parameters_.calibration.radius_ratio_deviation);
  EXPECT_EQ(after.calibration.wheel_base_deviation, parameters_.calibration.wheel_base_deviation);
  EXPECT_EQ(after.gyro_bias_initial, parameters_.gyro_bias_initial);
}

TEST_F(CalibrationFile, ChangesNothingThatIsHeldForEver) {
  parameters_.calibration.radius_ratio_deviation = parameters_.calibration.wheel_base_deviation = 0;
  const EstimatorParameters after = continued(parameters_, learned_);
  EXPECT_EQ(after.calibration.radius_ratio, 1);
  EXPECT_EQ(after.calibration.radius_ratio_deviation, 0);
  EXPECT_EQ(after.calibration.wheel_base_factor, 1);
}

TEST_F(CalibrationFile, LeavesTheParametersWhereNothingWasLearned) {
  const EstimatorParameters after = continued(parameters_, {.wheels = {.radius_ratio = 1.02}, .gyro_bias = {1, 1, 1}});
  EXPECT_EQ(after.calibration.radius_ratio, 1);
  EXPECT_EQ(after.gyro_bias, Vector3{});
  EXPECT_EQ(after.gyro_bias_initial, parameters_.gyro_bias_initial);
}

TEST_F(CalibrationFile, TakesOverWhatSaysMore) {
  LearnedCalibration kept;
  EXPECT_TRUE(improve(kept, learned_));
  EXPECT_EQ(kept.wheels.radius_ratio, learned_.wheels.radius_ratio);
  EXPECT_EQ(kept.gyro_bias, learned_.gyro_bias);
  EXPECT_FALSE(improve(kept, learned_));
  LearnedCalibration now = learned_;
  now.wheels.radius_ratio += 0.1 * now.wheels.radius_ratio_deviation;
  EXPECT_FALSE(improve(kept, now));
  now.wheels.radius_ratio += 0.2 * now.wheels.radius_ratio_deviation;
  EXPECT_TRUE(improve(kept, now));
  EXPECT_EQ(kept.wheels.radius_ratio, now.wheels.radius_ratio);
  now.gyro_bias_deviation[2] *= 0.8;
  EXPECT_TRUE(improve(kept, now));
  EXPECT_EQ(kept.gyro_bias_deviation[2], now.gyro_bias_deviation[2]);
}

// A new run begins with the parameters' values, and has learned only the ratio again.
TEST_F(CalibrationFile, KeepsWhatANewRunHasNotLearnedAgain) {
  LearnedCalibration kept = learned_;
  LearnedCalibration now{.wheels = {.radius_ratio = 1.0063,
                                    .wheel_base_factor = 1,
                                    .radius_ratio_deviation = 0.0001,
                                    .wheel_base_deviation = 0.03},
                         .gyro_bias = {},
                         .gyro_bias_deviation = {0.05, 0.05, 0.05}};
  EXPECT_TRUE(improve(kept, now));
  EXPECT_EQ(kept.wheels.radius_ratio, 1.0063);
  EXPECT_EQ(kept.wheels.wheel_base_factor, 0.987);
  EXPECT_EQ(kept.wheels.wheel_base_deviation, 0.001);
  EXPECT_EQ(kept.gyro_bias, learned_.gyro_bias);
}

TEST_F(CalibrationFile, KeepsNoNonsense) {
  EXPECT_TRUE(may_be_kept(learned_));
  EXPECT_FALSE(may_be_kept({}));  // nothing was estimated
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto keeps = [&](auto change) {
    LearnedCalibration changed = learned_;
    change(changed);
    return may_be_kept(changed);
  };
  EXPECT_FALSE(keeps([](LearnedCalibration& c) { c.wheels.radius_ratio = 1.05; }));
  EXPECT_FALSE(keeps([](LearnedCalibration& c) { c.wheels.wheel_base_factor = 0.7; }));
  EXPECT_FALSE(keeps([](LearnedCalibration& c) { c.wheels.wheel_base_factor = kNan; }));
  EXPECT_FALSE(keeps([](LearnedCalibration& c) { c.wheels.radius_ratio_deviation = kNan; }));
  EXPECT_FALSE(keeps([](LearnedCalibration& c) { c.gyro_bias[1] = kNan; }));
  EXPECT_FALSE(keeps([](LearnedCalibration& c) { c.gyro_bias_deviation[0] = kNan; }));
}

}  // namespace robot_control::tests
