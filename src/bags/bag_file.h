#pragma once
/// The bytes of a bag, read with pread: a file that another program shortens meanwhile ends in a message, whereas a
/// mapping of it would end the process.

#include <cstdint>
#include <string>
#include <string_view>

namespace robot_control {

inline constexpr std::uint64_t kMaxBag = std::uint64_t{16} << 30U;  ///< bytes; an hour of trace has 2.5 GB

class BagFile {
 public:
  /// Throws std::runtime_error: no regular file that can be read, or larger than kMaxBag.
  explicit BagFile(const std::string& path);
  ~BagFile();
  BagFile(const BagFile&) = delete;
  BagFile& operator=(const BagFile&) = delete;

  std::uint64_t size() const { return size_; }

  /// `count` bytes from `offset`, valid until the next call. Throws BagError for `field` where the file ends before.
  std::string_view read(std::uint64_t offset, std::size_t count, const std::string& field);

 private:
  std::size_t fill(std::uint64_t offset, std::size_t count);

  int descriptor_;
  std::uint64_t size_ = 0;
  std::uint64_t begin_ = 0;  // in the file, of what is in `window_`
  std::string window_;
};

}  // namespace robot_control
