#include "drivers/unitree/unitree_front.h"
#include "drivers/unitree_go/unitree_go_file.h"

namespace robot_control {

std::unique_ptr<DeviceFront> make_unitree_go_front(const DriveFile& file, FrontSetup setup) {
  std::unique_ptr<DatagramLine> line;
  if (setup.line) line = std::get<std::unique_ptr<DatagramLine>>(std::move(*setup.line));
  return std::make_unique<UnitreeFront<Go2>>(dynamic_cast<const UnitreeGoFile&>(file).parameters(),
                                             file.request().period(), setup.seed, std::move(line));
}

}  // namespace robot_control
