#pragma once
/// A DdsNetwork is one end of the topics rt/lowcmd and rt/lowstate, by CycloneDDS. A thread of that library calls
/// `on_message`.
///
/// Types are made without type information, because CycloneDDS 0.10 ends with a memory fault when a participant of
/// version 11 announces such a type.

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace robot_control::unitree::go {

class DdsError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// kController takes states and sends commands; kRobot takes commands and sends states.
enum class DdsSide : std::uint8_t { kController, kRobot };

class DdsNetwork {
 public:
  /// `writer` is a number of the DDS writer, which no other writer has meanwhile.
  using Receiver = std::function<void(std::span<std::uint8_t> bytes, std::uint64_t writer)>;

  /// All sockets belong to this network interface. Throws DdsError.
  DdsNetwork(DdsSide side, const std::string& interface, std::uint32_t domain, Receiver on_message);
  DdsNetwork(const DdsNetwork&) = delete;
  DdsNetwork& operator=(const DdsNetwork&) = delete;
  ~DdsNetwork();

  /// Sends the bytes of a whole message, the bytes between its members 0. Returns false if DDS refuses it.
  bool send(std::span<const std::uint8_t> bytes) noexcept;

  // The following are of the controller's side alone.

  /// Returns the number of writers of rt/lowcmd in other processes.
  std::size_t other_writers() const noexcept;
  /// Returns whether one of them sent a command since the last call.
  bool others_sent() noexcept;

  /// Sends a request to the motion service.
  void request(std::int64_t id, std::int64_t api) noexcept;
  /// Takes what the motion service answered.
  void take_answers(
      const std::function<void(std::int64_t id, std::int64_t api, std::int32_t code, std::string_view data)>& take);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace robot_control::unitree::go
