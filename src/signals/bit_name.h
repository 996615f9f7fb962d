#pragma once
/// One bit of a frame's bit set, in words.

#include <cstdint>
#include <string_view>

namespace robot_control {

struct BitName {
  std::uint64_t bit;
  std::string_view name;        ///< snake_case, for logs and topics
  std::string_view sentence;    ///< what is the case
  std::string_view remedy;      ///< what is done about it
  std::string_view actor = {};  ///< of the remedy: "operator", "integrator", "technician"; stop causes only
  std::string_view unit = {};   ///< of CauseEvidence::value and limit; empty: the cause has none
};

}  // namespace robot_control
