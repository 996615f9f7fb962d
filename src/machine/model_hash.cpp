#include "machine/model_hash.h"

#include <bit>

namespace robot_control {

void ModelHash::add(const std::string& text) {
  sum_.mix(text.size());
  sum_.mix(text);
}

void ModelHash::add(const std::vector<std::string>& texts) {
  sum_.mix(texts.size());
  for (const std::string& text : texts) add(text);
}

void ModelHash::add(const std::optional<double>& value) {
  sum_.mix(value.has_value() ? 1 : 0);
  sum_.mix(std::bit_cast<std::uint64_t>(value.value_or(0.0)));
}

void ModelHash::add(const std::optional<Vector3>& vector) {
  sum_.mix(vector.has_value() ? 1 : 0);
  for (const double component : vector.value_or(Vector3{})) sum_.mix(std::bit_cast<std::uint64_t>(component));
}

void ModelHash::add(const MachineParameters& parameters) {
  add(parameters.mass);
  add(parameters.centre_of_gravity);
  add(parameters.imu_link);
  add(parameters.imu_position);
  add(parameters.imu_orientation);
}

}  // namespace robot_control
