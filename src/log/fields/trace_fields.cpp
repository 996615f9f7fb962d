#include "log/fields/trace_fields.h"

#include <algorithm>
#include <utility>

#include "log/fields/trace_field_groups.h"
#include "log/fields/trace_field_kinds.h"
#include "log/messages/message_checksum.h"

namespace robot_control {

using namespace trace_words;

namespace {

const FrameHead* head_of(const JoinedRow& row) {
  if (row.driver != nullptr) return &row.driver->sensors.head;
  if (row.laws.estimator != nullptr) return &row.laws.estimator->state.head;
  if (row.laws.controller != nullptr) return &row.laws.controller->command.head;
  return row.laws.monitor != nullptr ? &row.laws.monitor->permit.head : nullptr;
}

u8 bits_of(const void* driver, const void* estimator, const void* controller, const void* monitor) {
  return static_cast<u8>((driver != nullptr ? kPartDriver : 0) | (estimator != nullptr ? kPartEstimator : 0) |
                         (controller != nullptr ? kPartController : 0) | (monitor != nullptr ? kPartMonitor : 0));
}

template <class Wire, class Put, class Take>
TraceField& of_row(TraceFields& to, std::string_view name, std::string_view comment, Put, Take) {
  TraceField& result = add_field(to, name, wire_name<Wire>(), comment);
  result.plain.integer = true;
  result.plain.value = [](const JoinedRow& row, std::size_t) {
    return static_cast<double>(Put{}(TraceSource{.row = row}));
  };
  result.write = [](const TraceSource& source, std::string& message) { write_number(message, Wire(Put{}(source))); };
  result.read = [](ByteSource& from, TraceRow& row) {
    Take{}(row, from.number<Wire>());
    return true;
  };
  return result;
}

void add_row(TraceFields& to) {
  using S = const TraceSource&;
  using R = TraceRow&;
  of_row<std::int64_t>(
      to, "run", "0, 1, ... in the order in which the runs began; a run ends with the driver or a reset",
      [](S s) { return s.row.run; }, [](R r, i64 value) { r.run = value; })
      .shown();
  of_row<u64>(
      to, "run_id", "random number of the run",
      [](S s) {
        const FrameHead* head = head_of(s.row);
        return head != nullptr ? head->run : 0;
      },
      [](R r, u64 value) { r.run_id = value; });
  of_row<u64>(
      to, "cycle", "k, from 0 in each run", [](S s) { return s.row.cycle; }, [](R r, u64 value) { r.cycle = value; })
      .shown()
      .shown_as({.name = "time",
                 .meaning = "s since the run began, cycle times period",
                 .value = [](const JoinedRow& row, std::size_t) { return row.time; }});
  of_row<i64>(
      to, "stamp_ns", "ns, of the sensor sample, on the clock of the loop (CLOCK_MONOTONIC, or simulated time)",
      [](S s) {
        const FrameHead* head = head_of(s.row);
        return head != nullptr ? head->stamp_ns : 0;
      },
      [](R r, i64 value) { r.stamp_ns = value; })
      .shown()
      .as_timing();
  of_row<u8>(
      to, "parts", "bits of the nodes that have a row in this cycle: 1 driver, 2 estimator, 4 controller, 8 monitor",
      [](S s) { return bits_of(s.row.driver, s.row.laws.estimator, s.row.laws.controller, s.row.laws.monitor); },
      [](R r, u8 value) { r.parts = value; });
  of_row<u8>(
      to, "published", "bits of those whose frame was published; the others were suppressed by an injected fault",
      [](S s) { return bits_of(s.row.driver, s.row.estimator, s.row.controller, s.row.monitor); },
      [](R r, u8 value) { r.published = value; });
  of_row<u8>(
      to, "repeats",
      "1: a node answered a cycle again (started again, or the monitor without a new sensor frame); no row of the run",
      [](S s) { return s.row.repeats; }, [](R r, u8 value) { r.repeats = value != 0; });
  of_row<u64>(
      to, "lost",
      "rows lost since telemetry began: in the rings, or not taken by the disk. Cycles that are missing though it "
      "stays the same were left out, because nothing moved (telemetry.record)",
      [](S s) { return s.lost; }, [](R r, u64 value) { r.lost = value; });
}

/// A reader ignores it: a replay computes it again.
void add_checksum(TraceFields& to) {
  TraceField& checksum =
      add_field(to, "checksum", wire_name<u32>(), "of the fields before it and of the message's time in the bag");
  checksum.write = [](const TraceSource& source, std::string& message) {
    write_number(message, message_checksum(message, source.time_ns));
  };
  checksum.read = [](ByteSource& from, TraceRow&) {
    from.number<u32>();
    return true;
  };
}

TraceFields all_fields() {
  TraceFields all;
  const auto group = [&](const char* heading, void (*add)(TraceFields&)) {
    const std::size_t first = all.size();
    add(all);
    all[first].heading = heading;
  };
  group("The row.", add_row);
  group("Sensors: what estimator, controller and monitor took in; joints in the order of the header.", add_sensors);
  group("Links of the driver to its devices.", add_links);
  group("When each node woke and published, relative to when the cycle was due.", add_timing);
  group("Truth, of a simulator.", add_truth);
  group("Estimate.", add_estimate);
  group("How far each sensor agrees, and what was learned of it.", add_trust);
  group("Command.", add_command);
  group("Permit of the safety monitor.", add_permit);
  group("Driver and gate.", add_driver);
  group("What each law was given beside these, and the checksum of what it computed: for a replay.", add_calls);
  group("Limits and gains in force.", add_tuning);
  group("The message.", add_checksum);
  return all;
}

}  // namespace

TraceColumn named_column(std::string_view name, std::string_view meaning) {
  return {.name = std::string(name), .meaning = std::string(meaning)};
}

TraceField& add_field(TraceFields& to, std::string_view name, std::string_view type, std::string_view comment,
                      std::string_view elements) {
  return to.emplace_back(TraceField{
      .name = std::string(name), .type = std::string(type).append(elements), .comment = std::string(comment)});
}

TraceField& TraceField::shown(const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    columns.push_back(plain);
    columns.back().name = names[i];
    columns.back().element = i;
  }
  return *this;
}

TraceField& TraceField::shown_per_joint(std::string suffix) {
  columns.push_back(plain);
  columns.back().name = std::move(suffix);
  columns.back().owner = TraceColumn::Owner::kJoint;
  return *this;
}

TraceField& TraceField::shown_per_contact() {
  columns.push_back(plain);
  columns.back().name = name;
  columns.back().owner = TraceColumn::Owner::kContact;
  return *this;
}

TraceField& TraceField::shown_as(TraceColumn column) {
  columns.push_back(std::move(column));
  return *this;
}

TraceField& TraceField::as_timing() {
  for (TraceColumn& column : columns) column.timing = true;
  return *this;
}

TraceField& TraceField::as_part() {
  write_member = nullptr;
  return *this;
}

const TraceFields& frame_only_fields() {
  static const TraceFields fields = [] {
    TraceFields all;
    add_frame_only_gate(all);
    add_frame_only_estimate(all);
    add_frame_only_command(all);
    return all;
  }();
  return fields;
}

const std::vector<TraceField>& trace_fields() {
  static const TraceFields fields = all_fields();
  return fields;
}

std::vector<TraceColumn> log_columns(const std::vector<std::string>& joints, const std::vector<std::string>& contacts,
                                     bool timing) {
  using Owner = TraceColumn::Owner;
  std::vector<TraceColumn> columns;
  for (const TraceField& field : trace_fields()) {
    for (const TraceColumn& column : field.columns) {
      if (column.timing && !timing) continue;
      const std::vector<std::string>& owners = column.owner == Owner::kJoint ? joints : contacts;
      const std::size_t limit = column.owner == Owner::kJoint ? field.max_joints : kMaxContacts;
      const std::size_t count = column.owner == Owner::kRow ? 1 : std::min(owners.size(), limit);
      for (std::size_t i = 0; i < count; ++i) {
        columns.push_back(column);
        if (column.meaning.empty()) columns.back().meaning = field.comment;
        if (column.owner == Owner::kRow) continue;
        columns.back().name = owners[i] + "_" + column.name;
        columns.back().element = i;
      }
    }
  }
  return columns;
}

std::string trace_definition() {
  std::string text =
      "# One control cycle of all four nodes: sensors k, state k, command k, permit k. Topic `trace` of a log, beside\n"
      "# TraceHeader. Enums and bits: src/signals. Behind | stand the columns of Python's arrays and of run.csv.\n"
      "# Written by tests/docs/trace_message.py; do not edit.\n";
  for (const TraceField& field : trace_fields()) {
    if (!field.heading.empty()) text += "\n# " + field.heading + "\n";
    std::string comment = field.comment;
    for (const TraceColumn& column : field.columns) {
      comment += (&column == field.columns.data() ? " | " : ", ");
      comment += (column.owner == TraceColumn::Owner::kJoint     ? "<joint>_"
                  : column.owner == TraceColumn::Owner::kContact ? "<contact>_"
                                                                 : "") +
                 column.name;
    }
    text += field.type + " " + field.name + (comment.empty() ? "" : "  # " + comment) + "\n";
  }
  return text;
}

JoinedRow TraceRow::joined(double period) const {
  JoinedRow result{.run = run, .cycle = cycle, .time = row_time(cycle, period)};
  result.repeats = repeats;
  if ((parts & kPartDriver) != 0) result.driver = &driver;
  result.set({.estimator = (parts & kPartEstimator) != 0 ? &estimator : nullptr,
              .controller = (parts & kPartController) != 0 ? &controller : nullptr,
              .monitor = (parts & kPartMonitor) != 0 ? &monitor : nullptr});
  return result;
}

}  // namespace robot_control
