#include "machine/description/markup/urdf_markup.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <string_view>

#include "files/message_text.h"
#include "machine/description/markup/elements.h"
#include "machine/description/markup/free_root.h"
#include "machine/description/urdf_document.h"
#include "machine/description/wording.h"

namespace robot_control {
namespace {

std::string at_line(const RobotDescription& description, const TiXmlBase& place) {
  return description.source + (place.Row() > 0 ? " line " + std::to_string(place.Row()) : "");
}

void check_name(const RobotDescription& description, const TiXmlElement& element) {
  const char* const name = element.Attribute("name");
  if (name == nullptr || *name != 0) return;
  refuse(at_line(description, element), "<" + element.ValueStr() + ">", "its name is empty", "Set its name");
}

void check_joint(const RobotDescription& description, const TiXmlElement& joint, const TiXmlElement* free_one) {
  if (&joint == free_one) return;
  const std::string type = attribute(joint, "type");
  const std::string element = joint_element(attribute(joint, "name"));
  const std::string remedy = "Set type to fixed, revolute, continuous or prismatic";
  if (is_free(joint)) {
    refuse(at_line(description, joint), element,
           "a " + type + " joint is supported only as the single joint of an empty root link", remedy);
  }
  if (type != "fixed" && type != "revolute" && type != "continuous" && type != "prismatic") {
    refuse(at_line(description, joint), element, "type=\"" + type + "\" is unknown", remedy);
  }
  if ((type == "revolute" || type == "prismatic") && joint.FirstChildElement("limit") == nullptr) {
    refuse(at_line(description, joint), element, "a " + type + " joint has no <limit>",
           type == "revolute" ? "Add <limit lower upper effort velocity>, or make it type=\"continuous\""
                              : "Add <limit lower upper effort velocity>");
  }
}

void check_tree(const RobotDescription& description, const TiXmlElement& robot) {
  struct Above {
    std::string joint, parent;
  };
  std::map<std::string, Above> above;
  for (const TiXmlElement* joint : children(robot, "joint")) {
    const TiXmlElement* child = joint->FirstChildElement("child");
    const TiXmlElement* parent = joint->FirstChildElement("parent");
    if (child == nullptr || parent == nullptr) continue;
    const std::string link = attribute(*child, "link");
    const auto [other, first] = above.emplace(link, Above{attribute(*joint, "name"), attribute(*parent, "link")});
    if (!first) {
      refuse(at_line(description, *joint), joint_element(attribute(*joint, "name")),
             "its child \"" + link + "\" is already the child of joint \"" + other->second.joint + "\"",
             "Set one parent for each link: a URDF is a tree");
    }
  }
  // Links are removed from the ends of the tree upwards; a ring has no end. (urdfdom would never free one.)
  std::map<std::string, std::size_t> hanging;
  for (const auto& [link, place] : above) ++hanging[place.parent];
  std::vector<std::string> ends;
  for (const auto& [link, place] : above) {
    if (!hanging.contains(link)) ends.push_back(link);
  }
  while (!ends.empty()) {
    const auto end = above.find(ends.back());
    ends.pop_back();
    const std::string parent = end->second.parent;
    above.erase(end);
    if (--hanging[parent] == 0 && above.contains(parent)) ends.push_back(parent);
  }
  if (!above.empty()) {
    const std::string& first = above.begin()->first;
    std::string link = first, cycle = first;
    do {
      link = above.at(link).parent;
      cycle = link + " → " + cycle;
    } while (link != first);
    refuse(description.source, joint_element(above.begin()->second.joint), "cycle in the joint tree: " + cycle,
           "Set another <parent> for one of these joints: a URDF is a tree");
  }
}

/// TinyXML descends by recursion, so the depth is bounded.
void check_depth(const RobotDescription& description) {
  const std::string& text = description.text;
  int depth = 0;
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    if (text.compare(i, 4, "<!--") == 0) {
      i = std::min(text.find("-->", i), text.size());
    } else if (text.compare(i, 2, "</") == 0 || text.compare(i, 2, "/>") == 0) {
      --depth;
    } else if (text[i] == '<' && text[i + 1] != '!' && text[i + 1] != '?' && ++depth > kDeepest) {
      refuse(description.source, "XML", "elements are nested " + std::to_string(kDeepest) + " deep",
             "Check that each element is closed; a URDF needs five levels");
    }
  }
}

/// urdfdom passes its messages, which contain text of the file, to printf as the format.
void check_percent(const RobotDescription& description, const TiXmlElement& element) {
  for (const TiXmlAttribute* given = element.FirstAttribute(); given != nullptr; given = given->Next()) {
    const std::string text = std::string(given->Name()) + "=\"" + given->Value() + "\"";
    if (std::string(given->Name()) == "filename" || text.find('%') == std::string::npos) continue;
    refuse(at_line(description, element), "<" + element.ValueStr() + ">", text + " contains a percent sign",
           "Remove it: names and numbers have none");
  }
  for (const TiXmlElement* child : children(element)) check_percent(description, *child);
}

/// Elements of xacro stand for links and joints that would be missing.
void check_expanded(const RobotDescription& description, const TiXmlElement& robot) {
  for (const TiXmlElement* child : children(robot)) {
    if (!child->ValueStr().starts_with("xacro:")) continue;
    refuse(at_line(description, *child), "<" + child->ValueStr() + ">", "it is xacro, which is not expanded in a URDF",
           "Rename the file to .xacro, or expand it: xacro FILE > robot.urdf");
  }
}

void check_size(const RobotDescription& description, const TiXmlElement& robot) {
  std::size_t links = 0, shapes = 0;
  for (const TiXmlElement* link : children(robot, "link")) {
    ++links;
    for (const TiXmlElement* part : children(*link))
      shapes += part->ValueStr() == "collision" || part->ValueStr() == "visual" ? 1 : 0;
  }
  if (links > kMaxLinks)
    refuse(description.source, "<robot>", std::to_string(links) + " links",
           "Merge links that are fixed to each other; the limit is " + std::to_string(kMaxLinks));
  if (shapes > kMaxShapes)
    refuse(description.source, "<robot>", std::to_string(shapes) + " shapes",
           "Replace them with simpler shapes; the limit is " + std::to_string(kMaxShapes));
}

std::set<std::string> words(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == ',' || c == ';'; }, ' ');
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

bool says_drive(const std::string& text) {
  return lower_case(text).find("drive") != std::string::npos;
}

void add_plugin_joints(const TiXmlElement& element, bool drive, std::set<std::string>& joints) {
  for (const TiXmlElement* child : children(element)) {
    add_plugin_joints(*child, drive, joints);
    if (child->GetText() == nullptr) continue;
    if (drive || says_left(child->Value()) || says_right(child->Value())) joints.merge(words(child->GetText()));
  }
}

void add_gazebo_joints(const TiXmlElement& element, std::set<std::string>& joints) {
  for (const TiXmlElement* plugin : children(element, "plugin")) {
    add_plugin_joints(*plugin, says_drive(attribute(*plugin, "name") + attribute(*plugin, "filename")), joints);
  }
}

void add_plugins_that_say(const TiXmlElement& element, const std::vector<std::string>& words,
                          std::set<std::string>& plugins) {
  for (const TiXmlElement* child : children(element)) {
    if (child->ValueStr() != "plugin") {
      add_plugins_that_say(*child, words, plugins);
      continue;
    }
    const std::string file = attribute(*child, "filename"), name = attribute(*child, "name");
    const std::string text = child->GetText() == nullptr ? "" : child->GetText();
    const std::string said = lower_case(file + " " + name + " " + text);
    const bool says = std::any_of(words.begin(), words.end(),
                                  [&](const std::string& word) { return said.find(word) != std::string::npos; });
    if (says) plugins.insert(!file.empty() ? file : !name.empty() ? name : text);
  }
}

/// Refuses text that TinyXML would misread or ignore.
void check_text(const RobotDescription& description) {
  const std::string& text = description.text;
  const std::string source = description.source;
  if (is_lfs_pointer(text)) refuse(source, "URDF", kLfsPointer, kLfsRemedy);
  const bool marked = text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff");
  const std::string_view start = std::string_view(text).substr(0, 4);
  const std::string_view little("<\0", 2), big("\0<", 2);
  if (marked || start.find(little) != std::string_view::npos || start.find(big) != std::string_view::npos) {
    refuse(source, "XML", "it is UTF-16, not UTF-8", "Save it as UTF-8: iconv -f UTF-16 -t UTF-8 FILE");
  }
  if (const std::size_t at = text.find('\0'); at != std::string::npos) {
    refuse(source, "XML", "it contains a NUL character at byte " + std::to_string(at), "Check that the file is text");
  }
  if (const std::size_t at = utf8_end(text); at != text.size()) {
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    refuse(source + " line " + std::to_string(line), "XML", printable(text.substr(at, 1)) + " is not UTF-8",
           "Save it as UTF-8, for instance iconv -f ISO-8859-1 -t UTF-8 FILE");
  }
  for (std::size_t i = text.find("<!"); i != std::string::npos; i = text.find("<!", i + 2)) {
    if (text.compare(i, 4, "<!--") == 0) {
      i = std::min(text.find("-->", i), text.size() - 2);
    } else if (text.compare(i, 8, "<!ENTITY") == 0) {
      refuse(source, "<!ENTITY>", "it defines entities, which are not supported",
             "Replace them with their text, or use xacro");
    }
  }
}

void remove(TiXmlElement& parent, const char* name) {
  for (TiXmlElement* child : children(parent, name)) parent.RemoveChild(child);
}

bool three_numbers(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double x = 0, y = 0, z = 0;
  std::string rest;
  return stream >> x >> y >> z && !(stream >> rest);
}

constexpr double kRoundedTurn = 0.01;  // rad; 6.29 is a whole turn

/// Returns the largest absolute value of the numbers in a text; 0: there is none.
double largest_of(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double largest = 0;
  for (double x = 0; stream >> x;) largest = std::max(largest, std::abs(x));
  return largest;
}

void repair_shape(TiXmlElement& visual_or_collision) {
  TiXmlElement* geometry = visual_or_collision.FirstChildElement("geometry");
  TiXmlElement* mesh = geometry == nullptr ? nullptr : geometry->FirstChildElement("mesh");
  if (mesh == nullptr || mesh->Attribute("scale") == nullptr) return;
  if (!three_numbers(mesh->Attribute("scale"))) mesh->SetAttribute("scale", "0 0 0");
}

void repair_link(TiXmlElement& link) {
  for (TiXmlElement* visual : children(link, "visual")) {
    const TiXmlElement* geometry = visual->FirstChildElement("geometry");
    remove(*visual, "material");
    repair_shape(*visual);
    if (geometry == nullptr || geometry->FirstChildElement() == nullptr) link.RemoveChild(visual);
  }
  for (TiXmlElement* collision : children(link, "collision")) repair_shape(*collision);
}

void repair_joint(TiXmlElement& joint) {
  remove(joint, "safety_controller");
  remove(joint, "calibration");
  const TiXmlElement* axis = joint.FirstChildElement("axis");
  if (axis != nullptr && axis->Attribute("xyz") == nullptr) remove(joint, "axis");
  TiXmlElement* limit = joint.FirstChildElement("limit");
  if (limit == nullptr) return;
  for (const char* name : {"effort", "velocity"}) {
    if (limit->Attribute(name) == nullptr) limit->SetAttribute(name, "0");
  }
}

}  // namespace

TiXmlElement& parse_markup(const RobotDescription& description, TiXmlDocument& xml) {
  check_text(description);
  check_depth(description);
  xml.Parse(description.text.c_str(), nullptr, TIXML_ENCODING_UTF8);
  if (xml.Error()) {
    // TinyXML gives no row of an element that the end of the file cuts off.
    const std::size_t last = description.text.rfind('<');
    const bool cut = xml.ErrorRow() <= 0 && last != std::string::npos;
    const auto begin = description.text.begin();
    const auto row = cut ? 1 + std::count(begin, begin + static_cast<std::ptrdiff_t>(last), '\n') : xml.ErrorRow();
    const std::string line = row > 0 ? " line " + std::to_string(row) : "";
    const std::string what =
        cut ? "the element is not closed (end of file inside it)" : std::string("not well-formed: ") + xml.ErrorDesc();
    refuse(description.source + line, "XML", what, "Check with: xmllint --noout FILE");
  }
  TiXmlElement* root = xml.RootElement();
  if (root == nullptr || root->ValueStr() != "robot") {
    refuse(description.source, "<robot>", "element not found",
           "Check that the file is a URDF: its outermost element is <robot>");
  }
  if (const TiXmlElement* second = root->NextSiblingElement()) {
    refuse(at_line(description, *second), "<" + second->ValueStr() + ">",
           "a second outermost element after <robot> in line " + std::to_string(root->Row()),
           "Remove one: one file describes one robot");
  }
  check_expanded(description, *root);
  for (const char* kind : {"link", "joint"}) {
    for (const TiXmlElement* element : children(*root, kind)) {
      check_percent(description, *element);
      check_name(description, *element);
    }
  }
  const TiXmlElement* const free_one = free_joint(*root);
  for (const TiXmlElement* joint : children(*root, "joint")) check_joint(description, *joint, free_one);
  check_size(description, *root);
  check_tree(description, *root);
  return *root;
}

std::set<std::string> driven_joints(const TiXmlElement& robot) {
  std::set<std::string> joints;
  for (const TiXmlElement* element : children(robot)) {
    if (element->ValueStr() == "gazebo") add_gazebo_joints(*element, joints);
    const bool transmission = element->ValueStr() == "transmission";
    if (!transmission && element->ValueStr() != "ros2_control") continue;
    for (const TiXmlElement* joint : children(*element, "joint")) {
      if (transmission || joint->FirstChildElement("command_interface") != nullptr) {
        joints.insert(attribute(*joint, "name"));
      }
    }
  }
  return joints;
}

std::set<std::string> plugins_that_say(const TiXmlElement& robot, const std::vector<std::string>& words) {
  std::set<std::string> plugins;
  add_plugins_that_say(robot, words, plugins);
  return plugins;
}

std::set<std::string> unsaid_axes(const TiXmlElement& robot) {
  std::set<std::string> joints;
  for (const TiXmlElement* joint : children(robot, "joint")) {
    const TiXmlElement* axis = joint->FirstChildElement("axis");
    const bool fixed = attribute(*joint, "type") == "fixed";
    if (axis == nullptr ? !fixed : axis->Attribute("xyz") == nullptr) joints.insert(attribute(*joint, "name"));
  }
  return joints;
}

std::map<std::string, std::string> turned_origins(const TiXmlElement& robot) {
  std::map<std::string, std::string> origins;
  const auto collect = [&](const TiXmlElement& owner, const std::string& words) {
    const TiXmlElement* origin = owner.FirstChildElement("origin");
    const std::string rpy = origin == nullptr ? "" : attribute(*origin, "rpy");
    if (largest_of(rpy) > 2 * M_PI + kRoundedTurn) origins.emplace(words, rpy);
  };
  for (const TiXmlElement* element : children(robot)) {
    if (element->ValueStr() == "joint") collect(*element, joint_element(attribute(*element, "name")));
    if (element->ValueStr() != "link") continue;
    for (const TiXmlElement* part : children(*element)) {
      collect(*part, link_element(attribute(*element, "name")) + "<" + part->ValueStr() + ">");
    }
  }
  return origins;
}

void repair_markup(TiXmlElement& robot) {
  for (TiXmlElement* element : children(robot)) {
    if (element->ValueStr() == "link") {
      repair_link(*element);
    } else if (element->ValueStr() == "joint") {
      repair_joint(*element);
    } else {
      robot.RemoveChild(element);
    }
  }
}

}  // namespace robot_control
