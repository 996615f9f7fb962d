#pragma once
/// Which description of the robot a node reads. All nodes use the same order, so that they agree:
///
///   1. the file of `robot/urdf` or of the plant's `~urdf` on the parameter server: explicitly requested;
///   2. `robot_description`: the user's, or what a plant published;
///   3. the file of the YAML file's `robot.urdf`.
///
/// A plant publishes what it has read as `robot_description` and sets `robot/urdf` to its `~urdf` for all nodes; when
/// it ends, it restores the parameter server. A text from the server has no folder, so meshes named relative to the
/// URDF are found only where it is the very text of the file in 3; package:// and file:// are found always.

#include <optional>
#include <string>

#include "parameters/parameters.h"
#include "robot/robot_model.h"

namespace robot_control {

/// `urdf_requested`: parameters.urdf came from the server. `published`: the text on the server, or empty;
/// `name`: its resolved name. Throws RobotError where a file is needed and cannot be read.
RobotDescription chosen_description(const Parameters& parameters, bool urdf_requested, const std::string& published,
                                    const std::string& name);

/// Says that `asked_for` ("/robot/urdf"), perhaps left over from an earlier launch, went before another description on
/// the server; empty where that is none or the same.
std::string unread_description(const RobotDescription& chosen, const std::string& published, const std::string& name,
                               const std::string& asked_for);

/// Takes `~urdf` off the server: an argument of this start, refused or not, is not one of the next start.
void forget_argument();

/// What a plant leaves on the parameter server while it lives.
class PublishedDescription {
 public:
  /// `urdf`: path the robot was read from, if it was a file.
  PublishedDescription(const RobotModel& robot, const std::string& urdf);
  ~PublishedDescription();
  PublishedDescription(const PublishedDescription&) = delete;
  PublishedDescription& operator=(const PublishedDescription&) = delete;

 private:
  bool changed_description_ = false;
  bool changed_urdf_ = false;
  std::string description_before_;
  std::string urdf_before_;
};

}  // namespace robot_control
