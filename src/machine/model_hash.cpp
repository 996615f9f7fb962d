#include "machine/model_hash.h"

#include <bit>

#include "signals/checksum.h"

namespace robot_control {
namespace {

class ModelHash {
 public:
  void add(const std::string& text) {
    sum_.mix(text.size());
    sum_.mix(text);
  }
  void add(const std::vector<std::string>& texts) {
    sum_.mix(texts.size());
    for (const std::string& text : texts) add(text);
  }
  void add(const std::optional<double>& value) {
    sum_.mix(value.has_value() ? 1 : 0);
    sum_.mix(std::bit_cast<std::uint64_t>(value.value_or(0.0)));
  }
  void add(const std::optional<Vector3>& vector) {
    sum_.mix(vector.has_value() ? 1 : 0);
    for (const double component : vector.value_or(Vector3{})) sum_.mix(std::bit_cast<std::uint64_t>(component));
  }
  std::uint64_t value() const { return sum_.sum(); }

 private:
  Checksum sum_;
};

}  // namespace

std::uint64_t model_hash(const std::string& urdf, const RobotParameters& parameters) {
  ModelHash hash;
  hash.add(urdf);
  hash.add(parameters.left_wheel_joints);
  hash.add(parameters.right_wheel_joints);
  hash.add(parameters.wheel_base);
  hash.add(parameters.wheel_base_multiplier);
  hash.add(parameters.wheel_radius);
  hash.add(parameters.left_wheel_radius_multiplier);
  hash.add(parameters.right_wheel_radius_multiplier);
  hash.add(parameters.wheel_effort_limit);
  hash.add(parameters.wheel_velocity_limit);
  hash.add(parameters.wheel_effort_rate);
  hash.add(parameters.mass);
  hash.add(parameters.centre_of_gravity);
  hash.add(parameters.imu_link);
  hash.add(parameters.imu_position);
  hash.add(parameters.imu_orientation);
  return hash.value();
}

}  // namespace robot_control
