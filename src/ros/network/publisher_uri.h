#pragma once
/// publisher_uri identifies the process at the other end of a subscription's connection.
///
/// A connection header names the publisher's node, and a restarted node has the same name. The master gives roscpp the
/// address of the node's XML-RPC server, but roscpp does not pass it on. Here ros::PublisherLink::setHeader is replaced
/// (interposition.h), so that the address is added to the header.

#include <ros/datatypes.h>

#include <string>

namespace robot_control {

/// The mangled name of ros::PublisherLink::setHeader.
inline constexpr const char* kSetHeader = "_ZN3ros13PublisherLink9setHeaderERKNS_6HeaderE";

/// Returns the address in a connection header that roscpp keeps; "" if the loaded roscpp does not use the replacement.
std::string publisher_uri(const ros::M_string& header);

}  // namespace robot_control
