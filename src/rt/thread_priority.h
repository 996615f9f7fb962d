#pragma once
/// This function is for an ordinary thread that must not wait for other programs, but is no part of the loop.

namespace robot_control {

/// Gives the calling thread the lowest priority of SCHED_FIFO: before all ordinary threads of the machine, after every
/// RealtimeThread. Threads that it starts are ordinary. Returns false and changes nothing if that is not granted
/// (docs/realtime.md).
bool precede_ordinary_threads() noexcept;

}  // namespace robot_control
