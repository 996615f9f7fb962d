#pragma once
/// All sockets of this process listen on the loopback alone if ROS_HOSTNAME or ROS_IP name the loopback.
///
/// roscpp follows this for the sockets of topics and services, but its XML-RPC server listens on every address. A
/// process that reaches this server needs no master: `publisherUpdate` makes a node accept commands from any publisher,
/// `shutdown` ends the node. So loopback.cpp replaces the C library's bind(2) for every socket of a program that calls
/// `bind_as_ros_is_configured`.

namespace robot_control {

/// Returns whether ROS_HOSTNAME, or ROS_IP if that is not set, is localhost, 127.… or ::1.
bool listens_on_the_loopback_alone();

/// After this call a socket that would be bound to every address is bound to the loopback, if
/// `listens_on_the_loopback_alone` holds at that moment.
void bind_as_ros_is_configured();

}  // namespace robot_control
