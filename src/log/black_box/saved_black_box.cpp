#include "log/black_box/saved_black_box.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>
#include <vector>

#include "log/bag/bag_error.h"
#include "log/bag_log.h"
#include "log/log_folder.h"
#include "log/trace_reader.h"

namespace robot_control {
namespace {

namespace fs = std::filesystem;

/// A bag of the ring.
struct RingBag {
  std::string path;
  std::uint64_t bytes = 0;
  std::uint32_t part = 0;  ///< TraceHeader::part; rises from bag to bag
};

/// Returns the part in the header of a bag; nothing: it cannot be read.
std::optional<std::uint32_t> part_of(const std::string& path) {
  struct Found {
    std::uint32_t part;
  };
  try {
    TraceReader(path, {.header = [](const LogHeader& header) { throw Found{header.part}; }, .damaged = [] {}});
  } catch (const Found& found) {
    return found.part;
  } catch (const std::runtime_error&) {
  }
  return {};
}

bool zeros_at(std::ifstream& file, std::uint64_t begin, std::uint64_t end) {
  std::string bytes(end - begin, 'x');
  file.seekg(static_cast<std::streamoff>(begin));
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes.find_first_not_of('\0') == std::string::npos;
}

/// True: its writer had not begun it, or was killed while it wrote its begin, which is less than half of it.
bool not_begun(const std::string& path, std::uint64_t bytes) {
  std::ifstream file(path, std::ios::binary);
  return bytes >= 4 && (zeros_at(file, 0, 4) || zeros_at(file, bytes / 2, bytes));
}

/// The bags of a ring, oldest first.
struct Ring {
  explicit Ring(const std::string& path) {
    std::error_code error;
    std::uint64_t numbers = 0;
    for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error)) {
      const auto number = number_in(entry->path().filename().string(), "", ".bag");
      if (!number) continue;
      numbers = std::max(numbers, *number + 1);
      ++files;
      const std::string bag = entry->path().string();
      const std::uint64_t bytes = fs::file_size(bag, error);
      whole_bytes = std::max(whole_bytes, bytes);
      if (const auto part = part_of(bag)) {
        bags.push_back({.path = bag, .bytes = bytes, .part = *part});
      } else if (!not_begun(bag, bytes)) {
        ++unreadable;
      }
    }
    if (files == 0) {
      throw LogError(path + ": is not a black box of this version; give the folder black_box/ring in that of the logs");
    }
    absent = numbers - files;
    std::ranges::sort(bags, {}, &RingBag::part);
  }

  std::vector<RingBag> bags;
  std::uint64_t files = 0;
  std::uint64_t whole_bytes = 0;  ///< of each bag
  std::uint64_t unreadable = 0;   ///< bags that were written
  std::uint64_t absent = 0;       ///< bags
};

/// Gives the contents of a ring to the log, and counts what is missing between two rows.
class Saver {
 public:
  Saver(LogFolder& folder, std::string missing) : folder_(folder), missing_(std::move(missing)) {}

  void begin(const LogHeader& header, const std::string& path) {
    if (log_) return;
    if (header.joints.size() > kMaxJoints) throw LogError(path + " is of no robot");
    LogHeader first = header;
    first.part = 0;
    first.missing = missing_;
    period_ = header.period;
    TelemetryParameters all;
    all.record = RecordMode::kAlways;
    all.split_size = all.split_time = all.quota = 0;
    log_.emplace(folder_, first, all);
  }

  void add(const TraceRow& row, std::int64_t time_ns) {
    const JoinedRow joined = row.joined(period_);
    count_lost(row);
    log_->set_lost(row.lost + lost_);
    log_->set_time_offset(time_ns - stamp_of(joined));
    log_->write(joined);
    for (std::size_t node = 0; node < saved_.newest_ns.size(); ++node) {
      if ((row.parts >> node & 1U) != 0) saved_.newest_ns[node] = row.stamp_ns;
    }
    if (!row.repeats) ++saved_.rows;
  }
  void add(const LawSnapshot& snapshot, std::int64_t time_ns) {
    log_->set_time_offset(time_ns - snapshot.head.stamp_ns);
    log_->write(snapshot);
  }

  /// Rows may be missing behind the last one.
  void gap() noexcept { gap_ = true; }

  SavedBlackBox finish() {
    if (log_) log_->close();
    return saved_;
  }

  /// The result is empty if nothing is missing between the rows.
  std::string lost() const {
    if (places_.empty()) return {};
    std::string text = "records are missing at " + std::to_string(places_.size()) +
                       (places_.size() == 1 ? " place" : " places") + " of the others, " + std::to_string(lost_) +
                       " rows";
    constexpr std::size_t kShown = 5;
    for (std::size_t i = 0; i < std::min(kShown, places_.size()); ++i) {
      text += (i == 0 ? ", in the cycles " : ", ") + places_[i];
    }
    return text + (places_.size() <= kShown ? "" : ", …");
  }

 private:
  /// A gap in which a run ended does not count.
  void count_lost(const TraceRow& row) {
    if (row.repeats) return;
    const bool follows = saved_.rows != 0 && row.run_id == run_ && row.cycle > cycle_ + 1;
    if (gap_ && follows) {
      lost_ += row.cycle - cycle_ - 1;
      places_.push_back(std::to_string(cycle_ + 1) + " to " + std::to_string(row.cycle - 1));
    }
    gap_ = false;
    run_ = row.run_id;
    cycle_ = row.cycle;
  }

  LogFolder& folder_;
  std::string missing_;
  std::optional<BagLog> log_;
  double period_ = 0;
  SavedBlackBox saved_;
  bool gap_ = false;
  std::uint64_t run_ = 0, cycle_ = 0;  ///< of the last row
  std::uint64_t lost_ = 0;             ///< rows
  std::vector<std::string> places_;
};

void read_bag(const RingBag& bag, Saver& saver, const std::function<void()>& go_on) {
  const auto begin = [&](const LogHeader& header) {
    if (header.part != bag.part) throw NoTraceError(bag.path + " was overwritten meanwhile");
    saver.begin(header, bag.path);
  };
  const auto add = [&](const TraceRow& row, std::int64_t time_ns) {
    go_on();
    saver.add(row, time_ns);
  };
  const auto add_snapshot = [&](const LawSnapshot& snapshot, std::int64_t time_ns) { saver.add(snapshot, time_ns); };
  const TraceReader reader(bag.path,
                           {.header = begin, .row = add, .snapshot = add_snapshot, .damaged = [&] { saver.gap(); }});
  if (reader.of_this_version()) return;
  throw LogError(bag.path + " was written by the version " + reader.header().version + ", build " +
                 reader.header().build + ": read it with the programs that wrote it");
}

/// A bag that is overwritten meanwhile leaves a gap.
void read_ring(const Ring& ring, Saver& saver, const std::function<void()>& go_on) {
  std::optional<std::uint32_t> before;
  for (const RingBag& bag : ring.bags) {
    go_on();
    if (before && bag.part != *before + 1) saver.gap();
    before = bag.part;
    try {
      read_bag(bag, saver, go_on);
    } catch (const BagError&) {
    } catch (const NoTraceError&) {
    }
    if (bag.bytes < ring.whole_bytes || part_of(bag.path) != bag.part) saver.gap();
  }
}

/// The result is empty if nothing is missing.
std::string missing_in(const Ring& ring, const std::string& lost) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  const auto add_bags = [&](const char* what, std::uint64_t count) {
    if (count == 0) return;
    add(std::string("bags that ") + what + ": " + std::to_string(count) + " of " +
        std::to_string(ring.files + ring.absent));
  };
  add_bags("are not there", ring.absent);
  add_bags("cannot be read", ring.unreadable);
  add_bags("are cut off", static_cast<std::uint64_t>(std::ranges::count_if(
                              ring.bags, [&](const RingBag& bag) { return bag.bytes < ring.whole_bytes; })));
  if (!lost.empty()) add(lost);
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
  void empty() const {
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

}  // namespace

SavedBlackBox save_black_box(const std::string& path, const std::string& bag, const GiveUp& give_up) {
  const auto go_on = [&] {
    if (give_up && give_up()) throw SavingGivenUp("saving " + path + " was given up");
  };
  const Ring ring(path);
  Growing growing(bag);
  // Gaps between the rows are known after they were read, and stand in the header.
  std::string missing = missing_in(ring, "");
  for (bool again = false;; again = true) {
    LogFolder logs(growing.folder(), 0);
    Saver saver(logs, missing);
    try {
      read_ring(ring, saver, go_on);
    } catch (const SavingGivenUp&) {
      growing.empty();
      throw;
    }
    const std::string found = missing_in(ring, saver.lost());
    if (found != missing && !again) {
      missing = found;
      growing.empty();
      continue;
    }
    SavedBlackBox saved = saver.finish();
    if (saved.rows == 0 && missing.empty()) throw EmptyBlackBox(path + " holds no row: telemetry has received none");
    if (saved.rows == 0) throw LogError(path + " holds no record that is whole: " + missing);
    growing.finish();
    saved.missing = missing;
    return saved;
  }
}

}  // namespace robot_control
