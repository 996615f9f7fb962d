#pragma once
/// Service data objects: the client reads (upload) or writes (download) one entry of a node's object dictionary.
///
/// Values of 1 … 4 bytes go expedited, in the first frame of a transfer. Longer ones follow in segments of 7 bytes,
/// whose toggle bit begins with 0 and changes with each segment. Each request is answered once, or aborted by either
/// side with a code. A frame has 8 bytes:
///
///   request                     first byte           response                first byte
///   download                    001 0 nn e s         download                011 00000
///   download segment            000 t nnn c          download segment        001 t 0000
///   upload                      010 00000            upload                  010 0 nn e s
///   upload segment              011 t 0000           upload segment          000 t nnn c
///   abort                       100 00000            abort                   100 00000
///
/// n is the number of bytes without data, e expedited, s size indicated, t toggle, c last segment. Bytes 1 … 3 hold the
/// object, and bytes 4 … 7 the data, the size or the code of the abort, except in segments.
/// Source: CiA 301, 7.2.4.3.

#include <array>
#include <cstdint>
#include <optional>

#include "drivers/cia402/canopen.h"

namespace robot_control::canopen {

enum class SdoSide : std::uint8_t { kRequest, kResponse };

enum class SdoCommand : std::uint8_t { kDownload, kDownloadSegment, kUpload, kUploadSegment, kAbort };

struct SdoMessage {
  SdoCommand command = SdoCommand::kUpload;
  ObjectAddress object{};        ///< not in segments
  bool expedited = false;        ///< The value is in this frame.
  bool toggle = false;           ///< of a segment
  bool last = false;             ///< No segment follows.
  std::uint32_t size = 0;        ///< bytes of a value that follows in segments; 0: not indicated
  std::uint32_t abort_code = 0;  ///< of an abort
  std::uint8_t length = 0;       ///< bytes of `data`
  std::array<std::uint8_t, 7> data{};

  bool operator==(const SdoMessage&) const = default;
};

/// Only the fields of this command are sent; `length` is at least 1 and at most 4 in an expedited message, at most 7 in
/// a segment.
can_frame encode_sdo(SdoSide side, std::uint8_t node, const SdoMessage& message) noexcept;

/// Returns nothing if the frame is not of this side and node, has not 8 bytes, or its first byte is not in the table.
/// Reserved bits and bytes without data are ignored.
std::optional<SdoMessage> decode_sdo(SdoSide side, std::uint8_t node, const can_frame& frame) noexcept;

/// The request to write the lowest `bytes` (1, 2 or 4) bytes of `value`.
SdoMessage expedited_download(const ObjectAddress& object, std::uint32_t value, std::uint8_t bytes) noexcept;

/// The data of an expedited message as a number, little-endian.
std::uint32_t expedited_value(const SdoMessage& message) noexcept;

/// Returns the code of an abort in words. Source: CiA 301, table 22.
const char* abort_words(std::uint32_t code) noexcept;

}  // namespace robot_control::canopen
