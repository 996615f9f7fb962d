#pragma once
/// What arrives at the ports of this process is checked before roscpp trusts it.
///
/// Debian's roscpp (1.15) trusts every length that a peer sends. These functions of it are replaced by checked ones,
/// which call the originals for what is sound (wire_guard.cpp; interposition.h says how that works):
///
///   ros::Header::parse           the original reads beyond the header where a field names a length that exceeds it:
///                                28 bytes to any port end the process. Here such a header is refused
///   ros::Connection::read        allocates what a peer announces, up to 1 GB. Here a header of more than
///                                kMaxHeader or a message of more than kMaxMessage closes the connection
///   ros::TransportUDP::createOutgoing   divides by the datagram size that a subscriber names, less 8. Here sizes that
///                                IPv4 does not have become the default
///   ros::console::get_loggers    the service ~get_loggers. Debian's, against log4cxx 1.0, frees the loggers: the next
///                                line that is logged is a SIGSEGV. Here it names the loggers of a node and touches
///                                none
///   XmlRpc::XmlRpcSocket::nbRead reads without an end. Here a request has at most kMaxXmlRequest bytes, an answer of
///                                the master kMaxXmlAnswer
///   XmlRpc::XmlRpcValue::fromXml recurses as deep as the request is nested. Here at most kMaxValueDepth levels
///   XmlRpc::XmlRpcServerConnection::executeMethod   lets pass what a method throws, as InvalidNameException of
///                                `paramUpdate`, and nothing catches it. Here the caller gets a fault
///
/// What remains possible for a peer stands in docs/safety.md.

#include <cstddef>
#include <cstdint>
#include <string>

namespace robot_control {

inline constexpr std::uint32_t kMaxHeader = 64U * 1024;              ///< B; message definitions have some kB
inline constexpr std::uint32_t kMaxMessage = 1024U * 1024;           ///< B; the longest message in has 320
inline constexpr std::size_t kMaxXmlRequest = std::size_t{1} << 20;  ///< B
inline constexpr std::size_t kMaxXmlAnswer = std::size_t{1} << 26;   ///< B; parameters with a robot description in it
inline constexpr int kMaxValueDepth = 64;                            ///< arrays and structs within each other

/// What of these guards the loaded roscpp does not use, with the remedy; empty: it uses all.
std::string unguarded();

/// Connections that were closed because they announced too much, so far. Any thread.
std::uint64_t overlong_announcements() noexcept;

}  // namespace robot_control
