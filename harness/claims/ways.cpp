#include "harness/claims/ways.h"

#include <algorithm>

namespace harness::claims {

void Ways::add(const std::string& words, const std::string& verdict, const std::string& measured,
               const std::vector<Curve>& evidence) {
  claim_.measured += (verdicts_.empty() ? "" : "; ") + words + ": " + verdict +
                     (measured.empty() ? "" : ", " + measured);
  verdicts_.push_back(verdict);
  if (verdict == not_measured) return;
  for (const Curve& curve : evidence) {
    for (const auto& entry : curve) {
      const std::string id = entry.second.id();
      if (std::find(claim_.points.begin(), claim_.points.end(), id) == claim_.points.end())
        claim_.points.push_back(id);
    }
  }
}

Ways::~Ways() {
  const bool none = std::all_of(verdicts_.begin(), verdicts_.end(),
                                [](const std::string& verdict) { return verdict == not_measured; });
  if (none) claim_.measured.clear();
  if (!verdicts_.empty()) claim_.verdict = verdicts_.front();
}

}  // namespace harness::claims
