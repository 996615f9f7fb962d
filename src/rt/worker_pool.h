#pragma once
/// A WorkerPool spreads calls of a function over ordinary threads, which are started once.
///
/// The calling thread works, too. Threads take the next number when they are done with one, so that unequal calls leave
/// no thread idle. A process that was forked has no other thread: then the calling thread makes all calls.

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace robot_control {

class WorkerPool {
 public:
  using Work = std::function<void(std::size_t)>;

  /// `threads` includes the calling thread. Throws std::invalid_argument for 0.
  explicit WorkerPool(std::size_t threads);
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;
  ~WorkerPool();

  /// Calls work(0) … work(count − 1), each once, in any order, and returns after the last one has ended. Then it throws
  /// the first exception that a call threw. One thread at a time calls it.
  void for_each(std::size_t count, const Work& work);

  std::size_t threads() const noexcept { return helpers_.size() + 1; }

 private:
  void help();
  void make_calls() noexcept;

  std::mutex mutex_;
  std::condition_variable begun_, idle_;
  const Work* work_ = nullptr;
  std::size_t count_ = 0;
  std::atomic<std::size_t> next_{0};
  std::size_t active_ = 0;   ///< helpers that may call `work_`
  std::uint64_t round_ = 0;  ///< calls of for_each
  bool ends_ = false;
  std::exception_ptr problem_;
  std::vector<std::thread> helpers_;
};

}  // namespace robot_control
