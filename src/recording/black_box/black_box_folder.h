#pragma once
/// The files beside a black box that is written:
///
///   ring          it
///   ring.before   the one before, whose writer has ended orderly
///   stop.N.bag    what it held some seconds after a latched stop
///   crash.N.bag   what one held whose writer did not end orderly, or had no time to save a stop; until it is saved,
///                 crash.N.ring
///
/// The higher N, the newer. Of stops and of crashes the newest `keep` are kept.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "recording/black_box/saved_black_box.h"

namespace robot_control {

enum class IncidentKind { kStop, kCrash };

struct SavedIncident {
  std::string bag;      ///< its path
  std::string missing;  ///< SavedBlackBox::missing
};

class BlackBoxFolder {
 public:
  /// `keep` 0: incidents are not saved.
  BlackBoxFolder(std::string folder, std::size_t keep) : folder_(std::move(folder)), keep_(keep) {}

  std::string ring() const;

  /// Makes the folder and gives an earlier ring another name. Throws LogError: it is in use, or cannot be renamed.
  void put_ring_aside();

  /// crash.N.ring, oldest first.
  std::vector<std::string> unsaved() const;

  /// Writes what `ring` holds to the next bag of this kind, of a crash to that of its number; removes the oldest.
  /// Throws LogError; then no bag is there. Throws SavingGivenUp.
  SavedIncident save(const std::string& ring, IncidentKind kind, std::uint64_t build, const GiveUp& give_up = {}) const;

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
