#include "rt/wait_count.h"

namespace robot_control {
namespace {

thread_local std::atomic<std::uint64_t>* waits_of_thread = nullptr;

}  // namespace

void count_waits_in(std::atomic<std::uint64_t>* counter) noexcept {
  waits_of_thread = counter;
}

void count_wait() noexcept {
  if (waits_of_thread == nullptr) return;
  waits_of_thread->store(waits_of_thread->load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

}  // namespace robot_control
