#pragma once
/// A bus of this test's own, named after the process; its objects are removed at the end.

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <string>
#include <system_error>

namespace robot_control {

class ScopedBus {
 public:
  ScopedBus() : owner_(getpid()), name_("test-" + std::to_string(owner_) + "-" + std::to_string(next_++)) {}
  ScopedBus(const ScopedBus&) = delete;
  ScopedBus& operator=(const ScopedBus&) = delete;
  ~ScopedBus() {
    if (getpid() == owner_) remove_objects();
  }

  const std::string& name() const noexcept { return name_; }

 private:
  void remove_objects() const noexcept {
    const std::string prefix = "robot_control." + std::to_string(geteuid()) + "." + name_ + ".";
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator("/dev/shm", ignored)) {
      if (entry.path().filename().string().starts_with(prefix)) std::filesystem::remove(entry.path(), ignored);
    }
  }

  static inline std::atomic<int> next_{0};
  pid_t owner_;
  std::string name_;
};

}  // namespace robot_control
