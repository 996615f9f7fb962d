#pragma once
/// A CanSocket is the end of a CAN bus in this process. Opening it may block and allocate; it is closed with this
/// value.
///
///   can0          the interface of this name: SocketCAN, raw frames, with time stamps and error frames; frames of CAN
///                 FD on request
///   unix:FOLDER   a broadcast medium for machines without CAN. Each party binds a datagram socket to the first free
///                 name of FOLDER/0 … FOLDER/15 and sends to all others. A datagram holds 1 … kMaxFramesPerDatagram
///                 frames. The medium has neither a bit rate nor arbitration.
///
/// FOLDER is made with mode 0700 if it is missing. It is refused if it belongs to another user or if other users may
/// write to it. Names that an ended process left are removed; a lock on the folder keeps two starts apart.

#include <linux/can.h>
#include <sys/un.h>

#include <span>
#include <string>
#include <vector>

#include "files/descriptor.h"

namespace robot_control {

inline constexpr unsigned kMaxParties = 16;
inline constexpr unsigned kMaxFramesPerDatagram = 16;

class CanSocket {
 public:
  /// Throws DriverError, which names the address, the reason and the remedy. Frames that pass none of the filters are
  /// not received; an empty list passes all. With `fd` the interface must carry frames of CAN FD.
  static CanSocket open(const std::string& address, std::span<const can_filter> filters = {}, bool fd = false);

  /// Takes over a datagram socket each of whose messages is one frame.
  explicit CanSocket(int descriptor, std::span<const can_filter> filters = {});

  /// Takes over one end of a line within this process: a socket pair whose datagrams hold 1 … kMaxFramesPerDatagram
  /// frames, without time stamps.
  static CanSocket line_end(int descriptor);

  CanSocket(CanSocket&&) noexcept = default;
  CanSocket& operator=(CanSocket&&) = delete;
  ~CanSocket();

  int descriptor() const noexcept { return descriptor_.number(); }

  /// Returns the addresses of all parties of a folder, whether they are there or not; none elsewhere.
  std::span<sockaddr_un> parties() noexcept { return parties_; }

  /// Returns the number of this party in its folder.
  unsigned own_party() const noexcept { return own_party_; }

  /// Returns whether one datagram for the other end may hold several frames.
  bool is_line() const noexcept { return is_line_; }

  /// Returns whether a filter passes the identifier.
  bool passes(canid_t id) const noexcept;

 private:
  void open_interface(const std::string& name, bool fd);
  void open_folder(const std::string& folder);
  void bind_first_free_name();
  void request_time_stamps() const noexcept;

  Descriptor descriptor_;
  std::vector<can_filter> filters_;
  std::vector<sockaddr_un> parties_;
  unsigned own_party_ = 0;
  bool is_line_ = false;
};

}  // namespace robot_control
