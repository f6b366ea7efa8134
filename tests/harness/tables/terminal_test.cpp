// What a terminal shows of invented results: never wider than it may be, and everybody if asked
// for.
#include <gtest/gtest.h>

#include <iterator>

#include "harness/tables/tables.h"
#include "support/invented_runs.h"

namespace harness::tables {
namespace {

using invented::document;
using invented::run;
using nlohmann::json;

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

TEST(Terminal, IsNoWiderThanItMayBeAndLosesNoWord) {
  const json result =
      document({run("fast_projection_adaptive@bdf2", 0.1, 0.04, 1e-3, 0.008),
                run("icd", 0.1, 0.04, 3e-3, 0.03), run("fast_projection", 0.1, 0.02, 2e-3, 0.01)});
  std::ostringstream whole;
  print_sweep(whole, result, "", true, 1000);
  for (const char* words : {"chain, 80 vertices, over strain", "2.00 (1.99-2.01) fast_projection"})
    EXPECT_NE(whole.str().find(words), std::string::npos) << whole.str();
  for (const std::size_t columns : {60, 80, 100}) {
    std::ostringstream out;
    print_sweep(out, result, "", true, columns);
    EXPECT_EQ(words_of(out.str()), words_of(whole.str()));
    std::istringstream lines(out.str());
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), columns) << line;
  }
}

TEST(Terminal, NamesPluginsAndTheCostOfCopying) {
  json engine = run("engine", 0.1, 0.04, 1e-3, 0.008), other = run("filter", 0.1, 0.04, 2e-3, 0.01);
  engine["phases"].update(
      {{"unconstrained", 0.1}, {"filter", 0.7}, {"collision", 0}, {"copy", 0.2}});
  json failed = engine;
  failed["status"] = "diverged";
  failed["phases"]["copy"] = 9;
  json result = document({engine, other, failed});
  std::ostringstream without, with;
  print_sweep(without, result, "");
  EXPECT_EQ(without.str().find("plug-in"), std::string::npos);
  result["context"]["plugins"] = {{{"version", "Engine 1.2"}, {"solvers", {"engine"}}},
                                  {{"version", "3"}, {"solvers", {"filter"}}}};
  print_sweep(with, result, "");
  EXPECT_NE(
      with.str().find("plug-in engine: Engine 1.2; copying its state takes 20 % of its time\n"),
      std::string::npos)
      << with.str();
  EXPECT_NE(with.str().find("plug-in filter: 3\n"), std::string::npos) << with.str();
}

}  // namespace
}  // namespace harness::tables
