#pragma once
/// The black box is the log as a ring of short bags, which outlives a kill of all nodes.
///
///   folder/N.bag  a bag of a fixed size: its begin (connections, header), a chunk for each `flush`, then zeros
///
/// `flush` writes into the kernel's page cache. That survives the end of the process by any signal, and reaches the
/// disk with the next writeback. A kill leaves at most one incomplete chunk, the last one. The space of all
/// bags is reserved at the start, so that no flush meets a full disk. The oldest bag is filled with zeros and written
/// again; TraceHeader::part gives their order. The folder is locked while it is written; the lock of a killed process
/// ends with it. The file `ended` marks an orderly end.
///
/// A dead node would delay the join. A cycle is written without a node once another one is `kWindow` ahead.

#include <cstdint>
#include <string>

#include "files/descriptor.h"
#include "log/log_chunk.h"
#include "log/rows/join.h"
#include "signals/law_snapshot.h"

namespace robot_control {

class BlackBox {
 public:
  /// The least size of a bag. It has at least a thousandth of the ring, and four times the header.
  static constexpr std::size_t kBagBytes = std::size_t{2} << 20U;
  static constexpr double kWindow = 0.25;  ///< s; a ring of a node is found within 0.1 s

  /// Makes the folder with room for the newest `bytes`. Throws LogError if it cannot be made, or if the disk has no
  /// room; then nothing is left of it.
  BlackBox(const std::string& folder, std::size_t bytes, const LogHeader& header);
  BlackBox(const BlackBox&) = delete;
  BlackBox& operator=(const BlackBox&) = delete;

  /// Adds the row of one node.
  template <class Row>
  void add(const Row& row) {
    join_.add(row);
  }

  /// A snapshot comes before the row to which it belongs.
  void add(const LawSnapshot& snapshot) { chunk_.add(snapshot); }

  /// Hands what was added to the kernel. All rows that the nodes have written by one moment were added before.
  void flush();

  /// The following holds for the rows that are joined from now on: ROS time − stamps, ns, and the number of rows that
  /// were lost before they were added.
  void set_state(std::int64_t time_offset_ns, std::uint64_t lost) noexcept;

  /// Sets the header of the bags that begin from now on. Joints and period must stay the same.
  void set_header(const LogHeader& header);

  /// Joins and hands over what still waits; nothing may be added afterwards.
  void finish();

  /// Marks an orderly end.
  void mark_ended() const noexcept;

  /// False: the folder or the present bag was removed or replaced, or cannot be written.
  bool sound() const noexcept;

  /// The time between the oldest and the newest row, s.
  double seconds_added() const noexcept { return static_cast<double>(newest_ns_ - first_ns_) * 1e-9; }

  /// The seconds of rows that the bags can hold at the rate so far; 0: not known yet.
  double seconds_held() const noexcept;

 private:
  void make_bags();
  void write(const JoinedRow& row);
  void write_chunk();
  bool begin_bag(std::int64_t time_ns);
  bool append(std::string_view bytes);

  std::string folder_;
  Descriptor lock_;  ///< of the folder
  LogHeader header_;
  std::size_t bag_bytes_ = 0;
  std::size_t bags_ = 0;
  Descriptor bag_;           ///< the present one
  std::uint64_t begun_ = 0;  ///< number of bags that were begun
  std::size_t at_ = 0;       ///< position in the present bag
  bool failed_ = false;
  LogChunk chunk_;
  std::uint64_t lost_ = 0;
  std::int64_t first_ns_ = 0;  ///< stamp of the first row; 0: there is none
  std::int64_t newest_ns_ = 0;
  Join join_;
  std::size_t window_;  ///< rows
};

}  // namespace robot_control
