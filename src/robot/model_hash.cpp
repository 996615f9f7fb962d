#include "robot/model_hash.h"

#include <bit>

#include "signals/fnv.h"

namespace robot_control {
namespace {

class ModelHash {
 public:
  void add(const std::string& text) {
    hash_.add(text);
    add_byte(0);
  }
  void add(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) add(text);
    add_byte(1);
  }
  void add(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int shift = 0; shift < 64; shift += 8) add_byte(static_cast<unsigned char>(bits >> shift));
  }
  void add(const std::optional<double>& value) {
    add_byte(value.has_value());
    add(value.value_or(0.0));
  }
  void add(const std::optional<Vector3>& vector) {
    add(std::optional<double>(vector ? 1.0 : 0.0));
    for (const double component : vector.value_or(Vector3{})) add(component);
  }
  std::uint64_t value() const { return hash_.value(); }

 private:
  void add_byte(unsigned char byte) { hash_.add(byte); }
  Fnv1a hash_;
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
