#include "bindings/run_bag.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings/numpy_version.h"
#include "log/bag_log.h"
#include "log/black_box/saved_black_box.h"
#include "log/log_error.h"
#include "log/trace_reader.h"
#include "loop/log_header.h"
#include "simulation/closed_loop.h"

namespace py = pybind11;

namespace robot_control {
namespace {

using namespace py::literals;

/// Converts to a Python text. Bytes that are not UTF-8 become U+FFFD, because a scene or a calibration file may contain
/// some.
py::str text_of(const std::string& bytes) {
  PyObject* const text = PyUnicode_DecodeUTF8(bytes.data(), static_cast<py::ssize_t>(bytes.size()), "replace");
  if (text == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(text);
}

py::dict header_of(const LogHeader& header) {
  const auto texts_of = [](const std::vector<std::string>& all) {
    py::list texts;
    for (const std::string& each : all) texts.append(text_of(each));
    return texts;
  };
  return py::dict(
      "robot"_a = text_of(header.robot), "kind"_a = text_of(header.kind), "joints"_a = texts_of(header.joints),
      "roles"_a = texts_of(header.roles), "contacts"_a = texts_of(header.contacts), "wheels"_a = header.wheels,
      "period"_a = header.period, "clock"_a = text_of(header.clock), "record"_a = text_of(header.record),
      "part"_a = header.part, "parameters"_a = text_of(header.parameters), "urdf"_a = text_of(header.urdf),
      "scene"_a = text_of(header.scene), "calibration"_a = text_of(header.calibration),
      "version"_a = text_of(header.version), "build"_a = text_of(header.build), "host"_a = text_of(header.host),
      "kernel"_a = text_of(header.kernel), "processor"_a = text_of(header.processor),
      "libraries"_a = text_of(header.libraries), "missing"_a = text_of(header.missing));
}

/// A column of the table, which grows with the rows.
struct FilledColumn {
  TraceColumn column;
  std::vector<double> values;
};

/// A Table holds the rows of the last run and counts the runs.
class Table {
 public:
  /// `names` selects columns; if it is empty, the table has all columns.
  Table(const LogHeader& header, const std::vector<std::string>& names) : period_(header.period) {
    for (TraceColumn& column : log_columns(header.joints, header.contacts, header.clock == "wall")) {
      if (!names.empty() && std::find(names.begin(), names.end(), column.name) == names.end()) continue;
      columns_.push_back({.column = std::move(column), .values = {}});
    }
  }

  void add(const TraceRow& row, std::int64_t time_ns) {
    if (run_ != row.run) {
      ++runs_;
      run_ = row.run;
      clear();
    }
    if (times_.size() == times_.capacity()) grow();
    const JoinedRow joined = row.joined(period_);
    for (FilledColumn& each : columns_) each.values.push_back(each.column.value(joined, each.column.element));
    times_.push_back(static_cast<double>(time_ns) * 1e-9);
  }

  /// Estimates the number of all rows; `share` of the file has been read.
  void expect(double share) { expected_ = static_cast<double>(times_.size()) / share; }

  py::dict columns() {
    py::dict result;
    for (FilledColumn& each : columns_) result[text_of(each.column.name)] = array_of(std::move(each.values));
    return result;
  }
  py::set integers() const {
    py::set result;
    for (const FilledColumn& each : columns_) {
      if (each.column.integer) result.add(text_of(each.column.name));
    }
    return result;
  }
  py::array_t<double> times() { return array_of(std::move(times_)); }
  std::uint64_t runs() const noexcept { return runs_; }
  std::size_t rows() const noexcept { return times_.size(); }
  void clear() {
    for (FilledColumn& each : columns_) each.values.clear();
    times_.clear();
  }

 private:
  /// Reserves room for the estimated number of rows and some more, because each further growth copies everything. The
  /// growth is bounded, because the file may announce too many rows.
  void grow() {
    constexpr double kMore = 1.1;
    constexpr std::size_t kMinGrowth = 1 << 10, kMaxGrowth = 1 << 20;  // rows at once; 2²⁰ are 1.3 GB of address space
    const std::size_t now = times_.size();
    const double expected = std::min(expected_ * kMore, static_cast<double>(now + kMaxGrowth));
    const std::size_t rows = std::max({now + kMinGrowth, 2 * now, static_cast<std::size_t>(expected)});
    for (FilledColumn& each : columns_) each.values.reserve(rows);
    times_.reserve(rows);
  }

  /// Returns an array that owns the vector, without a copy.
  static py::array_t<double> array_of(std::vector<double>&& values) {
    auto* const owned = new std::vector<double>(std::move(values));
    const py::capsule owner(owned, [](void* vector) { delete static_cast<std::vector<double>*>(vector); });
    return py::array_t<double>(static_cast<py::ssize_t>(owned->size()), owned->data(), owner);
  }

  double period_;
  double expected_ = 0;  ///< estimated rows in the file
  std::vector<FilledColumn> columns_;
  std::vector<double> times_;
  std::int64_t run_ = -1;
  std::uint64_t runs_ = 0;
};

py::dict read_run_bag(const std::string& path, const std::vector<std::string>& names) {
  check_numpy_version();
  constexpr std::uint64_t kLook = 1 << 16;  // rows between two checks for Ctrl-C
  std::optional<Table> table;
  std::uint64_t rows = 0;
  std::uint64_t lost = 0;
  const auto add = [&](const TraceRow& row, std::int64_t time_ns) {
    if (!row.repeats) table->add(row, time_ns);
    lost = row.lost;
    if (++rows % kLook == 0 && PyErr_CheckSignals() != 0) throw py::error_already_set();
  };
  const TraceReader reader(path, {.header = [&](const LogHeader& header) { table.emplace(header, names); },
                                  .row = add,
                                  .chunk = [&](double share) { table->expect(share); }});
  return py::dict("header"_a = header_of(reader.header()), "columns"_a = table->columns(),
                  "ros_time"_a = table->times(), "runs"_a = table->runs(), "lost"_a = lost, "cut"_a = reader.cut());
}

/// Gives all runs of a log to `use(arrays by column, names of the columns of integers)`, in parts. Returns
/// TraceReader::cut.
std::string each_part_of_run_bag(const std::string& path, const py::function& use) {
  check_numpy_version();
  constexpr std::size_t kRows = 1 << 14;
  TraceReader reader(path);
  Table table(reader.header(), {});
  std::int64_t run = -1;
  const auto end_part = [&] {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (table.rows() == 0) return;
    use(table.columns(), table.integers());
    table.clear();
  };
  reader.read({.row = [&](const TraceRow& row, std::int64_t time_ns) {
    if (row.repeats) return;
    if (std::exchange(run, row.run) != row.run || table.rows() == kRows) end_part();
    table.add(row, time_ns);
  }});
  end_part();
  return reader.cut();
}

/// A FolderLog is a bag together with the folder that contains it.
class FolderLog final : public RowLog {
 public:
  FolderLog(const std::string& directory, const ClosedLoop& loop)
      : folder_(directory, 0), log_(folder_, log_header(loop.parameters(), loop.robot()), all_of(loop)) {}

  void write(const JoinedRow& row) override { log_.write(row); }
  void write(const LawSnapshot& snapshot) override { log_.write(snapshot); }
  void close() override { log_.close(); }

 private:
  static TelemetryParameters all_of(const ClosedLoop& loop) {
    TelemetryParameters parameters = loop.parameters().telemetry;
    parameters.record = RecordMode::kAlways;
    parameters.quota = 0;
    return parameters;
  }

  LogFolder folder_;
  BagLog log_;
};

void log_into(ClosedLoop& loop, const std::string& directory) {
  if (auto before = loop.set_log(std::make_unique<FolderLog>(directory, loop))) before->close();
}

void end_log(ClosedLoop& loop) {
  const std::string problem = loop.log_problem();
  if (auto log = loop.set_log(nullptr)) log->close();
  if (!problem.empty()) throw LogError(problem);
}

}  // namespace

void bind_run_bag(py::module_& module) {
  py::register_exception<LogError>(module, "RunLogError", PyExc_OSError);
  py::register_exception<BagError>(module, "BagError", PyExc_ValueError);
  const py::object& trace_error = py::register_exception<TraceError>(module, "TraceError", PyExc_ValueError);
  py::register_exception<NoTraceError>(module, "NoTraceError", trace_error);
  module.def("read_run_bag", read_run_bag, "path"_a, "names"_a);
  module.def(
      "read_run_header", [](const std::string& path) { return header_of(TraceReader(path).header()); }, "path"_a);
  module.def("each_part_of_run_bag", each_part_of_run_bag, "path"_a, "use"_a);
  module.def(
      "save_black_box",
      [](const std::string& path, const std::string& bag) {
        const SavedBlackBox saved = save_black_box(path, bag);
        return py::make_tuple(saved.rows, saved.newest_ns, saved.missing);
      },
      "path"_a, "bag"_a);
  module.def("log_into", log_into, "loop"_a, "directory"_a);
  module.def("end_log", end_log, "loop"_a);
}

}  // namespace robot_control
