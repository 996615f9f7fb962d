#pragma once
/// Streams of bytes that are nearly those of a frame: half are any bytes, the others the frame with some bits changed.
/// A quarter of both lacks a byte. A stream never holds the whole frame.

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

namespace robot_control {

class MutatedStreams {
 public:
  std::vector<std::uint8_t> next(const std::vector<std::uint8_t>& frame) {
    std::vector<std::uint8_t> stream = frame;
    do {
      stream = frame;
      if (random_() % 2 == 0) {
        stream.resize(1 + random_() % 200);
        std::ranges::generate(stream, [&] { return static_cast<std::uint8_t>(random_()); });
      }
      for (auto changes = 1 + random_() % 4; changes > 0; --changes)
        stream[random_() % stream.size()] ^= static_cast<std::uint8_t>(1U << random_() % 8);
      if (random_() % 4 == 0) stream.erase(stream.begin() + static_cast<std::ptrdiff_t>(random_() % stream.size()));
      stream.push_back(0);
    } while (std::ranges::search(stream, frame).size() != 0);
    return stream;
  }

 private:
  std::mt19937 random_{49};
};

}  // namespace robot_control
