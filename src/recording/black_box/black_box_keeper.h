#pragma once
/// The black box of a robot, and its incidents: what it holds some seconds after a latched stop is saved as a bag, and
/// so is that of a telemetry that was killed. A thread of the lowest priority writes them, one at a time.

#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "recording/black_box/black_box.h"
#include "recording/black_box/black_box_folder.h"
#include "recording/black_box/incident_watch.h"
#include "recording/black_box/saved_black_box.h"

namespace robot_control {

class BlackBoxKeeper {
 public:
  static constexpr std::int64_t kRetryNs = 10'000'000'000;
  static constexpr std::int64_t kHeaderNs = 10'000'000'000;
  static constexpr double kPromised = 60;   ///< s of rows; a smaller one is named
  static constexpr double kRateKnown = 10;  ///< s of rows, after which it is known how many it holds

  /// Of `bytes` in `folder`, with the newest `keep` incidents of each kind. Throws LogError.
  BlackBoxKeeper(const std::string& folder, std::size_t bytes, std::size_t keep, std::uint64_t build,
                 const LogHeader& header);
  ~BlackBoxKeeper();
  BlackBoxKeeper(const BlackBoxKeeper&) = delete;
  BlackBoxKeeper& operator=(const BlackBoxKeeper&) = delete;

  /// As BlackBox::add; nothing where there is no ring just now.
  template <class Record>
  void add(const Record& record) noexcept {
    if (box_ != nullptr) box_->add(record);
  }
  void add_state(std::int64_t time_offset_ns, std::uint64_t lost) noexcept {
    if (box_ != nullptr) box_->add_state(time_offset_ns, lost);
  }
  std::string path() const { return folder_.ring(); }

  /// What holds from now on. The ring gets it every `kHeaderNs`, so that what it holds can begin with it.
  void set_header(const LogHeader& header);

  /// Permit::causes of now; `now_ns` on any clock that runs.
  void see(std::uint64_t causes, std::int64_t now_ns) noexcept { watch_.see(causes, now_ns); }

  /// At 10 Hz: begins what is due. Where the ring is not at its path any more, another one is made, and tried again
  /// every `kRetryNs`.
  void poll(std::int64_t now_ns);

  /// The end: what the thread is saving is given up; a stop that waits for what follows, or was given up, is saved
  /// here, with the priority of the caller, and the ring is marked as ended orderly. Where `late` becomes true first,
  /// the ring is not marked: the next keeper of this folder saves it, as that of a crash.
  void finish(const GiveUp& late = {});

  std::uint64_t saved() const noexcept { return saved_; }

  /// Sentences about what was saved, or could not be, since the last call.
  std::vector<std::string> take_notes() { return std::exchange(notes_, {}); }

 private:
  struct Outcome {
    bool saved = false;
    bool given_up = false;
    std::string note;
  };
  void make_box();
  void look_for_box(std::int64_t now_ns);
  void look_at_size();
  Outcome save(const std::string& ring, IncidentKind kind, const std::string& why, const GiveUp& give_up) const;
  void begin(const std::string& ring, IncidentKind kind, const std::string& why);
  bool take_outcome();
  void note(Outcome outcome);

  BlackBoxFolder folder_;
  std::size_t keep_;
  std::uint64_t build_;
  std::size_t bytes_;
  LogHeader header_;
  std::string encoded_;            ///< header_
  std::int64_t header_ns_ = 0;     ///< when the ring gets it again
  std::unique_ptr<BlackBox> box_;  ///< null: it was removed, and no other could be made
  IncidentWatch watch_;
  std::vector<std::string> unsaved_;  ///< oldest first
  std::string saving_;                ///< why, where it is a stop
  std::atomic<bool> ends_{false};
  std::future<Outcome> outcome_;  ///< of what the thread saves; its destructor waits for the thread
  std::int64_t look_ns_ = 0;      ///< when to look for the ring again
  bool absent_ = false;           ///< and said
  bool size_looked_at_ = false;
  std::uint64_t saved_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace robot_control
