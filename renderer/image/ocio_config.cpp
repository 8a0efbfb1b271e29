#include "renderer/image/ocio_config.h"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/core/first_line.h"
#include "renderer/core/shortened.h"

namespace chiaro::renderer {
namespace {

namespace ocio = OCIO_NAMESPACE;

constexpr std::size_t kMostTransforms = 4096, kLongestChain = 64, kMostRepetitions = 1000;
constexpr const char* kExpected = "an OpenColorIO config";

enum class Kind { kColorSpace, kNamedTransform, kLook, kViewTransform, kView };

// What transforms refer to.
struct Node {
  Kind kind;
  std::string name;
  std::string display{};  // of a view
  auto operator<=>(const Node&) const = default;
};

std::string in_words(const Node& node) {
  static constexpr const char* kKinds[] = {"colour space", "named transform", "look", "view transform", "view"};
  return fmt::format("{} \"{}\"", kKinds[int(node.kind)], shortened(node.name, 40));
}

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t");
  return begin == std::string::npos ? "" : text.substr(begin, end + 1 - begin);
}

// "+first, -second | third"
std::vector<std::string> names_of_looks(const std::string& looks) {
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin <= looks.size();) {
    const std::size_t end = std::min(looks.find_first_of(",:|", begin), looks.size());
    std::string name = trimmed(looks.substr(begin, end - begin));
    if (name.starts_with('+') || name.starts_with('-')) name = trimmed(name.substr(1));
    if (!name.empty()) names.push_back(std::move(name));
    begin = end + 1;
  }
  return names;
}

// Follows all references of a config.
class References {
 public:
  References(const ocio::ConstConfigRcPtr& config, const std::filesystem::path& path)
      : config_(config), context_(config->getCurrentContext()), path_(path) {}

  void check() {
    const ocio::SearchReferenceSpaceType all = ocio::SEARCH_REFERENCE_SPACE_ALL;
    for (int i = 0; i < config_->getNumColorSpaces(all, ocio::COLORSPACE_ALL); ++i) {
      follow({Kind::kColorSpace, config_->getColorSpaceNameByIndex(all, ocio::COLORSPACE_ALL, i)});
    }
    for (int i = 0; i < config_->getNumLooks(); ++i) follow({Kind::kLook, config_->getLookNameByIndex(i)});
    for (int i = 0; i < config_->getNumDisplays(); ++i) {
      const char* const display = config_->getDisplay(i);
      for (int v = 0; v < config_->getNumViews(display); ++v) {
        follow({Kind::kView, config_->getView(display, v), display});
      }
    }
  }

 private:
  // Of a node, all references followed.
  struct Size {
    std::size_t transforms = 0, chain = 0;  // chain: 0 while it is being followed
  };

  struct Content {
    std::vector<Node> references;
    std::size_t transforms = 0;
  };

  [[noreturn]] void fail(const Node& node, const std::string& problem, const std::string& expected) const {
    throw Error({path_.string(), in_words(node), problem, expected});
  }

  Size follow(const Node& node, std::size_t above = 0) {
    const auto [found, is_new] = sizes_.try_emplace(node);
    if (!is_new && found->second.chain == 0) fail(node, "refers to itself", "transforms that end");
    if (!is_new) return found->second;
    const Content content = content_of(node);
    Size size{content.transforms, 1};
    for (const Node& reference : content.references) {
      if (above + size.chain > kLongestChain) break;
      const Size further = follow(reference, above + 1);
      size.transforms += further.transforms;
      size.chain = std::max(size.chain, further.chain + 1);
    }
    if (size.transforms > kMostTransforms) {
      fail(node, "asks for more transforms than there is use of", fmt::format("at most {}", kMostTransforms));
    }
    if (above + size.chain > kLongestChain) {
      fail(node, "refers to others that refer to others and so on", fmt::format("at most {} of them", kLongestChain));
    }
    return found->second = size;
  }

  Content content_of(const Node& node) const {
    Content content;
    const char* const name = node.name.c_str();
    if (node.kind == Kind::kColorSpace) {
      if (const auto space = config_->getColorSpace(name)) {
        add(space->getTransform(ocio::COLORSPACE_DIR_TO_REFERENCE), content);
        add(space->getTransform(ocio::COLORSPACE_DIR_FROM_REFERENCE), content);
      }
    } else if (node.kind == Kind::kNamedTransform) {
      if (const auto transform = config_->getNamedTransform(name)) {
        add(transform->getTransform(ocio::TRANSFORM_DIR_FORWARD), content);
        add(transform->getTransform(ocio::TRANSFORM_DIR_INVERSE), content);
      }
    } else if (node.kind == Kind::kLook) {
      if (const auto look = config_->getLook(name)) {
        add_space(look->getProcessSpace(), content);
        add(look->getTransform(), content);
        add(look->getInverseTransform(), content);
      }
    } else if (node.kind == Kind::kViewTransform) {
      if (const auto view = config_->getViewTransform(name)) {
        add(view->getTransform(ocio::VIEWTRANSFORM_DIR_TO_REFERENCE), content);
        add(view->getTransform(ocio::VIEWTRANSFORM_DIR_FROM_REFERENCE), content);
      }
    } else {
      add_view(node, content);
    }
    return content;
  }

  void add_view(const Node& node, Content& content) const {
    const char *const display = node.display.c_str(), *const view = node.name.c_str();
    const std::string space = config_->getDisplayViewColorSpaceName(display, view);
    add_space(space == ocio::OCIO_VIEW_USE_DISPLAY_NAME ? node.display : space, content);
    const std::string transform = config_->getDisplayViewTransformName(display, view);
    if (!transform.empty()) content.references.push_back({Kind::kViewTransform, transform});
    add_looks(config_->getDisplayViewLooks(display, view), content);
  }

  // Between spaces of scenes and of displays stands the default view transform.
  void add_conversion(const std::string& from, const std::string& to, Content& content) const {
    const auto first = add_space(from, content), second = add_space(to, content);
    const auto between = config_->getDefaultSceneToDisplayViewTransform();
    if (!first || !second || !between || first->getReferenceSpaceType() == second->getReferenceSpaceType()) return;
    content.references.push_back({Kind::kViewTransform, between->getName()});
  }

  // By its name, an alias or a role: the space, unless it is a named transform.
  ocio::ConstColorSpaceRcPtr add_space(const std::string& name, Content& content) const {
    const char* const resolved = context_->resolveStringVar(name.c_str());
    const auto space = config_->getColorSpace(resolved);
    if (space) {
      content.references.push_back({Kind::kColorSpace, space->getName()});
    } else if (const auto transform = config_->getNamedTransform(resolved)) {
      content.references.push_back({Kind::kNamedTransform, transform->getName()});
    }
    return space;
  }

  void add_looks(const std::string& looks, Content& content) const {
    for (const std::string& name : names_of_looks(context_->resolveStringVar(looks.c_str()))) {
      content.references.push_back({Kind::kLook, name});
    }
  }

  void add(const ocio::ConstTransformRcPtr& transform, Content& content) const {
    ++content.transforms;
    if (const auto group = std::dynamic_pointer_cast<const ocio::GroupTransform>(transform)) {
      for (int i = 0; i < group->getNumTransforms(); ++i) add(group->getTransform(i), content);
    } else if (const auto spaces = std::dynamic_pointer_cast<const ocio::ColorSpaceTransform>(transform)) {
      add_conversion(spaces->getSrc(), spaces->getDst(), content);
    } else if (const auto looks = std::dynamic_pointer_cast<const ocio::LookTransform>(transform)) {
      add_conversion(looks->getSrc(), looks->getDst(), content);
      add_looks(looks->getLooks(), content);
    } else if (const auto view = std::dynamic_pointer_cast<const ocio::DisplayViewTransform>(transform)) {
      add_space(view->getSrc(), content);
      content.references.push_back({Kind::kView, view->getView(), view->getDisplay()});
    } else if (const auto file = std::dynamic_pointer_cast<const ocio::FileTransform>(transform)) {
      check_file(file->getSrc());
    }
  }

  // Reading of pipes and devices does not end.
  void check_file(const std::string& name) const {
    std::string location;
    try {
      location = context_->resolveFileLocation(name.c_str());
    } catch (const ocio::Exception&) {
      return;  // told where it is needed
    }
    std::error_code ignored;
    const auto type = std::filesystem::status(location, ignored).type();
    if (type == std::filesystem::file_type::not_found || type == std::filesystem::file_type::regular ||
        type == std::filesystem::file_type::directory) {
      return;
    }
    throw Error({path_.string(), fmt::format("\"{}\"", shortened(name, 100)), "is not a file", "a file"});
  }

  ocio::ConstConfigRcPtr config_;
  ocio::ConstContextRcPtr context_;
  const std::filesystem::path& path_;
  std::map<Node, Size> sizes_;
};

bool ends_name(char c) { return std::string_view(" \t\r\n,]}:").find(c) != std::string_view::npos; }

// YAML repeats what is behind an anchor (&name) wherever an alias of it (*name) stands, and what that repeats, and so
// on. What is behind an anchor is taken to reach to the next one.
void refuse_repetition(const std::filesystem::path& path) {
  std::error_code no_file;
  if (!std::filesystem::is_regular_file(path, no_file)) return;
  const std::string text = read_file(path);
  std::map<std::string, double> parts;  // behind each anchor
  std::string last;
  double repeated = 0;
  for (std::size_t at = text.find_first_of("&*"); at != std::string::npos; at = text.find_first_of("&*", at + 1)) {
    const auto end = std::find_if(text.begin() + std::ptrdiff_t(at) + 1, text.end(), ends_name);
    const std::string name(text.begin() + std::ptrdiff_t(at) + 1, end);
    if (text[at] == '&') {
      parts[last = name] = 1;
    } else if (const auto anchor = parts.find(name); anchor != parts.end()) {
      repeated += anchor->second;
      if (name != last) parts[last] += anchor->second;
    }
  }
  if (repeated <= double(kMostRepetitions)) return;
  throw Error({path.string(), "", "repeats parts of itself, and those repeat others, without measure",
               fmt::format("at most {} repetitions", kMostRepetitions)});
}

}  // namespace

ocio::ConstConfigRcPtr load_config(const std::filesystem::path& path) {
  ocio::SetLoggingFunction([](const char*) {});  // warnings of its own, as the config words them
  refuse_repetition(path);
  try {
    const ocio::ConstConfigRcPtr config = ocio::Config::CreateFromFile(path.c_str());
    config->validate();
    References(config, path).check();
    return config;
  } catch (const ocio::Exception& exception) {
    throw Error({path.string(), "", first_line(exception.what()), kExpected});
  }
}

}  // namespace chiaro::renderer
