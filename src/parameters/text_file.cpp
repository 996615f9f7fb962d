#include "parameters/text_file.h"

#include "files/given_path.h"
#include "files/input_file.h"

namespace robot_control {

std::optional<std::string> read_text_file(const std::string& path, std::size_t max_bytes, const std::string& remedy,
                                          ProblemList& problems) {
  InputFile file = read_input_file(path, max_bytes);
  if (file.problem.empty()) return std::move(file.text);
  problems.add({"", "", file_error(path, file.problem), "", remedy});
  return std::nullopt;
}

}  // namespace robot_control
