#include "ros/network/wire_guard.h"

#include <netinet/in.h>
#include <ros/connection.h>
#include <ros/console.h>
#include <ros/header.h>
#include <ros/transport/transport_udp.h>
#include <ros/xmlrpc_manager.h>
#include <sys/socket.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpcException.h>
#include <xmlrpcpp/XmlRpcServerConnection.h>
#include <xmlrpcpp/XmlRpcSocket.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <exception>
#include <map>
#include <mutex>
#include <string_view>

#include "ros/network/interposition.h"
#include "ros/network/publisher_uri.h"
#include "ros/reports/name_list.h"

namespace robot_control {
namespace {

constexpr int kMinDatagram = 64;      // bytes; the data follow a UDPROS header of 8 bytes
constexpr int kMaxDatagram = 65'507;  // bytes; IPv4's 65,535 minus both headers
constexpr int kDefaultDatagram = 1500;

constexpr const char* kParseShared =
    "_ZN3ros6Header5parseERKN5boost12shared_arrayIhEEjRNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEE";
constexpr const char* kRead =
    "_ZN3ros10Connection4readEjRKN5boost8functionIFvRKNS1_10shared_ptrIS0_EERKNS1_12shared_arrayIhEEjbEEE";
constexpr const char* kCreateOutgoing =
    "_ZN3ros12TransportUDP14createOutgoingENSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEEiii";
constexpr const char* kGetLoggers =
    "_ZN3ros7console11get_loggersERSt3mapINSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEENS0_"
    "6levels5LevelESt4lessI"
    "S7_ESaISt4pairIKS7_S9_EEE";
constexpr const char* kNbRead =
    "_ZN6XmlRpc12XmlRpcSocket6nbReadEiRNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEEPb";
constexpr const char* kFromXml =
    "_ZN6XmlRpc11XmlRpcValue7fromXmlERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEEPi";

constexpr const char* kExecuteMethod =
    "_ZN6XmlRpc22XmlRpcServerConnection13executeMethodERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEERNS_"
    "11XmlRpcValueESA_";

std::atomic<std::uint64_t> overlong{0};
std::atomic<std::uint32_t> longest{kMaxMessage};

/// Returns whether the XML-RPC server of this process accepted the socket, so that a request comes over it.
bool is_request(int socket) {
  sockaddr_storage address{};
  socklen_t length = sizeof address;
  if (getsockname(socket, reinterpret_cast<sockaddr*>(&address), &length) != 0) return true;
  std::uint16_t port = 0;  // both families have the port at the same offset
  static_assert(offsetof(sockaddr_in, sin_port) == offsetof(sockaddr_in6, sin6_port));
  std::memcpy(&port, reinterpret_cast<const char*>(&address) + offsetof(sockaddr_in, sin_port), sizeof port);
  return ntohs(port) == ros::XMLRPCManager::instance()->getServerPort();
}

bool parse(ros::M_string& values, std::string_view rest, std::string& problem) {
  while (!rest.empty()) {
    std::uint32_t length = 0;
    if (rest.size() < sizeof length) {
      problem = "a connection header ends within the length of a field";
      return false;
    }
    std::memcpy(&length, rest.data(), sizeof length);
    rest.remove_prefix(sizeof length);
    if (length > rest.size()) {
      problem = "a field of a connection header exceeds the header";
      return false;
    }
    const std::string_view field = rest.substr(0, length);
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) {
      problem = "a field of a connection header has no '='";
      return false;
    }
    values[std::string(field.substr(0, equals))] = field.substr(equals + 1);
    rest.remove_prefix(length);
  }
  return true;
}

/// A LoggerProbe has one location per level of a logger. rosconsole keeps the address of each until the process ends.
struct LoggerProbe {
  std::string name;
  std::array<ros::console::LogLocation, ros::console::levels::Count> levels;
};

ros::console::Level level_of(LoggerProbe& probe) {
  for (int i = 0; i < ros::console::levels::Count; ++i) {
    ros::console::LogLocation& location = probe.levels.at(static_cast<std::size_t>(i));
    const auto level = static_cast<ros::console::Level>(i);
    if (!location.initialized_) ros::console::initializeLogLocation(&location, probe.name, level);
    ros::console::checkLogLocationEnabled(&location);
    if (location.logger_enabled_) return level;
  }
  return ros::console::levels::Fatal;
}

}  // namespace

std::string unguarded() {
  const std::string roscpp = "libroscpp.so";
  const std::string xmlrpcpp = "libxmlrpcpp.so";
  const std::string text = joined(not_replaced({
      {roscpp, kParseShared, "connection headers"},
      {roscpp, kRead, "announced lengths"},
      {roscpp, kCreateOutgoing, "datagram sizes"},
      {roscpp, kGetLoggers, "get_loggers"},
      {xmlrpcpp, kNbRead, "lengths of XML-RPC requests"},
      {xmlrpcpp, kFromXml, "nesting of XML-RPC requests"},
      {xmlrpcpp, kExecuteMethod, "what an XML-RPC method throws"},
      {roscpp, kSetHeader, "publishers' addresses"},
      {roscpp, "accept", "accepted connections"},
      {xmlrpcpp, "accept", "accepted XML-RPC connections"},
      {roscpp, "socket", "outgoing connections"},
      {xmlrpcpp, "socket", "outgoing XML-RPC connections"},
  }));
  if (text.empty()) return "";
  return "the loaded roscpp does not use this program's checks of " + text +
         ": a malformed connection may end this node, and a restarted sender may have to send a zero first. "
         "Remedy: build robot_control against the roscpp that is loaded "
         "here (Debian's libroscpp-dev; LD_LIBRARY_PATH and LD_PRELOAD must not name another one), and protect "
         "its ports from other computers (docs/security.md)";
}

std::uint32_t max_message() noexcept {
  return longest.load();
}

void allow_messages_of(std::uint32_t bytes) noexcept {
  longest.store(bytes);
}

std::uint64_t overlong_announcements() noexcept {
  return overlong.load();
}

}  // namespace robot_control

namespace ros {

bool Header::parse(const boost::shared_array<std::uint8_t>& buffer, std::uint32_t size, std::string& error_msg) {
  return parse(buffer.get(), size, error_msg);
}

bool Header::parse(std::uint8_t* buffer, std::uint32_t size, std::string& error_msg) {
  return robot_control::parse(*read_map_, {reinterpret_cast<const char*>(buffer), size}, error_msg);
}

void Connection::read(std::uint32_t size, const ReadFinishedFunc& callback) {
  using namespace robot_control;
  static const auto original_read = original<decltype(&Connection::read)>(kRead);
  const bool before_header = header_.getValues()->empty();
  if (size > (before_header ? kMaxHeader : max_message())) {
    overlong.fetch_add(1);
    return drop(TransportDisconnect);
  }
  (this->*original_read)(size, callback);
}

bool console::get_loggers(std::map<std::string, levels::Level>& loggers) {
  static std::mutex mutex;
  static std::array<robot_control::LoggerProbe, 3> probes{{{.name = ROSCONSOLE_ROOT_LOGGER_NAME, .levels = {}},
                                                           {.name = ROSCONSOLE_DEFAULT_NAME, .levels = {}},
                                                           {.name = "ros.roscpp", .levels = {}}}};
  const std::lock_guard lock(mutex);
  for (robot_control::LoggerProbe& probe : probes) loggers[probe.name] = robot_control::level_of(probe);
  return true;
}

TransportUDPPtr TransportUDP::createOutgoing(std::string host, int port, int conn_id, int max_datagram_size) {
  using namespace robot_control;
  static const auto original_create = original<decltype(&TransportUDP::createOutgoing)>(kCreateOutgoing);
  const bool possible = max_datagram_size >= kMinDatagram && max_datagram_size <= kMaxDatagram;
  return (this->*original_create)(std::move(host), port, conn_id, possible ? max_datagram_size : kDefaultDatagram);
}

}  // namespace ros

namespace XmlRpc {

bool XmlRpcSocket::nbRead(int socket, std::string& s, bool* eof) {
  using namespace robot_control;
  const std::size_t max_size = is_request(socket) ? kMaxXmlRequest : kMaxXmlAnswer;
  std::array<char, 4096> buffer{};
  *eof = false;
  while (s.size() <= max_size) {
    const ssize_t count = ::read(socket, buffer.data(), buffer.size());
    if (count < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR || errno == EINPROGRESS;
    if (count == 0) {
      *eof = true;
      return true;
    }
    s.append(buffer.data(), static_cast<std::size_t>(count));
  }
  return false;
}

bool XmlRpcValue::fromXml(const std::string& value_xml, int* offset) {
  using namespace robot_control;
  static const auto original_from = original<decltype(&XmlRpcValue::fromXml)>(kFromXml);
  thread_local int depth = 0;
  struct Level {
    Level() { ++depth; }
    ~Level() { --depth; }
  } const level;
  return depth <= kMaxValueDepth && (this->*original_from)(value_xml, offset);
}

bool XmlRpcServerConnection::executeMethod(const std::string& name, XmlRpcValue& params, XmlRpcValue& result) {
  using namespace robot_control;
  static const auto original_execute = original<decltype(&XmlRpcServerConnection::executeMethod)>(kExecuteMethod);
  try {
    return (this->*original_execute)(name, params, result);
  } catch (const std::exception& error) {
    throw XmlRpcException(error.what());
  }
}

}  // namespace XmlRpc
