#include "rt/worker_pool.h"

#include <stdexcept>
#include <utility>

namespace robot_control {

WorkerPool::WorkerPool(std::size_t threads) {
  if (threads == 0) throw std::invalid_argument("threads is 0, must be at least 1");
  while (helpers_.size() + 1 < threads) helpers_.emplace_back(&WorkerPool::help, this);
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  begun_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void WorkerPool::for_each(std::size_t count, const Work& work) {
  std::unique_lock lock(mutex_);
  idle_.wait(lock, [&] { return active_ == 0; });  // a helper that woke too late for the last round
  work_ = &work;
  count_ = count;
  next_.store(0, std::memory_order_relaxed);
  ++round_;
  lock.unlock();
  begun_.notify_all();
  make_calls();
  lock.lock();
  idle_.wait(lock, [&] { return active_ == 0; });
  if (problem_ != nullptr) std::rethrow_exception(std::exchange(problem_, nullptr));
}

void WorkerPool::help() {
  std::uint64_t seen = 0;
  std::unique_lock lock(mutex_);
  while (true) {
    begun_.wait(lock, [&] { return ends_ || round_ != seen; });
    if (ends_) return;
    seen = round_;
    ++active_;
    lock.unlock();
    make_calls();
    lock.lock();
    if (--active_ == 0) idle_.notify_all();
  }
}

void WorkerPool::make_calls() noexcept {
  for (std::size_t i = next_++; i < count_; i = next_++) {
    try {
      (*work_)(i);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (problem_ == nullptr) problem_ = std::current_exception();
    }
  }
}

}  // namespace robot_control
