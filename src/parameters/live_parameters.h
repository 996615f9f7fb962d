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

/// `base` is sound. Any text.
LiveChange read_live(const Parameters& base, const std::string& block, const std::string& text);

}  // namespace robot_control
