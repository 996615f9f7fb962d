#pragma once
/// A function with a stack of its own, run in slices: `resume` runs it up to its next `pause` or its end.

#include <ucontext.h>

#include <cstddef>
#include <functional>
#include <vector>

namespace robot_control::model {

class Fiber {
 public:
  Fiber() : stack_(kStackBytes) {}
  Fiber(const Fiber&) = delete;
  Fiber& operator=(const Fiber&) = delete;

  /// Starts the function with the first `resume`. An earlier function has ended.
  void start(std::function<void()> body) {
    body_ = std::move(body);
    ended_ = false;
    getcontext(&inside_);
    inside_.uc_stack.ss_sp = stack_.data();
    inside_.uc_stack.ss_size = stack_.size();
    inside_.uc_link = &outside_;
    entered_ = this;
    makecontext(&inside_, &Fiber::enter, 0);
  }

  void resume() {
    entered_ = this;
    swapcontext(&outside_, &inside_);
  }

  /// The function itself calls it.
  void pause() { swapcontext(&inside_, &outside_); }

  bool ended() const noexcept { return ended_; }

 private:
  static constexpr std::size_t kStackBytes = 256 * 1024;

  static void enter() {
    Fiber& self = *entered_;
    self.body_();
    self.ended_ = true;
  }

  static inline Fiber* entered_ = nullptr;

  std::vector<char> stack_;
  std::function<void()> body_;
  ucontext_t inside_{};
  ucontext_t outside_{};
  bool ended_ = true;
};

}  // namespace robot_control::model
