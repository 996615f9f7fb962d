#include "drivers/table/read_drive_file.h"

#include <functional>

#include "configuration/loop_parameters.h"
#include "configuration/peer_file.h"
#include "drivers/table/drive_table.h"
#include "parameters/tree_reader.h"

namespace robot_control {
namespace {

constexpr const char* kEveryJoint = "every_joint";
constexpr const char* kDialect = "bus.dialect";

std::string block_of(const std::string& path) {
  return path.substr(0, path.find('.'));
}

/// Moves the block out of the tree.
ParameterTree extracted(ParameterTree& tree, std::string_view block) {
  ParameterTree part;
  std::erase_if(tree.entries, [&](const auto& entry) {
    if (block_of(entry.first) != block) return false;
    part.entries.insert(entry);
    return true;
  });
  std::erase_if(tree.blocks, [&](const BlockEntry& entry) {
    if (entry.name != block) return false;
    part.blocks.push_back(entry);
    return true;
  });
  return part;
}

/// The row of this driver; where several drives share it, that of the dialect, else the first one.
const DriveRow& row_of(std::string_view driver, const ParameterTree& tree) {
  const auto dialect = tree.entries.find(kDialect);
  const DriveRow* found = nullptr;
  for (const DriveRow& row : kDriveRows) {
    if (row.driver != driver) continue;
    const bool named = dialect != tree.entries.end() && dialect->second.text == row.name;
    if (found == nullptr || named) found = &row;
  }
  return *found;
}

class JointProblems final : public JointValues {
 public:
  JointProblems(std::string joint, const std::string& path, GivenValues& given, ProblemList& problems)
      : joint_(std::move(joint)), path_(path), given_(given), problems_(problems) {}

  bool accepted(const std::string& key) const override { return given_.accepted(joint_ + "." + key); }
  void refuse(const std::string& key, const std::string& rule, const std::string& remedy) override {
    const std::string path = joint_ + "." + key;
    if (given_.accepted(path)) return given_.refuse(path, rule, remedy);
    if (!given_.refused(path)) problems_.add({path, "", rule, path_, remedy});
  }

 private:
  std::string joint_;
  const std::string& path_;
  GivenValues& given_;
  ProblemList& problems_;
};

/// A DriveFileReader collects the problems of one file.
class DriveFileReader {
 public:
  DriveFileReader(const std::string& path, DriveFile& file, ParameterTree tree, ProblemList& problems)
      : path_(path), file_(file), problems_(problems), tree_(std::move(tree)) {}

  void read_line() {
    read(extracted(tree_, file_.line_block()), {{file_.line_block(), file_.line_keys()}},
         [&](GivenValues& given) { file_.check_line(given); });
  }

  void read_joints() {
    const std::vector<std::string>& names = file_.request().joints;
    Block every{kEveryJoint, file_.every_keys()};
    for (Key& key : every.keys) key.traits |= kOptional;
    const ParameterTree common = extracted(tree_, kEveryJoint);
    read(common, {every}, [](GivenValues&) {});
    file_.begin_joints();
    std::vector<Block> blocks;
    for (std::size_t i = 0; i < names.size(); ++i) {
      blocks.push_back({names[i], file_.joint_keys(i)});
      for (Key& key : blocks.back().keys) {
        if (common.entries.contains(path_of(every, key))) key.traits |= kOptional;
      }
    }
    read(std::move(tree_), std::move(blocks), [&](GivenValues& given) {
      for (std::size_t i = 0; i < names.size(); ++i) {
        JointProblems joint(names[i], path_, given, problems_);
        file_.check_joint(i, joint);
      }
    });
  }

 private:
  void read(ParameterTree tree, std::vector<Block> blocks, const std::function<void(GivenValues&)>& check) {
    const Schema schema{.blocks = std::move(blocks), .check = [&](const Schema&, GivenValues& given) { check(given); }};
    read_blocks(std::move(tree), schema, schema.blocks, path_, problems_);
  }

  const std::string& path_;
  DriveFile& file_;
  ProblemList& problems_;
  ParameterTree tree_;
};

/// With `joints` their blocks are read, too.
std::unique_ptr<DriveFile> read_file(const std::string& path, std::string_view driver, DriveFileRequest request,
                                     bool joints) {
  const std::string subject = "drive file refused (" + path + ")";
  ProblemList problems;
  ParameterTree tree = read_tree(path, {}, problems, &peer_problem);
  if (tree.blocks.empty() && problems.empty()) problems.add({path, "", "holds no blocks", "", ""});
  if (tree.blocks.empty()) problems.throw_if_any(subject);
  const DriveRow& row = row_of(driver == word_of(DriverName::kMujoco) ? "can" : driver, tree);
  const auto dialect = tree.entries.find(kDialect);
  const bool known = row.name == row.driver || (dialect != tree.entries.end() && dialect->second.text == row.name);
  request.drive = row.name;
  request.min_rate = kMinRate;
  std::unique_ptr<DriveFile> file = row.make_file(std::move(request));
  DriveFileReader reader(path, *file, std::move(tree), problems);
  reader.read_line();
  if (!known || !joints) problems.throw_if_any(subject);
  if (!joints) return file;
  reader.read_joints();
  problems.throw_if_any(subject);
  if (const auto overload = file->overload())
    problems.add({std::string(file->line_block()) + "." + overload->key, overload->value, overload->rule, path, ""});
  problems.throw_if_any(subject);
  return file;
}

}  // namespace

std::unique_ptr<DriveFile> read_drive_file(const std::string& path, std::string_view driver, DriveFileRequest request) {
  return read_file(path, driver, std::move(request), true);
}

std::unique_ptr<DriveFile> read_drive_line(const std::string& path, std::string_view driver) {
  return read_file(path, driver, {.joints = {}}, false);
}

std::unique_ptr<DriveFile> read_drive_file(const Parameters& parameters, std::vector<std::string> joints) {
  return read_drive_file(parameters.drives, word_of(parameters.driver),
                         {.joints = std::move(joints),
                          .rate = parameters.loop.rate,
                          .takes_speeds = parameters.robot.wheel_command == WheelCommand::kVelocity});
}

}  // namespace robot_control
