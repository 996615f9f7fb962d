#pragma once
/// Text for services, topics and diagnostics: rosservice and rostopic print every byte beyond ASCII as an escape, and
/// what reads a C locale cannot show it.

#include <string>
#include <string_view>

namespace robot_control {

/// The signs of units and of this project's sentences in ASCII: "2 kg·m²" is "2 kg*m^2", "0.2°" is "0.2 deg". A byte
/// that belongs to no known sign, a user's name or path, becomes \xNN.
std::string ascii(std::string_view text);

}  // namespace robot_control
