#include "configuration/wheeled/calibration_file.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>

#include "configuration/peer_file.h"
#include "estimation/wheeled/calibration_bounds.h"
#include "files/given_path.h"
#include "files/output_file.h"
#include "parameters/parameter_tree.h"
#include "parameters/parameters_text.h"
#include "parameters/tree_reader.h"
#include "signals/roles.h"

namespace robot_control {
namespace {

constexpr const char* kBlock = "calibration";
constexpr const char* kRemedy = "delete it to restart the calibration, or name another file";

/// The content of the file.
struct Content {
  std::string robot;
  double wheel_radius = 0;
  double wheel_base = 0;
  double initial_radius_ratio = 1;
  double initial_wheel_base_factor = 1;
  LearnedCalibration learned;
};

Content content_of(const LearnedCalibration& calibration, const DriveTrain& robot,
                   const EstimatorParameters& parameters) {
  double radius = 0;
  for (const WheelModel& wheel : robot.wheels) radius += wheel.radius / static_cast<double>(robot.wheels.size());
  return {robot.name,
          radius,
          robot.effective_wheel_base(),
          parameters.calibration.radius_ratio,
          parameters.calibration.wheel_base_factor,
          calibration};
}

Keys keys(Content& content) {
  WheelCalibration& wheels = content.learned.wheels;
  return {
      {"robot", &content.robot},
      {"wheel_radius", &content.wheel_radius, "m", 0, 10},
      {"wheel_base", &content.wheel_base, "m", 0, 100},
      {"initial_radius_ratio", &content.initial_radius_ratio, {}, kRadiusRatioMin, kRadiusRatioMax},
      {"initial_wheel_base_factor", &content.initial_wheel_base_factor, {}, kWheelBaseFactorMin, kWheelBaseFactorMax},
      {"radius_ratio", &wheels.radius_ratio, {}, kRadiusRatioMin, kRadiusRatioMax},
      {"radius_ratio_deviation", &wheels.radius_ratio_deviation, {}, 0, 1},
      {"wheel_base_factor", &wheels.wheel_base_factor, {}, kWheelBaseFactorMin, kWheelBaseFactorMax},
      {"wheel_base_deviation", &wheels.wheel_base_deviation, {}, 0, 1},
      {"gyro_bias", &content.learned.gyro_bias, "rad/s", -kGyroBiasMax, kGyroBiasMax},
      {"gyro_bias_deviation", &content.learned.gyro_bias_deviation, "rad/s", 0, 10},
  };
}

/// Compares two numbers. Numbers are written with all digits, so only rounding may differ.
bool equal(double a, double b) {
  return std::abs(a - b) <= 1.0e-9 * std::max(std::abs(a), std::abs(b));
}

void check_owner(const Content& found, const Content& own, const std::string& path, ProblemList& problems) {
  const auto differ = [&](const std::string& name, const std::string& value, const std::string& wanted) {
    problems.add({std::string(kBlock) + "." + name, value,
                  "was learned of another robot or with other parameters: " + wanted + " holds here", path, kRemedy});
  };
  if (found.robot != own.robot) differ("robot", printable(found.robot), printable(own.robot));
  const auto check = [&](const std::string& name, double value, double wanted) {
    if (!equal(value, wanted)) differ(name, shortest(value), shortest(wanted));
  };
  check("wheel_radius", found.wheel_radius, own.wheel_radius);
  check("wheel_base", found.wheel_base, own.wheel_base);
  check("initial_radius_ratio", found.initial_radius_ratio, own.initial_radius_ratio);
  check("initial_wheel_base_factor", found.initial_wheel_base_factor, own.initial_wheel_base_factor);
}

std::filesystem::path folder_of(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  return folder.empty() ? "." : folder;
}

std::string text_of(Content content) {
  std::string text = "# The calibration that " + std::string(program_of(Role::kEstimator)) +
                     " learned; delete this file to restart it.\n";
  text.append(kBlock).append(":\n");
  for (const Key& key : keys(content)) {
    text.append("  ").append(key.name).append(": ").append(value_text(key.field));
    if (!key.unit.empty()) text.append("  # ").append(key.unit);
    text += '\n';
  }
  return text;
}

double grown(double learned, double added, double max) {
  return std::min(max, std::hypot(learned, added));
}

bool estimated(const Vector3& deviation) {
  return std::ranges::all_of(deviation, [](double axis) { return axis > 0; });
}

bool take_over(double& kept, double& kept_deviation, double now, double deviation) {
  constexpr double kShrunk = 0.9;
  constexpr double kMoved = 0.2;
  constexpr double kComparable = 1.5;
  if (!(deviation > 0)) return false;
  const bool moved = std::abs(now - kept) > kMoved * deviation && deviation <= kComparable * kept_deviation;
  if (kept_deviation > 0 && deviation >= kShrunk * kept_deviation && !moved) return false;
  kept = now;
  kept_deviation = deviation;
  return true;
}

}  // namespace

LearnedCalibration learned(const StateFrame& state) {
  return {state.wheeled.calibration, state.base.gyro_bias, state.base.gyro_bias_deviation};
}

bool may_be_kept(const LearnedCalibration& calibration) {
  const WheelCalibration& wheels = calibration.wheels;
  const auto within = [](double value, double min, double max) { return value >= min && value <= max; };
  constexpr double kStopped = 1.0e-3;
  const bool sound = within(wheels.radius_ratio, kRadiusRatioMin + kStopped, kRadiusRatioMax - kStopped) &&
                     within(wheels.wheel_base_factor, kWheelBaseFactorMin + kStopped, kWheelBaseFactorMax - kStopped) &&
                     within(wheels.radius_ratio_deviation, 0, 1) && within(wheels.wheel_base_deviation, 0, 1) &&
                     std::ranges::all_of(calibration.gyro_bias,
                                         [&](double bias) { return within(bias, -kGyroBiasMax, kGyroBiasMax); }) &&
                     std::ranges::all_of(calibration.gyro_bias_deviation, [&](double d) { return within(d, 0, 10); });
  return sound && (wheels.radius_ratio_deviation > 0 || wheels.wheel_base_deviation > 0 ||
                   estimated(calibration.gyro_bias_deviation));
}

bool improve(LearnedCalibration& kept, const LearnedCalibration& now) {
  WheelCalibration& wheels = kept.wheels;
  bool any = take_over(wheels.radius_ratio, wheels.radius_ratio_deviation, now.wheels.radius_ratio,
                       now.wheels.radius_ratio_deviation);
  any |= take_over(wheels.wheel_base_factor, wheels.wheel_base_deviation, now.wheels.wheel_base_factor,
                   now.wheels.wheel_base_deviation);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    any |= take_over(kept.gyro_bias[axis], kept.gyro_bias_deviation[axis], now.gyro_bias[axis],
                     now.gyro_bias_deviation[axis]);
  }
  return any;
}

std::optional<LearnedCalibration> read_calibration(const std::string& path, const DriveTrain& robot,
                                                   const EstimatorParameters& parameters) {
  const std::string subject = std::string(program_of(Role::kEstimator)) + ".calibration_file refused (" + path + ")";
  ProblemList problems;
  if (parameters.self_calibration && access(folder_of(path).c_str(), W_OK | X_OK) != 0) {
    problems.add({folder_of(path).string(), "", failed("written", errno), "",
                  "create the folder, set its owner to this user, or set another file"});
    problems.throw_if_any(subject);
  }
  std::error_code error;
  const auto status =
      std::filesystem::status(path, error);  // a link to a file that does not exist yet counts as no file
  if (status.type() == std::filesystem::file_type::not_found) return {};
  ParameterTree tree = read_tree(path, {}, problems, &peer_problem);
  if (tree.blocks.empty() && problems.empty()) problems.add({path, "", "holds no calibration", "", kRemedy});
  problems.throw_if_any(subject);
  Content found;
  const Schema schema{.blocks = {{kBlock, keys(found)}},
                      .other_package_remedy = [](std::string_view) { return std::string(kRemedy); }};
  read_blocks(std::move(tree), schema, schema.blocks, path, problems);
  problems.throw_if_any(subject);
  check_owner(found, content_of(LearnedCalibration{}, robot, parameters), path, problems);
  problems.throw_if_any(subject);
  return found.learned;
}

void write_calibration(const std::string& path, const LearnedCalibration& calibration, const DriveTrain& robot,
                       const EstimatorParameters& parameters) {
  write_output_file(path, text_of(content_of(calibration, robot, parameters)));
}

EstimatorParameters continued(const EstimatorParameters& parameters, const LearnedCalibration& calibration) {
  EstimatorParameters result = parameters;
  WheelCalibration& wheels = result.calibration;
  const WheelCalibration& was = calibration.wheels;
  if (wheels.radius_ratio_deviation > 0 && was.radius_ratio_deviation > 0) {
    wheels.radius_ratio = was.radius_ratio;
    wheels.radius_ratio_deviation =
        grown(was.radius_ratio_deviation, kRadiusRatioChange, wheels.radius_ratio_deviation);
  }
  if (wheels.wheel_base_deviation > 0 && was.wheel_base_deviation > 0) {
    wheels.wheel_base_factor = was.wheel_base_factor;
    wheels.wheel_base_deviation = grown(was.wheel_base_deviation, kWheelBaseChange, wheels.wheel_base_deviation);
  }
  if (estimated(calibration.gyro_bias_deviation)) {
    result.gyro_bias = calibration.gyro_bias;
    result.gyro_bias_initial =
        grown(std::ranges::max(calibration.gyro_bias_deviation), kBiasSwitchOn, parameters.gyro_bias_initial);
  }
  return result;
}

}  // namespace robot_control
