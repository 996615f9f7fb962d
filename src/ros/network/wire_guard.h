#pragma once
/// Data that arrive at the ports of this process are checked before roscpp uses them.
///
/// Debian's roscpp (1.15) trusts every length that a peer sends. The following functions are replaced by checked ones,
/// which call the original functions for sound data (wire_guard.cpp, interposition.h):
///
///   ros::Header::parse           the original reads beyond the header if a field names a length that exceeds it:
///                                28 bytes to any port end the process. Here such a header is refused
///   ros::Connection::read        allocates as much as a peer announces, up to 1 GB. Here a header of more than
///                                kMaxHeader or a message of more than max_message() closes the connection
///   ros::TransportUDP::createOutgoing   divides by the datagram size that a subscriber names, less 8. Here sizes that
///                                IPv4 does not have become the default
///   ros::console::get_loggers    the service ~get_loggers. Debian's version, with log4cxx 1.0, frees the loggers, so
///                                that the next log line is a SIGSEGV. Here it only names the loggers of a node
///   XmlRpc::XmlRpcSocket::nbRead reads without a limit. Here a request has at most kMaxXmlRequest bytes, an answer of
///                                the master kMaxXmlAnswer
///   XmlRpc::XmlRpcValue::fromXml recurses as deep as the request is nested. Here at most kMaxValueDepth levels
///   XmlRpc::XmlRpcServerConnection::executeMethod   does not catch what a method throws, such as
///                                InvalidNameException of `paramUpdate`. Here the caller gets a fault
///
/// docs/security.md lists what a peer can still do.

#include <cstddef>
#include <cstdint>
#include <string>

namespace robot_control {

inline constexpr std::uint32_t kMaxHeader = 64U * 1024;              ///< bytes; message definitions have some kB
inline constexpr std::uint32_t kMaxMessage = 1024U * 1024;           ///< bytes; a joint_trajectory may be so long
inline constexpr std::size_t kMaxXmlRequest = std::size_t{1} << 20;  ///< B
inline constexpr std::size_t kMaxXmlAnswer = std::size_t{1}
                                             << 26;  ///< bytes; the parameters contain a robot description
inline constexpr int kMaxValueDepth = 64;            ///< levels of nested arrays and structs

/// Returns a warning that names the guards that the loaded roscpp does not use, with the remedy; "" if it uses all.
std::string unguarded();

/// Returns the longest message that this process takes: kMaxMessage, until a longer one is allowed.
std::uint32_t max_message() noexcept;
void allow_messages_of(std::uint32_t bytes) noexcept;

/// Returns how many connections were closed so far because they announced too much. Any thread may call it.
std::uint64_t overlong_announcements() noexcept;

}  // namespace robot_control
