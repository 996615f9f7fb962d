#pragma once
/// The keeper writes the black box of a robot and saves its incidents as bags.
///
/// It saves the contents of the black box some seconds after a latched stop, and those that a killed telemetry left. A
/// thread of the lowest priority writes the bags, one at a time.

#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "log/black_box/black_box.h"
#include "log/black_box/black_box_folder.h"
#include "log/black_box/saved_black_box.h"

namespace robot_control {

/// A black box is saved `kTimeAfterStop` after a latched stop. A further stop before that time is saved with it. The
/// delay is at most `kMaxDelay` after the first stop, so that the rows before that one are still present.
///
/// A stop is latched when causes appear and there were none. Causes in the first update were latched before.
class IncidentWatch {
 public:
  static constexpr std::int64_t kTimeAfterStop = 5'000'000'000;  ///< ns; the oscillation after the stop has ended
  static constexpr std::int64_t kMaxDelay = 30'000'000'000;      ///< ns; a black box holds a minute or more

  /// `causes` are the present Permit::causes; true: there is a new stop.
  bool update(std::uint64_t causes, std::int64_t now_ns) noexcept;

  /// True: there was a stop that is not saved.
  bool pending() const noexcept { return causes_to_save_ != 0; }

  bool due(std::int64_t now_ns) const noexcept { return pending() && now_ns >= due_ns_; }

  /// Returns the causes of the stops that are saved now, and forgets them.
  std::uint64_t clear() noexcept { return std::exchange(causes_to_save_, 0); }

 private:
  bool seen_ = false;
  std::uint64_t causes_ = 0;
  std::uint64_t causes_to_save_ = 0;
  std::int64_t latest_ns_ = 0;  ///< latest time at which saving is due
  std::int64_t due_ns_ = 0;
};

class BlackBoxKeeper {
 public:
  static constexpr std::int64_t kRetryNs = 10'000'000'000;
  static constexpr double kMinHeldTime = 60;  ///< s of rows; a smaller black box is reported
  static constexpr double kRateKnown = 10;    ///< s of rows after which the rate is known

  /// Makes a black box of `bytes` in `folder` and keeps the newest `keep` incidents of each kind. Throws LogError.
  BlackBoxKeeper(const std::string& folder, std::size_t bytes, std::size_t keep, LogHeader header);
  ~BlackBoxKeeper() { ends_.store(true); }
  BlackBoxKeeper(const BlackBoxKeeper&) = delete;
  BlackBoxKeeper& operator=(const BlackBoxKeeper&) = delete;

  /// These call the functions of the BlackBox if there is a ring.
  template <class Record>
  void add(const Record& record) {
    if (box_ != nullptr) box_->add(record);
  }
  void flush() {
    if (box_ != nullptr) box_->flush();
  }
  void set_state(std::int64_t time_offset_ns, std::uint64_t lost) noexcept {
    if (box_ != nullptr) box_->set_state(time_offset_ns, lost);
  }
  void set_header(const LogHeader& header);

  std::string path() const { return folder_.ring(); }

  /// `causes` are the present Permit::causes; `now_ns` is on any clock that runs.
  void watch(std::uint64_t causes, std::int64_t now_ns) noexcept { watch_.update(causes, now_ns); }

  /// The caller calls this at 10 Hz; it begins to save what is due. If the ring was removed, another one is made; after
  /// a failure it is tried again every `kRetryNs`.
  void poll(std::int64_t now_ns);

  /// Ends the keeper. The thread gives up what it is saving. A stop that is not saved yet is saved here, with the
  /// priority of the caller, and the ring is marked as ended orderly. If `late` becomes true first, the ring is not
  /// marked, and the next keeper of this folder saves it as a crash.
  void finish(const GiveUp& late = {});

  std::uint64_t saved() const noexcept { return saved_; }

  /// Returns sentences about what was saved, or could not be saved, since the last call.
  std::vector<std::string> take_notes() { return std::exchange(notes_, {}); }

 private:
  struct Outcome {
    bool saved = false;
    bool given_up = false;
    std::string note;
  };
  void make_box() { box_ = std::make_unique<BlackBox>(folder_.ring(), bytes_, header_); }
  void check_ring(std::int64_t now_ns);
  void check_size();
  Outcome save(const std::string& ring, IncidentKind kind, const std::string& why, const GiveUp& give_up) const;
  void begin(const std::string& ring, IncidentKind kind, const std::string& why);
  bool finish_saving();
  void report(Outcome outcome);

  BlackBoxFolder folder_;
  std::size_t keep_;
  std::size_t bytes_;
  LogHeader header_;
  std::unique_ptr<BlackBox> box_;  ///< null: the ring was removed, and no other could be made
  IncidentWatch watch_;
  std::vector<std::string> unsaved_;  ///< rings of crashes, oldest first
  std::string saving_;                ///< causes of the stop that is saved; empty: none is
  std::atomic<bool> ends_{false};
  std::future<Outcome> outcome_;  ///< outcome of the thread; its destructor waits for the thread
  std::int64_t check_ns_ = 0;     ///< time at which the ring is checked again
  bool absent_ = false;           ///< true: the missing ring is reported
  bool size_checked_ = false;
  std::uint64_t saved_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace robot_control
