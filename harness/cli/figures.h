// Figures, films and reports, drawn by the scripts of plots/.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace harness {

// Runs a script of plots/ with these arguments and --out <a folder of its own>, or --out <that
// folder>/<name> with a name. What it has written there takes its place in `folder`, file by file
// and each whole, and is named on stdout. Its exit code; where that is not 0, nothing is touched.
int draw(const std::string& script, const std::vector<std::string>& arguments,
         const std::string& folder, const std::string& name = {});

// A result as plots/ reads it: a sweep with its analysis. Throws UsageError where nothing was
// timed.
nlohmann::json with_analysis(nlohmann::json document);

// The figures of a result file, with the analysis that they are drawn from. folder: "" for that of
// the file. Throws UsageError for a file that is none.
int draw_result(const std::string& file, std::string folder = {});
// Those of several files that are pieces of one sweep, drawn as one (points/joined.h). name: what
// their pictures' names begin with.
int draw_pieces(const std::vector<std::string>& files, const std::string& name,
                std::string folder = {});

}  // namespace harness
