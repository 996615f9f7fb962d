#include "robot/urdf_document.h"

#include <console_bridge/console.h>
#include <tinyxml.h>
#include <urdf_parser/urdf_parser.h>

#include <mutex>

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

void check_markup(const RobotDescription& description, TiXmlDocument& xml) {
  xml.Parse(description.text.c_str());
  if (xml.Error()) {
    const std::string line = xml.ErrorRow() > 0 ? " line " + std::to_string(xml.ErrorRow()) : "";
    refuse(description.source + line, "XML", xml.ErrorDesc(), "Mend the markup");
  }
  if (xml.FirstChildElement("robot") == nullptr) {
    refuse(description.source, "<robot>", "there is no such element",
           "Give a URDF, whose outermost element is <robot>");
  }
}

}  // namespace

void refuse(const std::string& source, const std::string& element, const std::string& what, const std::string& remedy) {
  // TinyXML's sentences bring their full stop along.
  const std::string sentence = what.substr(0, what.find_last_not_of('.') + 1);
  throw RobotError(source + ": " + element + ": " + sentence + ". " + remedy + ".");
}

UrdfDocument parse_urdf(const RobotDescription& description) {
  TiXmlDocument xml;
  check_markup(description, xml);

  // console_bridge has one output per process.
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  CapturedConsole console;
  UrdfDocument document{description.source, urdf::parseURDF(description.text), {}};
  if (!document.model || !console.errors().empty()) {
    refuse(description.source, "<robot>", console.errors().empty() ? "urdfdom refuses it" : console.errors(),
           "See http://wiki.ros.org/urdf/XML");
  }
  for (const TiXmlElement* joint = xml.FirstChildElement("robot")->FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    document.joint_order.emplace_back(joint->Attribute("name"));
  }
  return document;
}

}  // namespace robot_control
