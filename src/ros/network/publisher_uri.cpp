#include "ros/network/publisher_uri.h"

#include <ros/header.h>
#include <ros/publisher_link.h>

#include "ros/network/interposition.h"

namespace robot_control {
namespace {

constexpr const char* kPublisherUri = "publisher_uri";

}  // namespace

std::string publisher_uri(const ros::M_string& header) {
  const auto field = header.find(kPublisherUri);
  return field == header.end() ? "" : field->second;
}

}  // namespace robot_control

namespace ros {

/// Adds the address to the header. It overwrites a field of this name from the peer.
bool PublisherLink::setHeader(const Header& header) {
  using namespace robot_control;
  static const auto original_set = original<decltype(&PublisherLink::setHeader)>(kSetHeader);
  Header complete = header;  // both share their fields
  (*complete.getValues())[kPublisherUri] = publisher_xmlrpc_uri_;
  return (this->*original_set)(complete);
}

}  // namespace ros
