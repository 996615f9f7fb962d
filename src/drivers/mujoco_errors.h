#pragma once
/// MuJoCo's warnings and errors, kept out of its own hands: by default it appends to MUJOCO_LOG.TXT, prints, and
/// on an error ends the process.
///
/// Here a warning only counts (the step itself goes on, MuJoCo may have reset its state: the plant looks at
/// `mjData::warning` after every step). An error must not return into MuJoCo: inside `run_guarded` it leaves the
/// guarded function by longjmp, outside it throws DriverError with MuJoCo's message.

namespace robot_control {

/// Process-wide; may be called again.
void install_mujoco_handlers();

/// False when MuJoCo raised an error in `function(context)`. The mjData involved is then torn: never step it again.
/// `function` must hold no object with a destructor across a call of MuJoCo. No allocation.
bool run_guarded(void (*function)(void*), void* context) noexcept;

/// The last message of this thread, "" before the first.
const char* last_mujoco_message() noexcept;

}  // namespace robot_control
