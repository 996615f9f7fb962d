#pragma once
/// These templates make fields of members of a row; only the tables of fields, trace_*_fields.cpp, use them.
///
/// `Get` is a stateless lambda that returns a reference to a member of one part of a row, as `MEMBER` makes it. `Wire`
/// is the type in the message. If the part is missing, numbers are NaN and integers 0.

#include <array>
#include <limits>
#include <type_traits>

#include "log/fields/trace_fields.h"
#include "log/packed_chunk.h"
#include "signals/rotation.h"

namespace robot_control {

/// The tables of fields use these names for the parts of a row and for the types in the message.
namespace trace_words {
using D = DriverTrace;
using E = EstimatorTrace;
using C = ControllerTrace;
using M = MonitorTrace;
using f64 = double;
using f32 = float;
using u8 = std::uint8_t;
using u32 = std::uint32_t;
using u64 = std::uint64_t;
using i64 = std::int64_t;
}  // namespace trace_words

#define MEMBER(member)      \
  [](auto& part) -> auto& { \
    return part.member;     \
  }
/// The reference is to a member of element i of a list.
#define ELEMENT(member)                    \
  [](auto& part, std::size_t i) -> auto& { \
    return part.member;                    \
  }

/// The reference is to a member of what `Get` returns.
#define OF(member)             \
  [](auto& part) -> auto& {    \
    return Get{}(part).member; \
  }

/// A law has its part also where an injected fault suppressed the frame: the law ran.
template <class Part>
const Part* part_of(const JoinedRow& row) {
  if constexpr (std::is_same_v<Part, DriverTrace>) return row.driver;
  if constexpr (std::is_same_v<Part, EstimatorTrace>) return row.laws.estimator;
  if constexpr (std::is_same_v<Part, ControllerTrace>) return row.laws.controller;
  if constexpr (std::is_same_v<Part, MonitorTrace>) return row.laws.monitor;
}

/// Columns show the frames that were published.
template <class Part>
const Part* published_part(const JoinedRow& row) {
  if constexpr (std::is_same_v<Part, DriverTrace>) return row.driver;
  if constexpr (std::is_same_v<Part, EstimatorTrace>) return row.estimator;
  if constexpr (std::is_same_v<Part, ControllerTrace>) return row.controller;
  if constexpr (std::is_same_v<Part, MonitorTrace>) return row.monitor;
}

/// The number of a column. `Compute` is a stateless lambda of the part and the element.
template <class Part, class Compute>
void set_value(TraceColumn& column, Compute) {
  column.integer = !std::is_floating_point_v<std::invoke_result_t<Compute, const Part&, std::size_t>>;
  column.value = [](const JoinedRow& row, std::size_t element) -> double {
    const Part* part = published_part<Part>(row);
    if (part == nullptr) return std::numeric_limits<double>::quiet_NaN();
    return static_cast<double>(Compute{}(*part, element));
  };
}

/// A column without its number.
TraceColumn named_column(std::string_view name, std::string_view meaning);

/// A column of a part.
template <class Part, class Compute>
TraceColumn column(std::string_view name, std::string_view meaning, Compute compute) {
  TraceColumn result = named_column(name, meaning);
  set_value<Part>(result, compute);
  return result;
}

/// The number is NaN where `exists` is false.
inline double where(bool exists, double value) {
  return exists ? value : std::numeric_limits<double>::quiet_NaN();
}

template <class Part>
Part& part_of(TraceRow& row) {
  if constexpr (std::is_same_v<Part, DriverTrace>) return row.driver;
  if constexpr (std::is_same_v<Part, EstimatorTrace>) return row.estimator;
  if constexpr (std::is_same_v<Part, ControllerTrace>) return row.controller;
  if constexpr (std::is_same_v<Part, MonitorTrace>) return row.monitor;
}

template <class Wire>
constexpr const char* wire_name() {
  if constexpr (std::is_same_v<Wire, double>) return "float64";
  if constexpr (std::is_same_v<Wire, float>) return "float32";
  if constexpr (std::is_same_v<Wire, std::uint8_t>) return "uint8";
  if constexpr (std::is_same_v<Wire, std::uint32_t>) return "uint32";
  if constexpr (std::is_same_v<Wire, std::uint64_t>) return "uint64";
  if constexpr (std::is_same_v<Wire, std::int64_t>) return "int64";
}

template <class Wire>
constexpr Wire none() {
  if constexpr (std::is_floating_point_v<Wire>) return std::numeric_limits<Wire>::quiet_NaN();
  return Wire{};
}

template <class Wire>
void write_number(std::string& to, Wire value) {
  ByteSink(to).number(value);
}

/// Enums become integers.
template <class Value>
auto as_number(const Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    return static_cast<std::underlying_type_t<Value>>(value);
  } else {
    return value;
  }
}

template <class Value>
struct ArraySize : std::integral_constant<std::size_t, 0> {};
template <class Element, std::size_t N>
struct ArraySize<std::array<Element, N>> : std::integral_constant<std::size_t, N> {};

/// Appends a field that nothing writes, reads or shows as yet. `elements`: "" of a number, "[]" of a list, "[3]" of an
/// array.
TraceField& add_field(TraceFields& to, std::string_view name, std::string_view type, std::string_view comment,
                      std::string_view elements = "");

/// Appends a field of at most `Max` numbers. `Get` returns number i. `Size` is a stateless lambda of a part (null:
/// missing) and the number of joints; void: there are always `Max` numbers.
template <class Part, class Wire, std::size_t Max, class Size, class Get>
TraceField& add_numbers(TraceFields& to, std::string_view name, std::string_view comment, std::string_view elements) {
  using Value = std::decay_t<std::invoke_result_t<Get, Part&, std::size_t>>;
  constexpr bool kList = !std::is_void_v<Size>;
  TraceField& result = add_field(to, name, wire_name<Wire>(), comment, elements);
  set_value<Part>(result.plain, [](const Part& part, std::size_t i) { return as_number(Get{}(part, i)); });
  result.write = [](const TraceSource& source, std::string& message) {
    const Part* part = part_of<Part>(source.row);
    std::size_t size = Max;
    if constexpr (kList) {
      size = Size{}(part, source.joints);
      write_number(message, static_cast<std::uint32_t>(size));
    }
    for (std::size_t i = 0; i < size; ++i) {
      write_number(message, part != nullptr ? static_cast<Wire>(Get{}(*part, i)) : none<Wire>());
    }
  };
  result.read = [](ByteSource& from, TraceRow& row) {
    std::size_t size = Max;
    if constexpr (kList) size = from.number<std::uint32_t>();
    if (size > Max) return false;
    for (std::size_t i = 0; i < size; ++i) Get{}(part_of<Part>(row), i) = static_cast<Value>(from.number<Wire>());
    return true;
  };
  using Member = std::conditional_t<std::is_floating_point_v<Value>, double, std::uint64_t>;
  result.member_type = wire_name<Member>() + (elements.empty() ? "" : "[" + std::to_string(Max) + "]");
  result.write_member = [](const JoinedRow& row, std::string& bytes) {
    const Part* part = part_of<Part>(row);
    for (std::size_t i = 0; part != nullptr && i < Max; ++i) write_number(bytes, static_cast<Member>(Get{}(*part, i)));
  };
  return result;
}

template <class Get>
struct Itself {
  template <class Part>
  auto& operator()(Part& part, std::size_t) const {
    return Get{}(part);
  }
};
template <class Get>
struct ElementOf {
  template <class Part>
  auto& operator()(Part& part, std::size_t i) const {
    return Get{}(part)[i];
  }
};

/// The field is a number, or an array of fixed length.
template <class Part, class Wire, class Get>
TraceField& field(TraceFields& to, std::string_view name, std::string_view comment, Get) {
  constexpr std::size_t kSize = ArraySize<std::decay_t<std::invoke_result_t<Get, Part&>>>::value;
  if constexpr (kSize == 0) {
    return add_numbers<Part, Wire, 1, void, Itself<Get>>(to, name, comment, "");
  } else {
    return add_numbers<Part, Wire, kSize, void, ElementOf<Get>>(to, name, comment, "[" + std::to_string(kSize) + "]");
  }
}

/// A list has at most `Max` elements.
template <class Part, class Wire, std::size_t Max, class Size, class Get>
TraceField& list(TraceFields& to, std::string_view name, std::string_view comment, Size, Get) {
  return add_numbers<Part, Wire, Max, Size, Get>(to, name, comment, "[]");
}

/// The list holds a value for each joint.
template <class Part, class Wire, class Get>
TraceField& per_joint(TraceFields& to, std::string_view name, std::string_view comment, Get get) {
  return list<Part, Wire, kMaxJoints>(
      to, name, comment, [](const Part*, std::size_t joints) { return joints; }, get);
}

/// Appends the fields of a Request behind its twist. `Get` returns the Request.
template <class Get>
void add_request(TraceFields& to, const std::string& name, Get) {
  using Part = ControllerTrace;
  field<Part, double>(to, name + "_height", "m, above the nominal posture", OF(posture.height));
  field<Part, double>(to, name + "_roll", "rad", OF(posture.roll));
  field<Part, double>(to, name + "_pitch", "rad", OF(posture.pitch));
  field<Part, double>(to, name + "_x", "m, to the front", OF(posture.x));
  field<Part, double>(to, name + "_y", "m, to the left", OF(posture.y));
  field<Part, double>(to, name + "_yaw", "rad", OF(posture.yaw));
  list<Part, double, kRequestJoints>(
      to, name + "_joints", "rad or m; empty: all zero",
      [](const Part* part, std::size_t) { return part != nullptr ? logged_joints(Get{}(*part)) : 0; },
      [](auto& part, std::size_t i) -> auto& { return Get{}(part).joints[i]; });
  field<Part, std::uint64_t>(to, name + "_mode", "ModeKind", OF(mode.kind));
  field<Part, std::uint64_t>(to, name + "_mode_index", "of foot or gait", OF(mode.index));
}

/// The field holds the yaw of an orientation, computed from the recorded float32. A reader ignores it. The column is
/// the yaw of the member.
template <class Part, class Get>
TraceField& yaw(TraceFields& to, std::string_view name, Get) {
  TraceField& result = add_field(to, name, wire_name<float>(), "rad");
  set_value<Part>(result.plain, [](const Part& part, std::size_t) { return yaw_of(Get{}(part)); });
  result.write = [](const TraceSource& source, std::string& message) {
    const Part* part = part_of<Part>(source.row);
    if (part == nullptr) return write_number(message, none<float>());
    Quaternion recorded = Get{}(*part);
    for (double& entry : recorded) entry = static_cast<float>(entry);
    write_number(message, static_cast<float>(yaw_of(recorded)));
  };
  result.read = [](ByteSource& from, TraceRow&) {
    from.number<float>();
    return true;
  };
  return result;
}

}  // namespace robot_control
