#pragma once
/// Why a bag is refused: where in it, which field of which record, and what is wrong there.

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

namespace robot_control {

/// A byte of a bag: of the file, or of what a compressed chunk of it holds.
struct BagPlace {
  std::uint64_t offset = 0;                 ///< from the first byte of the file, or of the inflated chunk
  std::optional<std::uint64_t> chunk = {};  ///< offset in the file of the record of that chunk

  BagPlace operator+(std::uint64_t count) const { return {.offset = offset + count, .chunk = chunk}; }
};

class BagError : public std::runtime_error {
 public:
  /// `ends`: the file, or the chunk, ends before what its own lengths announce.
  BagError(const BagPlace& place, const std::string& field, const std::string& problem, bool ends = false)
      : std::runtime_error(words(place) + ", field " + field + ": " + problem), ends_(ends) {}

  bool ends() const { return ends_; }

 private:
  static std::string words(const BagPlace& place) {
    const std::string here = "byte " + std::to_string(place.offset);
    return place.chunk ? here + " of the inflated chunk at byte " + std::to_string(*place.chunk) : here;
  }

  bool ends_;
};

}  // namespace robot_control
