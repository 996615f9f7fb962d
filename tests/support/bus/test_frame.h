#pragma once
/// A frame whose content shows whether it is whole: every value is the cycle.

#include <algorithm>
#include <array>
#include <cstdint>

#include "signals/frame_head.h"

namespace robot_control {

struct TestFrame {
  FrameHead head;
  std::array<std::uint64_t, 100> values{};
};

inline TestFrame test_frame(std::uint64_t run, std::uint64_t cycle) {
  TestFrame frame;
  frame.head.run = run;
  frame.head.cycle = cycle;
  frame.values.fill(cycle);
  return frame;
}

inline bool whole(const TestFrame& frame) {
  return std::ranges::all_of(frame.values, [&](std::uint64_t value) { return value == frame.head.cycle; });
}

}  // namespace robot_control
