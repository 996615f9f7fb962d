#pragma once
/// Streams of bytes that are nearly those of a frame: half are any bytes, the others the frame with some bits changed.
/// A quarter of both lacks a byte. A stream never holds the whole frame.

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "drivers/line/serial_line.h"

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

/// A line that answers each request with a stream that is nearly the answer of a healthy device.
class MutatedLine : public SerialLine {
 public:
  bool receive(SerialChunk& chunk) noexcept override {
    chunk.size = std::min(chunk.bytes.size(), pending_.size());
    std::copy_n(pending_.begin(), chunk.size, chunk.bytes.begin());
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(chunk.size));
    return chunk.size > 0;
  }
  bool connected() const noexcept override { return true; }
  std::string name() const override { return "a line with errors"; }

  int driven = 0;  ///< requests that were to move a wheel

 protected:
  void answer(const std::vector<std::uint8_t>& frame) { pending_ = mutated_.next(frame); }

 private:
  MutatedStreams mutated_;
  std::vector<std::uint8_t> pending_;
};

}  // namespace robot_control
