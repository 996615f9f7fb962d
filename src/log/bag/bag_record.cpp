#include "log/bag/bag_record.h"

#include "files/message_text.h"

namespace robot_control {
namespace {

constexpr std::size_t kLength = sizeof(std::uint32_t);

std::string quoted(std::string_view text) {
  return "'" + printable(text, 40) + "'";
}

/// Returns the length in the four bytes at `at` and checks that so many bytes follow.
std::uint32_t length_at(std::string_view bytes, std::size_t at, const BagPlace& place, const char* field) {
  if (bytes.size() - at < kLength) throw BagError(place + at, field, "ends within its 4 bytes", true);
  const auto length = bag_number<std::uint32_t>(bytes.substr(at));
  if (bytes.size() - at - kLength < length) {
    throw BagError(
        place + at, field,
        std::to_string(length) + " bytes, but only " + std::to_string(bytes.size() - at - kLength) + " follow", true);
  }
  return length;
}

}  // namespace

std::uint64_t bag_time_ns(std::string_view bytes, const BagPlace& place, const std::string& field) {
  constexpr std::uint32_t kSecond = 1'000'000'000;
  const auto seconds = bag_number<std::uint32_t>(bytes), nanoseconds = bag_number<std::uint32_t>(bytes.substr(kLength));
  if (nanoseconds >= kSecond) {
    throw BagError(place, field, std::to_string(nanoseconds) + " ns, which is a second or more");
  }
  return std::uint64_t{seconds} * kSecond + nanoseconds;
}

BagHeader::BagHeader(std::string_view bytes, const BagPlace& place) : place_(place) {
  std::size_t at = 0;
  while (at < bytes.size()) {
    if (bytes.size() - at < kLength) throw BagError(place + at, "field_len", "the header ends within its 4 bytes");
    const auto length = bag_number<std::uint32_t>(bytes.substr(at));
    const std::size_t left = bytes.size() - at - kLength;
    if (length > left) {
      throw BagError(place + at, "field_len",
                     std::to_string(length) + " bytes, but the header has " + std::to_string(left) + " more");
    }
    const std::string_view field = bytes.substr(at + kLength, length);
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos || equals == 0) {
      throw BagError(place + (at + kLength), quoted(field), "is no name=value");
    }
    const std::string_view name = field.substr(0, equals);
    if (has(name)) throw BagError(place + (at + kLength), quoted(name), "stands in the header twice");
    if (count_ == kMaxFields) throw BagError(place + at, quoted(name), "the header has too many fields");
    fields_[count_++] = {.name = name, .value = field.substr(equals + 1), .offset = at + kLength + equals + 1};
    at += kLength + length;
  }
}

const BagHeader::Field* BagHeader::find(std::string_view name) const {
  for (std::size_t i = 0; i < count_; ++i) {
    if (fields_[i].name == name) return &fields_[i];
  }
  return nullptr;
}

const BagHeader::Field& BagHeader::sized(std::string_view name, std::size_t size) const {
  const Field* field = find(name);
  if (field == nullptr) throw BagError(place_, std::string(name), "is absent");
  if (field->value.size() != size) {
    throw BagError(place_ + field->offset, std::string(name),
                   "has " + std::to_string(field->value.size()) + " bytes instead of " + std::to_string(size));
  }
  return *field;
}

BagOp BagHeader::op() const {
  const Field& field = sized("op", 1);
  const auto op = static_cast<std::uint8_t>(field.value[0]);
  if (op < static_cast<std::uint8_t>(BagOp::kMessage) || op > static_cast<std::uint8_t>(BagOp::kConnection)) {
    throw BagError(place_ + field.offset, "op", std::to_string(op) + " is not a kind of record");
  }
  return static_cast<BagOp>(op);
}

std::uint64_t BagHeader::time_ns(std::string_view name) const {
  const Field& field = sized(name, sizeof(std::uint64_t));
  return bag_time_ns(field.value, place_ + field.offset, std::string(name));
}

std::string_view BagHeader::text(std::string_view name) const {
  const Field* field = find(name);
  if (field == nullptr) throw BagError(place_, std::string(name), "is absent");
  return field->value;
}

BagRecord read_bag_record(std::string_view bytes, const BagPlace& place) {
  const std::uint32_t header = length_at(bytes, 0, place, "header_len");
  if (header > kMaxBagHeader) {
    throw BagError(place, "header_len", std::to_string(header) + " bytes; at most 65536 are read");
  }
  const std::size_t data_length_at = kLength + header;
  const BagHeader fields(bytes.substr(kLength, header), place + kLength);
  const std::uint32_t data = length_at(bytes, data_length_at, place, "data_len");
  const std::size_t begin = data_length_at + kLength;
  return {.header = fields, .data = bytes.substr(begin, data), .data_place = place + begin, .size = begin + data};
}

}  // namespace robot_control
