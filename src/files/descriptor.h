#pragma once
/// A file descriptor has one owner, which closes it.

#include <sys/types.h>
#include <unistd.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace robot_control {

class Descriptor {
 public:
  explicit Descriptor(int number = -1) noexcept : number_(number) {}  ///< below 0: none
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() { close(); }

  int number() const noexcept { return number_; }
  bool open() const noexcept { return number_ >= 0; }

  /// The result is that of close(2); 0 if nothing is open.
  int close() noexcept { return open() ? ::close(std::exchange(number_, -1)) : 0; }

  /// Writes all bytes, at `at` or where the descriptor stands. The result is 0, or the error as errno.
  int write(std::string_view bytes, std::optional<off_t> at = std::nullopt) const noexcept;

  /// The result is 0 if the open file is at `path`, else the reason as errno.
  int absence_from(const std::string& path) const noexcept;

 private:
  int number_;
};

}  // namespace robot_control
