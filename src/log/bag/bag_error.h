#pragma once
/// A BagError says why a bag is refused: the place in the bag, the field of a record, and the problem.

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

namespace robot_control {

/// The place of a byte in a bag: in the file, or in the inflated content of a compressed chunk.
struct BagPlace {
  std::uint64_t offset = 0;                 ///< from the first byte of the file, or of the inflated chunk
  std::optional<std::uint64_t> chunk = {};  ///< offset in the file of that chunk's record

  BagPlace operator+(std::uint64_t count) const { return {.offset = offset + count, .chunk = chunk}; }
};

class BagError : public std::runtime_error {
 public:
  /// `ends` says that the file or the chunk ends before the end that its own lengths announce.
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
