#include "harness/claims/results_page.h"

#include "harness/base/errors.h"
#include "harness/claims/claims.h"
#include "harness/claims/page.h"

namespace harness {

void print_results_page(std::ostream& out, const std::vector<NamedResult>& results,
                        const std::vector<NamedResult>& growth,
                        const std::vector<NamedResult>& answers) try {
  std::vector<nlohmann::json> documents;
  documents.reserve(results.size());
  for (const NamedResult& result : results) documents.push_back(result.document);
  for (const NamedResult& result : growth) check_timed(result.document);
  out << "## The paper's claims\n\n`bench claims` on the same files gives each rule.\n\n";
  print_claims_markdown(out, judge_claims(documents));
  out << "\n## Who is fastest, by strain and error\n\n";
  for (const NamedResult& result : results) claims::print_planes(out, result);
  out << "## Time over permitted strain, any motion\n\n";
  for (const NamedResult& result : results) claims::print_best_points(out, result, "strain");
  out << "## Time over delivered strain\n\n";
  for (const NamedResult& result : results) claims::print_delivered(out, result);
  out << "## Time over resolution\n\n";
  for (const NamedResult& result : results) claims::print_best_points(out, result, "resolution");
  out << "## Time to reach an error\n\n";
  for (const NamedResult& result : results) claims::print_time_to_error(out, result);
  for (const NamedResult& result : results) claims::print_sag(out, result);
  for (const NamedResult& result : results) claims::print_slip(out, result);
  claims::print_survival(out, results);
  out << "## Growth\n\nThe time of a step grows as the number of vertices to this exponent.\n\n";
  for (const auto* files : {&results, &growth}) {
    for (const NamedResult& result : *files) claims::print_growth(out, result);
  }
  for (const NamedResult& result : answers) claims::print_answers(out, result);
  for (const NamedResult& result : results) claims::print_hard_cases(out, result);
  std::vector<NamedResult> all = results;
  all.insert(all.end(), growth.begin(), growth.end());
  claims::print_tuned(out, all);
  out << "## Where these numbers come from\n\n";
  all.insert(all.end(), answers.begin(), answers.end());
  claims::print_sources(out, all);
} catch (const nlohmann::json::exception& error) {
  throw UsageError(std::string("a result file lacks something: ") + error.what());
}

}  // namespace harness
