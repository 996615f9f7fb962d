#include "log/black_box/lost_rows.h"

#include <algorithm>

namespace robot_control {

void LostRows::gap() {
  for (Node& node : nodes_) node.gap = true;
  places_.emplace_back();
}

void LostRows::row(std::size_t node, const FrameHead& head) {
  Node& state = nodes_.at(node);
  const bool follows = state.gap && state.any && state.before.run == head.run && head.cycle > state.before.cycle + 1;
  if (follows) {
    const std::uint64_t first = state.before.cycle + 1, last = head.cycle - 1;
    Place& place = places_.back();
    place.first = place.known ? std::min(place.first, first) : first;
    place.last = place.known ? std::max(place.last, last) : last;
    place.known = true;
    count_ += last - first + 1;
  }
  state = {.before = head, .any = true, .gap = false};
}

std::string LostRows::text() const {
  constexpr std::size_t kShown = 5;
  std::string text = std::to_string(count_) + " rows of the nodes";
  std::size_t shown = 0, more = 0;
  for (const Place& place : places_) {
    if (!place.known) continue;
    if (shown == kShown) {
      ++more;
      continue;
    }
    text += (shown++ == 0 ? ", in the cycles " : ", ") + std::to_string(place.first);
    if (place.last != place.first) text += " to " + std::to_string(place.last);
  }
  return text + (more == 0 ? "" : " and at " + std::to_string(more) + " more places");
}

}  // namespace robot_control
