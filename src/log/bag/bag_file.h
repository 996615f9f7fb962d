#pragma once
/// A BagFile reads the bytes of a bag with pread. If another program shortens the file meanwhile, an error is reported;
/// with a mapping of the file the process would end.

#include <cstdint>
#include <string>
#include <string_view>

#include "files/descriptor.h"

namespace robot_control {

inline constexpr std::uint64_t kMaxBag = std::uint64_t{16} << 30U;  ///< bytes; an hour of trace has 2.5 GB

class BagFile {
 public:
  /// Throws std::runtime_error if the path is no regular file, cannot be read or is larger than kMaxBag.
  explicit BagFile(const std::string& path);

  std::uint64_t size() const { return size_; }

  /// Returns `count` bytes from `offset`, valid until the next call. Throws BagError for `field` if the file ends
  /// before.
  std::string_view read(std::uint64_t offset, std::size_t count, const std::string& field);

 private:
  std::size_t fill(std::uint64_t offset, std::size_t count);

  Descriptor file_;
  std::uint64_t size_ = 0;
  std::uint64_t begin_ = 0;  // offset of `window_` in the file
  std::string window_;
};

}  // namespace robot_control
