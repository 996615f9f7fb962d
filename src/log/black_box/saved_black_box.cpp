#include "log/black_box/saved_black_box.h"

#include <lz4.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "log/bag_log.h"
#include "log/black_box/black_box.h"
#include "log/black_box/black_box_reader.h"
#include "log/black_box/lost_rows.h"
#include "log/messages/message_types.h"
#include "log/rows/join.h"
#include "signals/checksum.h"

namespace robot_control {
namespace {

namespace fs = std::filesystem;

/// Gives the contents of a record to `use`: a row of a node, a LawSnapshot or a BlackBoxState. Other sizes are ignored.
class Unpacker {
 public:
  template <class Use>
  void give(const BlackBoxRecord& record, Use use) {
    switch (static_cast<BlackBoxKind>(record.kind)) {
      case BlackBoxKind::kDriver:
        return unpack(record, driver_, use);
      case BlackBoxKind::kEstimator:
        return unpack(record, estimator_, use);
      case BlackBoxKind::kController:
        return unpack(record, controller_, use);
      case BlackBoxKind::kMonitor:
        return unpack(record, monitor_, use);
      case BlackBoxKind::kSnapshot:
        return unpack(record, snapshot_, use);
      case BlackBoxKind::kState:
        return unpack(record, state_, use);
      case BlackBoxKind::kHeader:
        return;
    }
  }

 private:
  template <class Value, class Use>
  static void unpack(const BlackBoxRecord& record, Value& value, Use use) {
    static_assert(std::is_trivially_copyable_v<Value>);
    const int size = LZ4_decompress_safe(record.data.data(), reinterpret_cast<char*>(&value),
                                         static_cast<int>(record.data.size()), static_cast<int>(sizeof value));
    if (size == static_cast<int>(sizeof value)) use(value);
  }

  DriverTrace driver_;
  EstimatorTrace estimator_;
  ControllerTrace controller_;
  MonitorTrace monitor_;
  LawSnapshot snapshot_;
  BlackBoxState state_;
};

/// Gives records to the join and the log.
class Saver {
 public:
  Saver(LogFolder& folder, const LogHeader& header)
      : log_(folder, header, parameters()), join_(header.period, [this](const JoinedRow& row) {
          log_.write(row);
          if (!row.repeats) ++saved_.rows;
        }) {}

  void add(const BlackBoxRecord& record) {
    unpacker_.give(record, [&](const auto& value) { add(record, value); });
  }
  void gap() { lost_.gap(); }

  SavedBlackBox finish() {
    join_.finish();
    log_.close();
    return saved_;
  }

 private:
  static TelemetryParameters parameters() {
    TelemetryParameters all;
    all.record = RecordMode::kAlways;
    all.split_size = all.split_time = all.quota = 0;
    return all;
  }

  template <class Row>
  void add(const BlackBoxRecord& record, const Row& row) {
    saved_.newest_ns.at(record.kind) = record.time_ns;
    lost_.row(record.kind, head_of(row));
    log_.set_lost(lost_before_ + lost_.count());
    join_.add(row);
  }
  void add(const BlackBoxRecord& /*record*/, const LawSnapshot& snapshot) { log_.write(snapshot); }
  void add(const BlackBoxRecord& /*record*/, const BlackBoxState& state) {
    log_.set_time_offset(state.time_offset_ns);
    lost_before_ = state.lost;
    log_.set_lost(lost_before_ + lost_.count());
  }

  Unpacker unpacker_;
  BagLog log_;
  SavedBlackBox saved_;
  LostRows lost_;
  std::uint64_t lost_before_ = 0;
  Join join_;
};

/// The contents of a black box are counted before it is saved.
struct Survey {
  BlackBoxDamage damage;
  std::uint64_t records = 0;
  std::uint64_t rows = 0;  ///< rows of all nodes
  LostRows lost;
  std::string header;  ///< message of the oldest header; empty: there is none
};

/// Records are unpacked only if some are missing, to name those.
Survey survey_of(const BlackBoxReader& reader, const std::function<void()>& go_on) {
  Survey survey;
  const auto count = [&](const BlackBoxRecord& record) {
    ++survey.records;
    if (record.kind < kLaws) ++survey.rows;
    if (record.kind == static_cast<std::uint32_t>(BlackBoxKind::kHeader) && survey.header.empty()) {
      survey.header = record.data;
    }
  };
  survey.damage = reader.read({.record = count, .segment = go_on});
  if (survey.damage.none()) return survey;
  const auto unpacker = std::make_unique<Unpacker>();  // 100 KB
  const auto find_lost = [&](const BlackBoxRecord& record) {
    unpacker->give(record, [&](const auto& value) {
      if constexpr (requires { head_of(value); }) survey.lost.row(record.kind, head_of(value));
    });
  };
  reader.read({.record = find_lost, .gap = [&] { survey.lost.gap(); }, .segment = go_on});
  return survey;
}

std::string counted(std::uint64_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// The result is empty if nothing is missing.
std::string missing_in(const BlackBoxReader& reader, const Survey& survey) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (reader.bytes() < reader.whole_bytes()) {
    add("it is cut off after " + std::to_string(reader.bytes()) + " of " + std::to_string(reader.whole_bytes()) +
        " bytes");
  }
  if (survey.damage.segments != 0) {
    add(counted(survey.damage.segments, "segment", "segments") + " of " + std::to_string(reader.segments()) +
        ", 1 MiB each, cannot be read");
  }
  if (survey.damage.places != 0) {
    add("records are missing at " + counted(survey.damage.places, "place", "places") + " of the others");
  }
  if (survey.lost.count() != 0) add("between what was read " + survey.lost.text() + " are missing");
  return text.empty() ? text : "the black box is damaged: " + text;
}

/// A bag grows in a folder before it gets its name. The folder belongs to this process: another may save the same.
class Growing {
 public:
  explicit Growing(const std::string& bag)
      : bag_(bag), folder_(bag_.string() + "." + std::to_string(getpid()) + kSavingSuffix) {
    std::error_code error;
    above_ = bag_.has_parent_path() && fs::create_directories(bag_.parent_path(), error);
    remove();  // a killed process of the same number may have left it
    fs::create_directory(folder_, error);
    if (error) throw LogError(bag + " cannot be written: " + error.message());
  }
  ~Growing() {
    remove();
    std::error_code ignored;
    if (above_) fs::remove(bag_.parent_path(), ignored);  // a folder that holds something stays
  }
  Growing(const Growing&) = delete;
  Growing& operator=(const Growing&) = delete;

  std::string folder() const { return folder_.string(); }

  /// Empties the bag, which is not wanted: its closing would write to the disk for seconds.
  void empty() {
    std::error_code ignored;
    fs::resize_file(folder_ / "run.bag", 0, ignored);
  }

  void finish() {
    std::error_code error;
    fs::rename(folder_ / "run.bag", bag_, error);
    if (error) throw LogError(bag_.string() + " cannot be written: " + error.message());
  }

 private:
  void remove() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  fs::path bag_;
  fs::path folder_;
  bool above_ = false;  ///< true: the folder of the bag was made here
};

/// The ring began with this header.
std::string_view first_header(const BlackBoxReader& reader, std::uint64_t build, const std::string& path) {
  const std::string& description = reader.description();
  const std::string writer = description.substr(0, kBlackBoxBuildLength);
  if (writer != hex(build)) {
    throw LogError(path + " was written by the build " + writer + ", this is " + hex(build) +
                   ": read it with the programs that wrote it");
  }
  return std::string_view(description).substr(kBlackBoxBuildLength);
}

LogHeader header_of(std::string_view encoded, const std::string& path) {
  LogHeader header = decode_header(encoded, trace_header_type().definition);
  if (header.joints.size() > kMaxJoints) throw LogError(path + " is of no robot");
  header.record = "always";
  header.part = 0;
  return header;
}

}  // namespace

SavedBlackBox save_black_box(const std::string& path, std::uint64_t build, const std::string& bag,
                             const GiveUp& give_up) {
  const BlackBoxReader reader(path);
  const auto go_on = [&] {
    if (give_up && give_up()) throw SavingGivenUp("saving " + path + " was given up");
  };
  const std::string_view first = first_header(reader, build, path);
  const Survey survey = survey_of(reader, go_on);
  LogHeader header = header_of(survey.header.empty() ? first : survey.header, path);
  header.missing = missing_in(reader, survey);
  if (survey.records == 0 && !header.missing.empty()) {
    throw LogError(path + " holds no record that is whole: " + header.missing);
  }
  if (survey.rows == 0) throw EmptyBlackBox(path + " holds no row: telemetry has received none");
  Growing growing(bag);
  LogFolder logs(growing.folder(), 0);
  const auto saver = std::make_unique<Saver>(logs, header);  // 100 KB
  const auto add = [&](const BlackBoxRecord& record) {
    go_on();
    saver->add(record);
  };
  try {
    reader.read({.record = add, .gap = [&] { saver->gap(); }, .segment = go_on});
  } catch (const SavingGivenUp&) {
    growing.empty();
    throw;
  }
  SavedBlackBox saved = saver->finish();
  growing.finish();
  saved.missing = header.missing;
  return saved;
}

}  // namespace robot_control
