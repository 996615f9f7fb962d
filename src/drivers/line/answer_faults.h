#pragma once
/// An AnswerFault happens to every answer of simulated devices on its way to the driver, while all orders arrive. It is
/// the same for a serial line and a CAN bus, although the controller of a true bus hides damage.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace robot_control {

enum class AnswerFault : std::uint8_t {
  kNone,
  kLost,
  kDamaged,  ///< One of its bits is wrong.
  kShifted,  ///< Its bytes stand one place later.
  kLate,     ///< by kLateAnswerNs
};

inline constexpr std::int64_t kLateAnswerNs = 1'000'000'000;

/// The words of `inject`, in the order of the faults.
inline constexpr std::array<std::string_view, 5> kAnswerFaults{"ok", "answers_lost", "answers_damaged",
                                                               "answers_shifted", "answers_late"};
inline constexpr const char* kAnswerFaultWords = "answers_lost, answers_damaged, answers_shifted, answers_late";

/// Returns kNone for other words.
inline AnswerFault answer_fault(std::string_view word) {
  const auto found = std::ranges::find(kAnswerFaults, word);
  return static_cast<AnswerFault>((found - kAnswerFaults.begin()) % std::ssize(kAnswerFaults));
}

}  // namespace robot_control
