// Bad input: one clear line for the user, exit 2.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace harness {

class UsageError : public std::runtime_error {
 public:
  // One line, whatever names and values it holds, and not a long one.
  explicit UsageError(const std::string& message);
};

// The known name that a mistyped one is nearest to; empty if none is near.
std::string closest(std::string_view name, const std::vector<std::string>& known);

// "no solver 'fast'; did you mean 'fast_projection'? (known: a, b, c)"
[[nodiscard]] UsageError unknown_name(std::string_view kind, std::string_view name,
                                      const std::vector<std::string>& known);

// Throws unknown_name() unless `name` is known. where: begins the message; may be empty.
void check_known(std::string_view kind, std::string_view name,
                 const std::vector<std::string>& known, const std::string& where = "");

template <class Infos>
std::vector<std::string> names_of(const Infos& infos) {
  std::vector<std::string> names;
  names.reserve(infos.size());
  for (const auto& info : infos) names.emplace_back(info.name);
  return names;
}

}  // namespace harness
