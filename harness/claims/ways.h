// The same claim looked at in several ways.
#pragma once

#include <string>
#include <vector>

#include "harness/claims/curves.h"

namespace harness::claims {

// A level of error that a claim is looked at, and how the text says it. The first decides: the
// project's question. The second, the paper's own, stands beside it.
struct Level {
  double error;
  const char* words;
};
inline constexpr std::array claim_levels{Level{headline_error, "at an error of at most 2 %"},
                                         Level{any_motion, "at any motion"}};

// Collects what each way says; the claim's verdict is the first one's.
class Ways {
 public:
  explicit Ways(ClaimVerdict& claim) : claim_(claim) {}
  Ways(const Ways&) = delete;
  Ways& operator=(const Ways&) = delete;
  ~Ways();

  void add(const std::string& words, const std::string& verdict, const std::string& measured,
           const std::vector<Curve>& evidence = {});

 private:
  ClaimVerdict& claim_;
  std::vector<std::string> verdicts_;
};

}  // namespace harness::claims
