#include "drivers/cia402/object_dictionary.h"

#include "drivers/line/wire_layout.h"

namespace robot_control {

using canopen::ObjectAddress;
using canopen::SdoCommand;
using canopen::SdoMessage;

std::uint32_t ObjectDictionary::value(const ObjectAddress& object) const {
  const auto found = entries_.find(key(object));
  return found == entries_.end() ? 0 : found->second.value;
}

std::int32_t ObjectDictionary::signed_value(const ObjectAddress& object) const {
  const auto found = entries_.find(key(object));
  if (found == entries_.end()) return 0;
  return static_cast<std::int32_t>(sign_extended(found->second.value, 8U * found->second.bytes));
}

void ObjectDictionary::set(const ObjectAddress& object, std::uint32_t value) {
  const auto found = entries_.find(key(object));
  if (found != entries_.end()) {
    found->second.value = value & static_cast<std::uint32_t>(low_bits(8U * found->second.bytes));
  }
}

SdoMessage ObjectDictionary::answer(const SdoMessage& request, std::uint32_t refusal) {
  const auto abort = [&](std::uint32_t code) {
    return SdoMessage{.command = SdoCommand::kAbort, .object = request.object, .abort_code = code};
  };
  const bool reads = request.command == SdoCommand::kUpload;
  if (!reads && !(request.command == SdoCommand::kDownload && request.expedited)) return abort(0x0504'0001);
  const auto found = entries_.find(key(request.object));
  if (found == entries_.end()) return abort(has({request.object.index, 0}) ? 0x0609'0011 : 0x0602'0000);
  Entry& entry = found->second;
  if (reads) {
    SdoMessage answer = canopen::expedited_download(request.object, entry.value, entry.bytes);
    answer.command = SdoCommand::kUpload;
    return answer;
  }
  if (!entry.writable) return abort(0x0601'0002);
  if (request.length != entry.bytes) return abort(0x0607'0010);
  if (refusal != 0) return abort(refusal);
  entry.value = canopen::expedited_value(request) & static_cast<std::uint32_t>(low_bits(8U * entry.bytes));
  return {.command = SdoCommand::kDownload, .object = request.object};
}

}  // namespace robot_control
