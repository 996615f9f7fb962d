#pragma once
/// Values of one block, changed while its node runs: a request → the parameters that hold then, or every reason why
/// not.
///
/// A request is the text of a YAML map, {max_linear_speed: 0.5, pid_kp: 1.5}. Its values lie over those in force, and
/// together they are judged as at start: the same rules, contradictions and messages. A key that is read at start alone
/// (kLive is missing in its traits) is refused, as is an unknown one.

#include <string>
#include <variant>
#include <vector>

#include "parameters/parameters.h"

namespace robot_control {

/// One value that a request gave.
struct LiveValue {
  std::string key;                   ///< within its block: "pid_kp", "feed_forward.mass"
  std::variant<double, bool> value;  ///< as it holds then
  std::string before;                ///< as it would be written; "derived" where it was left out
  std::string after;
};

struct LiveChange {
  Parameters parameters;              ///< `base` with all that was sound in the request
  std::vector<LiveValue> values;      ///< in the order of the schema; the sound ones
  std::vector<std::string> problems;  ///< empty: nothing stands against it
};

/// One key that may change while its node runs.
struct LiveParameter {
  std::string key;                   ///< as in LiveValue
  std::variant<double, bool> value;  ///< as it holds
  double min = 0;                    ///< numbers only
  double max = 0;
  std::string rule;  ///< in words, "a number of 0.001 … 50 m/s"; in ASCII
};

/// Of one block, in the order of the schema; without those that are left out.
std::vector<LiveParameter> live_parameters(const Parameters& whole, const std::string& block);

/// `base` is sound. Any text.
LiveChange read_live(const Parameters& base, const std::string& block, const std::string& text);

}  // namespace robot_control
