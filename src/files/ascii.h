#pragma once
/// Texts of services, topics and diagnostics are ASCII. The programs rosservice and rostopic print other bytes as
/// escapes, and programs in a C locale cannot show them.

#include <string>
#include <string_view>

namespace robot_control {

/// Replaces the symbols of units and of this project's sentences by ASCII: "2 kg·m²" becomes "2 kg*m^2", "0.2°" becomes
/// "0.2 deg". A byte of any other symbol, for instance in a user's path, becomes \xNN.
std::string ascii(std::string_view text);

}  // namespace robot_control
