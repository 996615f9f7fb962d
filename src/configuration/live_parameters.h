#pragma once
/// These functions change values of one block while its node runs: a request yields the new parameters, or every reason
/// why it is refused.
///
/// A request is the text of a YAML map, {max_linear_speed: 0.5, pid_kp: 1.5}. Its values are laid over those in force.
/// The result is checked with the same rules, contradictions and messages as at start. An unknown key is refused, and
/// so is one that is read only at start (without kLive in its traits).

#include <string>
#include <variant>
#include <vector>

#include "configuration/parameters.h"

namespace robot_control {

/// One value of a request.
struct LiveValue {
  std::string key;                   ///< within its block: "pid_kp", "feed_forward.mass"
  std::variant<double, bool> value;  ///< value in force after the request
  std::string before;                ///< text of the value in force before; "derived" if it was left out
  std::string after;
};

struct LiveChange {
  Parameters parameters;              ///< `base` with all accepted values of the request
  std::vector<LiveValue> values;      ///< accepted values in the order of the schema
  std::vector<std::string> problems;  ///< empty: the request is accepted
};

/// One key that may change while its node runs.
struct LiveParameter {
  std::string key;                   ///< as in LiveValue
  std::variant<double, bool> value;  ///< value in force
  double min = 0;                    ///< numbers only
  double max = 0;
  std::string rule;  ///< allowed values in words: "a number of 0.001 … 50 m/s", in ASCII
};

/// Returns the live parameters of one block in the order of the schema, without those that are left out.
std::vector<LiveParameter> live_parameters(const Parameters& whole, const std::string& block);

/// Applies a request to `base`, which has been accepted before; `text` may be any text.
LiveChange read_live(const Parameters& base, const std::string& block, const std::string& text);

}  // namespace robot_control
