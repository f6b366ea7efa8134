#include "harness/base/errors.h"

#include <algorithm>
#include <numeric>

#include "harness/base/text.h"

namespace harness {
namespace {

constexpr std::size_t longest_message = 600;
constexpr std::size_t longest_name = 200;  // that is compared with others

// Levenshtein distance, for names of a few letters.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substitute = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, substitute});
    }
  }
  return row.back();
}

}  // namespace

UsageError::UsageError(const std::string& message)
    : std::runtime_error(shortened(message, longest_message)) {}

std::string closest(std::string_view name, const std::vector<std::string>& known) {
  name = name.substr(0, longest_name);
  std::string best;
  std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const bool prefix = name.size() >= 2 && candidate.starts_with(name);
    const std::size_t edits = edit_distance(name, candidate);
    const std::size_t distance = prefix ? std::min<std::size_t>(edits, 2) : edits;
    if (distance >= least) continue;
    least = distance;
    best = candidate;
  }
  return best;
}

UsageError unknown_name(std::string_view kind, std::string_view name,
                        const std::vector<std::string>& known) {
  std::string message = "no " + std::string(kind) + " '" + shortened(std::string(name)) + "'";
  const std::string best = closest(name, known);
  if (!best.empty()) message += "; did you mean '" + best + "'?";
  message += " (known: ";
  for (std::size_t i = 0; i < known.size(); ++i) message += (i ? ", " : "") + known[i];
  return UsageError(message + ")");
}

void check_known(std::string_view kind, std::string_view name,
                 const std::vector<std::string>& known, const std::string& where) {
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw UsageError((where.empty() ? "" : where + ": ") + unknown_name(kind, name, known).what());
}

}  // namespace harness
