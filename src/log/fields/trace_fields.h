#pragma once
/// This table lists every field of the message Trace once: name, type, unit, member of a row, and columns.
///
/// Writer and reader of run.bag, the arrays of Python, run.csv and msg/Trace.msg come from this table.
/// The script tests/docs/trace_message.py writes msg/Trace.msg. A new member of a row needs one line here. The inputs
/// of a law are recorded bit for bit (float64, integers). Its outputs, which a replay computes again, are float32. The
/// last field is the checksum of all fields before it.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "log/rows/trace_row.h"

namespace robot_control {

/// This reads values from a message; beyond its end, `ok` is false and every value is 0.
class ByteSource {
 public:
  explicit ByteSource(std::string_view bytes) : bytes_(bytes) {}

  template <class Number>
  Number number() {
    Number value{};
    if (bytes_.size() < sizeof value) {
      ok_ = false;
      return value;
    }
    bytes_.copy(reinterpret_cast<char*>(&value), sizeof value);
    bytes_.remove_prefix(sizeof value);
    return value;
  }
  std::string_view text() { return bytes(number<std::uint32_t>()); }
  std::string_view bytes(std::size_t size) {
    ok_ = ok_ && size <= bytes_.size();
    const std::string_view value = bytes_.substr(0, ok_ ? size : 0);
    bytes_.remove_prefix(value.size());
    return value;
  }

  bool ok() const noexcept { return ok_; }
  std::size_t left() const noexcept { return bytes_.size(); }

 private:
  std::string_view bytes_;
  bool ok_ = true;
};

/// A message is made from these values.
struct TraceSource {
  const JoinedRow& row;
  std::uint64_t lost = 0;    ///< rows dropped or overwritten in the rings, or refused by the disk, until now
  std::size_t joints = 0;    ///< number of the robot's joints: the length of the lists of joints
  std::int64_t time_ns = 0;  ///< time of the message in the bag
};

/// A column shows one number of a row in Python's arrays and in run.csv.
struct TraceColumn {
  using Value = double (*)(const JoinedRow& row, std::size_t element);

  /// An array or list has a column for the row, or for each joint or contact of the robot.
  enum class Owner { kRow, kJoint, kContact };

  std::string name = {};     ///< a suffix behind the name of the owner unless that is the row
  std::string meaning = {};  ///< unit and meaning; empty: those of the field
  bool integer = false;      ///< run.csv shows it without a decimal point
  Owner owner = Owner::kRow;
  bool timing = false;      ///< only runs on the wall clock have it: equal runs differ in it
  std::size_t element = 0;  ///< element of the array; `log_columns` sets it to the number of the owner
  Value value = nullptr;    ///< the number; NaN where its node published no frame. Integers are exact up to 2^53
};

struct TraceField {
  std::string name;
  std::string type;          ///< type of ROS: "float64", "float32[3]", "float64[]"
  std::string comment;       ///< unit and meaning
  std::string heading = {};  ///< heading in the .msg before this field; mostly empty
  std::vector<TraceColumn> columns = {};
  std::size_t max_joints = kMaxJoints;  ///< number of joints that have columns
  TraceColumn plain = {};               ///< shows the member itself, without a name

  void (*write)(const TraceSource& source, std::string& message) = nullptr;
  /// False: the list is longer than the member.
  bool (*read)(ByteSource& from, TraceRow& row) = nullptr;

  std::string member_type = {};  ///< "float64[3]", "uint64": of what the next function writes
  /// Writes all numbers of the member with its full precision; null: another field does.
  void (*write_member)(const JoinedRow& row, std::string& bytes) = nullptr;

  /// These functions add columns. Without names, the column has the name of the field; with names, each of the first
  /// elements has a column.
  TraceField& shown() { return shown({name}); }
  TraceField& shown(const std::vector<std::string>& names);
  TraceField& shown_per_joint(std::string suffix);
  TraceField& shown_per_contact();
  TraceField& shown_as(TraceColumn column);
  /// All columns of this field are of kind `timing`.
  TraceField& as_timing();
  /// This field shows a part of a member that another field holds whole.
  TraceField& as_part();
};

using TraceFields = std::vector<TraceField>;
const TraceFields& trace_fields();

/// The members of frames that the message holds only where it holds a whole frame.
const TraceFields& frame_only_fields();

/// The columns of a table, with their meaning, in the order of the fields. `joints` and `contacts`: names in the order
/// of MachineModel::joints and MachineModel::contacts. `timing`: with the columns of that kind.
std::vector<TraceColumn> log_columns(const std::vector<std::string>& joints, const std::vector<std::string>& contacts,
                                     bool timing);

/// The text of msg/Trace.msg, which names the columns, too.
std::string trace_definition();

}  // namespace robot_control
