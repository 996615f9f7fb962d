#pragma once
/// An SdoClient reads and writes entries of 1 … 4 bytes of one node's object dictionary, one at a time.

#include <cstdint>

#include "drivers/cia402/pdo.h"
#include "drivers/cia402/sdo.h"
#include "drivers/drive/drive.h"

namespace robot_control::canopen {

class SdoClient {
 public:
  static constexpr std::int64_t kTimeoutNs = 50'000'000;  ///< then the request is repeated
  static constexpr unsigned kTries = 5;

  enum class Result : std::uint8_t { kIdle, kPending, kDone, kAborted, kNoAnswer };

  explicit SdoClient(std::uint8_t node) noexcept : node_(node) {}

  void read(const ObjectAddress& object) noexcept { begin({.command = SdoCommand::kUpload, .object = object}); }
  void write(const SdoWrite& write) noexcept { begin(expedited_download(write.object, write.value, write.bytes)); }
  void cancel() noexcept { result_ = Result::kIdle; }

  void receive(const can_frame& frame) noexcept;
  /// Adds the request, if one is pending and was not sent or not answered in time.
  void step(std::int64_t now_ns, FrameBatch& send) noexcept;

  std::uint8_t node() const noexcept { return node_; }
  Result result() const noexcept { return result_; }
  std::uint32_t value() const noexcept { return value_; }            ///< of a read that is done
  std::uint32_t abort_code() const noexcept { return abort_code_; }  ///< of an aborted request

 private:
  void begin(const SdoMessage& request) noexcept;

  std::uint8_t node_;
  SdoMessage request_;
  Result result_ = Result::kIdle;
  unsigned tries_ = 0;
  std::int64_t sent_ns_ = 0;
  std::uint32_t value_ = 0;
  std::uint32_t abort_code_ = 0;
};

}  // namespace robot_control::canopen
