#include "harness/tables/results_page.h"

#include "harness/base/errors.h"
#include "harness/claims/claims.h"
#include "harness/tables/page.h"

namespace harness {

void print_results_page(std::ostream& out, const std::vector<NamedResult>& results,
                        const std::vector<NamedResult>& growth,
                        const std::vector<NamedResult>& answers) try {
  std::vector<nlohmann::json> documents;
  documents.reserve(results.size());
  for (const NamedResult& result : results) documents.push_back(result.document);
  for (const NamedResult& result : growth) check_timed(result.document);
  std::vector<NamedResult> sweeps = results, all;
  sweeps.insert(sweeps.end(), growth.begin(), growth.end());
  all = sweeps;
  all.insert(all.end(), answers.begin(), answers.end());

  out << "## The paper's claims\n\n`bench claims` on the same files gives each rule.\n\n";
  print_claims_markdown(out, judge_claims(documents));
  out << "\n## Who is fastest, by strain and error\n\nIn each cell the fastest: its time for one "
         "simulated second and its step in s; then how many times as long the best of the paper's "
         "six takes, if it is not of them. Bold: faster than each other one beyond the noise. "
         "`u`: with untuned settings. Errors are over the scene's size.\n\n";
  tables::print_planes(out, results);
  tables::print_growth(out, sweeps);
  for (const NamedResult& result : results) tables::print_sag(out, result);
  for (const NamedResult& result : results) tables::print_slip(out, result);
  for (const NamedResult& result : answers) tables::print_answers(out, result);
  for (const NamedResult& result : results) tables::print_hard_cases(out, result);
  out << "## Where these numbers come from\n\n";
  tables::print_sources(out, all);
} catch (const nlohmann::json::exception& error) {
  throw UsageError(std::string("a result file is incomplete: ") + error.what());
}

}  // namespace harness
