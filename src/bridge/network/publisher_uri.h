#pragma once
/// Which process is at the other end of a subscription's connection?
///
/// A connection header names the publisher's node, and a node that was restarted has the same name. roscpp knows the
/// address of the node's XML-RPC server as well, from the master, and does not pass it on. Here it joins the header:
/// ros::PublisherLink::setHeader is replaced (interposition.h).

#include <ros/datatypes.h>

#include <string>

namespace robot_control {

/// Of ros::PublisherLink::setHeader, mangled.
inline constexpr const char* kSetHeader = "_ZN3ros13PublisherLink9setHeaderERKNS_6HeaderE";

/// From a connection header that roscpp keeps; empty where the loaded roscpp does not use the replacement.
std::string publisher_uri(const ros::M_string& header);

}  // namespace robot_control
