#include "machine/description/urdf_document.h"

#include <console_bridge/console.h>
#include <tinyxml.h>
#include <urdf_parser/urdf_parser.h>

#include <mutex>

#include "machine/description/markup/elements.h"
#include "machine/description/markup/urdf_markup.h"

namespace robot_control {
namespace {

class CapturedConsole final : public console_bridge::OutputHandler {
 public:
  CapturedConsole() : previous_(console_bridge::getOutputHandler()) { console_bridge::useOutputHandler(this); }
  ~CapturedConsole() override { console_bridge::useOutputHandler(previous_); }
  CapturedConsole(const CapturedConsole&) = delete;
  CapturedConsole& operator=(const CapturedConsole&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    if (!errors_.empty()) errors_ += "; ";
    errors_ += text;
  }
  const std::string& errors() const { return errors_; }

 private:
  console_bridge::OutputHandler* previous_;
  std::string errors_;
};

std::string printed(const TiXmlElement& element) {
  TiXmlPrinter printer;
  printer.SetStreamPrinting();
  element.Accept(&printer);
  return printer.Str();
}

urdf::ModelInterfaceSharedPtr parsed_by_urdfdom(const std::string& text, std::string& errors) {
  // console_bridge has one output per process.
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  CapturedConsole console;
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(text);
    errors = console.errors();
  } catch (const std::exception& error) {
    errors = error.what();
  }
  return model;
}

std::vector<std::string> names_of(const TiXmlElement& robot, const char* kind) {
  std::vector<std::string> names;
  for (const TiXmlElement* element : children(robot, kind)) names.emplace_back(element->Attribute("name"));
  return names;
}

}  // namespace

UrdfDocument parse_urdf(const RobotDescription& description) {
  TiXmlDocument xml;
  TiXmlElement& robot = parse_markup(description, xml);
  UrdfDocument document;
  document.source = description.source;
  document.free_root = take_free_root(robot);
  document.driven = driven_joints(robot);
  document.unsaid_axes = unsaid_axes(robot);
  document.turned_origins = turned_origins(robot);
  document.sideways_names = sideways_names(robot);
  document.sideways_plugins = plugins_that_say(robot, kSidewaysWords);
  document.steering_plugins = plugins_that_say(robot, kSteeringWords);
  repair_markup(robot);

  std::string errors;
  document.model = parsed_by_urdfdom(printed(robot), errors);
  if (!document.model || !errors.empty()) {
    refuse(description.source, "<robot>", errors.empty() ? "the URDF parser (urdfdom) rejects it" : errors,
           "Check the element against http://wiki.ros.org/urdf/XML");
  }
  document.joint_order = names_of(robot, "joint");
  document.link_order = names_of(robot, "link");
  return document;
}

}  // namespace robot_control
