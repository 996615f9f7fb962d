#include "parameters/parameter_tree.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <sstream>

#include "files/given_path.h"
#include "files/input_file.h"
#include "parameters/text_file.h"
#include "parameters/value_reader.h"

namespace robot_control {
namespace {

std::string at_line(const std::string& source, const YAML::Mark& mark) {
  return mark.is_null() ? source : source + ":" + std::to_string(mark.line + 1);
}

Entry plain_entry_of(const YAML::Node& node) {
  Entry entry;
  if (node.IsScalar()) {
    entry.text = node.Scalar();
    entry.kind = node.Tag() == "!" ? Entry::Kind::kQuoted : Entry::Kind::kPlain;
  } else if (node.IsSequence()) {
    entry.kind = Entry::Kind::kList;
  } else if (node.IsMap()) {
    entry.kind = Entry::Kind::kMap;
  }
  return entry;
}

// Reads one level of a list: no parameter is a list of lists, and YAML's aliases can nest a list in itself.
Entry entry_of(const YAML::Node& node) {
  Entry entry = plain_entry_of(node);
  if (node.IsSequence()) {
    for (const YAML::Node& item : node) entry.items.push_back(plain_entry_of(item));
  }
  return entry;
}

// Calls `visit(name, key node, value node)` for every key of a map, once per name.
template <class Visit>
void for_each_key(const YAML::Node& map, const std::string& prefix, const std::string& source, ProblemList& problems,
                  Visit visit) {
  std::map<std::string, std::string> seen;
  for (const auto& pair : map) {
    const std::string origin = at_line(source, pair.first.Mark());
    if (!pair.first.IsScalar()) {
      problems.add({prefix + "?", "", "a key must be a plain word", origin, ""});
      continue;
    }
    const std::string& name = pair.first.Scalar();
    const auto [first, fresh] = seen.emplace(name, origin);
    if (fresh) {
      visit(name, origin, pair.second);
    } else {
      problems.add({prefix + printable(name), "", "given twice, first at " + first->second, origin, "remove one"});
    }
  }
}

// Puts the value and, if it is a map, each of its values; no parameter is nested deeper.
template <class Put>
void put_value(const std::string& path, const YAML::Node& value, const std::string& origin, const std::string& source,
               ProblemList& problems, Put put) {
  put(path, entry_of(value), origin);
  if (!value.IsMap()) return;
  for_each_key(value, path + ".", source, problems, [&](const auto& name, const auto& inner, const YAML::Node& node) {
    put(path + "." + name, entry_of(node), inner);
  });
}

/// Documents counts the documents of a text and finds their tags, which YAML::Node does not show.
class Documents : public YAML::EventHandler {
  using Mark = YAML::Mark;
  using Style = YAML::EmitterStyle::value;
  using Anchor = YAML::anchor_t;

 public:
  // The count is 0, 1, or 2 for more. YAML::LoadAll would find documents without end in a text that begins with a
  // comma.
  explicit Documents(const std::string& text) {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (count < 2 && parser.HandleNextDocument(*this)) ++count;
  }

  void refuse_tags(const std::string& source, ProblemList& problems) const {
    for (const auto& [tag, mark] : tags_) {
      problems.add({printable(tag), "", "is a YAML tag, which is not supported", at_line(source, mark),
                    "write the plain value, in the unit of the key: angles in rad"});
    }
  }

  std::size_t count = 0;

 private:
  // Collects a tag. yaml-cpp passes "" for no tag, "?" for a plain scalar and "!" for a quoted one.
  void collect(const std::string& tag, const Mark& mark) {
    if (tag.empty() || tag == "?" || tag == "!") return;
    constexpr std::string_view kCore = "tag:yaml.org,2002:";
    tags_.emplace_back(tag.starts_with(kCore) ? "!!" + tag.substr(kCore.size()) : tag, mark);
  }

  void OnDocumentStart(const Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const Mark&, Anchor) override {}
  void OnAlias(const Mark&, Anchor) override {}
  void OnScalar(const Mark& mark, const std::string& tag, Anchor, const std::string&) override { collect(tag, mark); }
  void OnSequenceStart(const Mark& mark, const std::string& tag, Anchor, Style) override { collect(tag, mark); }
  void OnSequenceEnd() override {}
  void OnMapStart(const Mark& mark, const std::string& tag, Anchor, Style) override { collect(tag, mark); }
  void OnMapEnd() override {}

  std::vector<std::pair<std::string, Mark>> tags_;
};

using Foreign = std::optional<Problem> (*)(const std::string& path, const YAML::Node& root);

void read_file(const std::string& yaml_path, Foreign foreign, ParameterTree& tree, ProblemList& problems) {
  std::error_code ignored;
  const std::filesystem::path path = std::filesystem::absolute(yaml_path, ignored);
  const auto text =
      read_text_file(yaml_path, kMaxParameterFile, "give a YAML file like config/robot_params.yaml", problems);
  if (!text) return;
  try {
    const Documents documents(*text);
    if (documents.count != 1) {
      const std::string found = documents.count == 0 ? "none" : "more";
      problems.add({yaml_path, "", "must hold one YAML document, not " + found, "", ""});
      return;
    }
    const YAML::Node root = YAML::Load(*text);
    if (const std::optional<Problem> problem = foreign(yaml_path, root)) {
      problems.add(*problem);
      return;
    }
    documents.refuse_tags(yaml_path, problems);
    read_document(root, yaml_path, path.parent_path(), tree, problems);
  } catch (const YAML::Exception& error) {
    problems.add({yaml_path, "", "is not YAML: " + printable(error.msg), at_line(yaml_path, error.mark), ""});
  }
}

/// Adds those keys of the base file that the tree does not have, also inside a map that both have.
void lay_under(const std::string& base_path, const std::string& yaml_path, Foreign foreign, ParameterTree& tree,
               ProblemList& problems) {
  std::error_code error;
  if (base_path.empty() || !std::filesystem::exists(base_path, error)) return;
  if (!yaml_path.empty() && std::filesystem::equivalent(base_path, yaml_path, error)) return;
  ParameterTree base;
  read_file(base_path, foreign, base, problems);
  for (auto& [path, entry] : base.entries) {
    const std::size_t inner = path.find('.', path.find('.') + 1);
    const auto map = inner == std::string::npos ? tree.entries.end() : tree.entries.find(path.substr(0, inner));
    if (map != tree.entries.end() && map->second.kind != Entry::Kind::kMap) continue;
    entry.base = true;
    tree.entries.emplace(path, std::move(entry));
  }
}

void lay_over(const Overlay& overlay, ParameterTree& tree, ProblemList& problems) {
  const std::filesystem::path folder = caller_folder();
  try {
    Documents(overlay.text).refuse_tags(overlay.origin, problems);
    put_value(overlay.path, YAML::Load(overlay.text), overlay.origin, overlay.origin, problems,
              [&](const std::string& path, Entry entry, const std::string&) {
                // On a server an empty string cannot be written in quotes.
                if (overlay.text.empty()) entry.kind = Entry::Kind::kQuoted;
                entry.origin = overlay.origin;
                entry.folder = folder;
                entry.overlay = true;
                tree.entries.insert_or_assign(path, std::move(entry));
              });
  } catch (const YAML::Exception& error) {
    problems.add(
        {printable(overlay.path), printable(overlay.text), "is not YAML: " + printable(error.msg), overlay.origin, ""});
  }
}

}  // namespace

void lay_request_over(const std::string& block, const std::string& text, ParameterTree& tree, ProblemList& problems) {
  const auto refuse = [&](const std::string& rule) {
    problems.add({"request", printable(text), rule, "", "for example {max_linear_speed: 0.5}"});
  };
  const std::string form = "must be a YAML map of keys of " + block;
  if (text.size() > kMaxRequest) {
    refuse(form + " in at most " + std::to_string(kMaxRequest) + " bytes, not " + std::to_string(text.size()));
    return;
  }
  try {
    const Documents documents(text);
    const YAML::Node map = documents.count == 1 ? YAML::Load(text) : YAML::Node();
    if (!map.IsMap() || map.size() == 0) {
      refuse(form + ", at least one");
      return;
    }
    documents.refuse_tags("request", problems);
    for_each_key(map, block + ".", "request", problems, [&](const auto& name, const auto&, const YAML::Node& value) {
      put_value(block + "." + name, value, "request", "request", problems,
                [&](const std::string& path, Entry entry, const std::string&) {
                  entry.origin = "request";
                  entry.overlay = true;
                  Entry& old = tree.entries[path];
                  if (old.overlay) {
                    problems.add({printable(path), as_written(entry), "given twice, first as " + as_written(old),
                                  "request", "remove one"});
                    return;
                  }
                  old = std::move(entry);
                });
    });
  } catch (const YAML::Exception& error) {
    refuse(form + ", is not YAML: " + printable(error.msg));
  }
}

void read_document(const YAML::Node& root, const std::string& source, const std::filesystem::path& folder,
                   ParameterTree& tree, ProblemList& problems) {
  if (!root.IsMap()) {
    problems.add({source, "", "must consist of blocks, such as robot:", "", ""});
    return;
  }
  for_each_key(root, "", source, problems, [&](const auto& block, const auto& block_origin, const YAML::Node& keys) {
    tree.blocks.push_back({block, block_origin});
    if (keys.IsNull()) return;
    if (!keys.IsMap()) {
      problems.add(
          {printable(block), "", "must be a block of keys", block_origin, "indent `key: value` lines below it"});
      return;
    }
    for_each_key(
        keys, block + ".", source, problems, [&](const auto& name, const auto& origin, const YAML::Node& value) {
          put_value(block + "." + name, value, origin, source, problems,
                    [&](const std::string& path, Entry entry, const std::string& at) {
                      entry.origin = at;
                      entry.folder = folder;
                      const auto [old, fresh] = tree.entries.emplace(path, std::move(entry));
                      if (fresh) return;
                      problems.add({printable(path), "", "given twice, first at " + old->second.origin, at, ""});
                    });
        });
  });
}

ParameterTree read_tree(const std::string& yaml_path, const std::vector<Overlay>& overlays, ProblemList& problems,
                        Foreign foreign, const std::string& base_path) {
  ParameterTree tree;
  if (!yaml_path.empty()) read_file(yaml_path, foreign, tree, problems);
  if (!problems.empty() && tree.blocks.empty()) return tree;
  lay_under(base_path, yaml_path, foreign, tree, problems);
  for (const Overlay& overlay : overlays) lay_over(overlay, tree, problems);
  return tree;
}

}  // namespace robot_control
