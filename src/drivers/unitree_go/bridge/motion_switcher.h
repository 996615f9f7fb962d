#pragma once
/// A MotionSwitcher asks the maker's motion service for its mode, and releases it if the user wishes that. Source of
/// the numbers and of the answer: unitree_sdk2_python, comm/motion_switcher and rpc/client_base.py.
///
/// A request has an id, which its answer repeats. CheckMode is answered with JSON that has a "name"; no mode is active
/// if it is empty. The service is asked every kAskNs. It is kNoAnswer after kPatienceNs
/// without an answer, unless it was free. A mode that begins afterwards is not released: the driver stops.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/unitree_go/bridge_report.h"

namespace robot_control::unitree::go {

class MotionSwitcher {
 public:
  static constexpr std::int64_t kCheckMode = 1001, kReleaseMode = 1003;
  static constexpr std::int64_t kAskNs = 500'000'000;
  static constexpr std::int64_t kPatienceNs = 3'000'000'000;

  struct Request {
    std::int64_t id = 0;
    std::int64_t api = 0;
  };

  MotionSwitcher(bool exists, bool release) : exists_(exists), release_(release) { begin(0); }

  /// A driver begins to command: the service is asked again.
  void begin(std::int64_t now_ns) noexcept;

  /// Returns the request that is due.
  std::optional<Request> due(std::int64_t now_ns) noexcept;

  /// Takes an answer. One with another id than the last request is not used.
  void accept(const Request& request, std::int64_t code, std::string_view data, std::int64_t now_ns);

  MotionService state() const noexcept { return state_; }
  bool is_free() const noexcept { return state_ == MotionService::kFree || state_ == MotionService::kNone; }
  const std::string& mode() const noexcept { return mode_; }

 private:
  bool exists_;
  bool release_;
  MotionService state_ = MotionService::kAsked;
  std::string mode_;
  Request last_;
  std::int64_t begin_ns_ = 0;  // or when the last answer came
  std::int64_t asked_ns_ = -kAskNs;
  bool releases_ = false;  // the next request
};

/// Returns the value of "name" in the JSON of an answer; none if it is not a text. Escapes stay as they are.
std::optional<std::string> name_in(std::string_view json);

}  // namespace robot_control::unitree::go
