#pragma once
/// These functions handle MuJoCo's warnings and errors. By default MuJoCo appends them to MUJOCO_LOG.TXT, prints them,
/// and ends the process on an error.
///
/// Here a warning is only counted. The step continues, and MuJoCo may have reset its state, so the plant checks
/// `mjData::warning` after every step. An error must not return into MuJoCo: inside `run_guarded` it leaves the guarded
/// function by longjmp, outside it throws DriverError with MuJoCo's message.

namespace robot_control {

/// Installs the handlers for the process; may be called repeatedly.
void install_mujoco_handlers();

/// Calls `function(context)`. Returns false if MuJoCo raised an error; the mjData is then inconsistent and must never
/// be stepped again. `function` must hold no object with a destructor during a call of MuJoCo. It does not allocate.
bool run_guarded(void (*function)(void*), void* context) noexcept;

/// Returns the last message of this thread; "" before the first.
const char* last_mujoco_message() noexcept;

}  // namespace robot_control
