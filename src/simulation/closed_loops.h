#pragma once
/// ClosedLoops runs many closed loops in threads of its own, for learning and planning.
///
/// A loop shares nothing that changes with another one, and one thread runs all its cycles of a step. So the bits of
/// loop i are those of a ClosedLoop with the same parameters, seed and calls, whatever the number of threads.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "configuration/parameters.h"
#include "log/fields/trace_fields.h"
#include "rt/worker_pool.h"
#include "simulation/closed_loop.h"

namespace robot_control {

class ClosedLoops {
 public:
  /// Makes one loop per seed, as ClosedLoop does. `threads` includes the calling thread. Throws as ClosedLoop, and
  /// std::invalid_argument without a seed or thread.
  ClosedLoops(const Parameters& parameters, std::span<const std::uint64_t> seeds, std::size_t threads);

  /// Copies the loops `which` of `other`. A loop may be named more than once. Throws as the copy of a ClosedLoop.
  ClosedLoops(const ClosedLoops& other, std::span<const std::size_t> which, std::size_t threads);

  /// Makes loop `which[i]` again with the seed `seeds[i]`.
  void reset(std::span<const std::size_t> which, std::span<const std::uint64_t> seeds);

  /// Runs `cycles` cycles of each loop. Loop i first receives `commands[i]` as a message on cmd_vel; a value that is
  /// not finite sends nothing. No commands: nothing is received. Afterwards row i of `out` has the values of `columns`
  /// in the last cycle. No cycles: the message arrives in the next one.
  void step(std::uint64_t cycles, std::span<const Twist> commands, std::span<const TraceColumn> columns,
            std::span<double> out);

  std::size_t size() const noexcept { return loops_.size(); }
  std::size_t threads() const noexcept { return pool_.threads(); }

  /// Shares loop `i`, which must not be used during a call of this class. `reset` replaces it.
  const std::shared_ptr<ClosedLoop>& loop(std::size_t i) const { return loops_.at(i); }

 private:
  std::shared_ptr<ClosedLoop> made(std::uint64_t seed) const;

  Parameters parameters_;
  std::shared_ptr<const Robot> robot_;
  WorkerPool pool_;
  std::vector<std::shared_ptr<ClosedLoop>> loops_;
};

}  // namespace robot_control
