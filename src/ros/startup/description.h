#pragma once
/// Selects the description of the robot that a node reads. All nodes use the same order, so that they agree:
///
///   1. the file of `robot/urdf` or of the plant's `~urdf` on the parameter server: explicitly requested;
///   2. `robot_description`: the user's, or what a plant published;
///   3. the file of the YAML file's `robot.urdf`.
///
/// A plant publishes the text that it has read as `robot_description` and sets `robot/urdf` to its `~urdf` for all
/// nodes. With robot.simulated_laser that text has the link of a laser (with_laser). When it ends, it restores the
/// parameter server. A text from the server has no folder. Meshes named relative to the URDF are therefore found only
/// if that text equals the file in 3. Meshes named by package:// and file:// are always found.

#include <string>
#include <vector>

#include "configuration/parameters.h"
#include "machine/machine_model.h"

namespace robot_control {

/// `urdf_requested` says that parameters.urdf came from the server. `published` is the text on the server, or empty,
/// and `name` its resolved name. Throws RobotError if a file is needed and cannot be read.
RobotDescription chosen_description(const Parameters& parameters, bool urdf_requested, const std::string& published,
                                    const std::string& name);

/// Returns a warning that the parameter `asked_for` ("/robot/urdf") took precedence over another description on the
/// server. The parameter may be left over from an earlier launch. Returns "" if the server holds no description or the
/// same one.
std::string unread_description(const RobotDescription& chosen, const std::string& published, const std::string& name,
                               const std::string& asked_for);

/// Returns what a node that does not run in the loop waits for: the description on the server, unless it is there.
std::vector<std::string> missing_description();

/// Returns the description on the server; without text if there is none.
RobotDescription published_description();

/// Deletes `~urdf` from the server: an argument of this start must not apply to the next start, whether it was refused
/// or not.
void forget_argument();

/// Publishes a plant's robot on the parameter server and restores the server when it is destroyed.
class PublishedDescription {
 public:
  /// `urdf` is the path of the file from which the robot was read, or empty.
  PublishedDescription(const MachineModel& robot, const std::string& urdf);
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
