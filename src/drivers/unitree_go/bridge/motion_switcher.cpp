#include "drivers/unitree_go/bridge/motion_switcher.h"

#include <utility>

namespace robot_control::unitree::go {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

}  // namespace

std::optional<std::string> name_in(std::string_view json) {
  constexpr std::string_view kKey = "\"name\"";
  std::size_t at = json.find(kKey);
  if (at == std::string_view::npos) return {};
  at = json.find_first_not_of(kBlanks, at + kKey.size());
  if (at == std::string_view::npos || json[at] != ':') return {};
  at = json.find_first_not_of(kBlanks, at + 1);
  if (at == std::string_view::npos || json[at] != '"') return {};
  const std::size_t end = json.find('"', at + 1);
  if (end == std::string_view::npos) return {};
  return std::string(json.substr(at + 1, end - at - 1));
}

void MotionSwitcher::begin(std::int64_t now_ns) noexcept {
  state_ = exists_ ? MotionService::kAsked : MotionService::kNone;
  mode_.clear();
  last_ = {};
  releases_ = false;
  begin_ns_ = now_ns;
  asked_ns_ = now_ns - kAskNs;
}

std::optional<MotionSwitcher::Request> MotionSwitcher::due(std::int64_t now_ns) noexcept {
  if (!exists_) return {};
  if (state_ != MotionService::kFree && now_ns - begin_ns_ > kPatienceNs) state_ = MotionService::kNoAnswer;
  if (now_ns - asked_ns_ < kAskNs) return {};
  asked_ns_ = now_ns;
  last_ = {.id = now_ns, .api = std::exchange(releases_, false) ? kReleaseMode : kCheckMode};
  return last_;
}

void MotionSwitcher::accept(const Request& request, std::int64_t code, std::string_view data, std::int64_t now_ns) {
  if (last_.id == 0 || request.id != last_.id || request.api != last_.api) return;
  last_ = {};
  if (code != 0) return;
  begin_ns_ = now_ns;
  if (request.api != kCheckMode) return;
  const std::optional<std::string> name = name_in(data);
  if (!name) return;
  mode_ = *name;
  releases_ = release_ && state_ != MotionService::kFree && !name->empty();
  state_ = name->empty() ? MotionService::kFree : MotionService::kActive;
}

}  // namespace robot_control::unitree::go
