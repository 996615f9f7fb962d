#include "drivers/unitree_legged/unitree_legged_front.h"

#include "drivers/unitree_legged/unitree_legged_file.h"

namespace robot_control {

std::unique_ptr<DeviceFront> make_unitree_legged_front(const DriveFile& file, FrontSetup setup) {
  std::unique_ptr<DatagramLine> line;
  if (setup.line) line = std::get<std::unique_ptr<DatagramLine>>(std::move(*setup.line));
  return std::make_unique<UnitreeLeggedFront>(dynamic_cast<const UnitreeLeggedFile&>(file).parameters(),
                                              file.request().period(), setup.seed, std::move(line));
}

}  // namespace robot_control
