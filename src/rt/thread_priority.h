#pragma once
/// For an ordinary thread that shall not wait for other programs, but has no part in the loop.

namespace robot_control {

/// The calling thread comes before all ordinary threads of the machine and after every RealtimeThread: SCHED_FIFO at
/// its lowest priority. Threads that it makes are ordinary. False: that is not granted (docs/troubleshooting.md), it
/// stays as it was.
bool precede_ordinary_threads() noexcept;

}  // namespace robot_control
