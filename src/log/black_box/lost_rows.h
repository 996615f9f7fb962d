#pragma once
/// Counts the rows that are missing in a black box, by the cycles before and after a gap between its records.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "signals/frame_head.h"

namespace robot_control {

class LostRows {
 public:
  /// Records are missing here: rows of each node may be among them.
  void gap();

  /// `head` is that of the next row of the node, by TraceRing. A gap in which a run ended does not count.
  void row(std::size_t node, const FrameHead& head);

  /// Number of missing rows of all nodes.
  std::uint64_t count() const noexcept { return count_; }

  /// The text names the first places: "4 rows, in the cycles 17 to 18, 30".
  std::string text() const;

 private:
  struct Place {
    std::uint64_t first = 0, last = 0;  ///< cycles
    bool known = false;
  };
  struct Node {
    FrameHead before;
    bool any = false;
    bool gap = false;
  };

  std::array<Node, 4> nodes_;
  std::vector<Place> places_;
  std::uint64_t count_ = 0;
};

}  // namespace robot_control
