// Figures of result files, drawn by the scripts of plots/.
#pragma once

#include <string>
#include <vector>

namespace harness {

// Runs a script of plots/ on result files; its paths go to stdout as they are. Its exit code.
int draw(const std::vector<std::string>& arguments, const std::string& script = "figures.py");
// The figures of a result file, with the analysis that they are drawn from. Throws UsageError for a
// file that is none.
int draw_result(const std::string& file, const std::vector<std::string>& more = {});
// Those of several files that are pieces of one sweep, drawn as one (points/joined.h). name: what
// their pictures' names begin with.
int draw_pieces(const std::vector<std::string>& files, const std::string& name,
                const std::vector<std::string>& more);

}  // namespace harness
