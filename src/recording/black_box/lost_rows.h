#pragma once
/// Which rows are missing in a black box, by the cycles of those before and after a gap between its records.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "signals/frame_head.h"

namespace robot_control {

class LostRows {
 public:
  /// The next row of each node may not be the one after the row before.
  void gap();

  /// The next row of the node, by TraceRing. A gap within which a run ended counts nothing.
  void row(std::size_t node, const FrameHead& head);

  /// Rows of all nodes.
  std::uint64_t count() const noexcept { return count_; }

  /// "4 rows, in the cycles 17 to 18, 30": the first places.
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
