// Where the program finds what comes with it, and where results go.
#pragma once

#include <string>

namespace harness {

// A file that comes with the program, named as in the source tree: of the share folder beside an
// installed bench, else of the source tree.
std::string source_path(const std::string& relative);
// Where results go by default: results/local of the source tree, for an installed bench of the
// current folder.
std::string local_result(const std::string& name);

}  // namespace harness
