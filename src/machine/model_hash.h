#pragma once
/// ModelHash computes the 64-bit hash of a robot's text and of everything in its parameters.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "machine/machine_parameters.h"
#include "signals/checksum.h"

namespace robot_control {

class ModelHash {
 public:
  void add(const std::string& text);
  void add(const std::vector<std::string>& texts);
  void add(const std::optional<double>& value);
  void add(const std::optional<Vector3>& vector);
  void add(const MachineParameters& parameters);
  std::uint64_t value() const { return sum_.sum(); }

 private:
  Checksum sum_;
};

}  // namespace robot_control
