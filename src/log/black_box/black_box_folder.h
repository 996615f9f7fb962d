#pragma once
/// A black box that is written has these files beside it:
///
///   ring          the black box, a folder (black_box.h)
///   ring.before   the black box before it, whose writer ended orderly
///   stop.N.bag    its contents some seconds after a latched stop
///   crash.N.bag   the contents of one whose writer was killed, or had no time to save a stop
///   crash.N.ring  the same, not saved yet
///
/// A higher N is newer. The newest `keep` stops and the newest `keep` crashes are kept.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "log/black_box/saved_black_box.h"

namespace robot_control {

/// This file in a ring marks an orderly end.
inline constexpr const char* kEndedMark = "ended";

enum class IncidentKind { kStop, kCrash };

struct SavedIncident {
  std::string bag;      ///< path of the bag
  std::string missing;  ///< SavedBlackBox::missing
};

class BlackBoxFolder {
 public:
  /// If `keep` is 0, incidents are not saved.
  BlackBoxFolder(std::string folder, std::size_t keep) : folder_(std::move(folder)), keep_(keep) {}

  std::string ring() const;

  /// Makes the folder and renames an earlier ring. Throws LogError if that is in use or cannot be renamed.
  void put_ring_aside();

  /// The paths of crash.N.ring, oldest first.
  std::vector<std::string> unsaved() const;

  /// Writes the contents of `ring` to the next bag of this kind; a crash keeps its number. Removes the oldest. If it
  /// throws LogError, there is no bag. Throws SavingGivenUp.
  SavedIncident save(const std::string& ring, IncidentKind kind, const GiveUp& give_up = {}) const;

 private:
  struct File {
    std::uint64_t number;
    std::string path;
  };
  std::vector<File> files(IncidentKind kind, const std::string& suffix) const;
  std::string name(IncidentKind kind, std::uint64_t number, const std::string& suffix) const;
  std::uint64_t next(IncidentKind kind) const;
  void remove_oldest(IncidentKind kind) const;

  std::string folder_;
  std::size_t keep_;
};

}  // namespace robot_control
