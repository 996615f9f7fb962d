#pragma once
/// Where this process listens: where ROS_HOSTNAME or ROS_IP say, if that is the loopback.
///
/// roscpp keeps to it with the sockets of topics and services, not with that of its XML-RPC server, which listens on
/// every address. A process that can reach it needs no master: `publisherUpdate` makes a node take commands from any
/// publisher, `shutdown` ends it. So loopback.cpp puts a bind(2) of its own before the C library's, for every socket of
/// a program that calls `bind_as_ros_is_configured`.

namespace robot_control {

/// ROS_HOSTNAME, else ROS_IP, is localhost, 127.… or ::1.
bool listens_on_the_loopback_alone();

/// From now on a socket bound to every address is bound to the loopback, if the above holds at that moment.
void bind_as_ros_is_configured();

}  // namespace robot_control
