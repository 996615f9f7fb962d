#pragma once
/// A BitName describes one bit of a frame's bit set in words.

#include <cstdint>
#include <string_view>

namespace robot_control {

struct BitName {
  std::uint64_t bit;
  std::string_view name;      ///< snake_case, for logs and topics
  std::string_view sentence;  ///< the condition that the bit reports
  std::string_view remedy;    ///< the action that removes the condition
  std::string_view actor =
      {};  ///< role that applies the remedy: "operator", "integrator", "technician"; stop causes only
  std::string_view unit = {};  ///< unit of CauseEvidence::value and limit; empty: the cause has none
};

}  // namespace robot_control
