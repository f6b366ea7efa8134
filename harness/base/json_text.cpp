#include "harness/base/json_text.h"

namespace harness {
namespace {

using nlohmann::ordered_json;

template <class Json>
std::string written(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string name_of(const std::string& key) { return written(ordered_json(key)) + ": "; }

// {a, b} or [a, b], from what each item is written as.
template <class Written>
std::string enclosed(const ordered_json& value, const std::string& separator,
                     const std::string& end, const Written& item_text) {
  std::string text, between = separator;
  for (const auto& [key, item] : value.items()) {
    text += between + (value.is_object() ? name_of(key) : "") + item_text(key, item);
    between = "," + (separator.empty() ? " " : separator);
  }
  return (value.is_object() ? "{" : "[") + text + end + (value.is_object() ? "}" : "]");
}

// The entries of `depth` levels a line each.
std::string lines(const ordered_json& value, int depth) {
  if (!value.is_structured()) return written(value);
  const char* separator = depth > 0 && !value.empty() ? "\n" : "";
  return enclosed(
      value, separator, separator,
      [depth](const std::string&, const ordered_json& item) { return lines(item, depth - 1); });
}

std::string folded(const ordered_json& value, std::size_t room, std::size_t width,
                   std::size_t indent) {
  std::string line = line_of(value);
  if (!value.is_structured() || value.empty() || line.size() <= room) return line;
  const std::string inner = "\n" + std::string(indent + 2, ' ');
  return enclosed(value, inner, "\n" + std::string(indent, ' '),
                  [&](const std::string& key, const ordered_json& item) {
                    const std::size_t used =
                        indent + 3 + (value.is_object() ? name_of(key).size() : 0);
                    return folded(item, width > used ? width - used : 0, width, indent + 2);
                  });
}

}  // namespace

std::string compact(const nlohmann::json& value) { return written(value); }

std::string line_of(const ordered_json& value) { return lines(value, 0); }

std::string folded_text(const ordered_json& value, std::size_t width) {
  return folded(value, width, width, 0) + "\n";
}

std::string document_text(const ordered_json& document) { return lines(document, 2) + "\n"; }

}  // namespace harness
