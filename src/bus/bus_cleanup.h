#pragma once
/// The shared memory of buses whose processes have all ended: some 14 MB each, which nothing else would remove.
///
/// The objects of a bus are removed when
///   · they are this user's, plain and private,
///   · this process holds the writer's lock of every one of them, so that no writer lives, and
///   · the last permit has no latched cause. A permit that cannot be read counts as latched: its bus stays until
///     its own next start.
/// The command channel stays if motion was requested at its last frame. The next start reads it and revokes the senders
/// that are present (ros/inputs/motion_requests.h).
///
/// A node that starts on that bus at the same moment waits for those locks (bus_object.cpp) and finds the names gone.
/// If it already holds a lock, the bus stays. Names of a bus that appear meanwhile are not touched.

#include <string>
#include <vector>

namespace robot_control {

/// Removes every ended bus but `own`. Returns the names of the buses of which it removed an object. A failure is not
/// reported, because the node that calls does not depend on it.
std::vector<std::string> remove_ended_buses(const std::string& own);

}  // namespace robot_control
